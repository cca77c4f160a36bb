//! Pixels that see nothing but the background, found before any ray is traced.

use super::Job;
use crate::camera::Projection;
use crate::math::{Aabb, DVec3, UVec2};
use crate::scene::{LeftOut, Omission};

/// Half the bits of single precision: far more than rounding moves a ray or a hit, next to the
/// largest coordinate, and far less than anybody sees.
const ROUNDING: f64 = 1.0 / (1 << 16) as f64;

/// The part of the film that may see something else than the background: all of it is between these
/// corners, in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foreground {
    min: [f64; 2],
    max: [f64; 2],
}

impl Foreground {
    /// All of the film.
    const EVERYWHERE: Self = Self {
        min: [f64::NEG_INFINITY; 2],
        max: [f64::INFINITY; 2],
    };

    /// Of the picture of `job`.
    pub fn of(job: &Job) -> Self {
        let camera = &job.camera;
        let (Some(bounds), false) = (job.scene.bounds, camera.lens_radius > 0.0) else {
            return Self::EVERYWHERE;
        };
        let mut foreground = Self {
            min: [f64::INFINITY; 2],
            max: [f64::NEG_INFINITY; 2],
        };
        if bounds.is_empty() {
            return foreground;
        }
        for corner in corners(bounds, camera.position.as_dvec3()) {
            let Some(film) = project(job, corner) else {
                return Self::EVERYWHERE;
            };
            for ((min, max), film) in foreground.min.iter_mut().zip(&mut foreground.max).zip(film) {
                // A pixel more, since places on the film are rounded too.
                *min = min.min(film - 1.0);
                *max = max.max(film + 1.0);
            }
        }
        foreground
    }

    /// Whether no ray through `pixel` meets anything.
    pub fn is_beyond(&self, pixel: UVec2) -> bool {
        let pixel = pixel.as_dvec2().to_array();
        (0..2).any(|i| pixel[i] + 1.0 < self.min[i] || pixel[i] > self.max[i])
    }
}

/// The corners of the box, which is made a little larger.
fn corners(bounds: Aabb, eye: DVec3) -> [DVec3; 8] {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let reach = min.abs().max(max.abs()).max(eye.abs()).max_element();
    let ends = [min - reach * ROUNDING, max + reach * ROUNDING];
    std::array::from_fn(|i| DVec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z))
}

/// Where the camera sees `point`, as [`crate::camera::Camera::ray`] looks there; `None` where it is
/// not in front of it.
fn project(job: &Job, point: DVec3) -> Option<[f64; 2]> {
    let camera = &job.camera;
    let toward = point - camera.position.as_dvec3();
    let along = |axis: DVec3| toward.dot(axis);
    let ahead = -along(camera.back.as_dvec3());
    let half_height = match camera.projection {
        Projection::Perspective {
            vertical_fov_radians,
        } => f64::from((0.5 * vertical_fov_radians).tan()) * ahead,
        Projection::Orthographic { half_height } => half_height.into(),
    };
    let size = job.settings.size.as_dvec2();
    let x = along(camera.right.as_dvec3()) / half_height;
    let y = along(camera.up.as_dvec3()) / half_height;
    let film = [0.5 * (x * size.y + size.x), 0.5 * (1.0 - y) * size.y];
    let is_seen = half_height > 0.0 && film.iter().all(|f| f.is_finite());
    is_seen.then_some(film)
}

/// What the picture of `job` does not need beyond what its scene does not.
pub fn left_out(job: &Job) -> Option<LeftOut> {
    let foreground = Foreground::of(job);
    let beyond = job.crop.pixels().filter(|&p| foreground.is_beyond(p));
    let beyond = beyond.count();
    (beyond > 0).then(|| {
        let what = format!("rays of {beyond} of {} pixels", job.crop.area());
        let why = "they see nothing but the background";
        LeftOut::new(Omission::Background, what, why, 0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::Builder;
    use crate::camera::Camera;
    use crate::color::Rgb;
    use crate::film::Rect;
    use crate::integrate::RayLog;
    use crate::integrate::integrator;
    use crate::material::{Material, MaterialId};
    use crate::math::{DAffine3, Vec3};
    use crate::prepare::prepare;
    use crate::render::tile::camera_sample;
    use crate::scene::{Instance, Mesh, MeshId, Placed, Scene, Settings};

    /// A scene of one triangle that shines.
    fn scene(corners: [Vec3; 3]) -> Scene {
        let mesh = Mesh::new("", corners.to_vec(), vec![[0, 1, 2]]);
        let mut material = Material::matte("", Rgb::WHITE);
        material.emission.factor = Rgb::WHITE;
        Scene {
            meshes: mesh.into_iter().collect(),
            instances: vec![Instance {
                name: String::new(),
                mesh: MeshId(0),
                material: MaterialId(0),
                transform: DAffine3::IDENTITY,
            }],
            materials: vec![material],
            ..Scene::default()
        }
    }

    fn jobs_of(scene: &Scene, camera: Camera, check: impl Fn(&Job)) {
        let prepared = prepare(scene, Builder::default()).scene;
        let settings = Settings {
            size: UVec2::new(64, 48),
            ..Settings::default()
        };
        let placed = Placed {
            name: String::new(),
            origin: DVec3::ZERO,
            item: camera,
        };
        check(&Job {
            scene: &prepared,
            camera: prepared.camera(&placed),
            settings: &settings,
            crop: Rect::full(settings.size),
            layers: Vec::new(),
        });
    }

    #[test]
    fn pixels_beyond_the_foreground_see_nothing() {
        let eyes = [
            Vec3::new(0.0, 0.0, 8.0),
            Vec3::new(700.0, -300.0, 90.0),
            Vec3::new(0.3, 0.2, 0.4),
            Vec3::new(3.0, 9.0, -5.0),
        ];
        let scene = scene([
            Vec3::new(-1.0, 0.1, 0.0),
            Vec3::X,
            Vec3::new(0.2, 1.0, -0.7),
        ]);
        for (i, eye) in eyes.into_iter().enumerate() {
            let fov = [0.5, 0.01, 2.0, 0.7][i];
            let Some(mut camera) = Camera::look_at(eye, Vec3::ZERO, Vec3::Y, fov) else {
                panic!("no direction");
            };
            for orthographic in [false, true] {
                if orthographic {
                    camera.projection = Projection::Orthographic { half_height: 2.0 };
                }
                jobs_of(&scene, camera, |job| {
                    let foreground = Foreground::of(job);
                    let integrator = integrator(job.scene, job.settings);
                    let mut beyond = 0;
                    let mut lit_beyond = 0;
                    let rays = job.camera.rays(job.settings.size);
                    for (pixel, index) in job.crop.pixels().flat_map(|p| [(p, 0), (p, 5)]) {
                        let (ray, sampler) = camera_sample(job, &rays, pixel, index);
                        let mut log = RayLog::default();
                        let value = integrator.radiance(&ray, &sampler, &mut log);
                        beyond += u32::from(foreground.is_beyond(pixel));
                        let is_lit = !value.is_black();
                        lit_beyond += u32::from(is_lit && foreground.is_beyond(pixel));
                    }
                    assert_eq!(lit_beyond, 0, "eye {eye}");
                    // From inside the box it may be anywhere.
                    assert!(orthographic || (beyond > 0) == (i != 2), "eye {eye}");
                });
            }
        }
    }

    #[test]
    fn nothing_is_seen_of_an_empty_scene_and_all_through_a_lens() {
        let Some(camera) = Camera::look_at(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0) else {
            panic!("no direction");
        };
        jobs_of(&Scene::default(), camera, |job| {
            assert!(Foreground::of(job).is_beyond(UVec2::new(30, 20)));
        });
        let lens = Camera {
            lens_radius: 0.1,
            ..camera
        };
        jobs_of(&Scene::default(), lens, |job| {
            assert!(!Foreground::of(job).is_beyond(UVec2::new(30, 20)));
        });
    }
}
