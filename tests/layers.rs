//! What a render keeps beside its picture: coverage, parts of the light, what is seen where.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::sync::atomic::AtomicBool;

use common::build::*;
use halfshade::bvh::Builder;
use halfshade::camera::{Camera, Projection};
use halfshade::color::Rgb;
use halfshade::film::{Film, Rect};
use halfshade::integrate::{Aov, LightGroups, LightPart, ViewKind};
use halfshade::light::{DiskLight, Light, SphereLight};
use halfshade::material::{AlphaMode, Material};
use halfshade::math::{DVec3, UVec2, UnitVec3, Vec3};
use halfshade::prepare::prepare;
use halfshade::render::{Job, Limits, render_within};
use halfshade::sampling::Pattern;
use halfshade::scene::{IntegratorKind, Placed, Scene, Settings};
use halfshade::texture::TexturedScalar;

const SKY: Rgb = Rgb::new(0.4, 0.6, 0.9);

fn veil(opacity: f32) -> Material {
    Material {
        alpha_mode: AlphaMode::Blend,
        opacity: TexturedScalar::constant(opacity),
        is_double_sided: true,
        ..Material::matte("veil", Rgb::splat(0.5))
    }
}

/// A floor with a mirror, clear glass, a veil and a lamp on it, under three lights and a sky.
fn still_life() -> Scene {
    let mut scene = Scene::default();
    scene.background.radiance = SKY;
    scene.background.ambient = Rgb::splat(0.1);
    let floor = Material::matte("floor", Rgb::new(0.7, 0.5, 0.3));
    add_quad(&mut scene, Vec3::ZERO, Vec3::Z * 2.0, Vec3::X * 2.0, floor);
    let mirror = phong(|p| p.reflect = Rgb::splat(0.8));
    add_box(
        &mut scene,
        Vec3::new(-1.6, 0.0, -1.0),
        Vec3::new(-0.8, 1.2, -0.2),
        mirror,
    );
    let glass = phong(|p| {
        p.transmit = Rgb::splat(0.9);
        p.index_of_refraction = 1.5;
    });
    add_sphere(&mut scene, Vec3::new(0.3, 0.6, 0.4), 0.5, 12, glass);
    let at = Vec3::new(1.2, 0.7, 0.6);
    add_quad(&mut scene, at, Vec3::X * 0.5, Vec3::Y * 0.6, veil(0.4));
    let mut ember = Material::matte("ember", Rgb::splat(0.2));
    ember.emission.factor = Rgb::new(0.9, 0.3, 0.1);
    add_box(
        &mut scene,
        Vec3::new(-0.3, 0.0, -1.2),
        Vec3::new(0.3, 0.4, -0.8),
        ember,
    );
    add_light(
        &mut scene,
        point_light(Vec3::new(2.0, 3.0, 2.0), 9.0, 0.3, 1),
    );
    add_light(
        &mut scene,
        Light::Disk(DiskLight {
            center: Vec3::new(-1.0, 2.5, 1.0),
            normal: UnitVec3::normalize(-Vec3::Y).unwrap(),
            radius: 0.4,
            radiance: Rgb::splat(6.0),
            is_visible: true,
            samples: 1,
        }),
    );
    add_light(
        &mut scene,
        Light::Sphere(SphereLight {
            center: Vec3::new(0.9, 1.6, -0.8),
            radius: 0.25,
            radiance: Rgb::new(3.0, 4.0, 5.0),
            is_visible: true,
            samples: 1,
        }),
    );
    scene.lights[0].name = "key".to_owned();
    scene
}

fn camera() -> Camera {
    Camera::look_at(
        Vec3::new(0.4, 1.7, 5.0),
        Vec3::new(0.0, 0.8, 0.0),
        Vec3::Y,
        0.7,
    )
    .unwrap()
}

fn settings(samples: u32) -> Settings {
    let mut settings = Settings {
        size: UVec2::new(48, 36),
        ..Settings::default()
    };
    settings.sampling.samples = samples;
    settings
}

fn film_of(scene: &Scene, camera: Camera, settings: &Settings, layers: &[Aov]) -> Film {
    let prepared = prepare(scene, Builder::default()).scene;
    let placed = Placed {
        name: String::new(),
        origin: DVec3::ZERO,
        item: camera,
    };
    let job = Job {
        scene: &prepared,
        camera: prepared.camera(&placed),
        settings,
        crop: Rect::full(settings.size),
        layers: layers.to_vec(),
    };
    // Adaptive, so that the halves of a pixel have different numbers of samples.
    let limits = Limits {
        is_adaptive: true,
        ..Limits::of(settings)
    };
    render_within(&job, &limits, &AtomicBool::new(false), &|_| {})
}

fn assert_same(a: Rgb, b: Rgb, what: &str) {
    let near = |a: f32, b: f32| (a - b).abs() <= 2e-5 * (1.0 + b.abs());
    let mut both = a.channels().into_iter().zip(b.channels());
    assert!(both.all(|(a, b)| near(a, b)), "{what}: {a:?}, {b:?}");
}

const FOLLOW_LIGHT: [IntegratorKind; 2] = [IntegratorKind::Whitted, IntegratorKind::Path];

#[test]
fn a_transparent_picture_over_its_background_is_the_opaque_one() {
    let scene = still_life();
    for integrator in FOLLOW_LIGHT {
        let film = |transparent| {
            let mut settings = Settings {
                integrator,
                transparent,
                ..settings(9)
            };
            // Not adaptive: what is dark where it is transparent would get other samples.
            settings.sampling.pattern = Pattern::Grid;
            film_of(&scene, camera(), &settings, &[Aov::Coverage])
        };
        let (opaque, transparent) = (film(false), film(true));
        let mut kinds = [0; 3];
        for i in 0..opaque.pixels.len() {
            let alpha = transparent.layers[0][i][0];
            let over = transparent.pixels[i].mean() + SKY * (1.0 - alpha);
            let what = format!("{integrator:?}, pixel {i}");
            assert_same(over, opaque.pixels[i].mean(), &what);
            assert_eq!(alpha, opaque.layers[0][i][0]);
            let kind = [alpha == 0.0, alpha == 1.0, true].iter().position(|k| *k);
            kinds[kind.unwrap()] += 1;
            assert!(alpha > 0.0 || transparent.pixels[i].mean().is_black());
        }
        assert!(kinds.iter().all(|&count| count > 20), "{kinds:?}");
    }
}

/// A camera without perspective above the square from -1 to 1, of which a film of one pixel sees
/// 4 by 4.
fn above(scene: &Scene, layers: &[Aov], samples: u32) -> Film {
    let camera = Camera {
        projection: Projection::Orthographic { half_height: 2.0 },
        ..Camera::look_at(Vec3::Y * 5.0, Vec3::ZERO, Vec3::Z, 1.0).unwrap()
    };
    let settings = Settings {
        size: UVec2::ONE,
        ..settings(samples)
    };
    film_of(scene, camera, &settings, layers)
}

#[test]
fn coverage_is_the_share_of_the_pixel_times_what_veils_stop() {
    for opacities in [&[1.0][..], &[0.25], &[0.25, 0.25], &[0.5, 1.0, 0.3]] {
        let mut scene = Scene::default();
        for (y, &opacity) in opacities.iter().enumerate() {
            let center = Vec3::Y * y as f32;
            add_quad(&mut scene, center, Vec3::X, Vec3::Z, veil(opacity));
        }
        let film = above(&scene, &[Aov::Coverage, Aov::Objects], 4096);
        let passed: f32 = opacities.iter().map(|opacity| 1.0 - opacity).product();
        let expected = 0.25 * (1.0 - passed);
        let got = film.layers[0][0][0];
        assert!((got - expected).abs() < 1e-3, "{opacities:?}: {got}");
        // The topmost comes first, and all of them add up.
        let mut objects = film.objects[0].clone();
        objects.sort_by_key(|object| std::cmp::Reverse(object.0));
        assert_eq!(objects[0].0 as usize, opacities.len() - 1);
        let top = 0.25 * opacities[opacities.len() - 1];
        assert!((objects[0].1 - top).abs() < 1e-3, "{objects:?}");
        let sum: f32 = objects.iter().map(|object| object.1).sum();
        assert!((sum - got).abs() < 1e-5, "{opacities:?}: {sum}");
    }
}

#[test]
fn a_light_that_is_seen_covers() {
    let mut scene = Scene::default();
    add_light(
        &mut scene,
        Light::Sphere(SphereLight {
            center: Vec3::ZERO,
            radius: 1.0,
            radiance: Rgb::WHITE,
            is_visible: true,
            samples: 1,
        }),
    );
    let depth = Aov::View(ViewKind::Depth);
    let film = above(&scene, &[Aov::Coverage, depth], 4096);
    let circle = std::f32::consts::PI / 16.0;
    assert!((film.layers[0][0][0] - circle).abs() < 1e-3);
    assert!((film.pixels[0].mean().g - circle).abs() < 1e-3);
    // The mean height of a hemisphere above its disk is two thirds.
    let expected = circle * (5.0 - 2.0 / 3.0);
    assert!((film.layers[1][0][0] - expected).abs() < 5e-3);
}

#[test]
fn the_layers_of_light_add_up_to_the_picture() {
    let scene = still_life();
    let groups = LightGroups::of(&scene);
    assert_eq!(groups.names(), ["background", "surfaces", "key", "1", "2"]);
    let mut layers = vec![LightPart::Emission, LightPart::Direct, LightPart::Indirect];
    layers.extend((0..5).map(LightPart::Group));
    let layers: Vec<Aov> = layers.into_iter().map(Aov::Light).collect();
    for (integrator, transparent) in FOLLOW_LIGHT
        .into_iter()
        .flat_map(|i| [(i, false), (i, true)])
    {
        let settings = Settings {
            integrator,
            transparent,
            // Of what was scattered more than once some is clamped (path).
            clamp: Some(0.5),
            ..settings(9)
        };
        let film = film_of(&scene, camera(), &settings, &layers);
        let mut totals = [0.0; 8];
        for (i, pixel) in film.pixels.iter().enumerate() {
            let layer = |n: usize| Rgb::from(film.layers[n][i]);
            let by_events = (0..3).map(layer).sum();
            let by_group = (3..8).map(layer).sum();
            assert_same(by_events, pixel.mean(), &format!("events, pixel {i}"));
            assert_same(by_group, pixel.mean(), &format!("groups, pixel {i}"));
            (0..8).for_each(|n| totals[n] += layer(n).g);
        }
        assert!(totals.iter().all(|&total| total > 1.0), "{totals:?}");
        assert!(
            film.pixels
                .iter()
                .any(|p| p.halves()[0].count() != p.halves()[1].count())
        );
    }
}

/// A light of a group, alone, gives the picture of its layer.
#[test]
fn a_light_alone_gives_its_layer() {
    let layer = |scene: &Scene, part| {
        let mut settings = settings(4);
        settings.sampling.pattern = Pattern::Grid;
        let film = film_of(scene, camera(), &settings, &[Aov::Light(part)]);
        (film.means(), film.layers[0].clone())
    };
    let (_, of_key) = layer(&still_life(), LightPart::Group(2));
    let mut alone = still_life();
    // Numbers and places of lights stay, since samples and what hides what depend on them.
    alone.background = Default::default();
    for light in &mut alone.lights {
        match &mut light.item {
            Light::Disk(disk) => disk.radiance = Rgb::BLACK,
            Light::Sphere(sphere) => sphere.radiance = Rgb::BLACK,
            _ => {}
        }
    }
    for material in &mut alone.materials {
        material.emission.factor = Rgb::BLACK;
    }
    let (picture, _) = layer(&alone, LightPart::Group(2));
    for (i, (picture, of_key)) in picture.iter().zip(of_key).enumerate() {
        assert_same(of_key.into(), *picture, &format!("pixel {i}"));
    }
}

#[test]
fn places_and_texture_coordinates_are_those_of_the_surface() {
    let mut scene = Scene::default();
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0f32)];
    let positions = corners.map(|(x, z)| Vec3::new(100.0 + x, 50.0, z)).to_vec();
    let uvs = corners.map(|(x, z)| halfshade::math::Vec2::new(0.5 + 0.5 * x, 0.5 + 0.25 * z));
    let mesh = halfshade::scene::Mesh::new("", positions.clone(), vec![[0, 1, 2], [0, 2, 3]]);
    let mesh = mesh.unwrap().with_uv_set(uvs.to_vec()).unwrap();
    add_mesh(
        &mut scene,
        positions,
        vec![[0, 1, 2]],
        Material::matte("", Rgb::WHITE),
    );
    scene.meshes[0] = mesh;
    let eye = Vec3::new(100.3, 53.0, 0.4);
    let camera = Camera::look_at(eye, Vec3::new(100.0, 50.0, 0.0), Vec3::Z, 0.3).unwrap();
    let views = [ViewKind::Position, ViewKind::Uv, ViewKind::Depth].map(Aov::View);
    let film = film_of(&scene, camera, &settings(4), &views);
    for i in 0..film.pixels.len() {
        let position = Vec3::from(film.layers[0][i]);
        let uv = film.layers[1][i];
        assert!((position.y - 50.0).abs() < 1e-4, "{position}");
        assert!(
            (uv[0] - 0.5 - 0.5 * (position.x - 100.0)).abs() < 1e-4,
            "{uv:?}"
        );
        assert!((uv[1] - 0.5 - 0.25 * position.z).abs() < 1e-4, "{uv:?}");
        // Over a pixel the mean of lengths is nearly the length of the mean.
        let depth = film.layers[2][i][0];
        assert!((depth - (position - eye).length()).abs() < 1e-3, "{depth}");
    }
}

/// Half of everything, at a distance from the plane in focus, through a thin lens: a point of that plane sees, at the
/// distance of the edge, a disk of the size of the circle of confusion, of which the edge covers a segment.
#[test]
fn an_edge_out_of_focus_is_as_wide_as_the_circle_of_confusion() {
    let (lens_radius, focus) = (0.1, 4.0);
    // A film of one row, one metre wide in the plane of focus.
    let columns = 64;
    let camera = Camera {
        lens_radius,
        focus_distance: focus,
        ..Camera::look_at(
            Vec3::ZERO,
            -Vec3::Z,
            Vec3::Y,
            2.0 * (0.5 / columns as f32 / focus).atan(),
        )
        .unwrap()
    };
    for distance in [2.0f32, 3.0, 4.0, 6.0, 12.0] {
        let mut scene = Scene::default();
        let quad = Vec3::new(-20.0, 0.0, -distance);
        let black = Material::matte("", Rgb::BLACK);
        add_quad(&mut scene, quad, Vec3::X * 20.0, Vec3::Y * 20.0, black);
        let settings = Settings {
            size: UVec2::new(columns, 1),
            ..settings(1024)
        };
        let film = film_of(&scene, camera, &settings, &[Aov::Coverage]);
        // Its radius in the plane of focus.
        let radius = lens_radius * (focus - distance).abs() / distance;
        // The share of the disk about `x` that is left of 0.
        let covered = |x: f32| {
            let s = if radius > 0.0 {
                (x / radius).clamp(-1.0, 1.0)
            } else {
                x.signum()
            };
            (s.acos() - s * (1.0 - s * s).sqrt()) / std::f32::consts::PI
        };
        let mut partly = 0;
        for (i, got) in film.layers[0].iter().map(|value| value[0]).enumerate() {
            let at = |step: usize| (i as f32 + (step as f32 + 0.5) / 64.0) / columns as f32 - 0.5;
            let expected = (0..64).map(|step| covered(at(step))).sum::<f32>() / 64.0;
            assert!(
                (got - expected).abs() < 0.02,
                "{distance}, {i}: {got} for {expected}"
            );
            partly += u32::from(got > 0.0 && got < 1.0);
        }
        let width = 2.0 * radius * columns as f32;
        assert!(
            (partly as f32 - width).abs() <= 2.0,
            "{distance}: {partly} for {width}"
        );
    }
}
