//! A matte floor, lights above it, and the irradiance that arrives.

use std::f32::consts::PI;

use halfshade::color::Rgb;
use halfshade::light::{DiskLight, Light};
use halfshade::material::Material;
use halfshade::math::{UVec2, UnitVec3, Vec3};
use halfshade::sampling::{Pattern, SamplingConfig};
use halfshade::scene::{Scene, Settings};

use super::build::*;

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

/// Fails where `got` is off by more than the share `relative` of what is expected.
pub fn assert_close(got: f32, expected: f32, relative: f32, what: &str) {
    let error = (got - expected).abs() / expected.abs();
    assert!(
        error <= relative,
        "{what}: {got} instead of {expected}, off by {error}"
    );
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

/// L1: the share of a disk of radius 1 that is beyond a straight line at signed distance `-s` from its
/// centre.
pub fn share_beyond(s: f64) -> f64 {
    let s = s.clamp(-1.0, 1.0);
    ((-s).acos() + s * (1.0 - s * s).sqrt()) / std::f64::consts::PI
}

/// L2: irradiance from a disk light of radiance 1 that faces the floor, `offset` from its axis.
pub fn disk_irradiance(radius: f64, height: f64, offset: f64) -> f64 {
    let (r2, h2, a2) = (radius * radius, height * height, offset * offset);
    let z = a2 + h2 + r2;
    let root = (z * z - 4.0 * r2 * a2).sqrt();
    // (1 - (z - 2 r²) / root) / 2 where a is 0, and as well conditioned where it is not.
    0.5 * std::f64::consts::PI * (1.0 - (a2 + h2 - r2) / root)
}
