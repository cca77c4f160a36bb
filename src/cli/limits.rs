//! From the options and the scene to the limits of a render.

use std::time::{Duration, Instant};

use halfshade::film::Rect;
use halfshade::render::Limits;
use halfshade::scene::Settings;

use super::Failure;
use super::options::RenderOptions;

/// Most camera samples per pixel, on average, where only a time or an error is asked for.
const OPEN_SAMPLES: u32 = 1 << 20;
/// Samples of a jittered pattern that goes on until a limit is met: two sets of 4 × 2 cells, and again.
const JITTERED_ROUND: u32 = 16;
/// What writing a picture takes at most on a slow machine, seconds for a value of a pixel.
const SECONDS_PER_VALUE: f64 = 40e-9;
/// And for making a file.
const SECONDS_PER_FILE: f64 = 0.005;

/// The limits that the options set to a render that `began` with the program. In `settings` the
/// samples become the size of the pattern's round.
pub fn limits(
    options: &RenderOptions,
    settings: &mut Settings,
    crop: Rect,
    began: Instant,
) -> Result<Limits, Failure> {
    let asked = &options.limits;
    let mut limits = Limits::of(settings);
    if !asked.are_open() && !asked.adaptive {
        return Ok(limits);
    }
    let pattern = settings.sampling.pattern;
    if pattern.sets() < 2 {
        return Err(Failure::usage(
            "render",
            format_args!(
                "--time, --error and --adaptive need a pattern with random numbers: the error of \
                 {} samples is not to be seen in them, and they cannot go on",
                pattern.name()
            ),
        ));
    }
    if asked.are_open() {
        limits.samples = options.sampling.samples.unwrap_or(OPEN_SAMPLES);
    }
    limits.deadline = asked.time.map(|seconds| {
        let writing = writing_seconds(options, crop);
        began + Duration::from_secs_f64((seconds - writing).max(0.0))
    });
    limits.error = asked.error;
    limits.is_adaptive = asked.is_adaptive();
    settings.sampling.samples = settings.sampling.samples.min(JITTERED_ROUND);
    Ok(limits)
}

/// What is set apart for writing the files, so that they are there in time.
fn writing_seconds(options: &RenderOptions, crop: Rect) -> f64 {
    let files = options.output.output.len().max(1) as f64;
    let layers = 1.0 + options.output.layers.len() as f64;
    let values = 3.0 * layers * crop.area() as f64;
    files * (SECONDS_PER_FILE + SECONDS_PER_VALUE * values)
}
