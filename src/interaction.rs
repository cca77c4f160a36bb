//! Where a ray meets a surface, and the rays that start there.

use crate::math::{Ray, UNIT_ROUNDOFF, UnitVec3, Vec3, gamma, larger};

/// A point on a surface, seen from a direction.
///
/// Both normals are on the side that [`Interaction::wo`] is on.
#[derive(Clone, Copy, Debug)]
pub struct Interaction {
    /// The point.
    pub point: Vec3,
    /// How far the true point may be from `point` along each axis.
    pub point_error: Vec3,
    /// Where vertex normals say that the surface bulges out of its triangle: a point above `point` on the bulge, where
    /// shadow rays start ([`LitSide`]).
    pub smooth_point: Option<Vec3>,
    /// Normal of the triangle.
    pub geometric_normal: UnitVec3,
    /// Interpolated and bumped normal; what shading uses.
    pub shading_normal: UnitVec3,
    /// Towards the viewer, away from the surface.
    pub wo: UnitVec3,
    /// Whether the viewer is outside: on the side that the triangle's winding faces.
    pub is_front: bool,
}

impl Interaction {
    /// A ray from here along `direction`, which starts off the surface on that side.
    ///
    /// The start is moved by the error bound of the point, so it is on the right side of the
    /// triangle whatever the scale (Pharr, Jakob, Humphreys 2023, "Physically Based Rendering",
    /// section 6.8.6).
    #[inline(always)]
    pub fn spawn_ray(&self, direction: Vec3) -> Ray {
        Ray::new(self.origin_towards(direction), direction)
    }

    /// What lights in front need to know of it.
    #[inline(always)]
    pub fn lit_side(&self) -> LitSide {
        let start = self.smooth_point.unwrap_or(self.point);
        LitSide {
            point: self.point,
            shadow_origin: self.moved(start, *self.geometric_normal),
            is_bulging: self.smooth_point.is_some(),
            geometric_normal: self.geometric_normal,
            shading_normal: self.shading_normal,
        }
    }

    /// A ray from here to `target`, with `target` at `t = 1` and the ray ending just before it.
    #[inline(always)]
    pub fn spawn_ray_to(&self, target: Vec3) -> Ray {
        ray_to(self.origin_towards(target - self.point), target)
    }

    #[inline(always)]
    fn origin_towards(&self, direction: Vec3) -> Vec3 {
        let n = *self.geometric_normal;
        self.moved(self.point, if n.dot(direction) < 0.0 { -n } else { n })
    }

    /// `point` moved along `n` by the bound of its error.
    #[inline(always)]
    fn moved(&self, point: Vec3, n: Vec3) -> Vec3 {
        let offset = n * (n.abs().dot(self.point_error) * (1.0 + const { gamma(4) }));
        Vec3::new(
            away(point.x, offset.x),
            away(point.y, offset.y),
            away(point.z, offset.z),
        )
    }
}

/// A point on a surface, as lights in front of it see it.
///
/// Where vertex normals say that the surface bulges, shadow rays start on the bulge: from there light is seen as far
/// below the horizon of the triangle as that of the smooth surface reaches, so that shadows do not end at
/// edges of triangles (Hanika 2021, "Hacking the Shadow Terminator", in "Ray Tracing Gems II").
#[derive(Clone, Copy, Debug)]
pub struct LitSide {
    /// The point.
    pub point: Vec3,
    /// Where shadow rays start: off the surface on its front, as those of [`Interaction::spawn_ray`].
    pub shadow_origin: Vec3,
    /// Whether that is above the triangle by more than rounding.
    pub is_bulging: bool,
    /// Normal of the triangle.
    pub geometric_normal: UnitVec3,
    /// Interpolated and bumped normal; what shading uses.
    pub shading_normal: UnitVec3,
}

impl LitSide {
    /// Whether light from `direction` does not come from behind the triangle, or passes over the bulge that hides
    /// it from the triangle.
    #[inline(always)]
    pub fn can_see(&self, direction: Vec3) -> bool {
        self.is_bulging | (self.geometric_normal.dot(direction) > 0.0)
    }

    /// A shadow ray along `direction`.
    #[inline(always)]
    pub fn shadow_ray(&self, direction: Vec3) -> Ray {
        Ray::new(self.shadow_origin, direction)
    }

    /// A shadow ray to `target`, with `target` at `t = 1` and the ray ending just before it.
    #[inline(always)]
    pub fn shadow_ray_to(&self, target: Vec3) -> Ray {
        ray_to(self.shadow_origin, target)
    }
}

/// `p + offset`, rounded away from `p`, so that the sum does not take the offset back.
#[inline(always)]
fn away(p: f32, offset: f32) -> f32 {
    let sum = p + offset;
    let (bits, is_up) = (sum.to_bits(), offset > 0.0);
    // `next_up` and `next_down` without a branch.
    let next = if (sum > 0.0) == is_up {
        bits + 1
    } else {
        bits.wrapping_sub(1)
    };
    let next = if sum == 0.0 {
        1 | (u32::from(!is_up) << 31)
    } else {
        next
    };
    if (offset != 0.0) & (sum.abs() < f32::INFINITY) {
        f32::from_bits(next)
    } else {
        sum
    }
}

/// The ray from `origin` with `target` at `t = 1` that ends just before it.
///
/// Surfaces that touch `target` within rounding do not count as in between.
#[inline(always)]
fn ray_to(origin: Vec3, target: Vec3) -> Ray {
    let direction = target - origin;
    let length = largest(direction);
    // A surface through `target` is off by up to a few roundings of the coordinates.
    let slack = const { gamma(8) } * (1.0 + larger(largest(origin), largest(target)) / length);
    Ray {
        t_max: larger(1.0 - slack, 0.0),
        ..Ray::new(origin, direction)
    }
}

#[inline(always)]
fn largest(v: Vec3) -> f32 {
    larger(larger(v.x.abs(), v.y.abs()), v.z.abs())
}

/// The error of a point that was computed in double precision and rounded once.
#[inline(always)]
pub fn rounding_error(point: Vec3) -> Vec3 {
    point.abs() * UNIT_ROUNDOFF
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_rounded_away_from_where_they_start() {
        let all = [0.0, -0.0, 1e-45, 1.0, f32::MIN_POSITIVE, 3e38];
        for p in all.into_iter().flat_map(|p| [p, -p]) {
            for offset in all.into_iter().flat_map(|o| [o, -o]) {
                let sum = p + offset;
                let next = if offset > 0.0 {
                    sum.next_up()
                } else {
                    sum.next_down()
                };
                let expected = if offset == 0.0 || sum.is_infinite() {
                    sum
                } else {
                    next
                };
                assert_eq!(
                    away(p, offset).to_bits(),
                    expected.to_bits(),
                    "{p} + {offset}"
                );
            }
        }
    }

    #[test]
    fn rays_start_on_the_side_they_go_to_at_any_scale() {
        for exponent in -30..30 {
            let scale = 2f32.powi(exponent);
            let normal = UnitVec3::normalize(Vec3::new(1.0, 2.0, -0.5)).unwrap_or(UnitVec3::Z);
            let point = Vec3::new(0.3, -1.7, 12.0) * scale;
            let interaction = Interaction {
                point,
                point_error: rounding_error(point),
                smooth_point: None,
                geometric_normal: normal,
                shading_normal: normal,
                wo: normal,
                is_front: true,
            };
            let side = |ray: Ray| (ray.origin - point).as_dvec3().dot(normal.as_dvec3());
            assert!(side(interaction.spawn_ray(*normal)) > 0.0);
            assert!(side(interaction.spawn_ray(-*normal)) < 0.0);
        }
    }
}
