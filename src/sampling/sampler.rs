//! The numbers of one camera sample.

use crate::math::{ONE_MINUS_EPSILON, UVec2, Vec2};

use super::cells::Cells;
use super::key::Key;
use super::sobol::{self, Pair};
use super::warp::square_to_disk;
use super::{Pattern, SamplingConfig, Target};

/// All numbers of one camera sample: a pure function of (seed, pixel, index, dimension).
///
/// It has no state: asking twice gives the same answer, and asking for less changes nothing else.
///
/// Dimensions come in sets: points of one set avoid each other, points of different sets have
/// nothing to do with each other. Each use of a sample has a set of its own, except that where the
/// sample lands in its pixel and on the first light form one four-dimensional Sobol set.
///
/// A pixel's samples are dealt in turn to sets that know nothing of each other
/// ([`Pattern::sets`]): even indices are the one, odd indices the other.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    pub(super) pattern: Pattern,
    pub(super) target: Target,
    /// Of all samples of the set; used by patterns that have cells.
    pub(super) cells: Cells,
    /// Of seed, pixel and set.
    pub(super) key: Key,
    /// Which of the pixel's sets.
    pub(super) set: u32,
    /// Which sample of its set.
    pub(super) index: u32,
}

/// Names a set of dimensions.
#[derive(Clone, Copy, Debug)]
pub(super) struct DimensionSet(pub u64);

impl DimensionSet {
    pub const CAMERA: Self = Self(u64::MAX);
    const LENS: Self = Self(u64::MAX - 1);

    fn light(vertex: u32, light: u32) -> Self {
        Self(u64::from(vertex) << 32 | u64::from(light))
    }

    /// What happens at the path's vertex number `vertex`, beside its light: in the place of lights
    /// that there are never so many of.
    fn event(vertex: u32, event: Event) -> Self {
        Self::light(vertex, u32::MAX - event as u32)
    }
}

/// What a path needs numbers for at each of its vertices.
#[derive(Clone, Copy, Debug)]
enum Event {
    Direction,
    Lobe,
    LightChoice,
    Crossing,
}

/// The samplers of a picture.
#[derive(Clone, Copy, Debug)]
pub struct Samplers {
    pattern: Pattern,
    target: Target,
    cells: Cells,
    seed: Key,
}

impl Samplers {
    /// With the samples of `config`.
    pub fn new(config: &SamplingConfig) -> Self {
        Self {
            pattern: config.pattern,
            target: config.target,
            cells: Cells::at_least(config.samples.div_ceil(config.pattern.sets())),
            seed: Key::new(config.seed),
        }
    }

    /// The first sample of set `set` ([`Pattern::sets`]) of `pixel`.
    pub fn of_set(&self, pixel: UVec2, set: u32) -> Sampler {
        let pixel = u64::from(pixel.y) << 32 | u64::from(pixel.x);
        Sampler {
            pattern: self.pattern,
            target: self.target,
            cells: self.cells,
            key: self.seed.with(pixel).with(u64::from(set)),
            set,
            index: 0,
        }
    }
}

impl Sampler {
    /// Sample `index` of `config.samples_per_pixel()` of `pixel`. An index past them goes on
    /// with more points of the same pattern.
    pub fn new(config: &SamplingConfig, pixel: UVec2, index: u32) -> Self {
        let sets = config.pattern.sets();
        Samplers::new(config)
            .of_set(pixel, index % sets)
            .at(index / sets)
    }

    /// Sample `number` of its set.
    pub fn at(&self, number: u32) -> Self {
        Self {
            index: number,
            ..*self
        }
    }

    /// Its index among all samples of its pixel.
    pub fn index(&self) -> u32 {
        self.index * self.pattern.sets() + self.set
    }

    /// Where in its pixel the sample lands, in `[0, 1)²`.
    pub fn camera(&self) -> Vec2 {
        let u = self.point(DimensionSet::CAMERA);
        match self.target {
            Target::Rectangle => u,
            Target::Circle => {
                let inscribed = 0.5 + 0.5 * square_to_disk(u);
                inscribed.clamp(Vec2::ZERO, Vec2::splat(ONE_MINUS_EPSILON))
            }
        }
    }

    /// Where on the lens it starts, in the unit disk.
    pub fn lens(&self) -> Vec2 {
        square_to_disk(self.point(DimensionSet::LENS))
    }

    /// Point `j` of the `count` that sample light number `light` at the path's vertex number
    /// `vertex` (1 is what the camera sees), in `[0, 1)²`. `count` is one that
    /// [`Pattern::cells`] gave.
    ///
    /// With a `count` of 1 the points of all camera samples of the pixel form the pattern. With
    /// more, each camera sample has its own pattern on the light (all of them together are one for Sobol).
    pub fn light(&self, vertex: u32, light: u32, j: u32, count: u32) -> Vec2 {
        let set = DimensionSet::light(vertex, light);
        // Of each camera sample its own.
        let key = || self.key.with(set.0).with(u64::from(self.index));
        match self.pattern {
            Pattern::Sobol => {
                let (set, pair) = Self::sobol_light(vertex, light, count);
                self.sobol(set, self.number(j, count), pair)
            }
            Pattern::Random => self.random(set, self.number(j, count)),
            Pattern::Grid if count > 1 => Cells::at_least(count).point(key(), j, false),
            Pattern::Jittered if count > 1 => Cells::at_least(count).point(key(), j, true),
            Pattern::Grid | Pattern::Jittered => self.point(set),
        }
    }

    /// Which Sobol points [`Self::light`] takes.
    pub(super) fn sobol_light(vertex: u32, light: u32, count: u32) -> (DimensionSet, Pair) {
        match (vertex, light, count) {
            (1, 0, 1) => (DimensionSet::CAMERA, Pair::Second),
            _ => (DimensionSet::light(vertex, light), Pair::First),
        }
    }

    fn number(&self, j: u32, count: u32) -> u64 {
        Self::number_of(self.index, j, count)
    }

    /// The number of point `j` of the `count` of sample `index`: up to 2^64 in one pixel, one sample after another.
    #[inline(always)]
    pub(super) fn number_of(index: u32, j: u32, count: u32) -> u64 {
        u64::from(index) * u64::from(count) + u64::from(j)
    }

    /// How a path goes on from its vertex number `vertex`: in which direction; and by which lobe of the material,
    /// and whether at all. All in `[0, 1)`; for Sobol they form one four-dimensional set.
    pub fn scattering(&self, vertex: u32) -> [Vec2; 2] {
        let set = DimensionSet::event(vertex, Event::Direction);
        match self.pattern {
            Pattern::Sobol => sobol::points(self.index, self.key.with(set.0).with(0)),
            _ => [
                self.even(set),
                self.even(DimensionSet::event(vertex, Event::Lobe)),
            ],
        }
    }

    /// Which of many lights it looks at from there, in `[0, 1)`, with more digits than a single has.
    pub fn light_choice(&self, vertex: u32) -> f64 {
        let u = self.even(DimensionSet::event(vertex, Event::LightChoice));
        f64::from(u.x) + f64::from(u.y) * (1.0 / (1 << 24) as f64)
    }

    /// Whether it crosses a surface that covers only a part of what is behind, in `[0, 1)`.
    pub fn crossing(&self, vertex: u32) -> f32 {
        self.even(DimensionSet::event(vertex, Event::Crossing)).x
    }

    /// As [`Self::point`], but jittered where the pattern is a grid: a path takes so many numbers
    /// that whole cells of what it may do would be left out.
    fn even(&self, set: DimensionSet) -> Vec2 {
        match self.pattern {
            Pattern::Grid => self.cells.point(self.key.with(set.0), self.index, true),
            _ => self.point(set),
        }
    }

    /// The one point that this sample has in `set`.
    fn point(&self, set: DimensionSet) -> Vec2 {
        match self.pattern {
            Pattern::Grid => self.cells.point(self.key.with(set.0), self.index, false),
            Pattern::Jittered => self.cells.point(self.key.with(set.0), self.index, true),
            Pattern::Random => self.random(set, u64::from(self.index)),
            Pattern::Sobol => self.sobol(set, u64::from(self.index), Pair::First),
        }
    }

    fn random(&self, set: DimensionSet, number: u64) -> Vec2 {
        self.key.with(set.0).with(number).point()
    }

    fn sobol(&self, set: DimensionSet, number: u64, pair: Pair) -> Vec2 {
        sobol::point_of(self.key.with(set.0), number, pair)
    }
}
