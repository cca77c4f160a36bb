//! The points of many samples at once.

use super::key::Key;
use super::sampler::{DimensionSet, Sampler};
use super::sobol::{self, Pair};
use super::{Pattern, Target};
use crate::math::{FEW, ROW, RowJob, Vec2, places, widely};

/// The samplers of up to [`ROW`] samples of one picture.
#[derive(Clone, Debug)]
pub struct SamplerRow {
    /// The first of them: what they have in common is read here.
    first: Option<Sampler>,
    keys: [Key; ROW],
    sets: [u32; ROW],
    indices: [u32; ROW],
    count: usize,
}

impl SamplerRow {
    /// No samplers.
    pub const EMPTY: Self = Self {
        first: None,
        keys: [Key::ZERO; ROW],
        sets: [0; ROW],
        indices: [0; ROW],
        count: 0,
    };

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Takes all of them out.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Adds a sampler of the same picture; there must be room.
    #[inline]
    pub fn push(&mut self, sampler: &Sampler) {
        self.first.get_or_insert(*sampler);
        self.keys[self.count] = sampler.key;
        self.sets[self.count] = sampler.set;
        self.indices[self.count] = sampler.index;
        self.count += 1;
    }

    /// Sampler `i`; `None` past the last.
    #[inline]
    pub fn get(&self, i: usize) -> Option<Sampler> {
        let of = |first: Sampler| Sampler {
            key: self.keys[i],
            set: self.sets[i],
            index: self.indices[i],
            ..first
        };
        self.first.filter(|_| i < self.count).map(of)
    }

    /// [`Sampler::camera`] of each into the first of `points`.
    pub fn camera(&self, points: &mut [Vec2; ROW]) {
        let is_plain = |s: &Sampler| s.pattern == Pattern::Sobol && s.target == Target::Rectangle;
        if self.count < FEW || !self.first.as_ref().is_some_and(is_plain) {
            for (i, point) in points[..self.count].iter_mut().enumerate() {
                *point = self.get(i).map_or(Vec2::ZERO, |sampler| sampler.camera());
            }
            return;
        }
        self.sobol(DimensionSet::CAMERA, Pair::First, [0, 1], points);
    }

    /// [`Sampler::light`] of each of those with a bit in `of` into their places in `points`.
    pub fn light(&self, [vertex, light, j, count]: [u32; 4], of: u64, points: &mut [Vec2; ROW]) {
        let is_sobol = |s: &Sampler| s.pattern == Pattern::Sobol;
        if (of.count_ones() as usize) < FEW || !self.first.as_ref().is_some_and(is_sobol) {
            for i in places(of) {
                let light = |sampler: Sampler| sampler.light(vertex, light, j, count);
                points[i] = self.get(i).map_or(Vec2::ZERO, light);
            }
            return;
        }
        let (set, pair) = Sampler::sobol_light(vertex, light, count);
        self.sobol(set, pair, [j, count], points);
    }

    /// Points of `set`: `j` of the `count` that each sample has.
    fn sobol(&self, set: DimensionSet, pair: Pair, [j, count]: [u32; 2], points: &mut [Vec2; ROW]) {
        let job = Points {
            set,
            pair,
            keys: &self.keys,
            indices: &self.indices,
            j,
            count,
        };
        *points = widely(job);
    }
}

struct Points<'a> {
    set: DimensionSet,
    pair: Pair,
    keys: &'a [Key; ROW],
    indices: &'a [u32; ROW],
    j: u32,
    count: u32,
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
            let number = Sampler::number_of(self.indices[i], self.j, self.count);
            *point = sobol::point_of(key, number, pair);
        }
        points
    }
}
