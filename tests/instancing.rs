//! Meshes that are kept as instances look as if they were flattened.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use common::build::*;
use common::floor::{RHO, assert_close, matte};
use halfshade::bvh::Builder;
use halfshade::camera::Camera;
use halfshade::color::Rgb;
use halfshade::film::Film;
use halfshade::integrate::{Integrator, RayLog, Whitted};
use halfshade::light::{
    DiskLight, DistantLight, Falloff, Light, RectangleLight, SphereLight, SpotLight,
};
use halfshade::material::{AlphaMode, Material, MaterialId};
use halfshade::math::{DAffine3, DQuat, DVec3, Ray, UVec2, UnitVec3, Vec2, Vec3};
use halfshade::prepare::prepare_within;
use halfshade::sampling::{Sampler, SamplingConfig};
use halfshade::scene::{Background, Instance, MeshId, Placed, Scene, Settings};
use halfshade::texture::{TexturedRgb, TexturedScalar};

/// Every shared mesh is an instance; none is.
const BUDGETS: [u64; 2] = [0, u64::MAX];

fn render_within(budget: u64, scene: &Scene, camera: &Placed<Camera>, settings: &Settings) -> Film {
    let prepared = prepare_within(scene, Builder::default(), budget).scene;
    picture_of(&prepared, camera, settings)
}

fn settings(samples: u32) -> Settings {
    Settings {
        size: UVec2::new(64, 48),
        sampling: SamplingConfig {
            samples,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    }
}

/// Numbers in `[0, 1)` that have no pattern to speak of.
fn number(i: u32, dimension: u32) -> f64 {
    let irrational = [
        0.754_877_666,
        0.569_840_291,
        0.430_159_709,
        0.328_775_1,
        0.618_033_989,
    ];
    (f64::from(i + 1) * irrational[dimension as usize] * 7.0).fract()
}

/// Turned, scaled, and every third mirrored.
fn pose(i: u32) -> DAffine3 {
    let axis = DVec3::new(number(i, 0) - 0.5, number(i, 1) - 0.4, number(i, 2) - 0.6).normalize();
    let size = 0.05 + 0.25 * number(i, 3);
    let mirror = if i.is_multiple_of(3) { -1.0 } else { 1.0 };
    let scale = DVec3::new(size, size * (0.5 + number(i, 4)), size * mirror);
    let place = DVec3::new(number(i, 0), 0.4 * number(i, 1), number(i, 2)) * 6.0
        - DVec3::new(3.0, 0.0, 3.0);
    DAffine3::from_scale_rotation_translation(
        scale,
        DQuat::from_axis_angle(axis, 6.0 * number(i, 2)),
        place,
    )
}

/// Places mesh `mesh` again, with its material.
fn add_copy(scene: &mut Scene, mesh: u32, transform: DAffine3) {
    scene.instances.push(Instance {
        name: String::new(),
        mesh: MeshId(mesh),
        material: MaterialId(mesh),
        transform,
    });
}

/// 200 copies of a small sphere over a floor.
fn swarm() -> Scene {
    let mut scene = Scene::default();
    add_quad(
        &mut scene,
        -Vec3::Y * 0.4,
        Vec3::Z * 5.0,
        Vec3::X * 5.0,
        matte(),
    );
    add_sphere(&mut scene, Vec3::ZERO, 1.0, 8, matte());
    scene.instances.pop();
    for i in 0..200 {
        add_copy(&mut scene, 1, pose(i));
    }
    let position = Vec3::new(3.0, 6.0, 2.0);
    add_light(&mut scene, point_light(position, 60.0, 0.3, 2));
    scene.background.radiance = Rgb::new(0.2, 0.3, 0.5);
    scene
}

#[test]
fn instances_look_like_flattened_copies() {
    let scene = swarm();
    let camera = look_at(Vec3::new(1.0, 4.0, 7.0), Vec3::Y * 0.7);
    let settings = settings(16);
    let [kept, flat] = BUDGETS.map(|budget| render_within(budget, &scene, &camera, &settings));
    let memory = BUDGETS.map(|budget| {
        prepare_within(&scene, Builder::default(), budget)
            .scene
            .memory_bytes()
    });
    assert!(
        2 * memory[0] < memory[1],
        "nothing was kept as instances: {memory:?}"
    );
    let error = relative_rmse(&flat, &kept);
    println!("instances against flattened copies: relative RMSE {error:e}");
    assert!(error < 1e-4, "{error:e}");
}

/// G7: a convex body has no shadow on its lit side and no light inside, as an instance either.
#[test]
fn instances_show_neither_acne_nor_leaks() {
    for scale in [1e-6, 1.0, 1e6f64] {
        for offset in [0.0, 10.0, 1000.0f64] {
            for budget in BUDGETS {
                check_body(scale, offset, budget);
            }
        }
    }
}

fn check_body(scale: f64, offset: f64, budget: u64) {
    let center = DVec3::new(offset, -0.3 * offset, 0.7 * offset) * scale;
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.8);
    let mirrored = DVec3::new(scale, -scale, scale);
    let mut scene = Scene::default();
    add_sphere(&mut scene, Vec3::ZERO, 1.0, 24, matte());
    scene.instances.pop();
    let pose = DAffine3::from_scale_rotation_translation(mirrored, turn, center);
    add_copy(&mut scene, 0, pose);
    // Shares the mesh, on the far side from the light.
    let beside = DAffine3::from_translation(DVec3::new(-8.0, -9.0, -9.0) * scale);
    add_copy(&mut scene, 0, beside * pose);
    let mut lamp = point_light(Vec3::ZERO, (1e3 * scale * scale) as f32, 0.0, 1);
    if let Light::Point(light) = &mut lamp {
        light.position = (DVec3::new(3.0, 4.0, 5.0) * scale).as_vec3();
    }
    add_light(&mut scene, lamp);
    scene.lights[0].origin = center;

    let prepared = prepare_within(&scene, Builder::default(), budget).scene;
    let settings = settings(1);
    let integrator = Whitted::new(&prepared, &settings);
    let mut log = RayLog::default();
    let mut lit = 0;
    for i in 0..4000u32 {
        let angle = f64::from(i) * 2.399_963;
        let y = 1.0 - f64::from(2 * i + 1) / 4000.0;
        let ring = (1.0 - y * y).sqrt();
        let toward = DVec3::new(ring * angle.cos(), y, ring * angle.sin());
        let sampler = Sampler::new(&settings.sampling, UVec2::ZERO, i);
        let from = |eye: DVec3, direction: DVec3| {
            Ray::new(prepared.placement.point(eye), direction.as_vec3())
        };
        let what = format!("scale {scale}, offset {offset}, budget {budget}, {i}");

        let inside = integrator.radiance(&from(center, toward), &sampler, &mut log);
        assert_eq!(inside, Rgb::BLACK, "a leak: {what}");

        let ray = from(center + toward * (2.0 * scale), -toward);
        let hit = prepared.closest_hit(&ray, None).expect("a closed body");
        let at = prepared.surface(&ray, &hit).interaction;
        let light = prepared.lights[0]
            .sample(at.point, Vec2::splat(0.5))
            .unwrap();
        let cos = at.shading_normal.dot(*light.wi);
        if cos > 0.0 {
            let got = integrator.radiance(&ray, &sampler, &mut log).g;
            let expected = light.weight.g * RHO / std::f32::consts::PI * cos;
            assert_close(got, expected, 1e-5, &format!("acne: {what}"));
            lit += 1;
        }
    }
    assert!(lit > 1000, "{lit}");
}

/// Instances, textures, holes, microfacets, every kind of light. All lengths times `scale`, a
/// power of two, and intensities times its square.
fn everything(scale: f32) -> Scene {
    let mut scene = Scene::default();
    let pixels = (0..16u16).map(|i| {
        let c = f32::from(i) / 15.0;
        [c, 1.0 - c, 0.5, f32::from((i * 7) % 16) / 15.0]
    });
    let texture = add_texture(&mut scene, 4, pixels.collect());
    let coat = |metallic: f32, roughness: f32| {
        metallic_roughness(|m| {
            m.base_color = TexturedRgb {
                factor: Rgb::new(0.9, 0.8, 0.7),
                texture: Some(texture),
            };
            m.metallic = TexturedScalar::constant(metallic);
            m.roughness = TexturedScalar::constant(roughness);
        })
    };
    let cut = |alpha_mode| Material {
        alpha_mode,
        opacity: TexturedScalar {
            factor: 1.0,
            texture: Some(texture),
            channel: 3,
        },
        ..coat(0.0, 0.5)
    };
    let materials = [
        coat(1.0, 0.4),
        coat(0.0, 0.1),
        cut(AlphaMode::Mask { cutoff: 0.5 }),
        cut(AlphaMode::Blend),
    ];
    for material in materials {
        add_sphere(&mut scene, Vec3::ZERO, 1.0, 8, material);
        scene.instances.pop();
        let mesh = scene.meshes.pop().unwrap();
        let uvs = mesh
            .positions()
            .iter()
            .map(|p| Vec2::new(p.x + p.z, p.y))
            .collect();
        scene.meshes.push(mesh.with_uv_set(uvs).unwrap());
    }
    let larger = DAffine3::from_scale(DVec3::splat(scale.into()));
    for i in 0..40 {
        // Only the placing grows, not the mesh.
        let mut transform = larger * pose(i);
        transform.matrix3 *= 2.0;
        add_copy(&mut scene, i % 4, transform);
    }
    let floor = -Vec3::Y * 0.5 * scale;
    add_quad(
        &mut scene,
        floor,
        Vec3::Z * 5.0 * scale,
        Vec3::X * 5.0 * scale,
        matte(),
    );
    add_lights(&mut scene, scale);
    scene.background = Background {
        radiance: Rgb::new(0.2, 0.3, 0.5),
        ambient: Rgb::splat(0.1),
    };
    scene
}

fn add_lights(scene: &mut Scene, scale: f32) {
    let unit = |x, y, z| UnitVec3::normalize(Vec3::new(x, y, z)).unwrap();
    let radiance = Rgb::new(3.0, 2.0, 4.0);
    let lights = [
        Light::Spot(SpotLight {
            position: Vec3::new(3.0, 5.0, 2.0) * scale,
            direction: unit(-3.0, -5.0, -2.0),
            intensity: Rgb::splat(60.0 * scale * scale),
            inner_angle_radians: 0.2,
            outer_angle_radians: 0.6,
            radius: 0.2 * scale,
            samples: 2,
            falloff: Falloff::INVERSE_SQUARE,
        }),
        Light::Distant(DistantLight {
            direction: unit(1.0, -2.0, 0.3),
            irradiance: Rgb::splat(0.7),
            angle_radians: 0.05,
            samples: 1,
        }),
        Light::Rectangle(RectangleLight {
            center: Vec3::new(-2.0, 4.0, 1.0) * scale,
            half_u: Vec3::X * 0.5 * scale,
            half_v: Vec3::Z * 0.3 * scale,
            radiance,
            is_visible: true,
            samples: 1,
        }),
        Light::Sphere(SphereLight {
            center: Vec3::new(2.0, 3.0, -1.0) * scale,
            radius: 0.4 * scale,
            radiance,
            is_visible: true,
            samples: 1,
        }),
        Light::Disk(DiskLight {
            center: Vec3::new(0.0, 4.0, 0.0) * scale,
            normal: -UnitVec3::Y,
            radius: 0.5 * scale,
            radiance,
            is_visible: false,
            samples: 3,
        }),
    ];
    for light in lights {
        add_light(scene, light);
    }
}

fn camera(scale: f32) -> Placed<Camera> {
    let mut camera = look_at(
        Vec3::new(0.5, 3.0, 7.0) * scale,
        Vec3::new(0.0, 0.7, 0.0) * scale,
    );
    camera.item.lens_radius = 0.1 * scale;
    camera
}

/// G4: no length of ours is hidden anywhere.
#[test]
fn powers_of_two_give_the_same_bits() {
    let settings = settings(4);
    for budget in BUDGETS {
        let render = |scale| {
            let film = render_within(budget, &everything(scale), &camera(scale), &settings);
            assert_eq!(film.rejected, 0);
            bits(&film)
        };
        let reference = render(1.0);
        for k in (-40..=40).step_by(8) {
            assert!(reference == render(2f32.powi(k)), "budget {budget}, 2^{k}");
        }
    }
}

#[test]
fn one_two_and_seven_threads_give_the_same_bits() {
    let scene = everything(1.0);
    for budget in BUDGETS {
        let pictures = [1, 2, 7].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            pool.install(|| render_within(budget, &scene, &camera(1.0), &settings(4)))
        });
        assert!(pictures[0].means().iter().any(|c| !c.is_black()));
        for other in &pictures[1..] {
            assert_eq!(bits(&pictures[0]), bits(other), "budget {budget}");
            assert_eq!(pictures[0].rays, other.rays);
        }
    }
}

/// The two ways differ by rounding alone, whatever a scene is made of; a sample or two may land on
/// the other side of a hole's edge.
#[test]
fn every_material_and_light_looks_the_same_on_instances() {
    let scene = everything(1.0);
    let settings = settings(16);
    let [kept, flat] = BUDGETS.map(|budget| render_within(budget, &scene, &camera(1.0), &settings));
    let error = relative_rmse(&flat, &kept);
    println!("instances against flattened copies: relative RMSE {error:e}");
    assert!(error < 5e-4, "{error:e}");
}
