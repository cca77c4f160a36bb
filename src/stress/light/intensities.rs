//! L11: intensities of any size that single precision holds.

use std::io;

use crate::color::Rgb;
use crate::math::{UVec2, Vec3};
use crate::output::exr::{Layer, Values, Window, write};
use crate::report::read_picture;
use crate::sampling::Pattern;
use crate::stress::floor::{irradiance, plane, settings};
use crate::stress::scenes::{add_light, point_light};
use crate::stress::{Check, Curve, Effort, Sweep};

/// Adds up lights, and writes what does not fit into half floats.
pub fn run(_: Effort) -> Vec<Check> {
    let alone = (-30..=30).step_by(3).map(|k| {
        let i = 10f32.powi(k);
        (f64::from(i), error(&[i]))
    });
    let pairs = (-30..=18).step_by(3).map(|k| {
        let (a, b) = (10f32.powi(k), 10f32.powi(k + 12));
        (f64::from(b), error(&[a, b]))
    });
    let curves = vec![
        Curve::new("one light", alone.collect()),
        Curve::new("two lights, 1e12 apart", pairs.collect()),
    ];
    let sweep = Sweep::several("intensity, W/sr", "relative error of the sum", curves);
    let changed = match changed_in_file() {
        Ok(changed) => Check::none("values up to 1e30 in an EXR: changed by the file", changed),
        Err(error) => Check::none("values up to 1e30 in an EXR", 1).noted(error.to_string()),
    };
    vec![
        Check::worst(
            "1e-30..1e30, and two 1e12 apart: relative error of the sum",
            1e-6,
            sweep,
        ),
        changed.noted("EXR files are always in single precision, never in half"),
    ]
}

fn error(intensities: &[f32]) -> f64 {
    let mut scene = plane();
    for &i in intensities {
        add_light(&mut scene, point_light(Vec3::Y * 2.0, i, 0.0, 1));
    }
    let got = irradiance(&scene, Vec3::ZERO, &settings(4, Pattern::Sobol));
    let sum: f64 = intensities.iter().map(|&i| f64::from(i)).sum();
    (f64::from(got) / (sum / 4.0) - 1.0).abs()
}

/// Pixels that are not the same once written and read.
fn changed_in_file() -> io::Result<u64> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("bright.exr");
    let pixels = [1e-30, 1.0, 65504.0, 65505.0, 7e4, 1e30f32].map(Rgb::splat);
    let window = Window::whole(UVec2::new(6, 1));
    let layer = Layer {
        name: "",
        values: Values::Colors(&pixels),
    };
    write(&path, window, &[layer], &[]).map_err(io::Error::other)?;
    let read = read_picture(&path).map_err(io::Error::other)?.picture;
    let changed = pixels.iter().zip(&read.pixels).filter(|(a, b)| a != b);
    Ok(changed.count() as u64 + pixels.len().abs_diff(read.pixels.len()) as u64)
}
