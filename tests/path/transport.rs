//! Whole paths against closed forms, against `whitted` where that is exact, and against themselves.

use std::f32::consts::PI;

use halfshade::bvh::Builder;
use halfshade::color::Rgb;
use halfshade::integrate::{Integrator, PathTracer, RayLog, Weighing, Whitted};
use halfshade::light::{
    DistantLight, Environment, Falloff, Light, RectangleLight, SphereLight, SpotLight,
};
use halfshade::material::{AlphaMode, Material};
use halfshade::math::{Ray, UVec2, UnitVec3, Vec3};
use halfshade::prepare::prepare;
use halfshade::sampling::{Pattern, Sampler, SamplingConfig};
use halfshade::scene::{Background, IntegratorKind, Scene, Settings};
use halfshade::stress::closed_form::{disk_irradiance, polygon_irradiance, sphere_irradiance};
use halfshade::texture::{TexturedRgb, TexturedScalar};

use crate::common::build::*;
use crate::common::floor::{disk, irradiance, matte, plane};

pub fn path(samples: u32, max_depth: u32) -> Settings {
    Settings {
        integrator: IntegratorKind::Path,
        max_depth: Some(max_depth),
        size: UVec2::new(24, 18),
        sampling: SamplingConfig {
            samples,
            pattern: Pattern::Sobol,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    }
}

fn emissive(radiance: f32) -> Material {
    Material {
        emission: TexturedRgb::constant(Rgb::splat(radiance)),
        ..Material::matte("lamp", Rgb::BLACK)
    }
}

pub fn sphere_light(center: Vec3, radius: f32, is_visible: bool) -> Light {
    Light::Sphere(SphereLight {
        center,
        radius,
        radiance: Rgb::splat(3.0),
        is_visible,
        samples: 1,
    })
}

fn rectangle_light(is_visible: bool) -> Light {
    Light::Rectangle(RectangleLight {
        center: Vec3::new(0.4, 1.5, 0.2),
        half_u: Vec3::new(0.7, 0.0, 0.1),
        half_v: Vec3::new(0.0, 0.2, 0.5),
        radiance: Rgb::splat(3.0),
        is_visible,
        samples: 1,
    })
}

/// Mean and standard error of samples that go along one ray.
pub fn mean(
    scene: &Scene,
    weighing: Weighing,
    eye: Vec3,
    way: Vec3,
    settings: &Settings,
) -> [f64; 2] {
    let settings = Settings {
        sampling: SamplingConfig {
            pattern: Pattern::Random,
            ..settings.sampling
        },
        ..settings.clone()
    };
    let prepared = prepare(scene, Builder::default()).scene;
    let tracer = PathTracer::new(&prepared, &settings).weighing(weighing);
    let origin = prepared.placement.point(eye.as_dvec3());
    let ray = Ray::new(origin, way.normalize());
    let count = settings.sampling.samples;
    let values: Vec<f64> = (0..count)
        .map(|index| {
            let sampler = Sampler::new(&settings.sampling, UVec2::ZERO, index);
            f64::from(tracer.radiance(&ray, &sampler, &mut RayLog::default()).g)
        })
        .collect();
    let n = f64::from(count);
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    [mean, (squares / (n * (n - 1.0))).sqrt()]
}

fn assert_near(got: f32, expected: f32, tolerance: f32, what: &str) {
    assert!(
        (got / expected - 1.0).abs() <= tolerance,
        "{what}: {got} for {expected}"
    );
}

/// L2, L3, L4: area lights of every kind bring the irradiance of their closed forms.
#[test]
fn area_lights_have_their_closed_forms() {
    let settings = path(1 << 12, 1);
    let with = |light| {
        let mut scene = plane();
        add_light(&mut scene, light);
        irradiance(&scene, Vec3::ZERO, &settings)
    };
    for (radius, height, offset) in [(0.5f32, 2.0f32, 0.0f32), (1.5, 1.0, 0.0), (1.0, 1.5, 2.5)] {
        let exact = 3.0 * disk_irradiance(radius.into(), height.into(), offset.into()) as f32;
        assert_near(with(disk(radius, height, offset, 1)), exact, 5e-3, "disk");
    }
    for center in [Vec3::new(0.0, 2.0, 0.0), Vec3::new(1.0, 1.2, 0.5)] {
        let distance = center.length();
        let cos = center.y / distance;
        let exact = 3.0 * sphere_irradiance(0.6, distance.into(), cos.into()) as f32;
        for is_visible in [true, false] {
            let got = with(sphere_light(center, 0.6, is_visible));
            assert_near(got, exact, 5e-3, "sphere");
        }
    }
    let Light::Rectangle(light) = rectangle_light(true) else {
        unreachable!()
    };
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(u, v)| (light.center + light.half_u * u + light.half_v * v).as_dvec3());
    let exact = 3.0 * polygon_irradiance(&corners, halfshade::math::DVec3::Y) as f32;
    // Whichever order of the edges makes it face the floor.
    let facing = Light::Rectangle(if light.half_u.cross(light.half_v).y < 0.0 {
        light
    } else {
        RectangleLight {
            half_u: light.half_v,
            half_v: light.half_u,
            ..light
        }
    });
    assert_near(with(facing), exact, 5e-3, "rectangle");
}

/// L4 of a mesh: triangles that shine, alone and among a thousand, flat and kept as instances.
#[test]
fn emissive_meshes_have_their_closed_form() {
    let (center, u, v) = (Vec3::new(0.3, 1.4, -0.2), Vec3::X * 0.5, Vec3::Z * 0.4);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(a, b)| (center + u * a + v * b).as_dvec3());
    let exact = 2.0 * polygon_irradiance(&corners, halfshade::math::DVec3::Y) as f32;
    let mut scene = plane();
    add_quad(&mut scene, center, u, v, emissive(2.0));
    let got = irradiance(&scene, Vec3::ZERO, &path(1 << 12, 1));
    assert_near(got, exact, 1e-2, "two triangles");

    let mut scene = plane();
    for i in 0..16 {
        for j in 0..16 {
            let place = |k: i32| (2.0 * k as f32 + 1.0) / 16.0 - 1.0;
            let middle = center + u * place(i) + v * place(j);
            add_quad(&mut scene, middle, u / 16.0, v / 16.0, emissive(2.0));
        }
    }
    let got = irradiance(&scene, Vec3::ZERO, &path(1 << 12, 1));
    assert_near(got, exact, 1e-2, "512 triangles");
}

/// A texture of emission: half of it black, and a mask with holes over the rest.
#[test]
fn textured_emission_is_that_of_its_texture() {
    let mut scene = plane();
    let texture = add_texture(&mut scene, 2, vec![[0.0; 4], [1.0, 1.0, 1.0, 0.25]]);
    let opacity = TexturedScalar {
        factor: 1.0,
        texture: Some(texture),
        channel: 3,
    };
    let lamp = Material {
        emission: TexturedRgb {
            factor: Rgb::splat(8.0),
            texture: Some(texture),
        },
        alpha_mode: AlphaMode::Blend,
        opacity,
        ..emissive(1.0)
    };
    add_quad(&mut scene, Vec3::Y * 1.3, Vec3::X, Vec3::Z, lamp);
    let mesh = scene.meshes.pop().unwrap();
    let uvs = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
        .map(|(x, y)| halfshade::math::Vec2::new(x, y));
    scene.meshes.push(mesh.with_uv_set(uvs.to_vec()).unwrap());
    // The half at x > 0, of radiance 8 and opacity 1/4.
    let corners = [(0.0, -1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 1.0)]
        .map(|(x, z)| halfshade::math::DVec3::new(x, 1.3, z));
    let exact = 2.0 * polygon_irradiance(&corners, halfshade::math::DVec3::Y) as f32;
    let settings = path(1 << 13, 1);
    let got = irradiance(&scene, Vec3::ZERO, &settings);
    assert_near(got, exact, 2e-2, "half a lamp");
}

/// Point, spot and sharp distant lights: what whitted says, bit for bit up to rounding.
#[test]
fn direct_light_of_points_is_that_of_whitted() {
    let mut scene = plane();
    add_quad(
        &mut scene,
        Vec3::new(0.0, 0.4, 0.0),
        Vec3::X * 0.3,
        Vec3::Z * 0.3,
        matte(),
    );
    add_light(
        &mut scene,
        point_light(Vec3::new(0.5, 2.0, 0.3), 5.0, 0.0, 1),
    );
    add_light(
        &mut scene,
        Light::Spot(SpotLight {
            position: Vec3::new(-1.0, 2.0, 0.0),
            direction: -UnitVec3::Y,
            intensity: Rgb::new(3.0, 2.0, 1.0),
            inner_angle_radians: 0.2,
            outer_angle_radians: 0.7,
            radius: 0.0,
            samples: 1,
            falloff: Falloff::INVERSE_SQUARE,
        }),
    );
    add_light(
        &mut scene,
        Light::Distant(DistantLight {
            direction: UnitVec3::normalize(Vec3::new(0.3, -1.0, 0.4)).unwrap(),
            irradiance: Rgb::WHITE,
            angle_radians: 0.0,
            samples: 1,
        }),
    );
    let camera = look_at(Vec3::new(0.5, 3.0, 4.0), Vec3::ZERO);
    let path = path(4, 1);
    let whitted = Settings {
        integrator: IntegratorKind::Whitted,
        ..path.clone()
    };
    let error = relative_rmse(
        &picture(&scene, &camera, &whitted),
        &picture(&scene, &camera, &path),
    );
    assert!(error < 1e-6, "{error}");

    // And soft ones have the same mean.
    for light in &mut scene.lights {
        match &mut light.item {
            Light::Point(l) => l.radius = 0.3,
            Light::Spot(l) => l.radius = 0.3,
            Light::Distant(l) => l.angle_radians = 0.2,
            _ => {}
        }
    }
    let many = |settings: &Settings| Settings {
        sampling: SamplingConfig {
            samples: 256,
            ..settings.sampling
        },
        ..settings.clone()
    };
    let error = relative_rmse(
        &picture(&scene, &camera, &many(&whitted)),
        &picture(&scene, &camera, &many(&path)),
    );
    assert!(error < 1e-2, "{error}");
}

/// A matte floor and a metal block under lights with a size, and surroundings of two colours.
fn mixed_scene() -> Scene {
    let mut scene = plane();
    let metal = metallic_roughness(|m| {
        m.roughness = TexturedScalar::constant(0.3);
        m.base_color = TexturedRgb::constant(Rgb::splat(0.8));
    });
    add_quad(
        &mut scene,
        Vec3::new(0.0, 0.5, -0.8),
        Vec3::X,
        Vec3::new(0.0, 0.5, -0.2),
        metal,
    );
    let lamp = emissive(4.0);
    add_quad(
        &mut scene,
        Vec3::new(-0.8, 0.9, 0.3),
        Vec3::Y * 0.3,
        Vec3::Z * 0.3,
        lamp,
    );
    add_light(
        &mut scene,
        sphere_light(Vec3::new(0.8, 0.9, 0.1), 0.3, false),
    );
    add_light(&mut scene, rectangle_light(true));
    add_light(
        &mut scene,
        Light::Distant(DistantLight {
            direction: UnitVec3::normalize(Vec3::new(0.3, -1.0, -0.4)).unwrap(),
            irradiance: Rgb::splat(0.5),
            angle_radians: 0.8,
            samples: 1,
        }),
    );
    let sky = (0..32)
        .map(|i| [if i == 9 { 6.0 } else { 0.2 }; 3])
        .collect();
    scene.environment = Environment::new("sky", [8, 4], sky, Rgb::WHITE, 0.5);
    scene
}

/// Whatever technique finds a light, and however the two are weighed, the mean is the same.
#[test]
fn all_weighings_have_the_same_mean() {
    let scene = mixed_scene();
    let settings = path(1 << 14, 3);
    // On the floor, on the metal.
    for way in [Vec3::new(0.05, -1.0, -0.2), Vec3::new(0.1, -0.3, -1.0)] {
        let eye = Vec3::new(0.0, 1.2, 1.0);
        let of = |weighing| mean(&scene, weighing, eye, way, &settings);
        let [power, error] = of(Weighing::Power);
        assert!(power > 0.0);
        for other in [Weighing::LightsOnly, Weighing::ScatteringOnly] {
            let [value, other_error] = of(other);
            let bound = 4.5 * (error * error + other_error * other_error).sqrt();
            assert!(
                (value - power).abs() < bound,
                "{other:?}: {value} for {power}, bound {bound}"
            );
            assert!(
                error < 1.5 * other_error,
                "{other:?}: {other_error} {error}"
            );
        }
    }
}

/// A picture of the surroundings that is the same everywhere is a background of that radiance.
#[test]
fn a_constant_environment_is_a_constant_background() {
    let mut scene = plane();
    let metal = metallic_roughness(|m| m.roughness = TexturedScalar::constant(0.4));
    add_quad(
        &mut scene,
        Vec3::new(0.0, 0.5, -0.8),
        Vec3::X,
        Vec3::Y * 0.5,
        metal,
    );
    let settings = path(1 << 13, 4);
    let mut around = scene.clone();
    around.environment = Environment::new("", [6, 3], vec![[0.7; 3]; 18], Rgb::WHITE, 0.0);
    scene.background.radiance = Rgb::splat(0.7);
    for way in [Vec3::new(0.05, -1.0, -0.6), Vec3::new(0.1, -0.4, -1.0)] {
        let eye = Vec3::new(0.0, 1.2, 1.0);
        let [a, ea] = mean(&scene, Weighing::Power, eye, way, &settings);
        let [b, eb] = mean(&around, Weighing::Power, eye, way, &settings);
        assert!(
            (a - b).abs() < 4.5 * (ea * ea + eb * eb).sqrt() + 1e-4 * a,
            "{a} {b}"
        );
    }
    let up = |scene: &Scene| radiance(scene, Vec3::Y, Vec3::Y, &settings).g;
    assert!((up(&around) - up(&scene)).abs() < 1e-6);
}

/// White matte things under a sky of 1 are as bright as the sky, whatever their shape: every path
/// ends in the sky, and counts for 1.
#[test]
fn white_things_vanish_in_a_white_sky() {
    let mut scene = Scene::default();
    let white = || Material::matte("white", Rgb::WHITE);
    add_box(
        &mut scene,
        Vec3::new(-0.5, -0.4, -0.6),
        Vec3::new(0.4, 0.1, 0.3),
        white(),
    );
    add_quad(
        &mut scene,
        -Vec3::Y * 0.5,
        Vec3::Z * 4.0,
        Vec3::X * 4.0,
        white(),
    );
    add_sphere(&mut scene, Vec3::new(0.9, 0.2, 0.0), 0.5, 8, white());
    scene.background = Background {
        radiance: Rgb::WHITE,
        ambient: Rgb::BLACK,
    };
    let camera = look_at(Vec3::new(1.0, 1.5, 3.0), Vec3::ZERO);
    let film = picture(&scene, &camera, &path(16, 1000));
    for mean in film.means() {
        assert!((mean.g - 1.0).abs() < 1e-4, "{mean:?}");
    }
}

/// In a closed box whose walls give off 1 - albedo, every ray sees 1: the series of all bounces.
#[test]
fn a_closed_box_is_as_bright_as_its_series() {
    for albedo in [0.0f32, 0.5, 0.9] {
        let wall = Material {
            emission: TexturedRgb::constant(Rgb::splat(1.0 - albedo)),
            ..Material::matte("wall", Rgb::splat(albedo))
        };
        let mut scene = Scene::default();
        add_box(
            &mut scene,
            Vec3::splat(-1.0),
            Vec3::splat(1.0),
            wall.clone(),
        );
        add_box(&mut scene, Vec3::splat(-0.3), Vec3::splat(0.2), wall);
        let way = Vec3::new(0.4, -0.3, 0.8);
        let eye = Vec3::new(0.6, 0.5, -0.7);
        let [value, error] = mean(&scene, Weighing::Power, eye, way, &path(4096, 500));
        assert!(
            (value - 1.0).abs() < 4.5 * error + 1e-5,
            "albedo {albedo}: {value} {error}"
        );
        // Without the last bounces what is missing is known.
        let [cut, error] = mean(&scene, Weighing::Power, eye, way, &path(4096, 2));
        let expected = 1.0 - f64::from(albedo).powi(3);
        assert!(
            (cut - expected).abs() < 4.5 * error + 1e-5,
            "albedo {albedo}: {cut}"
        );
    }
}

/// What a lamp in a closed box gives off is what the walls take: with flux Φ and an albedo a, all light that
/// arrives on the walls is Φ/(1 - a) in a sphere, where every wall is lit by every other alike.
#[test]
fn a_sphere_keeps_the_light_of_its_lamp() {
    let albedo = 0.7f32;
    let mut scene = Scene::default();
    add_sphere(
        &mut scene,
        Vec3::ZERO,
        1.0,
        32,
        Material::matte("wall", Rgb::splat(albedo)),
    );
    add_light(&mut scene, point_light(Vec3::ZERO, 1.0, 0.0, 1));
    // Irradiance of the first bounce: I/R², of all: over (1 - a); radiance is a E / π.
    let exact = albedo / PI / (1.0 - albedo);
    let got = radiance(
        &scene,
        Vec3::new(0.1, 0.0, 0.0),
        Vec3::new(0.3, 0.5, -0.8),
        &path(4096, 200),
    )
    .g;
    // The sphere is made of flat facets: a little smaller than the true one.
    assert_near(got, exact, 1.5e-2, "lamp in a sphere");
}

/// L8 for paths: mirrors that shine and face each other.
#[test]
fn facing_mirrors_show_the_geometric_series() {
    for k in [0.3f32, 0.8] {
        let mut mirror = phong(|p| p.reflect = Rgb::splat(k));
        mirror.emission = TexturedRgb::constant(Rgb::splat(2.0));
        let mut scene = Scene::default();
        let (x, y) = (Vec3::X * 9.0, Vec3::Y * 9.0);
        add_quad(&mut scene, -Vec3::Z, x, y, mirror.clone());
        add_quad(&mut scene, Vec3::Z, y, x, mirror);
        let [value, error] = mean(
            &scene,
            Weighing::Power,
            Vec3::ZERO,
            Vec3::Z,
            &path(4096, 1000),
        );
        let exact = 2.0 / (1.0 - f64::from(k));
        assert!(
            (value - exact).abs() < 4.5 * error + 1e-5 * exact,
            "{k}: {value} {exact}"
        );
    }
}

/// Clear thin walls do not count as scattering, and hide nothing: not from paths, not from lights.
#[test]
fn panes_are_crossed_straight() {
    let pane = || {
        metallic_roughness(|m| {
            m.metallic = TexturedScalar::constant(0.0);
            m.transmission = TexturedScalar::constant(1.0);
            m.roughness = TexturedScalar::constant(0.0);
            m.index_of_refraction = 1.0;
        })
    };
    let mut scene = plane();
    add_light(&mut scene, disk(0.5, 2.0, 0.3, 1));
    let settings = path(1 << 12, 1);
    let bare = irradiance(&scene, Vec3::ZERO, &settings);
    for height in [0.2, 0.5, 0.8, 1.5] {
        let center = Vec3::Y * height;
        add_quad(&mut scene, center, Vec3::X * 9.0, Vec3::Z * 9.0, pane());
    }
    let behind = irradiance(&scene, Vec3::ZERO, &settings);
    assert_near(behind, bare, 1e-2, "four panes of index 1");
}

/// A solid body of glass: shadow rays stop at it, and what the paths bring through it is all there is. A
/// slab of index 1.5 lets through what two borders do, with all reflections between them.
#[test]
fn a_slab_of_glass_lets_through_what_fresnel_says() {
    let glass = phong(|p| {
        p.transmit = Rgb::WHITE;
        p.index_of_refraction = 1.5;
    });
    let mut scene = Scene::default();
    add_box(
        &mut scene,
        Vec3::new(-50.0, 0.5, -50.0),
        Vec3::new(50.0, 0.6, 50.0),
        glass,
    );
    let mut lamp = emissive(3.0);
    lamp.is_double_sided = true;
    add_quad(
        &mut scene,
        Vec3::Y * 2.0,
        Vec3::X * 90.0,
        Vec3::Z * 90.0,
        lamp,
    );
    let settings = path(1 << 14, 64);
    let [value, error] = mean(&scene, Weighing::Power, Vec3::ZERO, Vec3::Y, &settings);
    let reflected: f64 = 0.04;
    let exact = 3.0 * (1.0 - reflected) / (1.0 + reflected);
    assert!(
        (value - exact).abs() < 4.5 * error + 1e-3,
        "{value} {exact}"
    );
}

/// A body of glass that absorbs, over a floor, under a small lamp: the light is not counted twice.
/// Looked at or scattered to, the floor gets the same.
#[test]
fn light_through_glass_is_counted_once() {
    let mut scene = plane();
    let glass = phong(|p| {
        p.transmit = Rgb::WHITE;
        p.index_of_refraction = 1.3;
    });
    add_box(
        &mut scene,
        Vec3::new(-9.0, 0.3, -9.0),
        Vec3::new(9.0, 0.5, 9.0),
        glass,
    );
    add_quad(&mut scene, Vec3::Y * 1.5, Vec3::X, Vec3::Z, emissive(3.0));
    let eye = Vec3::new(0.0, 0.2, 0.0);
    let settings = path(1 << 14, 12);
    let way = Vec3::new(0.1, -1.0, 0.1);
    let of = |weighing| mean(&scene, weighing, eye, way, &settings);
    let [power, error] = of(Weighing::Power);
    let [lights, lights_error] = of(Weighing::LightsOnly);
    let [scattered, scattered_error] = of(Weighing::ScatteringOnly);
    assert!(power > 0.1, "{power}");
    for (value, other) in [(lights, lights_error), (scattered, scattered_error)] {
        let bound = 4.5 * (error * error + other * other).sqrt();
        assert!((value - power).abs() < bound, "{value} for {power}");
    }
}

/// Beer's law over the way through a body of index 1.
#[test]
fn a_body_absorbs_by_its_thickness() {
    let mut scene = Scene::default();
    let body = metallic_roughness(|m| {
        m.metallic = TexturedScalar::constant(0.0);
        m.roughness = TexturedScalar::constant(0.0);
        m.transmission = TexturedScalar::constant(1.0);
        m.index_of_refraction = 1.0;
        m.thickness = TexturedScalar::constant(1.0);
        m.attenuation_color = Rgb::new(0.5, 0.25, 1.0);
        m.attenuation_distance = 2.0;
    });
    add_box(&mut scene, Vec3::splat(-1.5), Vec3::splat(1.5), body);
    scene.background.radiance = Rgb::WHITE;
    let seen = radiance(&scene, Vec3::Z * 5.0, -Vec3::Z, &path(4, 8));
    for (got, expected) in seen
        .channels()
        .into_iter()
        .zip([0.5f32.powf(1.5), 0.125, 1.0])
    {
        assert!((got - expected).abs() < 1e-4, "{seen:?}");
    }
}

/// One depth is direct light; every further one adds what was scattered once more.
#[test]
fn depth_counts_scattering() {
    let mut scene = Scene::default();
    let wall = Material {
        emission: TexturedRgb::constant(Rgb::splat(1.0)),
        ..Material::matte("wall", Rgb::splat(0.5))
    };
    add_box(&mut scene, Vec3::splat(-1.0), Vec3::splat(1.0), wall);
    for depth in 1..6 {
        let way = Vec3::new(0.4, -0.3, 0.8);
        let [value, error] = mean(&scene, Weighing::Power, Vec3::ZERO, way, &path(4096, depth));
        let expected = 2.0 - 0.5f64.powi(depth as i32);
        assert!(
            (value - expected).abs() < 4.5 * error + 1e-5,
            "{depth}: {value}"
        );
    }
}

/// A clamp takes what it says that it takes.
#[test]
fn a_clamp_says_what_it_takes() {
    let mut scene = mixed_scene();
    scene.lights.clear();
    let camera = look_at(Vec3::new(0.0, 1.2, 2.0), Vec3::new(0.0, 0.4, -0.5));
    let open = path(64, 4);
    let clamped = Settings {
        clamp: Some(0.5),
        ..open.clone()
    };
    let (open, clamped) = (
        picture(&scene, &camera, &open),
        picture(&scene, &camera, &clamped),
    );
    let sum = |film: &halfshade::film::Film| -> f64 {
        film.means().iter().map(|c| f64::from(c.luminance())).sum()
    };
    let share = 1.0 - sum(&clamped) / sum(&open);
    assert!(share > 1e-4, "{share}");
    assert!((clamped.clamped_share() / share - 1.0).abs() < 1e-3);
    assert_eq!(open.clamped_share(), 0.0);
}

/// Patterns whose cells are few or many: the mean is the same.
#[test]
fn every_pattern_is_unbiased() {
    let scene = mixed_scene();
    let camera = look_at(Vec3::new(0.0, 1.2, 2.0), Vec3::new(0.0, 0.4, -0.5));
    let of = |pattern, samples| {
        let settings = path(samples, 4);
        let settings = Settings {
            sampling: SamplingConfig {
                pattern,
                ..settings.sampling
            },
            ..settings
        };
        let film = picture(&scene, &camera, &settings);
        film.means()
            .iter()
            .map(|c| f64::from(c.luminance()))
            .sum::<f64>()
    };
    let reference = of(Pattern::Sobol, 256);
    for (pattern, samples) in [
        (Pattern::Jittered, 50),
        (Pattern::Random, 64),
        (Pattern::Grid, 81),
        (Pattern::Sobol, 37),
    ] {
        let share = of(pattern, samples) / reference;
        assert!((share - 1.0).abs() < 0.02, "{pattern:?}: {share}");
    }
}

/// A camera sees the lights that are visible and no others, be they few or many; a black one hides what is behind it from
/// `whitted`, which shows lights as things, and is nothing to `path`.
#[test]
fn the_camera_sees_visible_lights_only() {
    let (eye, ahead) = (Vec3::Y * 2.0, Vec3::new(0.0, 0.0, -5.0));
    for others in [0, 30] {
        for (is_visible, radiance) in [(true, 3.0), (false, 3.0), (true, 0.0)] {
            let mut scene = plane();
            scene.background.radiance = Rgb::splat(0.25);
            let sphere = |center, radiance| {
                Light::Sphere(SphereLight {
                    center,
                    radius: 1.0,
                    radiance: Rgb::splat(radiance),
                    is_visible,
                    samples: 1,
                })
            };
            add_light(&mut scene, sphere(eye + ahead, radiance));
            for i in 0..others {
                let aside = Vec3::X * (10.0 + 3.0 * i as f32);
                add_light(&mut scene, sphere(eye + ahead + aside, 1.0));
            }
            let settings = path(1, 1);
            let prepared = prepare(&scene, Builder::default()).scene;
            let origin = prepared.placement.point(eye.as_dvec3());
            let ray = Ray::new(origin, ahead);
            let sampler = Sampler::new(&settings.sampling, UVec2::ZERO, 0);
            let seen = |integrator: &dyn Integrator| {
                integrator
                    .radiance(&ray, &sampler, &mut RayLog::default())
                    .g
            };
            let is_dark = radiance == 0.0;
            let whitted = seen(&Whitted::new(&prepared, &settings));
            assert_eq!(whitted, if is_visible { radiance } else { 0.25 });
            let path = seen(&PathTracer::new(&prepared, &settings));
            assert_eq!(
                path,
                if is_visible && !is_dark {
                    radiance
                } else {
                    0.25
                }
            );
        }
    }
}
