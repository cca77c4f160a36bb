//! Cameras: from a point on the film to a ray.

use crate::math::{Mat3, ROW, Ray, RayRow, RowJob, UVec2, UnitVec3, Vec2, Vec3, widely};

/// A camera at a place, looking along a direction.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Its eye, relative to the origin that its owner states.
    pub position: Vec3,
    /// To the right of the picture.
    pub right: UnitVec3,
    /// To the top of the picture.
    pub up: UnitVec3,
    /// Against the view: the camera looks along `-back`.
    pub back: UnitVec3,
    /// How points of the film become directions.
    pub projection: Projection,
    /// Radius of the thin lens; 0 for a pinhole.
    pub lens_radius: f32,
    /// Distance of the plane that is in focus, along the view; used where there is a lens.
    pub focus_distance: f32,
}

/// How points of the film become directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the eye.
    Perspective {
        /// Full angle between the bottom and the top of the picture, in radians, in `(0, pi)`.
        vertical_fov_radians: f32,
    },
    /// All rays are parallel.
    Orthographic {
        /// Half the height of what is seen.
        half_height: f32,
    },
}

impl Camera {
    /// A pinhole at `position`, looking at `target`, `up` to the top of the picture.
    ///
    /// `None` where `position` and `target` coincide. An `up` along the view is replaced.
    pub fn look_at(
        position: Vec3,
        target: Vec3,
        up: Vec3,
        vertical_fov_radians: f32,
    ) -> Option<Self> {
        let back = UnitVec3::normalize(position - target)?;
        let right = UnitVec3::normalize(up.cross(*back))
            .unwrap_or_else(|| UnitVec3::from_normalized(back.any_orthonormal_vector()));
        let up = UnitVec3::normalize(back.cross(*right))?;
        Some(Self {
            position,
            right,
            up,
            back,
            projection: Projection::Perspective {
                vertical_fov_radians,
            },
            lens_radius: 0.0,
            focus_distance: (position - target).length(),
        })
    }

    /// This camera in coordinates that are scaled by `scale` and then moved by `offset`.
    pub fn placed(&self, scale: f32, offset: Vec3) -> Self {
        Self {
            position: self.position * scale + offset,
            projection: match self.projection {
                Projection::Orthographic { half_height } => Projection::Orthographic {
                    half_height: half_height * scale,
                },
                perspective => perspective,
            },
            lens_radius: self.lens_radius * scale,
            focus_distance: self.focus_distance * scale,
            ..*self
        }
    }

    /// This camera turned by `radians` about the y axis through `center`, a point in its coordinates; from above
    /// against the clock.
    pub fn turned(&self, center: Vec3, radians: f32) -> Self {
        let rotation = Mat3::from_rotation_y(radians);
        let turned = |v: UnitVec3| UnitVec3::normalize(rotation * *v).unwrap_or(v);
        Self {
            position: center + rotation * (self.position - center),
            right: turned(self.right),
            up: turned(self.up),
            back: turned(self.back),
            ..*self
        }
    }

    #[inline(always)]
    fn in_world(&self, v: Vec3) -> Vec3 {
        *self.right * v.x + *self.up * v.y + *self.back * v.z
    }

    /// What makes its rays through a film of `size` pixels.
    pub fn rays(&self, size: UVec2) -> CameraRays<'_> {
        CameraRays {
            camera: self,
            size: size.as_vec2(),
            half_height: match self.projection {
                Projection::Perspective {
                    vertical_fov_radians,
                } => (0.5 * vertical_fov_radians).tan(),
                Projection::Orthographic { half_height } => half_height,
            },
        }
    }
}

/// The rays of a camera through a film.
#[derive(Clone, Copy, Debug)]
pub struct CameraRays<'a> {
    camera: &'a Camera,
    size: Vec2,
    /// Of what is seen; with perspective at distance 1.
    half_height: f32,
}

impl CameraRays<'_> {
    /// [`Self::at`] of the first `count` places of a row.
    pub fn row(&self, film: &[Vec2; ROW], lens: &[Vec2; ROW], count: usize) -> RayRow {
        widely(RaysAt {
            rays: self,
            film,
            lens,
            count,
        })
    }

    /// The ray through `film`, in pixels from the upper left corner of the film.
    ///
    /// `lens` is a point of the unit disk; a pinhole ignores it. The direction has length 1.
    #[inline(always)]
    pub fn at(&self, film: Vec2, lens: Vec2) -> Ray {
        let Self { camera, size, .. } = self;
        // From -1 to 1 up the picture, and in the same measure across it.
        let x = (2.0 * film.x - size.x) / size.y;
        let y = 1.0 - 2.0 * film.y / size.y;
        let across = Vec3::new(x * self.half_height, y * self.half_height, 0.0);
        let (origin, direction) = match camera.projection {
            Projection::Perspective { .. } => (Vec3::ZERO, across - Vec3::Z),
            Projection::Orthographic { .. } => (across, -Vec3::Z),
        };
        let (origin, direction) = if camera.lens_radius > 0.0 {
            let in_focus = origin + direction * camera.focus_distance;
            let on_lens = origin + (camera.lens_radius * lens).extend(0.0);
            (on_lens, in_focus - on_lens)
        } else {
            (origin, direction)
        };
        Ray::new(
            camera.position + camera.in_world(origin),
            camera.in_world(direction.normalize()),
        )
    }
}

struct RaysAt<'a> {
    rays: &'a CameraRays<'a>,
    film: &'a [Vec2; ROW],
    lens: &'a [Vec2; ROW],
    count: usize,
}

impl RowJob for RaysAt<'_> {
    type Output = RayRow;

    #[inline(always)]
    fn call(self) -> RayRow {
        let mut rays = RayRow::endless(self.count);
        for i in 0..ROW {
            let ray = self.rays.at(self.film[i], self.lens[i]);
            rays.origins.set(i, ray.origin);
            rays.directions.set(i, ray.direction);
        }
        rays
    }
}

/// The film position of sample offset `u` in `[0, 1)²` of `pixel`; in single precision an offset
/// just below 1 may round to the border with the next pixel.
pub fn film_position(pixel: UVec2, u: Vec2) -> Vec2 {
    pixel.as_vec2() + u
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera::look_at(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0).expect("a direction")
    }

    #[test]
    fn the_middle_of_the_film_looks_at_the_target() {
        let ray = camera()
            .rays(UVec2::new(80, 60))
            .at(Vec2::new(40.0, 30.0), Vec2::ZERO);
        assert!((ray.direction - Vec3::new(0.0, 0.0, -1.0)).length() < 1e-6);
    }

    #[test]
    fn the_field_of_view_spans_the_height() {
        let camera = camera();
        let rays = camera.rays(UVec2::new(80, 60));
        let top = rays.at(Vec2::new(40.0, 0.0), Vec2::ZERO).direction;
        let bottom = rays.at(Vec2::new(40.0, 60.0), Vec2::ZERO).direction;
        assert!((top.angle_between(bottom) - 1.0).abs() < 1e-5);
        assert!(top.y > 0.0);
    }

    #[test]
    fn a_turned_camera_sees_the_centre_at_the_same_place() {
        let center = Vec3::new(1.0, 0.5, -2.0);
        for step in 0..8 {
            let turned = camera().turned(center, step as f32 * std::f32::consts::FRAC_PI_4);
            let seen = |camera: Camera| {
                let to = center - camera.position;
                [camera.right, camera.up, camera.back].map(|axis| to.dot(*axis))
            };
            let both = seen(turned).into_iter().zip(seen(camera()));
            assert!(both.into_iter().all(|(a, b)| (a - b).abs() < 1e-5));
            assert!(turned.right.cross(*turned.up).dot(*turned.back) > 0.999_99);
        }
        // A quarter of the way: from +z to +x.
        let quarter = camera().turned(Vec3::ZERO, std::f32::consts::FRAC_PI_2);
        assert!((quarter.position - Vec3::new(5.0, 0.0, 0.0)).length() < 1e-5);
    }

    #[test]
    fn rays_through_the_lens_meet_in_the_plane_of_focus() {
        let camera = Camera {
            lens_radius: 0.5,
            focus_distance: 3.0,
            ..camera()
        };
        let film = Vec2::new(10.0, 20.0);
        let rays = camera.rays(UVec2::new(80, 60));
        let hits = [Vec2::ZERO, Vec2::X, Vec2::new(-0.6, 0.6)].map(|lens| {
            let ray = rays.at(film, lens);
            ray.at((2.0 - ray.origin.z) / ray.direction.z)
        });
        assert!((hits[0] - hits[1]).length() < 1e-5 && (hits[0] - hits[2]).length() < 1e-5);
    }
}
