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
    case(
        "G1",
        "watertight: rays at vertices and edges of closed meshes",
        watertight::run,
    ),
    case("G2", "needles and slivers", slivers::run),
    case("G3", "degenerate input", degenerate::run),
    case("G4", "scaled by a power of two", scaling::powers_of_two),
    case("G5", "scaled by a power of ten", scaling::powers_of_ten),
    case("G6", "far from the origin", far::run),
    case("G7", "self-intersection of a convex body", body::run),
    case("G8", "thin wall", thin_wall::run),
    case("G9", "grazing light and view", grazing::run),
    case("G10", "coplanar stack", coplanar::run),
    case("G11", "smooth normals on a coarse sphere", terminator::run),
    case(
        "G12",
        "rays along axes, on faces, with zeros of both signs",
        trees::along_axes,
    ),
    case(
        "G13",
        "trees against brute force in double precision",
        trees::against_brute_force,
    ),
];

const fn case(
    id: &'static str,
    name: &'static str,
    run: fn(super::Effort) -> Vec<super::Check>,
) -> Case {
    Case { id, name, run }
}
