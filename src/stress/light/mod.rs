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
    Case::new("L1", "penumbra of a half plane", half_plane::run),
    Case::new("L2", "disk emitter", emitters::disks),
    Case::new("L3", "sphere emitter", emitters::spheres),
    Case::new("L4", "rectangle emitter", emitters::rectangles),
    Case::new("L5", "vanishing radius", radius::vanishing),
    Case::new("L6", "huge and touching lights", radius::huge),
    Case::new("L7", "white furnace", furnace::run),
    Case::new("L8", "facing mirrors", mirrors::run),
    Case::new("L9", "glass", glass::run),
    Case::new("L10", "narrow lobes", lobes::run),
    Case::new("L11", "intensities of any size", intensities::run),
    Case::new("L12", "2^24 samples in one pixel", many_samples::run),
    Case::new("L13", "samplers at any count", samplers::run),
];
