//! How wrong a picture is, by its own account: no reference is needed.
//!
//! The two halves of every pixel are independent ([`Pixel`]), so a quarter of their squared
//! difference is the expected squared error of their average, whatever the pattern (replicates:
//! Cochran 1977, "Sampling Techniques", 13.15; Owen 1995 for scrambled nets). Summed over the picture that is its relMSE,
//! and how unevenly it is spread over the pixels tells how sure that sum is.
//!
//! With errors `a` and `b` of the halves, the true squared error of a pixel is `(a + b)²/4` and the estimate
//! `(a - b)²/4`: two numbers of one distribution, the difference of which, `ab`, is 0 on average. Over a picture
//! their ratio is close to Fisher's F, both its degrees of freedom those of the sum (Satterthwaite 1946, "An
//! Approximate Distribution of Estimates of Variance Components"); the interval is that of F, and wider by what the
//! halves do not tell:
//!
//! * What the truth is divided by is not known, and replaced by something corrected for its own error
//!   ([`Pixel::relative_squared_error`]). The correction is as uncertain as it is large: the lower end goes without it, and the
//!   upper end has it twice. It falls with the error itself, and with the number of samples.
//! * The upper end has room for slivers of bright things that hardly a sample met (`unmet.rs`).
//!
//! Both vanish where samples are many and no edge is bright.

use rayon::prelude::*;

use super::{Pixel, unmet};

/// What the denominator of relMSE adds to the square of the reference.
pub const RELATIVE_FLOOR: f64 = 0.01;

/// Share of the pixels of which [`ErrorEstimate::worst_share`] speaks.
const WORST: f64 = 0.001;

/// The error of a picture, √relMSE: relMSE is the mean over pixels and channels of
/// (a − b)² / (b² + 0.01), where b is the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// √relMSE as estimated.
    pub estimate: f64,
    /// Lower end of the interval that is to hold the picture's true √relMSE in 95 % of all pictures, or more where bright
    /// edges carry the error.
    pub low: f64,
    /// Its upper end: far away where few pixels carry the error, or bright edges may be missed by all samples of a pixel.
    pub high: f64,
    /// The share of the estimated relMSE, `[0, 1]`, that the worst 0.1 % of the pixels carry. Where that
    /// is most of it, the interval rests on few samples.
    pub worst_share: f64,
}

impl ErrorEstimate {
    /// The estimate for these pixels, in rows of `width`; `None` where there are none, or one has samples in one half
    /// only.
    pub fn of(pixels: &[Pixel], width: usize) -> Option<Self> {
        let parts: Option<Vec<_>> = pixels.par_chunks(PART).map(Part::of).collect();
        let Part {
            sums,
            uncorrected,
            mut squares,
        } = parts?.into_iter().fold(Part::default(), Part::and);
        let mut estimate = sums.estimate()?;
        estimate.worst_share = worst_share(&mut squares);
        if sums.sum() > 0.0 {
            let correction = (sums.sum() / uncorrected).sqrt();
            estimate.low /= correction;
            estimate.high *= correction;
        }
        let room = unmet::room(pixels, width) / (3 * pixels.len()) as f64;
        estimate.high = estimate.high.hypot(room.sqrt());
        Some(estimate)
    }
}

/// Pixels that are summed by themselves: sums have an order, whatever the number of threads.
pub(super) const PART: usize = 1 << 12;

/// Sums over some pixels.
#[derive(Default)]
struct Part {
    sums: ErrorSums,
    /// The sum of their parts of relMSE with the square of the value in the place of the truth's.
    uncorrected: f64,
    squares: Vec<f32>,
}

impl Part {
    fn of(pixels: &[Pixel]) -> Option<Self> {
        let mut part = Self::default();
        for pixel in pixels {
            let square = pixel.relative_squared_error()?;
            part.sums.add(square);
            part.squares.push(square as f32);
            let weights = relative_weights(pixel.value());
            let squares = pixel.squared_error().into_iter().zip(weights);
            part.uncorrected += squares.map(|(square, weight)| square * weight).sum::<f64>();
        }
        Some(part)
    }

    fn and(mut self, other: Self) -> Self {
        self.sums.add_all(&other.sums);
        self.uncorrected += other.uncorrected;
        self.squares.extend(other.squares);
        self
    }
}

impl Pixel {
    /// The pixel's part of relMSE as the halves tell it, summed over the channels; `None` where a
    /// half is empty.
    ///
    /// The truth that relMSE divides by is not known. The square of the value in its place makes the result too
    /// small while samples are few: they are spread most where they are too bright. Less the squared error over the
    /// number of samples, it is within 5 % for penumbrae (samples that are either lit or not, all shares
    /// alike) from four samples on, and the correction is gone where the error is.
    #[inline]
    pub fn relative_squared_error(&self) -> Option<f64> {
        let samples = self.count() as f64;
        let parts = self.value().into_iter().zip(self.squared_error());
        let part = |(v, square): (f64, f64)| square / (v * v - square / samples + RELATIVE_FLOOR);
        self.has_error().then(|| parts.map(part).sum())
    }
}

/// What a squared error of each channel counts for in relMSE, at this value.
pub fn relative_weights(value: [f64; 3]) -> [f64; 3] {
    value.map(|v| 1.0 / (v * v + RELATIVE_FLOOR))
}

/// Sums over pixels, from which the estimate is made.
#[derive(Clone, Copy, Debug, Default)]
pub struct ErrorSums {
    pixels: u64,
    /// Of the pixels' parts of relMSE.
    sum: f64,
    /// Of their squares.
    squares: f64,
}

impl ErrorSums {
    /// Of these pixels; `None` where one has samples in one half only.
    pub fn of<'p>(pixels: impl IntoIterator<Item = &'p Pixel>) -> Option<Self> {
        let mut sums = Self::default();
        for pixel in pixels {
            sums.add(pixel.relative_squared_error()?);
        }
        Some(sums)
    }

    /// Adds a pixel with its part of relMSE.
    #[inline]
    pub fn add(&mut self, square: f64) {
        self.pixels += 1;
        self.sum += square;
        self.squares += square * square;
    }

    /// Adds the pixels of `other`.
    pub fn add_all(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.sum += other.sum;
        self.squares += other.squares;
    }

    /// Sum of the pixels' parts.
    pub fn sum(&self) -> f64 {
        self.sum
    }

    /// √relMSE; 0 without pixels.
    pub fn root(&self) -> f64 {
        (self.sum / (3.0 * self.pixels.max(1) as f64)).sqrt()
    }

    /// Degrees of freedom of the sum: the number of pixels that carry it, if all carried the
    /// same. A square with one degree of freedom has a second moment of 3 times its squared mean.
    pub fn degrees_of_freedom(&self) -> f64 {
        if self.squares > 0.0 {
            3.0 * self.sum * self.sum / self.squares
        } else {
            0.0
        }
    }

    /// The estimate with the interval of F alone, without the share of the worst pixels; `None` without pixels.
    pub fn estimate(&self) -> Option<ErrorEstimate> {
        if self.pixels == 0 {
            return None;
        }
        let estimate = self.root();
        let factor = spread(self.degrees_of_freedom());
        let (low, high) = if estimate > 0.0 {
            (estimate / factor, estimate * factor)
        } else {
            (0.0, 0.0)
        };
        Some(ErrorEstimate {
            estimate,
            low,
            high,
            worst_share: 0.0,
        })
    }
}

/// Square root of the 97.5 % quantile of Fisher's F with `k` and `k` degrees of freedom, within 2 %
/// for k ≥ 4: log F is nearly normal with a variance of 4 / (k - 1).
fn spread(k: f64) -> f64 {
    const NORMAL_QUANTILE: f64 = 1.959_964;
    if k > 1.0 {
        (NORMAL_QUANTILE / (k - 1.0).sqrt()).exp()
    } else {
        f64::INFINITY
    }
}

fn worst_share(squares: &mut [f32]) -> f64 {
    let count = ((squares.len() as f64 * WORST).ceil() as usize).min(squares.len());
    let sum = |squares: &[f32]| squares.iter().map(|&s| f64::from(s)).sum::<f64>();
    let total = sum(squares);
    if count == 0 || total <= 0.0 {
        return 0.0;
    }
    squares.select_nth_unstable_by(count - 1, |a, b| b.total_cmp(a));
    sum(&squares[..count]) / total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;

    fn pixel(a: f32, b: f32) -> Pixel {
        let mut pixel = Pixel::default();
        pixel.add_sample(0, Rgb::splat(a));
        pixel.add_sample(1, Rgb::splat(b));
        pixel
    }

    #[test]
    fn the_estimate_is_the_root_of_the_mean_relative_square() {
        // Means 1, squared errors 0.01 and 0, two samples each: relMSE = 0.01 / (1.01 - 0.01 / 2) / 2.
        let pixels = [pixel(0.9, 1.1), pixel(1.0, 1.0)];
        let expected = (0.01_f64 / 1.005 / 2.0).sqrt();
        let got = ErrorEstimate::of(&pixels, 10).map(|e| e.estimate);
        assert!(got.is_some_and(|got| (got - expected).abs() < 1e-6));
    }

    /// The expectation over all outcomes of `n` samples in each half, each of them `lit` or black.
    #[test]
    fn few_samples_of_a_penumbra_tell_its_error_without_bias() {
        let choose =
            |n: i32, k: i32| (1..=k).fold(1.0, |c, i| c * f64::from(n - k + i) / f64::from(i));
        for (n, lit) in [(2, 0.8_f32), (4, 0.8), (8, 0.8), (4, 0.3), (16, 0.3)] {
            let (mut stated, mut truth) = (0.0, 0.0);
            for share in (0..50).map(|i| (f64::from(i) + 0.5) / 50.0) {
                let likely = |k: i32| choose(n, k) * share.powi(k) * (1.0 - share).powi(n - k);
                for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
                    let mut pixel = Pixel::default();
                    for k in 0..n {
                        pixel.add_sample(0, if k < i { Rgb::splat(lit) } else { Rgb::BLACK });
                        pixel.add_sample(1, if k < j { Rgb::splat(lit) } else { Rgb::BLACK });
                    }
                    let exact = share * f64::from(lit);
                    let off = (pixel.value()[0] - exact).powi(2);
                    truth += likely(i) * likely(j) * 3.0 * off / (exact * exact + RELATIVE_FLOOR);
                    stated += likely(i) * likely(j) * pixel.relative_squared_error().unwrap_or(0.0);
                }
            }
            let ratio = (stated / truth).sqrt();
            assert!((ratio - 1.0).abs() < 0.05, "{n} samples, {lit}: {ratio}");
        }
    }

    #[test]
    fn half_a_pixel_tells_nothing() {
        let mut half = Pixel::default();
        half.add_sample(0, Rgb::WHITE);
        assert_eq!(ErrorEstimate::of(&[pixel(1.0, 1.0), half], 2), None);
        assert_eq!(ErrorEstimate::of(&[], 0), None);
    }

    /// Quantiles of F from a table (97.5 %, equal degrees of freedom).
    #[test]
    fn the_spread_is_that_of_f() {
        for (k, quantile) in [(4.0, 9.605), (10.0, 3.717), (30.0, 2.074), (120.0, 1.433)] {
            let got: f64 = spread(k).powi(2);
            assert!((got / quantile - 1.0).abs() < 0.02, "{k}: {got}");
        }
    }

    #[test]
    fn one_bad_pixel_shows_in_the_share_and_the_interval() {
        let mut pixels = vec![pixel(0.9, 1.1); 1000];
        let even = ErrorEstimate::of(&pixels, 10).map(|e| (e.worst_share, e.high / e.estimate));
        assert!(even.is_some_and(|(share, factor)| share < 0.0011 && factor < 1.04));
        pixels[7] = pixel(0.0, 200.0);
        let uneven = ErrorEstimate::of(&pixels, 10).map(|e| (e.worst_share, e.high / e.estimate));
        assert!(uneven.is_some_and(|(share, factor)| share > 0.09 && factor > 1.05));
    }
}
