//! Room for what the halves of a picture cannot tell: slivers of something bright that hardly a sample meets.
//!
//! An edge of a lamp lies anywhere in the pixels along it, so that a pixel beside something bright holds a sliver of it
//! that `n` samples meet `x` times on average with the density `1/n` in `x`, however bright. If they meet it `K`
//! times (Poisson), each time adding `j` to the pixel's value, the pixel's part of relMSE in this channel is
//!
//! `(K - x)² / (x² + ε)`, `ε = (base² + 0.01) / j²`.
//!
//! Nothing shows that at `K = 0`; a hit or two of a sliver that is smaller than that are stated far too small, since the
//! picture is then too bright for what it is divided by. With `ε = 0` the part is larger than `t ≥ 1` with the
//! probability `1 / (2 t n)`, summed over all `K`. (The single hit that weighs most, (1 - x)² > t (x² + ε), needs
//! x² < 1/t - ε roughly, and has the probability x²/2: that is where it ends for other `ε`.) All
//! pixels together thus have `Σ (1/t - ε) / (2 n)` such parts on average, over those where that is positive, and the room
//! is the `t` at which that is 2.5 %: no larger one is there in 97.5 % of all pictures (Hanley and
//! Lippman-Hand 1983, "If Nothing Goes Wrong, Is Everything All Right?", for one pixel). Of sums of such parts, whose
//! tails fall with 1/t, the largest decides (Foss, Korshunov and Zachary 2013, "An Introduction to Heavy-Tailed and
//! Subexponential Distributions", 3.1); the others are left out.
//! (For t < 1 the law is no more than an order of magnitude; such a room is less than one pixel that misses all of its truth.)

use rayon::prelude::*;

use super::estimate::PART;
use super::{Pixel, RELATIVE_FLOOR};

/// The share of all pictures in which a sliver weighs more than the room for it.
const CHANCE: f64 = 0.025;

/// The most that a sliver adds to the picture's sum of parts of relMSE, over all channels, but in 2.5 % of all
/// pictures. The pixels come in rows of `width`.
pub(super) fn room(pixels: &[Pixel], width: usize) -> f64 {
    let width = width.max(1);
    let radiances: Vec<_> = pixels.par_iter().map(brightest).collect();
    let across = |i: usize| {
        let (start, x) = (i - i % width, i % width);
        let row = &radiances[start..radiances.len().min(start + width)];
        largest(&row[x.saturating_sub(1)..row.len().min(x + 2)])
    };
    let across: Vec<_> = (0..pixels.len()).into_par_iter().map(across).collect();
    let of_part = |(part, pixels): (usize, &[Pixel])| {
        let mut slivers = Slivers::default();
        for (i, pixel) in (part * PART..).zip(pixels) {
            let above = across[i.checked_sub(width).unwrap_or(i)];
            let below = *across.get(i + width).unwrap_or(&above);
            slivers.add(pixel, largest(&[above, across[i], below]));
        }
        slivers
    };
    let parts: Vec<_> = pixels.par_chunks(PART).enumerate().map(of_part).collect();
    let slivers = parts.iter().fold(Slivers::default(), Slivers::and);
    3.0 * slivers.largest_part()
}

/// The mean of its samples, each weighted by itself, by channel: where they are 0 or h, it is h, however few meet it.
fn brightest(pixel: &Pixel) -> [f32; 3] {
    let sums = pixel.halves().each_ref().map(|half| half.sums());
    std::array::from_fn(|c| {
        let [sum, squares] = [0, 1].map(|k| sums[0][k][c] + sums[1][k][c]);
        if sum > 0.0 {
            (squares / sum) as f32
        } else {
            0.0
        }
    })
}

fn largest(radiances: &[[f32; 3]]) -> [f32; 3] {
    let largest = |a: [f32; 3], b: &[f32; 3]| std::array::from_fn(|c| a[c].max(b[c]));
    radiances.iter().fold([0.0; 3], largest)
}

/// `ε` in quarters of powers of two (its exponent and the first two digits behind the point), so that no sorting is needed.
const FIRST_BIN: u64 = bin(f64::from_bits((1023 - 64) << 52));
const BINS: usize = 4 * 96;

const fn bin(epsilon: f64) -> u64 {
    epsilon.to_bits() >> 50
}

/// The slivers that there may be, by `ε`.
struct Slivers {
    /// Their density in `x`, and that times `ε`.
    bins: [[f64; 2]; BINS],
}

impl Default for Slivers {
    fn default() -> Self {
        Self {
            bins: [[0.0; 2]; BINS],
        }
    }
}

impl Slivers {
    /// Adds those of something of radiance `around` that may reach into `pixel`.
    fn add(&mut self, pixel: &Pixel, around: [f32; 3]) {
        let samples = pixel.count().max(1) as f64;
        let [a, b] = pixel.halves().each_ref().map(|half| half.mean());
        for c in 0..3 {
            // What has been met already shows in one half.
            let base = a[c].min(b[c]);
            let jump = (f64::from(around[c]) - base) / samples;
            if jump > 0.0 {
                self.add_one(
                    1.0 / (3.0 * samples),
                    (base * base + RELATIVE_FLOOR) / (jump * jump),
                );
            }
        }
    }

    fn and(mut self, other: &Self) -> Self {
        let sums = self.bins.iter_mut().flatten();
        for (sum, other) in sums.zip(other.bins.iter().flatten()) {
            *sum += other;
        }
        self
    }

    #[inline]
    fn add_one(&mut self, density: f64, epsilon: f64) {
        let i = bin(epsilon).saturating_sub(FIRST_BIN) as usize;
        // Beyond the last one are those that do not matter.
        if let Some([densities, moments]) = self.bins.get_mut(i) {
            *densities += density;
            *moments += density * epsilon;
        }
    }

    /// The `t` that is exceeded with the probability `CHANCE`; 0 where there are none.
    fn largest_part(&self) -> f64 {
        let (mut densities, mut moments) = (0.0, 0.0);
        for (i, [density, moment]) in self.bins.iter().enumerate() {
            densities += density;
            moments += moment;
            // Solves Σ density (1/t - ε) / 2 = CHANCE over those so far.
            let t = densities / (2.0 * CHANCE + moments);
            let end = f64::from_bits((FIRST_BIN + i as u64 + 1) << 50);
            if t * end >= 1.0 {
                return t;
            }
        }
        0.0
    }
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::super::{ErrorEstimate, ErrorSums};
    use super::*;
    use crate::color::Rgb;
    use crate::math::UVec2;
    use crate::sampling::{Pattern, Sampler, SamplingConfig};

    const WIDTH: u32 = 16;

    /// The share of a cell [i, i + 1] between `from` and `from + length`.
    fn overlap(i: u32, from: f32, length: f32) -> f32 {
        let i = i as f32;
        ((from + length).min(i + 1.0) - from.max(i)).max(0.0)
    }

    /// Pixels that are 0 or 0.2, half of the time each, and before them a lamp of 3.4 x 2.6 pixels, somewhere; with the
    /// true √relMSE.
    fn picture(seed: u64, samples: u32, lamp: f32) -> (Vec<Pixel>, f64) {
        let config = SamplingConfig {
            samples,
            pattern: Pattern::Random,
            seed,
            ..SamplingConfig::default()
        };
        let sample = |x, y, k| Sampler::new(&config, UVec2::new(x, y), k).camera();
        let corner = sample(WIDTH, WIDTH, 0) * 4.0 + 4.0;
        let mut truth = 0.0;
        let pixels = (0..WIDTH * WIDTH).map(|i| {
            let (x, y) = (i % WIDTH, i / WIDTH);
            let [across, down] = [overlap(x, corner.x, 3.4), overlap(y, corner.y, 2.6)];
            let mut pixel = Pixel::default();
            for k in 0..samples {
                let at = sample(x, y, k);
                let value = if at.x < across && at.y < down {
                    lamp
                } else if at.x.max(at.y) * 64.0 % 1.0 < 0.5 {
                    0.2
                } else {
                    0.0
                };
                pixel.add_sample(k as usize % 2, Rgb::splat(value));
            }
            let share = f64::from(across * down);
            let exact = share * f64::from(lamp) + (1.0 - share) * 0.1;
            truth += (pixel.value()[0] - exact).powi(2) / (exact * exact + RELATIVE_FLOOR);
            pixel
        });
        let pixels: Vec<_> = pixels.collect();
        (pixels, (truth / f64::from(WIDTH * WIDTH)).sqrt())
    }

    #[test]
    fn the_interval_covers_edges_of_lamps_wherever_they_are() {
        const PICTURES: u64 = 400;
        for (samples, lamp) in [(2, 100.0), (8, 100.0), (16, 100.0), (32, 1e4)] {
            let [mut below, mut above, mut plain] = [0; 3];
            for seed in 0..PICTURES {
                let (pixels, truth) = picture(seed, samples, lamp);
                let stated = ErrorEstimate::of(&pixels, WIDTH as usize).expect("there are halves");
                below += u64::from(truth < stated.low);
                above += u64::from(truth > stated.high);
                let sums = ErrorSums::of(&pixels).expect("there are halves");
                let stated = sums.estimate().expect("there are pixels");
                plain += u64::from(stated.low <= truth && truth <= stated.high);
            }
            let [below, above, plain] =
                [below, above, plain].map(|c| 100.0 * c as f64 / PICTURES as f64);
            let seen = format!("{samples}, {lamp}: {below} % below, {above} % above; {plain} %");
            // 2.5 % each, with the chance of 400 pictures.
            assert!(below < 5.0 && above < 4.5, "{seen}");
            assert!(plain < 91.0, "{seen}");
        }
    }

    /// Σ over K of the probability that (K - x)² > t x², over all x.
    #[test]
    fn parts_are_larger_than_t_with_the_probability_that_is_said() {
        const STEP: f64 = 1e-3;
        for t in [1.0_f64, 3.0, 20.0] {
            let mut sum = 0.0;
            for x in (0..100_000).map(|i| (f64::from(i) + 0.5) * STEP) {
                let mut likely = (-x).exp();
                for k in 1..300 {
                    likely *= x / f64::from(k);
                    if (f64::from(k) - x).powi(2) > t * x * x && f64::from(k) > x {
                        sum += likely * STEP;
                    }
                }
            }
            assert!((2.0 * t * sum - 1.0).abs() < 0.01, "{t}: {sum}");
        }
    }

    fn flat(value: f32, samples: usize) -> Pixel {
        let mut pixel = Pixel::default();
        for k in 0..samples {
            pixel.add_sample(k % 2, Rgb::splat(value));
        }
        pixel
    }

    /// A pixel of a lamp among 24 black ones, the 8 beside it of 32 samples: t = 20 · 8 / 32, and three channels.
    #[test]
    fn the_room_is_twenty_times_the_slivers_that_are_expected() {
        let around = |lamp: f32| -> Vec<Pixel> {
            (0..25)
                .map(|i| flat(if i == 12 { lamp } else { 0.0 }, 32))
                .collect()
        };
        for lamp in [1e6, 1e30, f32::MAX] {
            let got = room(&around(lamp), 5);
            assert!((got / 15.0 - 1.0).abs() < 1e-3, "{lamp}: {got}");
        }
        // One hit adds 0.1 in each channel at most, which is 1 by the floor.
        let got = room(&around(3.2), 5);
        assert!((2.0..3.0).contains(&got), "{got}");
        assert_eq!(room(&vec![flat(3.0, 4); 9], 3), 0.0);
        assert_eq!(room(&[], 0), 0.0);
    }

    #[test]
    fn noise_that_is_everywhere_needs_no_room() {
        let pixels: Vec<_> = (0..16).flat_map(|seed| picture(seed, 32, 0.2).0).collect();
        let parts = pixels.iter().filter_map(Pixel::relative_squared_error);
        let (room, all) = (room(&pixels, WIDTH as usize), parts.sum::<f64>());
        assert!(room < 0.01 * all, "{room} of {all}");
    }
}
