//! `render --stats`: what was done, as JSON.

use std::path::Path;
use std::time::Instant;

use halfshade::bench::processor_seconds;
use halfshade::color::Rgb;
use halfshade::film::{ErrorEstimate, Film, RayCounts, StoppedBy};
use halfshade::output::{OutputError, write_whole};
use halfshade::render::stability::Stability;
use halfshade::scene::LeftOut;
use serde::Serialize;
use sha2::{Digest, Sha256};

use super::process;

/// What scripts may rely on; more keys may come to stand beside these.
#[derive(Debug, Serialize)]
pub struct Stats<'a> {
    /// Pixels of the written picture, across and down.
    pub size: [u32; 2],
    pub samples: SampleStats,
    pub triangles: u64,
    pub threads: usize,
    pub seed: u64,
    pub seconds: Seconds,
    pub cpu_seconds: Option<f64>,
    pub rays: RayStats,
    pub peak_memory_bytes: Option<u64>,
    /// The error that the render states about itself; `null` where it cannot tell: a grid, or a
    /// single sample per pixel.
    pub error: Option<ErrorStats>,
    pub stopped_by: &'static str,
    pub rejected_samples: u64,
    /// Share of the light that `clamp` took.
    pub clamped_share: f64,
    /// What was hard about the render, and the verdict.
    pub stability: &'a Stability,
    /// What the picture did not need.
    pub left_out: &'a [LeftOut],
    /// Of the linear pixels: red, green, blue as little-endian singles, row by row.
    pub sha256: String,
}

/// Samples of a pixel.
#[derive(Debug, Serialize)]
pub struct SampleStats {
    min: u64,
    mean: f64,
    max: u64,
}

/// Wall time of each step.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    pub import: f64,
    pub prepare: f64,
    pub render: f64,
    pub output: f64,
    pub total: f64,
}

/// Rays by kind.
#[derive(Debug, Serialize)]
pub struct RayStats {
    camera: u64,
    shadow: u64,
    secondary: u64,
}

/// What a render says about its own error.
#[derive(Debug, Serialize)]
pub struct ErrorStats {
    /// Square root of relMSE: the mean over pixels and channels of (a - b)² / (b² + 0.01).
    metric: &'static str,
    estimate: f64,
    /// The 95 % interval; no upper end is `null`.
    low: f64,
    high: Option<f64>,
    /// Of relMSE, in the worst 0.1 % of the pixels.
    worst_share: f64,
}

impl From<ErrorEstimate> for ErrorStats {
    fn from(error: ErrorEstimate) -> Self {
        Self {
            metric: "sqrt-relmse",
            estimate: error.estimate,
            low: error.low,
            high: Some(error.high).filter(|high| high.is_finite()),
            worst_share: error.worst_share,
        }
    }
}

fn reason(stopped_by: StoppedBy) -> &'static str {
    match stopped_by {
        StoppedBy::Samples => "samples",
        StoppedBy::Time => "time",
        StoppedBy::Error => "error",
        StoppedBy::Interrupt => "interrupt",
    }
}

/// What is known of a render once its picture is there.
pub struct Done<'a> {
    pub film: &'a Film,
    pub pixels: &'a [Rgb],
    pub triangles: u64,
    pub seed: u64,
    pub seconds: Seconds,
    pub error: Option<ErrorEstimate>,
    pub left_out: &'a [LeftOut],
    pub stability: &'a Stability,
}

impl<'a> Stats<'a> {
    /// The stats of a render, and of the process that did it.
    pub fn of(done: &Done<'a>) -> Self {
        let (min, mean, max) = done.film.sample_counts();
        let RayCounts {
            camera,
            shadow,
            secondary,
            clamped: _,
        } = done.film.rays;
        Self {
            size: done.film.size().to_array(),
            samples: SampleStats { min, mean, max },
            triangles: done.triangles,
            threads: rayon::current_num_threads(),
            seed: done.seed,
            seconds: done.seconds,
            cpu_seconds: processor_seconds(),
            rays: RayStats {
                camera,
                shadow,
                secondary,
            },
            peak_memory_bytes: process::peak_memory_bytes(),
            error: done.error.map(ErrorStats::from),
            stopped_by: reason(done.film.stopped_by),
            rejected_samples: done.film.rejected,
            clamped_share: done.film.clamped_share(),
            stability: done.stability,
            left_out: done.left_out,
            sha256: digest(done.pixels),
        }
    }

    /// Writes them as JSON.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        write_whole(path, |file| {
            serde_json::to_writer_pretty(&mut *file, self)?;
            std::io::Write::write_all(file, b"\n")
        })
    }
}

fn digest(pixels: &[Rgb]) -> String {
    let mut hash = Sha256::new();
    for pixel in pixels {
        for channel in pixel.channels() {
            hash.update(channel.to_le_bytes());
        }
    }
    hash.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

/// A clock that is read at the end of each step.
pub struct StepClock {
    begin: Instant,
    last: Instant,
}

impl StepClock {
    /// Starts now.
    pub fn start() -> Self {
        let now = Instant::now();
        Self {
            begin: now,
            last: now,
        }
    }

    /// Seconds since it was last asked.
    pub fn step(&mut self) -> f64 {
        let now = Instant::now();
        let seconds = (now - self.last).as_secs_f64();
        self.last = now;
        seconds
    }

    /// When it was started.
    pub fn begin(&self) -> Instant {
        self.begin
    }

    /// Seconds since the start.
    pub fn total(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }
}
