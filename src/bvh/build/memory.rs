//! How much memory a builder will take.

use super::Builder;

/// What every build may take beside, for the small subtrees that threads work on.
const SCRATCH: u64 = 2 << 20;

impl Builder {
    /// Bytes on the heap while a tree over so many triangles is built, at most, on ordinary
    /// meshes: positions and indices not counted, one thread.
    ///
    /// Most of it grows with the leaves, each of which takes the room of 16 triangles however many
    /// it has. Triangles that are farther from each other than they are long fill it least.
    pub fn peak_bytes(self, triangles: u64) -> u64 {
        let per_triangle = match self {
            Self::None => 48,
            Self::Median => 290,
            Self::Fast => 92,
            Self::Balanced => 72,
            Self::Quality => 110,
        };
        SCRATCH + per_triangle * triangles
    }

    /// Bytes of the tree in the end, at most, on ordinary meshes.
    pub fn tree_bytes(self, triangles: u64) -> u64 {
        let per_triangle = match self {
            Self::None => 41,
            Self::Median => 280,
            Self::Fast | Self::Balanced => 66,
            Self::Quality => 90,
        };
        (64 << 10) + per_triangle * triangles
    }
}
