//! From a point on a surface to what a light was sampled at.

use crate::interaction::{Interaction, LitSide};
use crate::light::ShadowEnd;
use crate::math::{Ray, UnitVec3, Vec3};

/// A way from a surface to a light.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// The shadow ray.
    pub ray: Ray,
    /// Magnitude of the cosine of the light's direction with the shading normal.
    pub cos: f32,
    /// Whether the light is behind the surface, and shows on what scatters it through.
    pub is_behind: bool,
}

/// The way to `end`, which is sampled of a light in the direction `wi`; `None` where the normals of the surface do not agree
/// on which side that is.
pub fn way(at: &Interaction, wi: UnitVec3, end: ShadowEnd) -> Option<Way> {
    match way_in_front(&at.lit_side(), wi, end) {
        (way, true) => Some(way),
        (_, false) => way_behind(at, wi, end),
    }
}

/// The way to light in front, and whether it is in front by both normals, or passes over a bulge. Without a branch.
#[inline(always)]
pub fn way_in_front(at: &LitSide, wi: UnitVec3, end: ShadowEnd) -> (Way, bool) {
    let cos = at.shading_normal.dot(*wi);
    let (ray, is_end_seen) = match end {
        // The end of the shadow ray may be below the horizon of a point that sees the centre.
        ShadowEnd::Point(end) => (at.shadow_ray_to(end), at.can_see(end - at.point)),
        ShadowEnd::Direction(direction) => (at.shadow_ray(*direction), true),
    };
    let way = Way {
        ray,
        cos,
        is_behind: false,
    };
    (way, (cos > 0.0) & at.can_see(*wi) & is_end_seen)
}

fn way_behind(at: &Interaction, wi: UnitVec3, end: ShadowEnd) -> Option<Way> {
    let cos = at.shading_normal.dot(*wi);
    let is_behind = |direction: Vec3| at.geometric_normal.dot(direction) < 0.0;
    let (ray, is_end_behind) = match end {
        ShadowEnd::Point(end) => (at.spawn_ray_to(end), is_behind(end - at.point)),
        ShadowEnd::Direction(direction) => (at.spawn_ray(*direction), true),
    };
    let way = Way {
        ray,
        cos: -cos,
        is_behind: true,
    };
    (cos <= 0.0 && is_behind(*wi) && is_end_behind).then_some(way)
}
