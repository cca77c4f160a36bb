//! The points of many samples at once.

use super::key::Key;
use super::sampler::{DimensionSet, Sampler};
use super::sobol::{self, Pair};
use super::{Pattern, Target};
use crate::math::{FEW, ROW, RowJob, Vec2, widely};

impl Sampler {
    /// [`Sampler::camera`] of each of `samplers`, [`ROW`] at most, into the first of `points`.
    pub fn camera_row<'a>(
        samplers: impl ExactSizeIterator<Item = &'a Sampler> + Clone,
        points: &mut [Vec2; ROW],
    ) {
        let is_plain = |s: &Sampler| s.pattern == Pattern::Sobol && s.target == Target::Rectangle;
        if samplers.len() < FEW || !samplers.clone().all(is_plain) {
            for (point, sampler) in points.iter_mut().zip(samplers) {
                *point = sampler.camera();
            }
            return;
        }
        let of = |s: &Sampler| (s.key, u64::from(s.index));
        sobol_row(DimensionSet::CAMERA, Pair::First, samplers.map(of), points);
    }

    /// [`Sampler::light`] of each of `samplers`, [`ROW`] at most, into the first of `points`.
    pub fn light_row<'a>(
        samplers: impl ExactSizeIterator<Item = &'a Sampler> + Clone,
        [vertex, light, j, count]: [u32; 4],
        points: &mut [Vec2; ROW],
    ) {
        if samplers.len() < FEW || !samplers.clone().all(|s| s.pattern == Pattern::Sobol) {
            for (point, sampler) in points.iter_mut().zip(samplers) {
                *point = sampler.light(vertex, light, j, count);
            }
            return;
        }
        let (set, pair) = Sampler::sobol_light(vertex, light, count);
        let of = |s: &Sampler| (s.key, s.number(j, count));
        sobol_row(set, pair, samplers.map(of), points);
    }
}

/// Points of `set` by key and number of the samplers.
fn sobol_row(
    set: DimensionSet,
    pair: Pair,
    samplers: impl Iterator<Item = (Key, u64)>,
    points: &mut [Vec2; ROW],
) {
    let mut keys = [Key::default(); ROW];
    let mut numbers = [0; ROW];
    for (i, (key, number)) in samplers.take(ROW).enumerate() {
        keys[i] = key;
        numbers[i] = number;
    }
    *points = widely(Points {
        set,
        pair,
        keys: &keys,
        numbers: &numbers,
    });
}

struct Points<'a> {
    set: DimensionSet,
    pair: Pair,
    keys: &'a [Key; ROW],
    numbers: &'a [u64; ROW],
}

impl RowJob for Points<'_> {
    type Output = [Vec2; ROW];

    #[inline(always)]
    fn call(self) -> [Vec2; ROW] {
        match self.pair {
            Pair::First => self.all(Pair::First),
            Pair::Second => self.all(Pair::Second),
        }
    }
}

impl Points<'_> {
    #[inline(always)]
    fn all(&self, pair: Pair) -> [Vec2; ROW] {
        let mut points = [Vec2::ZERO; ROW];
        for (i, point) in points.iter_mut().enumerate() {
            let key = self.keys[i].with(self.set.0);
            *point = sobol::point_of(key, self.numbers[i], pair);
        }
        points
    }
}
