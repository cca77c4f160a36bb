//! L13: every sampler is unbiased at every count.

use rayon::prelude::*;

use crate::math::Vec3;
use crate::sampling::{Pattern, Target};
use crate::stress::check::deviation;
use crate::stress::closed_form::disk_irradiance;
use crate::stress::floor::{disk, irradiances, plane, settings};
use crate::stress::scenes::add_light;
use crate::stress::{Check, Curve, Effort, Sweep};

/// Counts that are squares, powers of two, and neither.
const COUNTS: [u32; 12] = [1, 2, 3, 5, 7, 10, 13, 16, 31, 64, 81, 100];

/// Means over seeds of the irradiance under a disk light, by pattern, with all samples at the pixel or at the light.
pub fn run(effort: Effort) -> Vec<Check> {
    let seeds = effort.pick(400, 10_000);
    let checks = Pattern::ALL
        .par_iter()
        .map(|&pattern| check(pattern, seeds));
    checks.collect()
}

fn check(pattern: Pattern, seeds: u64) -> Check {
    let curve = |name, is_at_light| {
        let points =
            COUNTS.map(|count| (f64::from(count), off(pattern, count, is_at_light, seeds)));
        Curve::new(name, points.into())
    };
    let curves = vec![curve("camera samples", false), curve("light samples", true)];
    let sweep = Sweep::several("samples", "error, standard errors", curves);
    let what = format!(
        "{}, 1..100 samples, {seeds} seeds: error in standard errors",
        pattern.name()
    );
    let check = Check::worst(what, 4.0, sweep);
    match pattern {
        Pattern::Grid => {
            check.refused("a grid takes no chances: its error is not of the kind that averages out")
        }
        _ => check,
    }
}

fn off(pattern: Pattern, count: u32, is_at_light: bool, seeds: u64) -> f64 {
    let (radius, height, offset) = (1.0, 1.5, 1.2);
    let mut scene = plane();
    let (camera, light) = if is_at_light { (1, count) } else { (count, 1) };
    add_light(
        &mut scene,
        disk(radius as f32, height as f32, offset as f32, light),
    );
    let exact = 3.0 * disk_irradiance(radius, f64::from(height as f32), f64::from(offset as f32));
    let mut settings = settings(camera, pattern);
    settings.sampling.target = Target::Rectangle;
    deviation(&irradiances(&scene, Vec3::ZERO, &settings, seeds), exact)
}
