//! How materials scatter: albedos by quadrature.

use std::f64::consts::{PI, TAU};

use crate::color::Rgb;
use crate::material::{Bsdf, Lookup, MAX_UV_SETS, Material};
use crate::math::{DVec3, UnitVec3, Vec2};
use crate::texture::{TexturedRgb, TexturedScalar};

use super::scenes::{metallic_roughness, phong};

/// From smooth to rough.
pub const ROUGHNESSES: [f32; 8] = [0.0, 0.01, 0.05, 0.15, 0.3, 0.5, 0.75, 1.0];

/// A coat of glTF: `metallic`, `roughness`, and a share of light let through.
pub fn coated(metallic: f32, roughness: f32, transmission: f32, index: f32) -> Material {
    metallic_roughness(|m| {
        m.metallic = TexturedScalar::constant(metallic);
        m.roughness = TexturedScalar::constant(roughness);
        m.transmission = TexturedScalar::constant(transmission);
        m.index_of_refraction = index;
    })
}

/// A Phong lobe.
pub fn glossy(reflectance: f32, exponent: f32) -> Material {
    phong(|p| {
        p.specular = TexturedRgb::constant(Rgb::splat(reflectance));
        p.exponent = TexturedScalar::constant(exponent);
    })
}

/// Where nothing has a texture.
pub fn bsdf(material: &Material) -> Bsdf {
    material.bsdf(&Lookup {
        textures: &[],
        images: &[],
        uvs: [Vec2::ZERO; MAX_UV_SETS],
        color: [1.0; 4],
    })
}

/// In the plane of x and z, so many degrees above the horizon of z.
pub fn wo(degrees_above: f64) -> UnitVec3 {
    let (sin, cos) = degrees_above.to_radians().sin_cos();
    UnitVec3::from_normalized(DVec3::new(cos, 0.0, sin).as_vec3())
}

/// Share of the light that comes to `wo` under a sky of radiance 1, around the normal z: by
/// rings around the mirror direction up to `reach` radians wide, the narrower the nearer to it.
pub fn albedo_within(bsdf: &Bsdf, wo: UnitVec3, reach: f64) -> f64 {
    quadrature(bsdf, wo, reach, 400, 64)
}

fn quadrature(bsdf: &Bsdf, wo: UnitVec3, reach: f64, rings: u32, spokes: u32) -> f64 {
    let mirror = DVec3::new(-f64::from(wo.x), -f64::from(wo.y), f64::from(wo.z)).normalize();
    let (a, b) = mirror.any_orthonormal_pair();
    let least = 1e-7f64;
    let step = (reach / least).ln() / f64::from(rings);
    let mut sum = 0.0;
    for ring in 0..rings {
        let angle = least * ((f64::from(ring) + 0.5) * step).exp();
        let area = angle.sin() * angle * step * TAU / f64::from(spokes);
        for spoke in 0..spokes {
            let (sin, cos) = (TAU * (f64::from(spoke) + 0.5) / f64::from(spokes)).sin_cos();
            let wi = mirror * angle.cos() + (a * cos + b * sin) * angle.sin();
            if wi.z > 0.0 {
                let wi = UnitVec3::from_normalized(wi.as_vec3());
                let value = bsdf.eval(UnitVec3::Z, wo, wi).max_channel();
                sum += f64::from(value) * f64::from(wi.z) * area;
            }
        }
    }
    sum
}

/// As [`albedo_within`], from everywhere.
pub fn albedo(bsdf: &Bsdf, wo: UnitVec3) -> f64 {
    albedo_within(bsdf, wo, PI)
}

/// Degrees above the horizon.
pub const ELEVATIONS: [f64; 10] = [3.0, 6.0, 10.0, 15.0, 22.0, 30.0, 45.0, 60.0, 75.0, 90.0];

/// By how much the albedo is certainly above 1: beyond what half the rings and spokes would change.
pub fn energy_made(bsdf: &Bsdf, wo: UnitVec3) -> f64 {
    let fine = quadrature(bsdf, wo, PI, 400, 64);
    let coarse = quadrature(bsdf, wo, PI, 200, 32);
    (fine - (fine - coarse).abs() - 1.0).max(0.0)
}
