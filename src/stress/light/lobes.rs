//! L10: lobes as narrow as parameters can say.

use rayon::prelude::*;

use crate::color::Rgb;
use crate::material::Material;
use crate::math::{UnitVec3, Vec3};
use crate::sampling::Pattern;
use crate::scene::{Background, Scene};
use crate::stress::floor::settings;
use crate::stress::scattering::{ROUGHNESSES, albedo_within, bsdf, coated, glossy, wo};
use crate::stress::scenes::{
    add_light, add_sphere, look_at, metallic_roughness, phong, picture, point_light, radiance,
};
use crate::stress::{Check, Curve, Effort, Sweep};
use crate::texture::TexturedScalar;

/// Radians around the mirror direction in which the light of a narrow lobe is to be.
const NEAR: f64 = 5e-3;

/// Tries every material at the ends of its parameters.
pub fn run(_: Effort) -> Vec<Check> {
    let materials = extremes();
    let values: u64 = materials.par_iter().map(bad_values).sum();
    let pictures: u64 = materials.par_iter().map(bad_pixels).sum();
    let n = materials.len();
    vec![
        Check::none(
            format!("{n} materials, index 0..100: values that are not finite"),
            values,
        ),
        Check::none(
            format!("{n} materials: dropped samples of pictures"),
            pictures,
        ),
        Check::worst(
            "narrow lobes: share of light off the mirror direction",
            1e-2,
            limits(),
        ),
    ]
}

/// Phong exponents 0 to 1e8, roughness 0 to 1, indices 0 to 100, glass thin and solid.
fn extremes() -> Vec<Material> {
    let indices = [0.0, 1.0, 1.5, 100.0];
    let mut materials: Vec<Material> = [0.0, 1.0, 1e2, 1e4, 1e6, 1e8]
        .into_iter()
        .map(|n| glossy(1.0, n))
        .collect();
    for index in indices {
        for roughness in ROUGHNESSES {
            let kinds = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)];
            materials.extend(kinds.map(|(m, t)| coated(m, roughness, t, index)));
        }
        materials.push(phong(|p| {
            p.transmit = Rgb::WHITE;
            p.index_of_refraction = index;
        }));
        materials.push(metallic_roughness(|m| {
            m.metallic = TexturedScalar::constant(0.0);
            m.roughness = TexturedScalar::constant(0.0);
            m.transmission = TexturedScalar::constant(1.0);
            m.thickness = TexturedScalar::constant(1.0);
            m.index_of_refraction = index;
        }));
    }
    materials
}

/// Values at the peak, beside it and along the horizon.
fn bad_values(material: &Material) -> u64 {
    let bsdf = bsdf(material);
    let mut bad = 0;
    // Viewers are never nearer to the horizon than this.
    for a in [0.06, 1.0, 30.0, 89.9999, 90.0].map(wo) {
        for b in [1e-30, 1e-4, 0.06, 1.0, 30.0, 89.9999, 90.0].map(wo) {
            for wi in [*b, Vec3::new(-b.x, b.y, b.z)] {
                let wi = UnitVec3::from_normalized(wi);
                bad += u64::from(!bsdf.eval(UnitVec3::Z, a, wi).is_finite());
            }
        }
    }
    bad
}

/// Dropped samples of a picture of a ball, and of a ray along the normal and through its centre.
fn bad_pixels(material: &Material) -> u64 {
    let mut scene = Scene::default();
    add_sphere(&mut scene, Vec3::ZERO, 1.0, 8, material.clone());
    scene.background = Background {
        radiance: Rgb::WHITE,
        ambient: Rgb::WHITE,
    };
    add_light(
        &mut scene,
        point_light(Vec3::new(0.0, 3.0, 3.0), 10.0, 0.0, 1),
    );
    let once = settings(1, Pattern::Sobol);
    let film = picture(&scene, &look_at(Vec3::Z * 3.0, Vec3::ZERO), &once);
    let through = radiance(&scene, Vec3::Z * 3.0, -Vec3::Z, &once);
    film.rejected + u64::from(!through.is_finite())
}

/// At the limit all light comes from the mirror direction.
fn limits() -> Sweep {
    let degrees = [30.0, 60.0, 90.0f64];
    // Phong's lobe takes the cosine along; microfacets mirror all.
    let phong = degrees.map(|d| {
        let near = albedo_within(&bsdf(&glossy(1.0, 1e8)), wo(d), NEAR);
        (d, (near - d.to_radians().sin()).abs())
    });
    let coat = degrees.map(|d| {
        let near = albedo_within(&bsdf(&coated(1.0, 0.01, 0.0, 1.5)), wo(d), NEAR);
        (d, (near - 1.0).abs())
    });
    let curves = vec![
        Curve::new("Phong, exponent 1e8", phong.into()),
        Curve::new("metal, roughness 0.01", coat.into()),
    ];
    Sweep::several(
        "degrees above the horizon",
        "share of light elsewhere",
        curves,
    )
}
