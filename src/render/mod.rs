//! The picture: every pixel's samples, on all cores, in an order that does not matter.
//!
//! The film is cut into tiles, and the work into passes over all of them: a render that is stopped early has seen the
//! whole picture. A pixel's samples are added in the order of their indices whatever the threads do,
//! and what a pass aims at is decided between passes from sums in a fixed order, so the same job gives
//! the same bits, unless the clock ends it.

mod allot;
mod course;
mod decay;
mod difficulty;
mod forecast;
mod replay;
pub mod stability;
mod stop;
mod tile;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use crate::camera::Camera;
use crate::film::{ErrorSums, Film, Pixel, Rect, StoppedBy};
use crate::integrate::{Account, Aov, Integrator, LightGroups, LightPart, integrator};
use crate::prepare::PreparedScene;
use crate::scene::Settings;

pub use forecast::{Forecast, Significant};
pub use replay::{Replay, ReplayedRay, replay};

use allot::Outcome;
use course::{Course, Step, aim_all, dealt, round};
use decay::Decay;
use forecast::{Bounds, Pace};
use stop::Stop;
use tile::{Halves, Tile, assemble, error_of, pixels, rows, tiles};

/// Samples of each half of each pixel before an error is believed and samples are allotted.
const FIRST_SAMPLES: u32 = 1;
/// By what a pass multiplies the number of samples, where somebody waits for a limit.
const GROWTH: f64 = 2.0;
/// A course is kept until there are so many times the samples that it began with: what is known of the pixels is not much
/// more before.
const FRESH: f64 = 1.5;
/// The least by which a pass multiplies it, where the course has steps as small: near a limit passes would become ever
/// smaller.
const LEAST_GROWTH: f64 = 1.02;
/// The share of the work after which a forecast is made, by the samples of a pixel, on average, that there are at least. Of the
/// first ones nobody can tell where the error is: what they lead to is foreseen to take half of what it takes. (Passes
/// double the samples, or a little less.)
const FORECAST_SHARES: [(f64, f64); 3] = [(7.0, 0.05), (3.0, 0.25), (0.0, 0.5)];
/// The samples of a pixel, on average, from which on a pass tells how fast the error falls. In the first ones a half has no
/// variance of its own, and the pass brings less than foreseen whatever the pattern.
const LEARNING_SAMPLES: f64 = 3.0;

/// What it takes, for a pixel, to find out where samples go, bytes.
const ALLOTMENT_BYTES: usize = 64;

/// About what the instances that are seen in a pixel take, bytes: most pixels see one or two.
const OBJECT_BYTES: usize = 256;

/// What is to be rendered.
#[derive(Debug)]
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a PreparedScene<'a>,
    /// Where it is seen from, in prepared coordinates ([`PreparedScene::camera`]).
    pub camera: Camera,
    /// How it is rendered; its size is that of the whole film.
    pub settings: &'a Settings,
    /// The part of the film that is rendered.
    pub crop: Rect,
    /// Layers beside the picture.
    pub layers: Vec<Aov>,
}

impl Job<'_> {
    /// The most memory that [`render`] takes for the film, bytes: the layers of tiles and film are there together while
    /// they are put together.
    pub fn memory_bytes(&self) -> u64 {
        let pixel = size_of::<Pixel>() + 2 * size_of::<Halves>() + ALLOTMENT_BYTES;
        let layer = size_of::<[[f64; 2]; 3]>() + size_of::<[f32; 3]>();
        let objects = match self.layers.contains(&Aov::Objects) {
            true => OBJECT_BYTES,
            false => 0,
        };
        self.crop.area() * (pixel + self.layers.len() * layer + objects) as u64
    }

    /// What takes down what the samples tell, where a layer asks for it.
    fn account(&self) -> Option<Account> {
        let is_by_group = |aov: &Aov| matches!(aov, Aov::Light(LightPart::Group(_)));
        let groups = match self.layers.iter().any(is_by_group) {
            true => LightGroups::of(self.scene.scene),
            false => LightGroups::default(),
        };
        (!self.layers.is_empty()).then(|| Account::new(groups))
    }
}

/// When a render ends, and where its samples go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Camera samples per pixel on average, at most; at least 1.
    pub samples: u32,
    /// When to stop with what there is. Each pixel's first sample is taken even after it, so that
    /// the picture has no holes.
    pub deadline: Option<Instant>,
    /// Stop when √relMSE, as estimated, is no larger. Has no effect for patterns of one set
    /// ([`crate::sampling::Pattern::sets`]).
    pub error: Option<f64>,
    /// Samples go where the error is; else each pixel gets the same. Has no effect for patterns of one set.
    pub is_adaptive: bool,
}

impl Limits {
    /// Just the samples that `settings` ask for, the same for each pixel.
    pub fn of(settings: &Settings) -> Self {
        Self {
            samples: settings.sampling.samples_per_pixel(),
            deadline: None,
            error: None,
            is_adaptive: false,
        }
    }

    /// Whether something else than a number of samples may end the render.
    pub fn is_open(&self) -> bool {
        self.deadline.is_some() || self.error.is_some()
    }
}

/// How far a render has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Camera samples that are done.
    pub done: u64,
    /// Camera samples in all, as far as is known by now.
    pub total: u64,
}

/// What a render tells while it runs.
#[derive(Clone, Copy, Debug)]
pub enum Event {
    /// A tile is done; from any thread.
    Progress(Progress),
    /// Once, where there is a deadline or an error to reach, after about 5 % of the work.
    Forecast(Forecast),
}

/// Renders `job` on the current thread pool, with the samples that its settings ask for, the same for each pixel.
///
/// `observe` hears of every finished tile, from any thread. Once `cancel` is set the render ends
/// once each thread is done with the few dozen samples that it has begun, and the film holds what there is.
pub fn render(job: &Job, cancel: &AtomicBool, observe: &(dyn Fn(Event) + Sync)) -> Film {
    render_within(job, &Limits::of(job.settings), cancel, observe)
}

/// As [`render`], with other limits; the number of samples in the job's settings is only the size of a jittered
/// pattern's round.
///
/// Without a deadline the same job and limits give the same bits.
pub fn render_within(
    job: &Job,
    limits: &Limits,
    cancel: &AtomicBool,
    observe: &(dyn Fn(Event) + Sync),
) -> Film {
    let mut run = Run {
        job,
        limits,
        integrator: integrator(job.scene, job.settings),
        account: job.account(),
        cancel,
        observe,
        pace: Pace::start(),
        decay: Decay::of(job.settings.sampling.pattern, job.settings.integrator),
        pixels: pixels(job),
        tiles: tiles(job),
        done: AtomicU64::new(0),
        total: AtomicU64::new(job.crop.area() * u64::from(limits.samples)),
        has_forecast: false,
    };
    let stopped_by = run.finish();
    assemble(job, run.pixels, &run.tiles, stopped_by)
}

/// A render at work.
struct Run<'a> {
    job: &'a Job<'a>,
    limits: &'a Limits,
    integrator: Box<dyn Integrator + 'a>,
    account: Option<Account>,
    cancel: &'a AtomicBool,
    observe: &'a (dyn Fn(Event) + Sync),
    pace: Pace,
    decay: Decay,
    /// Row by row.
    pixels: Vec<Pixel>,
    tiles: Vec<Tile>,
    done: AtomicU64,
    /// Samples in all, as far as is known.
    total: AtomicU64,
    has_forecast: bool,
}

/// A course that passes follow, the samples that it began with, and where it stands.
struct Kept {
    course: Course,
    since: u64,
    now: Outcome,
}

impl Kept {
    fn new(course: Course) -> Self {
        let now = course.now();
        Self {
            course,
            since: now.samples,
            now,
        }
    }

    /// Whether another course would hardly be better.
    fn is_fresh(&self) -> bool {
        (self.now.samples as f64) < FRESH * self.since as f64
    }
}

impl Run<'_> {
    fn finish(&mut self) -> StoppedBy {
        if let Some(end) = self.first_passes() {
            return end;
        }
        let is_adaptive = self.limits.is_adaptive && self.job.settings.sampling.pattern.sets() == 2;
        if !self.limits.is_open() && !is_adaptive {
            return self.remaining_passes();
        }
        // What a pass was to make of the squared error, and what that was before.
        let mut foreseen: Option<(f64, ErrorSums)> = None;
        let mut kept: Option<Kept> = None;
        loop {
            let sums = error_of(&self.tiles);
            let error = sums.map(|sums| sums.root());
            if let (Some((fall, before)), Some(after)) = (&foreseen, &sums) {
                self.decay.learn(*fall, before, after);
            }
            if let (Some(error), Some(enough)) = (error, self.limits.error)
                && error <= enough
            {
                return StoppedBy::Error;
            }
            let is_new = !kept.as_ref().is_some_and(Kept::is_fresh);
            let Kept { course, since, now } =
                kept.take().filter(|_| !is_new).unwrap_or_else(|| {
                    let exponent = self.decay.exponent();
                    let (pixels, tiles) = (&self.pixels, &self.tiles);
                    Kept::new(Course::of(self.job, pixels, tiles, is_adaptive, exponent))
                });
            let Some(step) = self.next_step(&course, now, error) else {
                return StoppedBy::Samples;
            };
            // A course that was kept foresaw by an exponent that may be out of date.
            let is_telling = is_new && self.per_pixel(now.samples) >= LEARNING_SAMPLES;
            foreseen = sums
                .filter(|_| is_telling)
                .map(|sums| (step.outcome.error / now.error, sums));
            course.aim(&mut self.tiles, &step);
            if let Some(end) = self.pass(self.limits.deadline) {
                return end;
            }
            let now = step.outcome;
            kept = Some(Kept { course, since, now });
        }
    }

    /// The first samples of every pixel: they are needed to say anything.
    fn first_passes(&mut self) -> Option<StoppedBy> {
        let pattern = self.job.settings.sampling.pattern;
        let most = dealt(pattern, u64::from(self.limits.samples));
        let round = round(self.job);
        let first = round * FIRST_SAMPLES.div_ceil(round);
        let mut samples = 1;
        let mut end = None;
        if self.limits.deadline.is_some() {
            aim_all(&mut self.tiles, [1, 0]);
            // However late it is: there is to be no hole in the picture.
            end = self.pass(None);
            self.pace.warmed_up(self.rays());
        }
        while end.is_none() && samples <= first.min(most[0]) {
            let aim = if round > 1 { first } else { samples };
            aim_all(&mut self.tiles, most.map(|most| most.min(aim)));
            end = self.pass(self.limits.deadline);
            samples = 2 * aim;
        }
        end
    }

    /// All that is left of a fixed number of samples.
    fn remaining_passes(&mut self) -> StoppedBy {
        let most = dealt(
            self.job.settings.sampling.pattern,
            u64::from(self.limits.samples),
        );
        let mut samples = FIRST_SAMPLES;
        loop {
            samples = samples.saturating_mul(4).min(most[0]);
            aim_all(&mut self.tiles, most.map(|most| most.min(samples)));
            if let Some(end) = self.pass(None) {
                return end;
            }
            if samples == most[0] {
                return StoppedBy::Samples;
            }
        }
    }

    /// Brings all tiles to their goals; says why where that is to be the last of it.
    fn pass(&mut self, deadline: Option<Instant>) -> Option<StoppedBy> {
        let stop = Stop::new(self.cancel, deadline);
        let (job, integrator, observe) = (self.job, self.integrator.as_ref(), self.observe);
        let account = self.account.as_ref();
        let (done, total) = (&self.done, self.total.load(Ordering::Relaxed));
        let rows = rows(job.crop, &mut self.pixels);
        debug_assert_eq!(rows.len(), self.tiles.len(), "each tile has its rows");
        let tiles = self.tiles.par_iter_mut().zip(rows);
        tiles.for_each(|(tile, pixels)| {
            let taken = tile.render(pixels, job, integrator, account, &stop);
            let done = done.fetch_add(taken, Ordering::Relaxed) + taken;
            let total = total.max(done);
            observe(Event::Progress(Progress { done, total }));
        });
        if stop.is_cancelled() && !self.is_at_goal() {
            Some(StoppedBy::Interrupt)
        } else if stop.is_late() {
            Some(StoppedBy::Time)
        } else {
            None
        }
    }

    fn is_at_goal(&self) -> bool {
        self.tiles.iter().all(|tile| tile.taken == tile.goal)
    }

    fn per_pixel(&self, samples: u64) -> f64 {
        samples as f64 / self.job.crop.area().max(1) as f64
    }

    fn rays(&self) -> f64 {
        self.tiles.iter().map(|tile| tile.rays.total() as f64).sum()
    }

    /// What the next pass is for; `None` where all samples are there.
    fn next_step(&mut self, course: &Course, now: Outcome, error: Option<f64>) -> Option<Step> {
        let most_samples = self.job.crop.area() * u64::from(self.limits.samples);
        let bounds = Bounds {
            limits: self.limits,
            pace: &self.pace,
            most_samples,
            now,
            error_now: error.unwrap_or(f64::INFINITY),
        };
        let forecast = bounds.forecast(course);
        self.total.store(forecast.samples, Ordering::Relaxed);
        // By the clock, but where the number of samples tells: what depends on no clock can be repeated.
        let share = match self.limits.deadline {
            Some(_) => self.pace.seconds() / forecast.seconds,
            None => now.samples as f64 / forecast.samples as f64,
        };
        let per_pixel = self.per_pixel(now.samples);
        let is_known =
            (FORECAST_SHARES.iter()).any(|&(least, of)| per_pixel >= least && share >= of);
        if self.limits.is_open() && error.is_some() && !self.has_forecast && is_known {
            self.has_forecast = true;
            (self.observe)(Event::Forecast(forecast));
        }
        let grown = |growth: f64| most_samples.min((growth * now.samples as f64) as u64);
        let wanted = course.furthest(|o| {
            // A little further than asked for: most passes that aim at it get there.
            o.samples <= grown(GROWTH) && bounds.is_in_time(o) && bounds.is_short_of(o, 0.99)
        });
        if wanted.outcome.samples > grown(LEAST_GROWTH) {
            return Some(wanted);
        }
        let [least, next] = course.around(|o| o.samples <= grown(LEAST_GROWTH));
        [least, next]
            .into_iter()
            .find(|step| (now.samples + 1..=most_samples).contains(&step.outcome.samples))
    }
}
