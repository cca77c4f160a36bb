//! G1 to G13: geometry of any size, shape and place.

mod body;
mod coplanar;
mod degenerate;
mod far;
mod grazing;
mod scaling;
mod slivers;
mod terminator;
mod thin_wall;
mod trees;
mod watertight;

use super::Case;

/// All of them.
pub const CASES: &[Case] = &[
    Case::new(
        "G1",
        "watertight: rays at vertices and edges of closed meshes",
        watertight::run,
    ),
    Case::new("G2", "needles and slivers", slivers::run),
    Case::new("G3", "degenerate input", degenerate::run),
    Case::new("G4", "scaled by a power of two", scaling::powers_of_two),
    Case::new("G5", "scaled by a power of ten", scaling::powers_of_ten),
    Case::new("G6", "far from the origin", far::run),
    Case::new("G7", "self-intersection of a convex body", body::run),
    Case::new("G8", "thin wall", thin_wall::run),
    Case::new("G9", "grazing light and view", grazing::run),
    Case::new("G10", "coplanar stack", coplanar::run),
    Case::new("G11", "smooth normals on a coarse sphere", terminator::run),
    Case::new(
        "G12",
        "rays along axes, on faces, with zeros of both signs",
        trees::along_axes,
    ),
    Case::new(
        "G13",
        "trees against brute force in double precision",
        trees::against_brute_force,
    ),
];
