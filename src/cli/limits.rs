//! From the options and the scene to the limits of a render.

use std::time::Instant;

use halfshade::render::Limits;
use halfshade::scene::Settings;

use super::Failure;
use super::options::RenderOptions;

/// Most camera samples per pixel, on average, where only a time or an error is asked for.
const OPEN_SAMPLES: u32 = 1 << 20;
/// Samples of a jittered pattern that goes on until a limit is met: two sets of 4 × 2 cells, and again.
const JITTERED_ROUND: u32 = 16;
/// The limits that the options set to a render whose picture is to be written until `deadline`. In
/// `settings` the samples become the size of the pattern's round.
pub fn limits(
    options: &RenderOptions,
    settings: &mut Settings,
    deadline: Option<Instant>,
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
    limits.deadline = deadline;
    limits.error = asked.error;
    limits.is_adaptive = asked.is_adaptive();
    settings.sampling.samples = settings.sampling.samples.min(JITTERED_ROUND);
    Ok(limits)
}
