//! L12: accumulation does not stall.

use crate::color::Rgb;
use crate::film::Pixel;
use crate::math::{UVec2, Vec3};
use crate::sampling::{Pattern, SamplingConfig};
use crate::scene::{Scene, Settings};
use crate::stress::scenes::{look_at, picture};
use crate::stress::{Check, Effort, Sweep};

/// Takes 2^24 and more samples of a constant.
pub fn run(effort: Effort) -> Vec<Check> {
    let mut pixel = Pixel::default();
    let mut points = Vec::new();
    for i in 0u32..(1 << effort.pick(25, 30)) + 3 {
        pixel.add_sample((i % 2) as usize, Rgb::splat(0.1));
        if i.is_power_of_two() {
            points.push((f64::from(i), relative(&pixel)));
        }
    }
    points.push((pixel.count() as f64, relative(&pixel)));
    let sweep = Sweep::of("samples", "relative error of the mean", points);
    vec![
        Check::worst(
            "a constant, 2^24 samples and more: relative error of the mean",
            1e-7,
            sweep,
        ),
        Check::at_most(
            format!(
                "a render of one pixel, 2^{} samples: relative error",
                effort.pick(18, 24)
            ),
            rendered(1 << effort.pick(18, 24)),
            1e-7,
        ),
    ]
}

fn relative(pixel: &Pixel) -> f64 {
    (pixel.value()[0] / f64::from(0.1f32) - 1.0).abs()
}

/// The error of a picture of a uniform sky, one pixel large.
fn rendered(samples: u32) -> f64 {
    let mut scene = Scene::default();
    scene.background.radiance = Rgb::splat(0.1);
    let settings = Settings {
        size: UVec2::ONE,
        sampling: SamplingConfig {
            samples,
            pattern: Pattern::Random,
            ..SamplingConfig::default()
        },
        ..Settings::default()
    };
    let film = picture(&scene, &look_at(Vec3::Z, Vec3::ZERO), &settings);
    relative(&film.pixels[0])
}
