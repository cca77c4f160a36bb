//! L1 to L13: light of any size, distance and strength.

mod emitters;
mod furnace;
mod glass;
mod half_plane;
mod intensities;
mod lobes;
mod many_samples;
mod mirrors;
mod radius;
mod samplers;

use super::Case;

/// All of them.
pub const CASES: &[Case] = &[
    case("L1", "penumbra of a half plane", half_plane::run),
    case("L2", "disk emitter", emitters::disks),
    case("L3", "sphere emitter", emitters::spheres),
    case("L4", "rectangle emitter", emitters::rectangles),
    case("L5", "vanishing radius", radius::vanishing),
    case("L6", "huge and touching lights", radius::huge),
    case("L7", "white furnace", furnace::run),
    case("L8", "facing mirrors", mirrors::run),
    case("L9", "glass", glass::run),
    case("L10", "narrow lobes", lobes::run),
    case("L11", "intensities of any size", intensities::run),
    case("L12", "2^24 samples in one pixel", many_samples::run),
    case("L13", "samplers at any count", samplers::run),
];

const fn case(
    id: &'static str,
    name: &'static str,
    run: fn(super::Effort) -> Vec<super::Check>,
) -> Case {
    Case { id, name, run }
}
