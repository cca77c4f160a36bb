//! L8: emitting mirrors that face each other.

use crate::color::Rgb;
use crate::math::Vec3;
use crate::sampling::Pattern;
use crate::scene::{Scene, Settings};
use crate::stress::check::deviation;
use crate::stress::floor::{paths, settings};
use crate::stress::scenes::{add_quad, means, phong, radiance};
use crate::stress::{Check, Curve, Effort, Sweep};
use crate::texture::TexturedRgb;

/// Rays of less weight are not followed ([`crate::integrate::Whitted`]).
const LEAST_WEIGHT: f64 = 1e-5;

/// Compares with the geometric series at depths from 1 to 1024.
pub fn run(effort: Effort) -> Vec<Check> {
    let curve = |k: f32| {
        let scene = mirrors(k);
        let k64 = f64::from(k);
        let limit = 2.0 / (1.0 - k64);
        let points = [1, 2, 4, 8, 64, 1024].map(|depth| {
            let settings = Settings {
                max_depth: Some(depth),
                ..settings(1, Pattern::Sobol)
            };
            let got = f64::from(radiance(&scene, Vec3::ZERO, Vec3::Z, &settings).r);
            // Cut off by the depth, or by the least weight that is followed; and a rounding for each term.
            let cut = k64.powi(depth as i32).max(LEAST_WEIGHT) + 1e-6;
            (f64::from(depth), (limit - got).abs() / limit / cut)
        });
        Curve::new(format!("reflectance {k}"), points.into())
    };
    let curves = [0.2, 0.5, 0.9, 0.99].map(curve).into();
    let sweep = Sweep::several("depth", "error over the bound of the truncation", curves);
    let what = "reflectance 0.2..0.99, depth 1..1024: error over the bound of the truncation";
    vec![Check::worst(what, 1.0, sweep), by_paths(effort)]
}

/// The same by `path`, which ends long series by chance.
fn by_paths(effort: Effort) -> Check {
    let settings = Settings {
        max_depth: Some(1024),
        ..paths(Pattern::Random)
    };
    let worst = [0.2, 0.5, 0.9, 0.99].map(|k: f32| {
        let limit = 2.0 / (1.0 - f64::from(k));
        let count = effort.pick(64, 1024);
        deviation(
            &means(&mirrors(k), Vec3::ZERO, Vec3::Z, &settings, count),
            limit,
        )
    });
    let worst = worst.into_iter().fold(0.0, f64::max);
    let what = "path, reflectance 0.2..0.99: error in standard errors";
    Check::at_most(what, worst, 4.0)
}

fn mirrors(k: f32) -> Scene {
    let mut mirror = phong(|p| p.reflect = Rgb::splat(k));
    mirror.emission = TexturedRgb::constant(Rgb::splat(2.0));
    let mut scene = Scene::default();
    let (x, y) = (Vec3::X * 9.0, Vec3::Y * 9.0);
    add_quad(&mut scene, -Vec3::Z, x, y, mirror.clone());
    add_quad(&mut scene, Vec3::Z, y, x, mirror);
    scene
}
