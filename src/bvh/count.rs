//! Counting what a traversal does.

/// What a traversal looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalCounts {
    /// Inner nodes whose children's boxes were tested.
    pub nodes: u64,
    /// Leaves whose triangles were filtered.
    pub leaves: u64,
    /// Triangles that came to the exact test.
    pub triangles: u64,
}

/// Is told what a traversal does; [`Silent`] costs nothing.
pub(super) trait Counter {
    /// An inner node is tested.
    fn node(&mut self) {}
    /// A leaf is filtered.
    fn leaf(&mut self) {}
    /// A triangle comes to the exact test.
    fn triangle(&mut self) {}
}

/// Counts nothing.
pub(super) struct Silent;

impl Counter for Silent {}

impl Counter for TraversalCounts {
    #[inline(always)]
    fn node(&mut self) {
        self.nodes += 1;
    }
    #[inline(always)]
    fn leaf(&mut self) {
        self.leaves += 1;
    }
    #[inline(always)]
    fn triangle(&mut self) {
        self.triangles += 1;
    }
}
