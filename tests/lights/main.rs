//! Lights: their samples against their own geometry, closed forms (numerics.md 2) and extremes.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;

mod closed_form;
mod density;
mod stiff;

use common::chi_square::Moments;
use halfshade::color::Rgb;
use halfshade::light::{
    DiskLight, DistantLight, Falloff, Light, LightSample, PointLight, RectangleLight, ShadowEnd,
    SphereLight, SpotLight,
};
use halfshade::math::{DVec3, UVec2, UnitVec3, Vec2, Vec3};
use halfshade::sampling::{Pattern, Sampler, SamplingConfig, Target};

fn unit(x: f32, y: f32, z: f32) -> UnitVec3 {
    UnitVec3::normalize(Vec3::new(x, y, z)).unwrap()
}

fn point(position: Vec3, radius: f32) -> PointLight {
    PointLight {
        position,
        intensity: Rgb::new(10.0, 20.0, 40.0),
        radius,
        samples: 4,
        falloff: Falloff::INVERSE_SQUARE,
    }
}

fn spot(position: Vec3, radius: f32) -> SpotLight {
    SpotLight {
        position,
        direction: -UnitVec3::Y,
        intensity: Rgb::new(10.0, 20.0, 40.0),
        inner_angle_radians: 0.3,
        outer_angle_radians: 0.6,
        radius,
        samples: 4,
        falloff: Falloff::INVERSE_SQUARE,
    }
}

fn distant(angle_radians: f32) -> DistantLight {
    DistantLight {
        direction: unit(0.3, -1.0, 0.2),
        irradiance: Rgb::WHITE,
        angle_radians,
        samples: 4,
    }
}

fn disk(center: Vec3, normal: UnitVec3, radius: f32) -> DiskLight {
    DiskLight {
        center,
        normal,
        radius,
        radiance: Rgb::WHITE,
        is_visible: true,
        samples: 4,
    }
}

fn rectangle(center: Vec3, half_u: Vec3, half_v: Vec3) -> RectangleLight {
    RectangleLight {
        center,
        half_u,
        half_v,
        radiance: Rgb::WHITE,
        is_visible: true,
        samples: 4,
    }
}

fn sphere(center: Vec3, radius: f32) -> SphereLight {
    SphereLight {
        center,
        radius,
        radiance: Rgb::WHITE,
        is_visible: true,
        samples: 4,
    }
}

/// Independent points of the unit square.
fn random(count: u32, seed: u64) -> impl Iterator<Item = Vec2> {
    numbers(Pattern::Random, count, seed)
}

fn numbers(pattern: Pattern, samples: u32, seed: u64) -> impl Iterator<Item = Vec2> {
    let config = SamplingConfig {
        samples,
        pattern,
        target: Target::Rectangle,
        seed,
    };
    (0..samples).map(move |i| Sampler::new(&config, UVec2::ZERO, i).camera())
}

/// The irradiance that `count` random samples of `light` bring to `point` on a surface.
fn irradiance(light: &Light, point: Vec3, normal: UnitVec3, count: u32) -> Moments {
    random(count, 1)
        .map(|u| {
            light.sample(point, u).map_or(0.0, |s| {
                let cos = normal.as_dvec3().dot(s.wi.as_dvec3());
                f64::from(s.weight.r) * cos.max(0.0)
            })
        })
        .collect()
}

fn end(sample: &LightSample) -> DVec3 {
    match sample.shadow {
        ShadowEnd::Point(p) => p.as_dvec3(),
        ShadowEnd::Direction(d) => d.as_dvec3(),
    }
}

/// The name of a light's kind. A new kind does not compile until it is named here, and fails
/// `every_kind_has_a_case` until it has a case.
fn kind(light: &Light) -> &'static str {
    match light {
        Light::Point(_) => "point",
        Light::Spot(_) => "spot",
        Light::Distant(_) => "distant",
        Light::Disk(_) => "disk",
        Light::Rectangle(_) => "rectangle",
        Light::Sphere(_) => "sphere",
    }
}
