//! Samples against the geometry of their lights: density, direction, what camera rays see.

use std::f64::consts::{PI, TAU};

use halfshade::color::Rgb;
use halfshade::light::{DiskLight, Light, LightSample, RectangleLight, ShadowEnd};
use halfshade::math::{DVec3, Ray, Vec3};

use crate::common::chi_square::survival;
use crate::stiff::stiff_lights;
use crate::{disk, distant, end, kind, point, random, rectangle, sphere, spot, unit};

/// From a sample to its place on its light, in the unit square.
type Place = Box<dyn Fn(&LightSample) -> (f64, f64)>;

/// A light, where it is seen from, and what its samples must be spread like.
pub struct Case {
    pub light: Light,
    pub seen_from: Vec3,
    place: Place,
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

pub fn cases() -> Vec<Case> {
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
            Light::Sphere(sphere(above, 1.0)),
            Vec3::ZERO,
            above.as_dvec3(),
            {
                let sin = 1.0 / above.as_dvec3().length();
                (1.0 - sin * sin).sqrt()
            },
        ),
        cone_case(
            Light::Sphere(sphere(above, 5.0)),
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

/// A ray towards a sample meets the light where the sample is; not from behind.
#[test]
fn rays_towards_samples_see_the_light() {
    for case in cases() {
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
            let seen = case.light.met(&ray);
            if !has_surface {
                assert!(seen.is_none());
                continue;
            }
            let (t, radiance) =
                seen.unwrap_or_else(|| panic!("{:?} unseen by {ray:?}", case.light));
            assert!((t - 1.0).abs() < 1e-2, "{:?}: t = {t}", case.light);
            assert_eq!(radiance, Rgb::WHITE);
            assert!(case.light.met(&Ray { t_max: 0.98, ..ray }).is_none());
            let away = Ray::new(case.seen_from, -direction);
            if !matches!(case.light, Light::Sphere(_)) {
                assert!(case.light.met(&away).is_none());
                let from_behind = Ray::new(ray.at(2.0), -direction);
                assert!(case.light.met(&from_behind).is_none(), "{:?}", case.light);
            }
        }
    }
}

/// The density that a light says of a direction is that with which it samples it: weight times density is
/// its radiance.
#[test]
fn densities_are_those_of_samples() {
    for case in cases() {
        let radiance = |wi| match &case.light {
            Light::Distant(light) => Some(f64::from(light.radiance_from(wi).r)),
            Light::Disk(light) => Some(f64::from(light.radiance.r)),
            Light::Rectangle(light) => Some(f64::from(light.radiance.r)),
            Light::Sphere(light) => Some(f64::from(light.radiance.r)),
            Light::Point(_) | Light::Spot(_) => None,
        };
        // Pulled in from the rim, where rounding decides whether the light is seen.
        for u in random(500, 9).map(|u| 0.5 + 0.98 * (u - 0.5)) {
            let Some(sample) = case.light.sample(case.seen_from, u) else {
                continue;
            };
            let density = case.light.density(case.seen_from, sample.wi);
            match radiance(sample.wi) {
                None => assert_eq!(density, 0.0),
                Some(radiance) => {
                    let share = f64::from(sample.weight.r) * density / radiance;
                    assert!((share - 1.0).abs() < 2e-3, "{:?}: {share}", case.light);
                }
            }
        }
    }
}
