//! A still life with everything in it, at any scale.

use crate::camera::Camera;
use crate::color::Rgb;
use crate::light::{DiskLight, Light};
use crate::material::{Material, Phong, Surface};
use crate::math::{UVec2, UnitVec3, Vec3};
use crate::sampling::{Pattern, SamplingConfig};
use crate::scene::{Background, Placed, Scene, Settings};

use super::scenes::{add_box, add_light, add_quad, add_sphere, look_at, point_light};

/// Everything in it: matte, mirror, glass, hard and soft lights. All lengths times `scale`, a
/// power of two, and intensities times its square.
pub fn scene(scale: f32) -> Scene {
    let mut scene = Scene::default();
    let matte = Material::matte("matte", Rgb::new(0.7, 0.5, 0.3));
    add_quad(
        &mut scene,
        Vec3::ZERO,
        Vec3::Z * 5.0 * scale,
        Vec3::X * 5.0 * scale,
        matte.clone(),
    );
    add_sphere(
        &mut scene,
        Vec3::new(-1.1, 1.0, 0.3) * scale,
        scale,
        16,
        matte,
    );
    let special = |edit: fn(&mut Phong)| {
        let mut phong = Phong::matte(Rgb::splat(0.05));
        edit(&mut phong);
        Material {
            surface: Surface::Phong(phong),
            ..Material::matte("special", Rgb::BLACK)
        }
    };
    let glass = special(|p| {
        p.transmit = Rgb::splat(0.9);
        p.index_of_refraction = 1.5;
    });
    let mirror = special(|p| p.reflect = Rgb::splat(0.8));
    add_sphere(
        &mut scene,
        Vec3::new(1.2, 0.8, 0.9) * scale,
        0.8 * scale,
        16,
        glass,
    );
    add_box(
        &mut scene,
        Vec3::new(0.3, 0.0, -1.7) * scale,
        Vec3::new(1.9, 1.3, -1.1) * scale,
        mirror,
    );
    let intensity = 60.0 * scale * scale;
    let position = Vec3::new(3.0, 5.0, 2.0) * scale;
    add_light(&mut scene, point_light(position, intensity, 0.4 * scale, 2));
    add_light(
        &mut scene,
        point_light(Vec3::new(-3.0, 2.0, 2.0) * scale, intensity, 0.0, 1),
    );
    add_light(
        &mut scene,
        Light::Disk(DiskLight {
            center: Vec3::new(0.0, 4.0, 0.0) * scale,
            normal: -UnitVec3::Y,
            radius: 0.5 * scale,
            radiance: Rgb::splat(3.0),
            is_visible: true,
            samples: 1,
        }),
    );
    scene.background = Background {
        radiance: Rgb::new(0.2, 0.3, 0.5),
        ambient: Rgb::splat(0.1),
    };
    scene
}

/// Where it is seen from.
pub fn camera(scale: f32) -> Placed<Camera> {
    look_at(
        Vec3::new(0.5, 3.0, 6.0) * scale,
        Vec3::new(0.0, 0.7, 0.0) * scale,
    )
}

/// A small picture.
pub fn settings(pattern: Pattern) -> Settings {
    Settings {
        size: UVec2::new(50, 37),
        sampling: SamplingConfig {
            samples: 5,
            pattern,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    }
}
