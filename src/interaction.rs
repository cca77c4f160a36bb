//! Where a ray meets a surface, and the rays that start there.

use crate::math::{Ray, UNIT_ROUNDOFF, UnitVec3, Vec3, gamma};

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
    /// shadow rays start ([`Self::shadow_ray`]).
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
    pub fn spawn_ray(&self, direction: Vec3) -> Ray {
        Ray::new(self.origin_towards(direction), direction)
    }

    /// A shadow ray from here along `direction`: as [`Self::spawn_ray`], but from the smooth point, where there is one.
    ///
    /// From there light is seen as far below the horizon of the triangle as that of the smooth surface
    /// reaches, so that shadows do not end at edges of triangles (Hanika 2021, "Hacking the Shadow
    /// Terminator", in "Ray Tracing Gems II").
    pub fn shadow_ray(&self, direction: Vec3) -> Ray {
        match self.smooth_point {
            Some(_) => Ray::new(self.smooth_origin(), direction),
            None => self.spawn_ray(direction),
        }
    }

    /// A shadow ray from here to `target`: as [`Self::spawn_ray_to`], but from the smooth point, where there is one.
    pub fn shadow_ray_to(&self, target: Vec3) -> Ray {
        match self.smooth_point {
            Some(_) => ray_to(self.smooth_origin(), target),
            None => self.spawn_ray_to(target),
        }
    }

    /// Whether light from `direction` does not come from behind the triangle, or passes over the bulge that hides
    /// it from the triangle.
    pub fn can_see(&self, direction: Vec3) -> bool {
        self.smooth_point.is_some() || self.geometric_normal.dot(direction) > 0.0
    }

    /// A ray from here to `target`, with `target` at `t = 1` and the ray ending just before it.
    ///
    /// Surfaces that touch `target` within rounding do not count as in between.
    pub fn spawn_ray_to(&self, target: Vec3) -> Ray {
        ray_to(self.origin_towards(target - self.point), target)
    }

    fn origin_towards(&self, direction: Vec3) -> Vec3 {
        let n = *self.geometric_normal;
        self.moved(self.point, if n.dot(direction) < 0.0 { -n } else { n })
    }

    /// On the viewer's side of the triangle, whatever the direction: it is the bulge that is left, not the triangle.
    fn smooth_origin(&self) -> Vec3 {
        self.moved(
            self.smooth_point.unwrap_or(self.point),
            *self.geometric_normal,
        )
    }

    /// `point` moved along `n` by the bound of its error.
    fn moved(&self, point: Vec3, n: Vec3) -> Vec3 {
        let offset = n * (n.abs().dot(self.point_error) * (1.0 + gamma(4)));
        let away = |p: f32, o: f32| {
            let moved = p + o;
            // Round away from the surface, so that the sum does not take the offset back.
            if o > 0.0 {
                moved.next_up()
            } else if o < 0.0 {
                moved.next_down()
            } else {
                moved
            }
        };
        Vec3::new(
            away(point.x, offset.x),
            away(point.y, offset.y),
            away(point.z, offset.z),
        )
    }
}

/// The ray from `origin` with `target` at `t = 1` that ends just before it.
fn ray_to(origin: Vec3, target: Vec3) -> Ray {
    let direction = target - origin;
    let length = direction.abs().max_element();
    let largest = origin.abs().max(target.abs()).max_element();
    // A surface through `target` is off by up to a few roundings of the coordinates.
    let slack = gamma(8) * (1.0 + largest / length);
    Ray {
        t_max: (1.0 - slack).max(0.0),
        ..Ray::new(origin, direction)
    }
}

/// The error of a point that was computed in double precision and rounded once.
pub fn rounding_error(point: Vec3) -> Vec3 {
    point.abs() * UNIT_ROUNDOFF
}

#[cfg(test)]
mod tests {
    use super::*;

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
