//! No material gives back more light than it gets, and none fails at the ends of its parameters.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use common::build::*;
use common::floor::settings;
use halfshade::color::Rgb;
use halfshade::light::{DiskLight, Light};
use halfshade::material::Material;
use halfshade::math::{DVec3, UnitVec3, Vec2, Vec3};
use halfshade::sampling::Pattern;
use halfshade::scene::{Background, Scene, Settings};
use halfshade::stress::scattering::*;
use halfshade::texture::TexturedScalar;

/// L7: under a uniform sky nothing is brighter than the sky, and white is nearly as bright.
#[test]
fn white_materials_of_gltf_stay_below_a_uniform_sky() {
    let settings = Settings {
        max_depth: 64,
        ..settings(1, Pattern::Sobol)
    };
    let mut faults = Vec::new();
    for metallic in [0.0, 0.5, 1.0] {
        for transmission in [0.0, 0.5, 1.0] {
            for roughness in ROUGHNESSES {
                let mut scene = Scene::default();
                let material = coated(metallic, roughness, transmission, 1.5);
                add_quad(&mut scene, Vec3::ZERO, Vec3::X, Vec3::Y, material);
                scene.background = Background {
                    radiance: Rgb::WHITE,
                    ambient: Rgb::WHITE,
                };
                for degrees in ELEVATIONS {
                    let eye = *wo(degrees);
                    let got = radiance(&scene, eye, -eye, &settings).max_channel();
                    if !(0.8..=1.001).contains(&got) {
                        faults.push(format!(
                            "metallic {metallic}, transmission {transmission}, roughness \
                             {roughness}, {degrees} degrees: {got}"
                        ));
                    }
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// L7: the same for solid bodies, which light enters and leaves.
#[test]
fn solid_glass_of_any_roughness_stays_below_a_uniform_sky() {
    for roughness in ROUGHNESSES {
        let mut glass = metallic_roughness(|m| {
            m.metallic = TexturedScalar::constant(0.0);
            m.roughness = TexturedScalar::constant(roughness);
            m.transmission = TexturedScalar::constant(1.0);
            m.thickness = TexturedScalar::constant(1.0);
        });
        glass.is_double_sided = false;
        let mut scene = Scene::default();
        add_sphere(&mut scene, Vec3::ZERO, 1.0, 16, glass);
        scene.background = Background {
            radiance: Rgb::WHITE,
            ambient: Rgb::WHITE,
        };
        let settings = Settings {
            max_depth: 64,
            ..settings(1, Pattern::Sobol)
        };
        for i in 0..40 {
            let eye = Vec3::new(0.025 * i as f32, 0.013, 3.0);
            let got = radiance(&scene, eye, -Vec3::Z, &settings).max_channel();
            assert!(got <= 1.001, "roughness {roughness}, {}: {got}", eye.x);
        }
    }
}

/// A light that is seen in a mirror and sampled too must not count twice, nor get lost.
#[test]
fn a_metal_shows_a_light_once() {
    const SEEDS: u64 = 16;
    for radius in [0.05, 0.3, 2.0, 100.0f32] {
        for roughness in [0.0, 0.05, 0.15, 0.3, 0.6] {
            for lateral in [0.0, 1.5f32] {
                let mut scene = Scene::default();
                let metal = coated(1.0, roughness, 0.0, 1.5);
                let elevation = f64::from(1.0f32.atan2(lateral)).to_degrees();
                let whole_sky = albedo(&bsdf(&metal), wo(elevation));
                add_quad(&mut scene, Vec3::ZERO, Vec3::Z * 9.0, Vec3::X * 9.0, metal);
                let light = Light::Disk(DiskLight {
                    center: Vec3::new(2.0 * lateral, 2.0, 0.0),
                    normal: -UnitVec3::Y,
                    radius,
                    radiance: Rgb::WHITE,
                    is_visible: true,
                    samples: 1,
                });
                add_light(&mut scene, light);
                let eye = Vec3::new(-lateral, 1.0, 0.0);
                let mut settings = settings(512, Pattern::Sobol);
                let values: Vec<f64> = (0..SEEDS)
                    .map(|seed| {
                        settings.sampling.seed = seed;
                        radiance(&scene, eye, -eye, &settings).g.into()
                    })
                    .collect();
                let n = SEEDS as f64;
                let mean = values.iter().sum::<f64>() / n;
                let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
                let error = (squares / (n * (n - 1.0))).sqrt();
                let what = format!("radius {radius}, roughness {roughness}, {lateral}");
                assert!(mean <= 1.0 + 4.0 * error + 1e-3, "{what}: {mean} ± {error}");
                if radius == 100.0 {
                    // All but a hundredth of what comes from the hemisphere.
                    let least = whole_sky - 0.02 - 4.0 * error;
                    assert!(mean >= least, "{what}: {mean} ± {error}, {whole_sky}");
                }
            }
        }
    }
}

#[test]
fn microfacets_over_a_diffuse_base_make_no_energy() {
    let mut faults = Vec::new();
    for index in [0.0, 1.0, 1.5, 100.0] {
        for metallic in [0.0, 0.5, 1.0] {
            for roughness in ROUGHNESSES {
                let bsdf = bsdf(&coated(metallic, roughness, 0.0, index));
                for degrees in ELEVATIONS {
                    let got = albedo(&bsdf, wo(degrees));
                    if got > 1.005 {
                        faults.push(format!(
                            "index {index}, metallic {metallic}, roughness {roughness}, \
                             {degrees} degrees: {got}"
                        ));
                    }
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    // A white metal that is nearly smooth loses hardly anything.
    let got = albedo(&bsdf(&coated(1.0, 0.1, 0.0, 1.5)), wo(60.0));
    assert!((got - 1.0).abs() < 0.01, "{got}");
}

#[test]
fn the_phong_lobe_makes_no_energy_and_loses_none_along_the_normal() {
    for exponent in (0..=16).map(|k| 10f32.powf(0.5 * k as f32)).chain([0.0]) {
        let bsdf = bsdf(&glossy(1.0, exponent));
        for degrees in ELEVATIONS {
            let got = albedo(&bsdf, wo(degrees));
            let what = format!("exponent {exponent}, {degrees} degrees: {got}");
            assert!(got <= 1.005, "{what}");
            if degrees == 90.0 {
                assert!((got - 1.0).abs() < 0.005, "{what}");
            }
        }
    }
}

/// L10: at the limit all light comes from the mirror direction.
#[test]
fn narrow_lobes_converge_to_the_mirror_direction() {
    for degrees in [30.0, 60.0, 90.0f64] {
        // Phong's lobe takes the cosine along; microfacets mirror all.
        for (material, expected) in [
            (glossy(1.0, 1e8), degrees.to_radians().sin()),
            (coated(1.0, 0.01, 0.0, 1.5), 1.0),
        ] {
            let bsdf = bsdf(&material);
            let near = albedo_within(&bsdf, wo(degrees), 5e-3);
            assert!(
                (near - expected).abs() < 0.01,
                "{degrees}: {near} {expected}"
            );
        }
    }
}

#[test]
fn scattering_is_reciprocal() {
    let materials = [
        coated(0.0, 0.02, 0.0, 1.5),
        coated(0.0, 0.5, 0.0, 1.5),
        coated(0.7, 0.2, 0.3, 2.0),
        coated(1.0, 1.0, 0.0, 1.5),
        glossy(0.8, 0.0),
        glossy(0.8, 30.0),
        Material::matte("matte", Rgb::splat(0.5)),
    ];
    let direction = |i: u32| {
        let (z, angle) = (
            (f64::from(i) * 0.618_033_988_7).fract() * 0.99 + 0.01,
            2.4 * f64::from(i),
        );
        let ring = (1.0 - z * z).sqrt();
        let v = DVec3::new(ring * angle.cos(), ring * angle.sin(), z);
        UnitVec3::normalize(v.as_vec3()).unwrap()
    };
    for material in &materials {
        let bsdf = bsdf(material);
        for i in 0..2000 {
            let (a, b) = (direction(i), direction(3 * i + 7));
            let there = bsdf.eval(UnitVec3::Z, a, b).g;
            let back = bsdf.eval(UnitVec3::Z, b, a).g;
            let error = (there - back).abs();
            assert!(
                error <= 1e-4 * there.max(back),
                "{material:?}: {there} {back}"
            );
        }
    }
}

/// L10: the value at the peak, beside it and along the horizon, and a whole render.
#[test]
fn no_parameter_makes_a_value_that_is_not_finite() {
    let exponents = [0.0, 1.0, 1e2, 1e4, 1e6, 1e8].map(|n| glossy(1.0, n));
    let indices = [0.0, 1.0, 1.5, 100.0];
    let coats = ROUGHNESSES.iter().flat_map(|&roughness| {
        indices.iter().flat_map(move |&index| {
            [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)]
                .map(|(metallic, transmission)| coated(metallic, roughness, transmission, index))
        })
    });
    let glasses = indices.map(|index| {
        phong(|p| {
            p.transmit = Rgb::WHITE;
            p.index_of_refraction = index;
        })
    });
    let solids = indices.map(|index| {
        metallic_roughness(|m| {
            m.metallic = TexturedScalar::constant(0.0);
            m.roughness = TexturedScalar::constant(0.0);
            m.transmission = TexturedScalar::constant(1.0);
            m.thickness = TexturedScalar::constant(1.0);
            m.index_of_refraction = index;
        })
    });
    let settings = settings(1, Pattern::Sobol);
    for material in exponents
        .into_iter()
        .chain(coats)
        .chain(glasses)
        .chain(solids)
    {
        let scattering = bsdf(&material);
        // Viewers are never nearer to the horizon than this.
        for a in [0.06, 1.0, 30.0, 89.9999, 90.0].map(wo) {
            for b in [1e-30, 1e-4, 0.06, 1.0, 30.0, 89.9999, 90.0].map(wo) {
                for wi in [*b, Vec3::new(-b.x, b.y, b.z)] {
                    let wi = UnitVec3::from_normalized(wi);
                    let value = scattering.eval(UnitVec3::Z, a, wi);
                    assert!(value.is_finite(), "{material:?} {a:?} {wi:?}: {value:?}");
                }
            }
        }
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
        let camera = look_at(Vec3::Z * 3.0, Vec3::ZERO);
        let film = picture(&scene, &camera, &settings);
        assert_eq!(film.rejected, 0, "{material:?}");
        // Along the normal, and through the centre.
        let got = radiance(&scene, Vec3::Z * 3.0, -Vec3::Z, &settings);
        assert!(got.is_finite(), "{material:?}: {got:?}");
    }
}
