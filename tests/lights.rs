//! Lights: their samples against their own geometry and against closed forms (numerics.md 2).

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use common::chi_square::{Moments, survival};
use halfshade::color::Rgb;
use halfshade::light::{
    DiskLight, DistantLight, Falloff, Light, LightSample, PointLight, RectangleLight, ShadowEnd,
    SphereLight, SpotLight,
};
use halfshade::math::{DVec3, Ray, UVec2, UnitVec3, Vec2, Vec3};
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

/// A light, where it is seen from, and what its samples must be spread like.
struct Case {
    light: Light,
    seen_from: Vec3,
    /// The place of a sample on its light, in the unit square.
    place: Box<dyn Fn(&LightSample) -> (f64, f64)>,
    /// What weight a patch of that square is due, about the place given, per area of the square.
    share: Box<dyn Fn(f64, f64) -> f64>,
}

/// Turns of `v` about `axis`, and its distance from it, in any frame.
fn polar(v: DVec3, axis: DVec3) -> (f64, f64) {
    let (x, y) = axis.normalize().any_orthonormal_pair();
    let (x, y) = (v.dot(x), v.dot(y));
    (0.5 + y.atan2(x) / TAU, x.hypot(y))
}

/// A soft point or spot light: shadow rays end uniformly on the disk, all weights are equal.
fn shadow_disk_case(light: Light, position: Vec3, radius: f64) -> Case {
    let seen_from = Vec3::new(1.0, 0.5, -0.3);
    let axis = (position - seen_from).as_dvec3();
    Case {
        light,
        seen_from,
        place: Box::new(move |s| {
            let (turn, distance) = polar(end(s) - position.as_dvec3(), axis);
            (turn, (distance / radius).powi(2))
        }),
        share: Box::new(|_, _| 1.0),
    }
}

/// A cone of equal weights around `axis`.
fn cone_case(light: Light, seen_from: Vec3, axis: DVec3, cos: f64) -> Case {
    Case {
        light,
        seen_from,
        place: Box::new(move |s| {
            let wi = s.wi.as_dvec3();
            let depth = 0.5 * (wi - axis.normalize()).length_squared();
            (polar(wi, axis).0, depth / (1.0 - cos))
        }),
        share: Box::new(|_, _| 1.0),
    }
}

/// Weight due to a patch of a one-sided surface: its solid angle.
fn facing(p: DVec3, normal: DVec3, area: f64) -> f64 {
    area * -p.dot(normal) / p.length().powi(3)
}

fn disk_case(light: DiskLight, seen_from: Vec3) -> Case {
    let (normal, radius) = (light.normal.as_dvec3().normalize(), f64::from(light.radius));
    let center = light.center.as_dvec3();
    Case {
        light: Light::Disk(light),
        seen_from,
        place: Box::new(move |s| {
            let (turn, distance) = polar(end(s) - center, normal);
            (turn, (distance / radius).powi(2))
        }),
        share: Box::new(move |turn, squared| {
            let (x, y) = normal.any_orthonormal_pair();
            let (sin, cos) = ((turn - 0.5) * TAU).sin_cos();
            let p = center + radius * squared.sqrt() * (x * cos + y * sin);
            facing(p - seen_from.as_dvec3(), normal, PI * radius * radius)
        }),
    }
}

fn rectangle_case(light: RectangleLight, seen_from: Vec3) -> Case {
    let [center, u, v] = [light.center, light.half_u, light.half_v].map(|v| v.as_dvec3());
    let cross = u.cross(v);
    let normal = cross.normalize();
    Case {
        light: Light::Rectangle(light),
        seen_from,
        place: Box::new(move |s| {
            let p = end(s) - center;
            let along_u = p.cross(v).dot(cross) / cross.length_squared();
            let along_v = u.cross(p).dot(cross) / cross.length_squared();
            (0.5 + 0.5 * along_u, 0.5 + 0.5 * along_v)
        }),
        share: Box::new(move |s, t| {
            let p = center + u * (2.0 * s - 1.0) + v * (2.0 * t - 1.0);
            facing(p - seen_from.as_dvec3(), normal, 4.0 * cross.length())
        }),
    }
}

fn cases() -> Vec<Case> {
    let above = Vec3::new(0.2, 3.0, 0.1);
    let tilted = unit(0.3, -1.0, -0.2);
    let (u, v) = (Vec3::new(0.9, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.5));
    let flat = rectangle(above, u, v);
    let turned = |q: Vec3| Vec3::new(0.6 * q.x - 0.8 * q.y, 0.8 * q.x + 0.6 * q.y, q.z);
    let skew = rectangle(above, u, v + 0.6 * u);
    let near = |height: f32| above - Vec3::Y * height + Vec3::new(0.3, 0.0, 0.2);
    let mut cases = vec![
        shadow_disk_case(Light::Point(point(above, 0.7)), above, f64::from(0.7_f32)),
        shadow_disk_case(Light::Spot(spot(above, 0.2)), above, f64::from(0.2_f32)),
        cone_case(
            sphere(above, 1.0).into_light(),
            Vec3::ZERO,
            above.as_dvec3(),
            {
                let sin = 1.0 / above.as_dvec3().length();
                (1.0 - sin * sin).sqrt()
            },
        ),
        cone_case(
            sphere(above, 5.0).into_light(),
            Vec3::X,
            (above - Vec3::X).as_dvec3(),
            -1.0,
        ),
    ];
    for angle in [0.01_f32, 0.5, 2.0, 5.0] {
        let light = distant(angle);
        let axis = -light.direction.as_dvec3();
        let cos = f64::from(0.5 * angle).cos();
        cases.push(cone_case(Light::Distant(light), Vec3::ZERO, axis, cos));
    }
    for seen_from in [Vec3::ZERO, Vec3::new(4.0, 1.0, 0.0), near(0.1), near(0.7)] {
        for radius in [0.1, 1.0, 3.0] {
            cases.push(disk_case(disk(above, tilted, radius), seen_from));
        }
        cases.push(rectangle_case(flat, seen_from));
        cases.push(rectangle_case(skew, seen_from));
        let turned = rectangle(above, turned(u), turned(v));
        cases.push(rectangle_case(turned, seen_from));
    }
    // So far away that it is sampled by area.
    cases.push(rectangle_case(flat, Vec3::new(9_000.0, -8_000.0, 5_000.0)));
    cases
}

trait IntoLight {
    fn into_light(self) -> Light;
}

impl IntoLight for SphereLight {
    fn into_light(self) -> Light {
        Light::Sphere(self)
    }
}

/// The name of a light's kind. A new kind does not compile until it is named here, and fails
/// [`every_kind_has_a_case`] until it has a case.
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

const KINDS: [&str; 6] = ["point", "spot", "distant", "disk", "rectangle", "sphere"];

#[test]
fn every_kind_has_a_case() {
    let cases = cases();
    for name in KINDS {
        assert!(
            cases.iter().any(|c| kind(&c.light) == name),
            "no case of a {name} light"
        );
        assert!(
            stiff_lights().iter().any(|l| kind(l) == name),
            "no stiff {name} light"
        );
    }
    assert!(cases.iter().all(|c| KINDS.contains(&kind(&c.light))));
}

/// In each of 8 × 8 patches of each light, the mean weight is the patch's due: samples have the
/// density that their weights claim.
#[test]
fn samples_have_the_density_that_their_weights_claim() {
    const SIDE: usize = 8;
    const COUNT: u32 = 200_000;
    for (number, case) in cases().iter().enumerate() {
        let mut sums = [(0.0, 0.0); SIDE * SIDE];
        let mut missed = 0;
        for u in random(COUNT, number as u64) {
            let Some(sample) = case.light.sample(case.seen_from, u) else {
                missed += 1;
                continue;
            };
            let (s, t) = (case.place)(&sample);
            assert!(
                (-1e-3..1.001).contains(&s) && (-1e-3..1.001).contains(&t),
                "case {number}: off the light, {s} {t}"
            );
            let cell = |x: f64| ((x * SIDE as f64) as usize).min(SIDE - 1);
            let weight = f64::from(sample.weight.r);
            let sum = &mut sums[cell(t) * SIDE + cell(s)];
            sum.0 += weight;
            sum.1 += weight * weight;
        }
        assert!(missed < COUNT, "case {number} sees nothing");
        let due = patches(&*case.share, SIDE);
        // Cases without a weight of their own say how it is spread only.
        let total: f64 = sums.iter().map(|s| s.0).sum::<f64>() / f64::from(COUNT);
        let is_solid_angle = matches!(case.light, Light::Disk(_) | Light::Rectangle(_));
        let scale = if is_solid_angle { 1.0 } else { total };
        let statistic: f64 = sums
            .iter()
            .zip(due)
            .map(|(&(sum, squares), due)| {
                let mean = sum / f64::from(COUNT);
                let variance = squares / f64::from(COUNT) - mean * mean;
                (mean - due * scale).powi(2) / (variance / f64::from(COUNT)).max(1e-300)
            })
            .sum();
        let p = survival(statistic, SIDE * SIDE - 1);
        assert!(
            p > 1e-4,
            "case {number}, {:?} from {}: p = {p}",
            case.light,
            case.seen_from
        );
    }
}

/// Integral of `f` over each patch of the unit square, by midpoints.
fn patches(f: &dyn Fn(f64, f64) -> f64, side: usize) -> Vec<f64> {
    const STEPS: usize = 40;
    let fine = (side * STEPS) as f64;
    let patch = |column: usize, row: usize| -> f64 {
        let at = |cell: usize, k: usize| ((cell * STEPS + k) as f64 + 0.5) / fine;
        (0..STEPS * STEPS)
            .map(|k| f(at(column, k % STEPS), at(row, k / STEPS)) / (fine * fine))
            .sum()
    };
    (0..side * side)
        .map(|cell| patch(cell % side, cell / side))
        .collect()
}

/// The direction is that of the shadow ray's end, except for points, where it is the centre's.
#[test]
fn directions_lead_to_the_ends_of_shadow_rays() {
    for case in cases() {
        for u in random(2000, 3) {
            let Some(s) = case.light.sample(case.seen_from, u) else {
                continue;
            };
            assert!((s.wi.as_dvec3().length() - 1.0).abs() < 1e-6);
            let toward = match (&case.light, s.shadow) {
                (Light::Point(l), _) => l.position - case.seen_from,
                (Light::Spot(l), _) => l.position - case.seen_from,
                (_, ShadowEnd::Point(p)) => p - case.seen_from,
                (_, ShadowEnd::Direction(d)) => d.get(),
            };
            assert!(
                toward.normalize().distance(*s.wi) < 1e-5,
                "{:?}",
                case.light
            );
        }
    }
}

/// numerics.md L2.
fn disk_irradiance(radius: f64, height: f64, offset: f64) -> f64 {
    if offset == 0.0 {
        return PI * radius * radius / (radius * radius + height * height);
    }
    let (h, r) = (height / offset, radius / offset);
    let z = 1.0 + h * h + r * r;
    // Z² - 4ρ² = (Z - 2ρ)(Z + 2ρ), and Z - 2ρ² over the root loses digits where ρ is small.
    let root = ((h * h + (r - 1.0).powi(2)) * (h * h + (r + 1.0).powi(2))).sqrt();
    // (root - Z + 2ρ²) / root with root - Z = -4ρ²/(root + Z).
    FRAC_PI_2 * r * r * (2.0 - 4.0 / (root + z)) / root
}

#[test]
fn a_disk_gives_the_irradiance_of_its_closed_form() {
    for (radius, height, offset) in [
        (1.0, 3.0, 0.0),
        (1.0, 3.0, 2.0),
        (1.0, 0.2, 0.5),
        (1.0, 0.01, 1.0),
        (1.0, 0.01, 0.3),
        (1.0, 1e-4, 0.9999),
        (1e-3, 3.0, 1.0),
        (1e6, 1.0, 1e5),
        (1e-6, 1e-6, 1e-6),
        (1e15, 3e15, 2e15),
    ] {
        let light = Light::Disk(disk(Vec3::new(offset, height, 0.0), -UnitVec3::Y, radius));
        let [r, h, a] = [radius, height, offset].map(f64::from);
        let exact = disk_irradiance(r, h, a);
        let measured = irradiance(&light, Vec3::ZERO, UnitVec3::Y, 200_000);
        let relative = measured.standard_error() / exact;
        println!(
            "disk R {radius} h {height} a {offset}: E {exact:.6e}, standard error {relative:.1e}"
        );
        measured.assert_mean(exact, &format!("R {radius}, h {height}, a {offset}"));
        // By solid angle only the cosine varies: less than 100 % a sample, wherever the disk is.
        assert!(relative < 1.0 / 200_000_f64.sqrt(), "{relative}");
        let behind = Light::Disk(disk(Vec3::new(offset, height, 0.0), UnitVec3::Y, radius));
        assert!(behind.sample(Vec3::ZERO, Vec2::splat(0.3)).is_none());
    }
}

#[test]
fn a_sphere_gives_the_irradiance_of_its_closed_form() {
    for (radius, distance, angle) in [
        (1.0, 3.0, 0.0),
        (1.0, 3.0, 1.0),
        (1.0, 1.0001, 0.0),
        (1e-3, 5.0, 1.2),
        (1e-9, 1e3, 0.5),
        (1e12, 4e12, 0.7),
    ] {
        let (sin, cos) = f64::sin_cos(angle);
        let center = DVec3::new(sin, cos, 0.0) * distance;
        let light = Light::Sphere(sphere(center.as_vec3(), radius as f32));
        let exact =
            PI * (f64::from(radius as f32) / center.as_vec3().as_dvec3().length()).powi(2) * cos;
        let measured = irradiance(&light, Vec3::ZERO, UnitVec3::Y, 200_000);
        measured.assert_mean(exact, &format!("R {radius}, d {distance}, {angle} rad"));
    }
    for point in [Vec3::ZERO, Vec3::new(0.3, 0.9, 0.1), Vec3::NEG_X] {
        let inside = Light::Sphere(sphere(Vec3::ZERO, 1.0));
        let measured = irradiance(&inside, point, UnitVec3::Y, 200_000);
        measured.assert_mean(PI, &format!("inside at {point}"));
    }
}

/// numerics.md L4: Lambert's sum over the edges of a polygon above the horizon.
fn polygon_irradiance(corners: &[DVec3], normal: DVec3) -> f64 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    0.5 * edges
        .map(|(a, b)| {
            let cross = a.cross(*b);
            cross.length().atan2(a.dot(*b)) * cross.normalize().dot(normal)
        })
        .sum::<f64>()
        .abs()
}

#[test]
fn a_rectangle_gives_the_irradiance_of_lamberts_sum() {
    let x = |s: f32| Vec3::new(s, 0.0, 0.0);
    let z = |s: f32| Vec3::new(0.0, 0.0, s);
    let up = |h: f32| Vec3::new(0.0, h, 0.0);
    for (center, half_u, half_v) in [
        (up(3.0), x(1.0), z(0.5)),
        (up(3.0) + x(2.0), x(1.0), z(0.5)),
        (up(0.01) + x(0.4), x(1.0), z(1.0)),
        (up(1.0), x(1e5), z(1e4)),
        (up(3.0), x(1.0), z(1e-5)),
        (up(3e4), x(1.0), z(0.5)),
        // A wall, seen edge-on but for a little.
        (up(2.0) + x(1e-3), up(1.0), z(1.0)),
        // Tilted.
        (up(3.0), Vec3::new(0.8, 0.6, 0.0), z(1.0)),
        // Parallelograms.
        (up(3.0), x(1.0), z(0.5) + x(0.7)),
        (up(2.0) + x(1.0), Vec3::new(0.8, 0.6, 0.3), z(1.0)),
        (up(3e15), x(1e15), z(1e15)),
        (up(3e-15), x(1e-15), z(1e-15)),
    ] {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(u, v)| center.as_dvec3() + u * half_u.as_dvec3() + v * half_v.as_dvec3());
        let exact = polygon_irradiance(&corners, DVec3::Y);
        // Whichever order of the edges makes it shine to the origin.
        let faces = half_u.cross(half_v).dot(center) < 0.0;
        let (u, v) = if faces {
            (half_u, half_v)
        } else {
            (half_v, half_u)
        };
        let light = Light::Rectangle(rectangle(center, u, v));
        let measured = irradiance(&light, Vec3::ZERO, UnitVec3::Y, 200_000);
        let relative = measured.standard_error() / exact;
        println!(
            "rectangle {center} {half_u} {half_v}: E {exact:.6e}, standard error {relative:.1e}"
        );
        // Lambert's sum itself cancels for a rectangle far away.
        let slack = 4.0 * measured.standard_error() + 1e-6 * exact + 1e-16;
        assert!(
            (measured.mean() - exact).abs() < slack,
            "{center}: {} for {exact}",
            measured.mean()
        );
        let back = Light::Rectangle(rectangle(center, v, u));
        assert!(back.sample(Vec3::ZERO, Vec2::splat(0.3)).is_none());
    }
}

/// The stated irradiance on a facing surface, its cosine on a tilted one; exact in every sample
/// without an angle.
#[test]
fn a_distant_light_gives_its_irradiance() {
    for angle in [0.0_f32, 1e-30, 1e-6, 0.009, 0.5, 1.5, 3.0] {
        let light = distant(angle);
        let facing = -light.direction;
        let measured = irradiance(&Light::Distant(light), Vec3::ZERO, facing, 100_000);
        measured.assert_mean(1.0, &format!("{angle}, facing"));
        // Tilted so far that the whole cap stays above the horizon.
        let tilt = FRAC_PI_2 - 0.5 * f64::from(angle) - 0.05;
        let tangent = facing.as_dvec3().any_orthonormal_vector();
        let normal = facing.as_dvec3() * tilt.cos() + tangent * tilt.sin();
        let normal = UnitVec3::normalize(normal.as_vec3()).unwrap();
        let measured = irradiance(&Light::Distant(light), Vec3::ZERO, normal, 100_000);
        let cos = normal.as_dvec3().dot(facing.as_dvec3());
        measured.assert_mean(cos, &format!("{angle}, tilted by {tilt}"));
    }
    // More than the hemisphere: what is below the horizon does not count.
    for angle in [PI, 4.0, TAU] {
        let light = distant(angle as f32);
        let measured = irradiance(
            &Light::Distant(light),
            Vec3::ZERO,
            -light.direction,
            100_000,
        );
        measured.assert_mean(1.0, &format!("{angle}, facing"));
    }
}

#[test]
fn a_point_light_follows_its_falloff() {
    let at = |falloff, distance: f32| {
        let light = PointLight {
            falloff,
            ..point(Vec3::new(0.0, distance, 0.0), 0.0)
        };
        light.sample(Vec3::ZERO, Vec2::ZERO).map(|s| s.weight)
    };
    let law = Falloff::INVERSE_SQUARE;
    assert_eq!(at(law, 2.0), Some(Rgb::new(2.5, 5.0, 10.0)));
    let seed = Falloff {
        constant: 1.0,
        linear: 0.5,
        quadratic: 0.25,
        ..law
    };
    assert_eq!(
        at(seed, 2.0),
        Some(Rgb::new(10.0 / 3.0, 20.0 / 3.0, 40.0 / 3.0))
    );
    let ranged = Falloff { range: 4.0, ..law };
    assert_eq!(
        at(ranged, 2.0),
        Some(Rgb::new(2.5, 5.0, 10.0) * (15.0 / 16.0))
    );
    assert_eq!(at(ranged, 4.0), None);
    assert_eq!(at(ranged, 5.0), None);
    let constant = Falloff {
        constant: 1.0,
        linear: 0.0,
        quadratic: 0.0,
        ..law
    };
    assert_eq!(at(constant, 1e30), Some(Rgb::new(10.0, 20.0, 40.0)));
}

/// Full inside, none outside, and the square of a ramp in the cosine between, as
/// `KHR_lights_punctual` has it.
#[test]
fn a_spot_light_fades_between_its_cones() {
    let share = |light: &SpotLight, angle: f64| {
        let from = light.position.as_dvec3() + DVec3::new(angle.sin(), -angle.cos(), 0.0);
        let sample = light.sample(from.as_vec3(), Vec2::ZERO);
        sample.map_or(0.0, |s| f64::from(s.weight.r / light.intensity.r))
    };
    let light = spot(Vec3::ZERO, 0.0);
    for (angle, exact) in [
        (0.0, 1.0),
        (0.299, 1.0),
        (0.601, 0.0),
        (3.0, 0.0),
        (
            0.45,
            ((0.45_f64.cos() - 0.6_f64.cos()) / (0.3_f64.cos() - 0.6_f64.cos())).powi(2),
        ),
    ] {
        let share = share(&light, angle);
        assert!((share - exact).abs() < 1e-5, "{angle}: {share} for {exact}");
    }
    let laser = SpotLight {
        inner_angle_radians: 0.0,
        outer_angle_radians: 1e-3,
        ..light
    };
    assert_eq!(share(&laser, 0.0), 1.0);
    // cos is quadratic there: the share is (1 - (a/b)²)².
    assert!((share(&laser, 5e-4) - 0.5625).abs() < 1e-3);
    let hard = SpotLight {
        inner_angle_radians: 0.6,
        ..light
    };
    assert_eq!((share(&hard, 0.599), share(&hard, 0.601)), (1.0, 0.0));
}

/// Everything about a sample, to compare bit for bit.
fn bits(sample: Option<LightSample>) -> Option<[u32; 9]> {
    sample.map(|s| {
        let end = match s.shadow {
            ShadowEnd::Point(v) => v,
            ShadowEnd::Direction(v) => v.get(),
        };
        let w = s.weight.channels();
        [
            s.wi.x, s.wi.y, s.wi.z, w[0], w[1], w[2], end.x, end.y, end.z,
        ]
        .map(f32::to_bits)
    })
}

/// numerics.md L5: soft lights become the hard one, and a radius of 0 is it, bit for bit.
#[test]
fn the_limit_of_a_vanishing_radius_is_the_hard_light() {
    let position = Vec3::new(0.5, 3.0, -0.25);
    let makers: [&dyn Fn(f32) -> Light; 3] = [
        &|r| Light::Point(point(position, r)),
        &|r| Light::Spot(spot(position, r)),
        &|r| Light::Distant(distant(r)),
    ];
    for make in makers {
        let hard = make(0.0);
        assert!(hard.is_delta());
        assert_eq!(hard.samples(), 1);
        let first = hard.sample(Vec3::ZERO, Vec2::ZERO).unwrap();
        for u in random(1000, 1) {
            assert_eq!(bits(hard.sample(Vec3::ZERO, u)), bits(Some(first)));
        }
        for k in 0..=30 {
            let radius = 10.0_f32.powi(-k);
            let soft = make(radius);
            assert!(!soft.is_delta());
            assert_eq!(soft.samples(), 4);
            for u in random(100, 2) {
                let s = soft.sample(Vec3::ZERO, u).unwrap();
                let moved = (end(&s) - end(&first)).length();
                assert!(moved <= f64::from(radius) + 1e-6, "1e-{k}: {moved}");
                let change = (s.weight.r / first.weight.r - 1.0).abs();
                assert!(change <= radius * radius + 1e-6, "1e-{k}: {change}");
            }
        }
    }
    // Area lights fade away with their area.
    for k in 0..=30 {
        let radius = 10.0_f32.powi(-k);
        for light in [
            Light::Disk(disk(position, -UnitVec3::Y, radius)),
            Light::Sphere(sphere(position, radius)),
            Light::Rectangle(rectangle(position, Vec3::X * radius, Vec3::Z * radius)),
        ] {
            for u in random(100, 2) {
                // Below the smallest f32, nothing is left.
                let weight = light.sample(Vec3::ZERO, u).map_or(0.0, |s| s.weight.r);
                assert!(
                    (0.0..=radius * radius).contains(&weight),
                    "1e-{k}: {weight}"
                );
            }
        }
    }
    for light in [
        Light::Disk(disk(position, -UnitVec3::Y, 0.0)),
        Light::Sphere(sphere(position, 0.0)),
        Light::Rectangle(rectangle(position, Vec3::X, Vec3::X)),
    ] {
        assert!(light.is_delta());
        assert!(light.sample(Vec3::ZERO, Vec2::splat(0.3)).is_none());
        assert!(light.emitted(&Ray::new(Vec3::ZERO, position)).is_none());
    }
}

/// Lights of every kind at every size and brightness.
fn stiff_lights() -> Vec<Light> {
    let mut lights = Vec::new();
    let down = unit(0.1, -1.0, 0.2);
    for position in [
        Vec3::ZERO,
        Vec3::new(1.0, 2.0, 3.0),
        Vec3::splat(1e-30),
        Vec3::splat(-3e37),
    ] {
        for radius in [0.0, 1e-38, 1e-30, 1e-10, 1.0, 1e10, 1e30, 3e38] {
            for brightness in [1e-30, 1.0, 1e30].map(Rgb::splat) {
                let half = |v: Vec3| v * radius;
                lights.extend([
                    Light::Point(PointLight {
                        intensity: brightness,
                        ..point(position, radius)
                    }),
                    Light::Spot(SpotLight {
                        intensity: brightness,
                        ..spot(position, radius)
                    }),
                    Light::Distant(DistantLight {
                        irradiance: brightness,
                        ..distant(radius)
                    }),
                    Light::Disk(DiskLight {
                        radiance: brightness,
                        ..disk(position, down, radius)
                    }),
                    Light::Sphere(SphereLight {
                        radiance: brightness,
                        ..sphere(position, radius)
                    }),
                    Light::Rectangle(RectangleLight {
                        radiance: brightness,
                        ..rectangle(position, half(Vec3::X), half(Vec3::Z))
                    }),
                    Light::Rectangle(RectangleLight {
                        radiance: brightness,
                        ..rectangle(position, half(Vec3::ONE), half(Vec3::Z) * 1e-9)
                    }),
                ]);
            }
        }
    }
    lights
}

/// numerics.md L6 and L11.
#[test]
fn every_sample_is_finite_however_stiff_the_scene() {
    let mut points = vec![
        Vec3::ZERO,
        Vec3::new(1.0, 2.0, 3.0),
        Vec3::new(1.0, -2.0, 3.0),
    ];
    for scale in [1e-45, 1e-30, 1e-7, 1.0, 1e7, 1e30, 3e38] {
        points.extend([Vec3::X, Vec3::NEG_Y, Vec3::new(0.3, -0.8, 0.5)].map(|v| v * scale));
    }
    points.push(Vec3::new(1.0, 2.0_f32.next_down(), 3.0));
    let corners = [0.0, 0.25, 0.5, 1.0_f32.next_down()];
    let mut taken = 0;
    for light in stiff_lights() {
        for &point in &points {
            for (a, b) in corners.iter().flat_map(|&a| corners.map(|b| (a, b))) {
                let Some(s) = light.sample(point, Vec2::new(a, b)) else {
                    continue;
                };
                taken += 1;
                let what = || format!("{light:?} from {point}: {s:?}");
                assert!(s.weight.is_finite() && s.weight.r > 0.0, "{}", what());
                assert!((s.wi.length() - 1.0).abs() < 1e-5, "{}", what());
                assert!(end(&s).is_finite(), "{}", what());
            }
            let ray = Ray::new(point, Vec3::new(0.1, 1.0, -0.2));
            let emitted = light.emitted(&ray);
            assert!(
                emitted.is_none_or(|(t, _)| t.is_finite() && t > 0.0),
                "{light:?} {emitted:?}"
            );
        }
    }
    assert!(taken > 50_000, "only {taken} samples to look at");
}

#[test]
fn a_point_at_the_very_light_gets_none_from_it() {
    let position = Vec3::new(1.0, 2.0, 3.0);
    for radius in [0.0, 1.0] {
        assert!(
            point(position, radius)
                .sample(position, Vec2::ZERO)
                .is_none()
        );
        assert!(
            spot(position, radius)
                .sample(position, Vec2::ZERO)
                .is_none()
        );
    }
    assert!(
        disk(position, UnitVec3::Y, 1.0)
            .sample(position, Vec2::ZERO)
            .is_none()
    );
    assert!(
        rectangle(position, Vec3::X, Vec3::Z)
            .sample(position, Vec2::ZERO)
            .is_none()
    );
}

/// Two lights 1e12 apart in one sum keep their ratio (numerics.md L11).
#[test]
fn weights_are_in_proportion_to_intensity() {
    for light in cases().iter().map(|c| (c.light, c.seen_from)) {
        let (light, from) = light;
        let dim = |factor: f32| match light {
            Light::Point(l) => Light::Point(PointLight {
                intensity: l.intensity * factor,
                ..l
            }),
            Light::Spot(l) => Light::Spot(SpotLight {
                intensity: l.intensity * factor,
                ..l
            }),
            Light::Distant(l) => Light::Distant(DistantLight {
                irradiance: l.irradiance * factor,
                ..l
            }),
            Light::Disk(l) => Light::Disk(DiskLight {
                radiance: l.radiance * factor,
                ..l
            }),
            Light::Rectangle(l) => Light::Rectangle(RectangleLight {
                radiance: l.radiance * factor,
                ..l
            }),
            Light::Sphere(l) => Light::Sphere(SphereLight {
                radiance: l.radiance * factor,
                ..l
            }),
        };
        let u = Vec2::new(0.3, 0.6);
        let weight = |light: Light| light.sample(from, u).unwrap().weight.r;
        for factor in [1e-20, 1e-12, 1e12, 1e20] {
            let ratio = weight(dim(factor)) / weight(light) / factor;
            assert!((ratio - 1.0).abs() < 1e-6, "{light:?}: {ratio}");
        }
    }
}

/// A scene scaled by a power of two gets the same light, bit for bit (numerics.md G4), radiant
/// intensity being kept by the falloff of the scaled light.
#[test]
fn placed_lights_light_the_scaled_scene_alike() {
    for case in cases() {
        for k in (-40..=40).step_by(5) {
            let scale = 2.0_f32.powi(k);
            let placed = case.light.placed(scale, Vec3::ZERO);
            assert_eq!(placed.is_delta(), case.light.is_delta());
            for u in random(50, 4) {
                let here = case.light.sample(case.seen_from, u);
                let there = placed.sample(case.seen_from * scale, u).map(|mut s| {
                    if let ShadowEnd::Point(p) = &mut s.shadow {
                        *p /= scale;
                    }
                    s
                });
                assert_eq!(bits(here), bits(there), "{:?} by 2^{k}", case.light);
            }
        }
    }
    let seed = Falloff {
        constant: 1.0,
        linear: 0.5,
        quadratic: 0.25,
        range: 30.0,
    };
    let light = Light::Point(PointLight {
        falloff: seed,
        ..point(Vec3::new(1.0, 5.0, 2.0), 0.5)
    });
    let (scale, offset) = (0.001, Vec3::new(3.0, -4.0, 5.0));
    let placed = light.placed(scale, offset);
    let (here, there) = (
        Vec3::new(2.0, 0.0, 1.0),
        Vec3::new(2.0, 0.0, 1.0) * scale + offset,
    );
    let u = Vec2::new(0.2, 0.9);
    let weights = [light.sample(here, u), placed.sample(there, u)].map(|s| s.unwrap().weight.r);
    assert!((weights[0] / weights[1] - 1.0).abs() < 1e-3, "{weights:?}");
}

/// A camera ray towards a sample meets the light where the sample is; not from behind, and not
/// where the light is invisible.
#[test]
fn rays_towards_samples_see_the_light() {
    for case in cases() {
        let hides = |light: Light| match light {
            Light::Disk(l) => Light::Disk(DiskLight {
                is_visible: false,
                ..l
            }),
            Light::Rectangle(l) => Light::Rectangle(RectangleLight {
                is_visible: false,
                ..l
            }),
            Light::Sphere(l) => Light::Sphere(SphereLight {
                is_visible: false,
                ..l
            }),
            other => other,
        };
        let has_surface = matches!(
            case.light,
            Light::Disk(_) | Light::Rectangle(_) | Light::Sphere(_)
        );
        // Pulled in from the rim, where rounding decides.
        for u in random(500, 5).map(|u| 0.5 + 0.98 * (u - 0.5)) {
            let Some(sample) = case.light.sample(case.seen_from, u) else {
                continue;
            };
            let direction = (end(&sample) - case.seen_from.as_dvec3()).as_vec3();
            let ray = Ray::new(case.seen_from, direction);
            let seen = case.light.emitted(&ray);
            if !has_surface {
                assert!(seen.is_none());
                continue;
            }
            let (t, radiance) =
                seen.unwrap_or_else(|| panic!("{:?} unseen by {ray:?}", case.light));
            assert!((t - 1.0).abs() < 1e-2, "{:?}: t = {t}", case.light);
            assert_eq!(radiance, Rgb::WHITE);
            assert!(hides(case.light).emitted(&ray).is_none());
            assert!(case.light.emitted(&Ray { t_max: 0.98, ..ray }).is_none());
            let away = Ray::new(case.seen_from, -direction);
            if !matches!(case.light, Light::Sphere(_)) {
                assert!(case.light.emitted(&away).is_none());
                let from_behind = Ray::new(ray.at(2.0), -direction);
                assert!(
                    case.light.emitted(&from_behind).is_none(),
                    "{:?}",
                    case.light
                );
            }
        }
    }
}

/// What solid angle is for: stratified points on a smooth integrand beat random ones by far.
#[test]
fn unblocked_area_lights_are_smooth() {
    for light in [
        Light::Disk(disk(Vec3::new(0.7, 1.0, 0.2), unit(0.2, -1.0, 0.1), 1.0)),
        Light::Rectangle(rectangle(Vec3::new(0.7, 1.0, 0.2), Vec3::X, Vec3::Z)),
        Light::Sphere(sphere(Vec3::new(0.7, 2.0, 0.2), 1.0)),
    ] {
        let error = |pattern| {
            let values: Moments = (0..300)
                .map(|seed| {
                    let sum: f64 = numbers(pattern, 256, seed)
                        .filter_map(|u| light.sample(Vec3::ZERO, u))
                        .map(|s| f64::from(s.weight.r * s.wi.y))
                        .sum();
                    sum / 256.0
                })
                .collect();
            values.variance().sqrt() / values.mean()
        };
        let [random, sobol] = [Pattern::Random, Pattern::Sobol].map(error);
        println!(
            "{}: relative error of 256 samples, random {random:.1e}, sobol {sobol:.1e}",
            kind(&light)
        );
        assert!(sobol < 0.1 * random, "{}", kind(&light));
    }
}
