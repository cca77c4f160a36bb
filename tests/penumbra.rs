//! Soft shadows near the horizon; other extremes are numerical cases.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;

use common::build::*;
use common::floor::*;
use halfshade::math::Vec3;
use halfshade::sampling::Pattern;
use halfshade::scene::Scene;

const SAMPLES: u32 = 4096;

/// Error of a share of `share` that is allowed after `SAMPLES` samples: four standard errors of
/// independent ones; of stratified ones four times what N^-3/4 leaves.
fn share_tolerance(pattern: Pattern, share: f64) -> f64 {
    let n = f64::from(SAMPLES);
    if pattern == Pattern::Random {
        4.0 * (share * (1.0 - share) / n).sqrt()
    } else {
        4.0 * n.powf(-0.75)
    }
}

/// The disk of a soft point light faces the shading point, so near the horizon a part of it is
/// below: that part is dark on an open plane as on the top of a solid box.
#[test]
fn what_is_below_the_horizon_stays_dark() {
    for (lateral, height, radius) in [(4.0, 0.5, 2.0), (4.0, 0.1, 1.0), (3.0, 1.0, 0.5f32)] {
        let light = || point_light(Vec3::new(lateral, height, 0.0), 5.0, radius, 1);
        let mut open = plane();
        add_light(&mut open, light());
        let mut solid = Scene::default();
        let (min, max) = (Vec3::new(-20.0, -9.0, -20.0), Vec3::new(20.0, 0.0, 20.0));
        add_box(&mut solid, min, max, matte());
        add_light(&mut solid, light());

        let distance = f64::from(lateral).hypot(height.into());
        let (sin, cos) = (f64::from(height) / distance, f64::from(lateral) / distance);
        let share = share_beyond(f64::from(height) / (f64::from(radius) * cos));
        let free = 5.0 * sin / (distance * distance);
        for pattern in [Pattern::Random, Pattern::Sobol] {
            let [open, solid] = [&open, &solid].map(|scene| {
                let got = irradiance(scene, Vec3::ZERO, &settings(SAMPLES, pattern));
                f64::from(got) / free
            });
            let tolerance = share_tolerance(pattern, share) + 1e-5;
            assert!(
                (open - share).abs() <= tolerance && (solid - share).abs() <= tolerance,
                "{pattern:?}, radius {radius}: {open} and {solid} instead of {share}"
            );
            assert!((open - solid).abs() <= 1e-5, "{open} {solid}");
        }
    }
}
