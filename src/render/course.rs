//! How a render goes on: the same for every pixel, or more where the error is.

use super::Job;
use super::allot::{Allotment, Outcome};
use super::tile::{Halves, Tile};
use crate::film::{Pixel, RayCounts};
use crate::sampling::Pattern;

/// A way to spend more samples, from what there is now.
pub(super) enum Course {
    /// Every pixel gets the same.
    Uniform(Uniform),
    /// The errors of the pixels decide.
    Adaptive(Allotment),
}

/// A place on a course, which [`Course::aim`] makes the goal of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Samples of a pixel, or the scale of an allotment.
    reach: f64,
    /// What comes of it.
    pub outcome: Outcome,
}

/// The same number of samples for every pixel.
pub(super) struct Uniform {
    pattern: Pattern,
    /// The power of the number of samples with which the squared error falls.
    exponent: f64,
    pixels: u64,
    /// Samples of a pixel now, and what they come in multiples of.
    taken: u64,
    unit: u64,
    rays_per_sample: f64,
}

/// Most samples of a pixel: an index has 32 bits.
const MOST: u64 = 1 << 31;

impl Course {
    /// The course of a render that has come to these `pixels` in `tiles`, whose squared error falls with the power `exponent` of the
    /// number of samples; where it `is_adaptive`, each half of each pixel has samples.
    pub fn of(
        job: &Job,
        pixels: &[Pixel],
        tiles: &[Tile],
        is_adaptive: bool,
        exponent: f64,
    ) -> Self {
        let pattern = job.settings.sampling.pattern;
        if is_adaptive {
            let allotment = Allotment::new(job.crop, pixels, tiles, pattern, round(job), exponent);
            return Self::Adaptive(allotment);
        }
        let mut rays = RayCounts::default();
        tiles.iter().for_each(|tile| rays.add(&tile.rays));
        let pixels = job.crop.area();
        let taken: u64 = tiles
            .first()
            .map_or(0, |t| t.taken[0].map(u64::from).iter().sum());
        Self::Uniform(Uniform {
            pattern,
            exponent,
            pixels,
            taken,
            unit: u64::from(pattern.sets() * round(job)),
            rays_per_sample: rays.total() as f64 / (taken * pixels).max(1) as f64,
        })
    }

    /// Where it stands.
    pub fn now(&self) -> Outcome {
        match self {
            Self::Uniform(uniform) => uniform.outcome(uniform.taken),
            Self::Adaptive(allotment) => allotment.now(),
        }
    }

    /// The last step whose outcome is `within`, where every earlier one is, and the first that is not.
    pub fn around(&self, within: impl Fn(&Outcome) -> bool) -> [Step; 2] {
        match self {
            Self::Uniform(uniform) => uniform.around(within),
            Self::Adaptive(allotment) => allotment.scales(within).map(|reach| Step {
                reach,
                outcome: allotment.at(reach),
            }),
        }
    }

    /// The last step whose outcome is `within`, where every earlier one is.
    pub fn furthest(&self, within: impl Fn(&Outcome) -> bool) -> Step {
        let [furthest, _] = self.around(within);
        furthest
    }

    /// Makes `step` the goal of the tiles.
    pub fn aim(&self, tiles: &mut [Tile], step: &Step) {
        match self {
            Self::Uniform(uniform) => aim_all(tiles, uniform.halves(step.reach as u64)),
            Self::Adaptive(allotment) => allotment.aim(tiles, step.reach),
        }
    }
}

/// Gives every pixel of `tiles` the same goal.
pub(super) fn aim_all(tiles: &mut [Tile], goal: Halves) {
    for tile in tiles {
        tile.goal.fill(goal);
    }
}

/// `samples` dealt to the sets of `pattern`.
pub(super) fn dealt(pattern: Pattern, samples: u64) -> Halves {
    let samples = samples.min(MOST) as u32;
    match pattern.sets() {
        1 => [samples, 0],
        _ => [samples.div_ceil(2), samples / 2],
    }
}

/// Samples of a set that belong together: one, or all cells.
pub(super) fn round(job: &Job) -> u32 {
    match job.settings.sampling.pattern {
        Pattern::Grid | Pattern::Jittered => job.settings.sampling.samples_per_set(),
        Pattern::Random | Pattern::Sobol => 1,
    }
}

impl Uniform {
    fn outcome(&self, samples: u64) -> Outcome {
        let all = samples * self.pixels;
        Outcome {
            samples: all,
            rays: all as f64 * self.rays_per_sample,
            error: (samples.max(1) as f64).powf(-self.exponent),
        }
    }

    fn around(&self, within: impl Fn(&Outcome) -> bool) -> [Step; 2] {
        let rounds = |rounds: u64| self.taken.max(rounds * self.unit);
        let (mut low, mut high) = (self.taken / self.unit, MOST / self.unit);
        while low + 1 < high {
            let middle = low + (high - low) / 2;
            if within(&self.outcome(rounds(middle))) {
                low = middle;
            } else {
                high = middle;
            }
        }
        [low, high].map(rounds).map(|samples| Step {
            reach: samples as f64,
            outcome: self.outcome(samples),
        })
    }

    fn halves(&self, samples: u64) -> Halves {
        dealt(self.pattern, samples)
    }
}
