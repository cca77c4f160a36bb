//! A matte floor, lights above it, and the irradiance that arrives.

use std::f32::consts::PI;

use crate::color::Rgb;
use crate::light::{DiskLight, Light};
use crate::material::Material;
use crate::math::{UVec2, UnitVec3, Vec3};
use crate::sampling::{Pattern, SamplingConfig};
use crate::scene::{IntegratorKind, Scene, Settings};

use super::scenes::{add_quad, means, radiance};

/// Reflectance of the floor.
pub const RHO: f32 = 0.6;

/// What the floor is made of.
pub fn matte() -> Material {
    Material::matte("matte", Rgb::splat(RHO))
}

/// A small film of so many samples.
pub fn settings(samples: u32, pattern: Pattern) -> Settings {
    Settings {
        size: UVec2::new(24, 18),
        sampling: SamplingConfig {
            samples,
            pattern,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    }
}

/// 64 samples by `path`.
pub fn paths(pattern: Pattern) -> Settings {
    Settings {
        integrator: IntegratorKind::Path,
        ..settings(64, pattern)
    }
}

/// A horizontal plane of reflectance `RHO` through the origin.
pub fn plane() -> Scene {
    let mut scene = Scene::default();
    add_quad(
        &mut scene,
        Vec3::ZERO,
        Vec3::Z * 50.0,
        Vec3::X * 50.0,
        matte(),
    );
    scene
}

/// Irradiance at `point` of the plane, from what a ray from above brings back.
pub fn irradiance(scene: &Scene, point: Vec3, settings: &Settings) -> f32 {
    let eye = point + Vec3::new(0.3, 1.0, 0.2);
    radiance(scene, eye, point - eye, settings).g * PI / RHO
}

/// [`irradiance`] for the seeds below `count`; the scene is prepared once.
pub fn irradiances(scene: &Scene, point: Vec3, settings: &Settings, count: u64) -> Vec<f64> {
    let eye = point + Vec3::new(0.3, 1.0, 0.2);
    let mut means = means(scene, eye, point - eye, settings, count);
    let reflected = f64::from(RHO) / std::f64::consts::PI;
    means.iter_mut().for_each(|mean| *mean /= reflected);
    means
}

/// A horizontal disk light of radiance 3 above (`offset`, 0, 0), facing down.
pub fn disk(radius: f32, height: f32, offset: f32, samples: u32) -> Light {
    Light::Disk(DiskLight {
        center: Vec3::new(offset, height, 0.0),
        normal: -UnitVec3::Y,
        radius,
        radiance: Rgb::splat(3.0),
        is_visible: true,
        samples,
    })
}
