//! Where the next samples go: to the pixels whose error they lower most.
//!
//! A half of a pixel is allotted by what the *other* half has seen there and what both have seen in
//! the eight pixels around, never by its own samples, so that no half stops where it has been lucky
//! (Kirk and Arvo 1991, "Unbiased Sampling Techniques for Image Synthesis", on the bias of doing so).
//! The halves weigh the same whatever their counts ([`crate::film::Pixel`]). What is left is a bias:
//! how well the other half knows depends on its count, on which this half once had a say; where halves have a single sample,
//! what varies around a pixel is told by its neighbours' surroundings, of which the pixel is one; and the factor that a tile
//! learns (below) has the difference of the pixel's own halves in it, among those of the whole tile and the film.
//! `tests/limits/adaptive.rs` measures it: with 16 samples a pixel its square is less than 1.2 % of the squared error.
//!
//! Variances of samples say where the error is, but overstate that of a stratified pattern by far. How far, each
//! tile learns from the difference of its pixels' halves. With errors falling like n^-p and samples that cost c, the sum of all
//! errors is least where n grows like (variance / c)^(1 / (1 + p)) (Lagrange).

use rayon::prelude::*;

use super::difficulty::Difficulty;
use super::tile::Tile;
use crate::film::{Pixel, Rect};
use crate::sampling::Pattern;

/// As many pixels of the whole film stand beside those of a tile.
const FILM: f64 = 8.0;
/// Every pixel keeps this share of the mean number of samples: what no sample has met yet, none has asked for.
const LEAST_SHARE: f64 = 0.125;
/// Most samples of one half of a pixel.
const MOST: u32 = 1 << 28;

/// Scores are kept as whole numbers of this part of an octave, so that halves alike can be counted together.
const STEPS_PER_OCTAVE: f64 = 16.0;
/// Weights below this are as good as 0.
const LEAST_WEIGHT: f32 = 1e-30;

/// One half of a pixel.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Share {
    /// The best number of samples is in proportion to this power of two, in steps of
    /// [`STEPS_PER_OCTAVE`].
    score: i16,
    taken: u32,
}

/// The powers of two that scores stand for.
struct Scores {
    least: i16,
    powers: Vec<f64>,
}

impl Scores {
    /// For all scores of `classes`, which are in their order.
    fn of(classes: &Classes) -> Self {
        let score = |end: Option<&(Share, Class)>| end.map_or(0, |(share, _)| share.score);
        let (least, most) = (score(classes.first()), score(classes.last()));
        let power = |score: i16| (f64::from(score) / STEPS_PER_OCTAVE).exp2();
        Self {
            least,
            powers: (least..=most).map(power).collect(),
        }
    }
}

/// How many samples a half of each score is to have.
struct Counts {
    least_score: i16,
    by_score: Vec<u32>,
}

impl Counts {
    /// What a half is to have with those that it has.
    fn of(&self, share: Share) -> u32 {
        let wanted = self.by_score[usize::from(share.score.abs_diff(self.least_score))];
        wanted.max(share.taken)
    }
}

/// All halves that are alike.
#[derive(Clone, Copy, Default)]
struct Class {
    count: u64,
    /// Sum of their rays for a sample.
    cost: f64,
    /// Sum of their weights: a half's part of the film's relMSE is its weight times n^-p.
    weight: f64,
}

impl Class {
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        self.cost += other.cost;
        self.weight += other.weight;
    }
}

/// In the order of their shares.
type Classes = Vec<(Share, Class)>;

/// What the halves of a tile's pixels are to get.
struct Allotted {
    shares: Vec<Share>,
    /// See [`Class::weight`].
    weights: Vec<f32>,
    /// See [`Class::cost`].
    cost: f64,
}

/// Parts of the film that are counted by themselves.
const PARTS: usize = 16;

impl Allotted {
    /// Each of its halves as a class of its own.
    fn halves(&self) -> impl Iterator<Item = (Share, Class)> {
        let class = |(share, weight): (&Share, &f32)| {
            let class = Class {
                count: 1,
                cost: self.cost,
                weight: f64::from(*weight),
            };
            (*share, class)
        };
        self.shares.iter().zip(&self.weights).map(class)
    }
}

/// The classes of some tiles.
fn sorted_classes(tiles: &[Allotted]) -> Classes {
    let mut halves: Classes = tiles.iter().flat_map(Allotted::halves).collect();
    halves.sort_by_key(|(share, _)| *share);
    merged(halves)
}

/// [`sorted_classes`] in another order, and quicker where there are few different numbers of samples, as there are
/// of powers of two.
fn counted_classes(tiles: &[Allotted]) -> Classes {
    let scores = || tiles.iter().flat_map(|tile| &tile.shares).map(|s| s.score);
    let (least, most) = (scores().min().unwrap_or(0), scores().max().unwrap_or(0));
    let span = usize::from(most.abs_diff(least)) + 1;
    let mut by_taken = Vec::<(u32, Vec<Class>)>::new();
    for (share, class) in tiles.iter().flat_map(Allotted::halves) {
        let known = by_taken.iter().position(|(taken, _)| *taken == share.taken);
        let known = known.unwrap_or_else(|| {
            by_taken.push((share.taken, vec![Class::default(); span]));
            by_taken.len() - 1
        });
        by_taken[known].1[usize::from(share.score.abs_diff(least))].add(&class);
    }
    let of_taken = |(taken, classes): (u32, Vec<Class>)| {
        let shares = (least..=most).map(move |score| Share { score, taken });
        shares.zip(classes).filter(|(_, class)| class.count > 0)
    };
    by_taken.into_iter().flat_map(of_taken).collect()
}

/// Classes of one share become one.
fn merged(sorted: impl IntoIterator<Item = (Share, Class)>) -> Classes {
    let mut classes = Classes::new();
    for (share, class) in sorted {
        match classes.last_mut() {
            Some((kept_share, kept)) if *kept_share == share => kept.add(&class),
            _ => classes.push((share, class)),
        }
    }
    classes
}

/// How many samples each half of each pixel is to get.
pub(super) struct Allotment {
    pattern: Pattern,
    exponent: f64,
    /// Samples come in multiples of this: a round of cells.
    unit: u32,
    pixels: u64,
    /// Of each tile, two for a pixel.
    shares: Vec<Vec<Share>>,
    classes: Classes,
    scores: Scores,
}

/// What comes of a number of samples.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outcome {
    /// Samples in all, those that are there included.
    pub samples: u64,
    /// Rays in all.
    pub rays: f64,
    /// The sum over all pixels of their parts of relMSE, up to a factor.
    pub error: f64,
}

impl Allotment {
    /// Looks at all `pixels` of `film`, which is cut into `tiles`; each half of each pixel has samples. Squared errors
    /// fall with this power of the number of samples.
    pub fn new(
        film: Rect,
        pixels: &[Pixel],
        tiles: &[Tile],
        pattern: Pattern,
        unit: u32,
        exponent: f64,
    ) -> Self {
        let difficulty = Difficulty::of(film, pixels);
        let measured: Vec<_> = tiles
            .par_iter()
            .map(|tile| Measured::of(film, pixels, tile, &difficulty, exponent))
            .collect();
        let film_factor = {
            let sum = |f: fn(&Measured) -> f64| measured.iter().map(f).sum::<f64>();
            let (error, model) = (sum(|m| m.error), sum(|m| m.model));
            // Without any variance no half has a weight, whatever the halves differ by.
            if model > 0.0 { error / model } else { 0.0 }
        };
        let allotted: Vec<_> = measured
            .into_par_iter()
            .map(|measured| measured.allotted(film_factor, exponent))
            .collect();
        // Parts do not depend on the number of threads: sums have an order.
        let part = allotted.len().div_ceil(PARTS).max(1);
        let classes_of = match pattern {
            Pattern::Sobol => counted_classes,
            _ => sorted_classes,
        };
        let by_part: Vec<_> = allotted.par_chunks(part).map(classes_of).collect();
        let mut classes = by_part.concat();
        classes.sort_by_key(|(share, _)| *share);
        let classes = merged(classes);
        let shares = allotted.into_iter().map(|tile| tile.shares).collect();
        Self {
            pattern,
            exponent,
            unit,
            pixels: film.area(),
            shares,
            scores: Scores::of(&classes),
            classes,
        }
    }

    /// What there is now.
    pub fn now(&self) -> Outcome {
        self.outcome(0.0, 0)
    }

    /// What comes of numbers of samples of `scale` times the scores.
    pub fn at(&self, scale: f64) -> Outcome {
        let by_score = self.outcome(scale, 0);
        self.outcome(scale, self.least(by_score.samples))
    }

    /// The largest scale whose outcome is `within`, where all smaller ones are, and the least that is not.
    pub fn scales(&self, within: impl Fn(&Outcome) -> bool) -> [f64; 2] {
        // Scores are powers, up to the first, of weights from 1e-30 to not much more than 1.
        let (mut low, mut high) = (-50.0_f64, 130.0_f64);
        for _ in 0..18 {
            let middle = 0.5 * (low + high);
            if within(&self.at(middle.exp2())) {
                low = middle;
            } else {
                high = middle;
            }
        }
        [low.exp2(), high.exp2()]
    }

    /// Sets the goals of all tiles.
    pub fn aim(&self, tiles: &mut [Tile], scale: f64) {
        let least = self.least(self.outcome(scale, 0).samples);
        let counts = self.counts(scale, least);
        tiles
            .par_iter_mut()
            .zip(&self.shares)
            .for_each(|(tile, shares)| {
                for (goal, shares) in tile.goal.iter_mut().zip(shares.chunks_exact(2)) {
                    *goal = [0, 1].map(|half| counts.of(shares[half]));
                }
            });
    }

    /// What every half of a pixel gets at least where there are `samples` in all.
    fn least(&self, samples: u64) -> u32 {
        let mean = samples as f64 / (2 * self.pixels) as f64;
        self.rounded(LEAST_SHARE * mean)
    }

    /// `scale` times the scores, but `least` at least.
    fn counts(&self, scale: f64, least: u32) -> Counts {
        let count = |power: &f64| self.rounded(scale * power).max(least);
        Counts {
            least_score: self.scores.least,
            by_score: self.scores.powers.iter().map(count).collect(),
        }
    }

    /// The number of samples near `x` that the pattern does well with.
    fn rounded(&self, x: f64) -> u32 {
        let x = x.min(f64::from(MOST));
        match self.pattern {
            // Between powers of two a net is unbalanced: to the nearer one, in proportion.
            Pattern::Sobol => {
                let x = (x * std::f64::consts::SQRT_2) as u32;
                x.checked_ilog2().map_or(0, |log| 1 << log)
            }
            Pattern::Random => x as u32,
            Pattern::Grid | Pattern::Jittered => {
                (x / f64::from(self.unit)).round() as u32 * self.unit
            }
        }
    }

    fn outcome(&self, scale: f64, least: u32) -> Outcome {
        let mut sum = Outcome::default();
        let mut fall = Fall::new(self.exponent);
        let counts = self.counts(scale, least);
        for &(share, class) in &self.classes {
            let count = counts.of(share);
            sum.samples += class.count * u64::from(count);
            sum.rays += class.cost * f64::from(count);
            sum.error += class.weight * fall.to(count);
        }
        sum
    }
}

/// What a tile's samples say before the tile is compared with the film.
struct Measured<'a> {
    tile: &'a Tile,
    difficulty: Vec<[f32; 2]>,
    /// The tile's part of relMSE, by the difference of the halves.
    error: f64,
    /// The same by the variances of the samples, up to a factor: what a tile of independent
    /// neighbours would have.
    model: f64,
    /// How many pixels carry `model`, if all carried the same.
    pixels: f64,
}

impl<'a> Measured<'a> {
    fn of(
        film: Rect,
        pixels: &[Pixel],
        tile: &'a Tile,
        difficulty: &Difficulty,
        exponent: f64,
    ) -> Self {
        let (mut model, mut squares) = (0.0, 0.0);
        let mut of_tile = Vec::with_capacity(tile.taken.len());
        let mut fall = Fall::new(exponent);
        for (place, &taken) in tile.rect().pixels().zip(&tile.taken) {
            let i = film.index(place);
            let of = difficulty.for_halves(i, taken);
            let expected: f64 = of
                .iter()
                .zip(taken)
                .map(|(&d, n)| 0.25 * f64::from(d) * fall.to(n.max(1)))
                .sum();
            model += expected;
            squares += expected * expected;
            of_tile.push(of);
        }
        // A tile has no sums where a pixel has nothing to say.
        let error_of = |place| pixels[film.index(place)].relative_squared_error();
        let summed = || tile.rect().pixels().filter_map(error_of).sum();
        let error = tile.error.map_or_else(summed, |sums| sums.sum());
        Self {
            tile,
            difficulty: of_tile,
            error,
            model,
            pixels: if squares > 0.0 {
                model * model / squares
            } else {
                0.0
            },
        }
    }

    /// Its allotment; `film_factor` is `error` over `model` for the whole film.
    fn allotted(self, film_factor: f64, exponent: f64) -> Allotted {
        let factor = if self.model > 0.0 {
            let own = self.error / self.model;
            (self.pixels * own + FILM * film_factor) / (self.pixels + FILM)
        } else {
            film_factor
        };
        let taken = |tile: &Tile| {
            tile.taken
                .iter()
                .flatten()
                .map(|&n| f64::from(n))
                .sum::<f64>()
        };
        let cost = (self.tile.rays.total() as f64 / taken(self.tile).max(1.0)).max(1.0);
        let power = STEPS_PER_OCTAVE as f32 / (1.0 + exponent as f32);
        // Never NaN: difficulties are finite, and so is the factor, whose divisors are above 0 (those of relMSE are where no
        // radiance is negative).
        let weigh = |d: f32| (0.25 * factor * f64::from(d)).clamp(0.0, f32::MAX.into()) as f32;
        let mut shares = Vec::with_capacity(2 * self.difficulty.len());
        let mut weights = Vec::with_capacity(2 * self.difficulty.len());
        for (taken, difficulty) in self.tile.taken.iter().zip(&self.difficulty) {
            for half in 0..2 {
                let weight = weigh(difficulty[half]);
                shares.push(Share {
                    score: nearest((weight.max(LEAST_WEIGHT) / cost as f32).log2() * power),
                    taken: taken[half],
                });
                weights.push(weight);
            }
        }
        Allotted {
            shares,
            weights,
            cost,
        }
    }
}

/// The whole number nearest to `x`, without the call that `round` is.
fn nearest(x: f32) -> i16 {
    const OFF: f32 = 16384.0;
    ((x.clamp(-OFF, OFF) + (OFF + 0.5)) as i32 - OFF as i32) as i16
}

/// What of a squared error is left with more samples. Neighbours have the same number more often than not, and
/// powers are slow.
struct Fall {
    exponent: f64,
    /// The last number of samples, and what it left.
    last: (u32, f64),
}

impl Fall {
    /// With this power of the number of samples.
    fn new(exponent: f64) -> Self {
        Self {
            exponent,
            last: (1, 1.0),
        }
    }

    fn to(&mut self, samples: u32) -> f64 {
        if samples != self.last.0 {
            self.last = (samples, f64::from(samples).powf(-self.exponent));
        }
        self.last.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::film::ErrorSums;
    use crate::math::UVec2;

    /// The allotment of a row of pixels with so many samples a half.
    fn allotment(pixels: &[Pixel], taken: u32) -> (Allotment, [Tile; 1]) {
        let film = Rect::full(UVec2::new(pixels.len() as u32, 1));
        let mut tiles = [Tile::new(film, &[])];
        tiles[0].taken.fill([taken; 2]);
        let without_sums = Allotment::new(film, pixels, &tiles, Pattern::Random, 1, 1.0);
        tiles[0].error = ErrorSums::of(pixels);
        let allotment = Allotment::new(film, pixels, &tiles, Pattern::Random, 1, 1.0);
        assert_eq!(without_sums.now().error, allotment.now().error);
        (allotment, tiles)
    }

    fn pixel(halves: [&[f32]; 2]) -> Pixel {
        let mut pixel = Pixel::default();
        for (half, values) in halves.into_iter().enumerate() {
            for &value in values {
                pixel.add_sample(half, Rgb::splat(value));
            }
        }
        pixel
    }

    /// Squares of single samples overflow, first those of dark pixels beside it, then those of the pixel itself.
    #[test]
    fn the_brightest_pixel_there_can_be_draws_samples_and_leaves_a_forecast() {
        for bright in [1e9, 1e19, 1e30, f32::MAX] {
            let mut pixels = vec![pixel([&[0.1], &[0.2]]); 9];
            pixels[1] = pixel([&[bright], &[bright]]);
            let (allotment, mut tiles) = allotment(&pixels, 1);
            let [now, then] = [allotment.now(), allotment.at(1e4)].map(|outcome| outcome.error);
            let falls = 0.0 < then && then < now && now < f64::INFINITY;
            assert!(falls, "{bright}: {now} {then}");
            let [scale, _] = allotment.scales(|outcome| outcome.samples < 1000);
            allotment.aim(&mut tiles, scale);
            let goal = &tiles[0].goal;
            assert!(goal[0][0] > 2 * goal[7][0], "{bright}: {goal:?}");
        }
    }

    /// The samples of a half are alike, and the halves differ: no variance explains it.
    #[test]
    fn halves_that_differ_without_a_variance_have_no_weight() {
        let pixels = vec![pixel([&[0.0, 0.0], &[1e3, 1e3]]); 9];
        let (allotment, _) = allotment(&pixels, 2);
        assert_eq!(allotment.now().error, 0.0);
    }
}
