//! The samples of one pixel, in two halves whose difference tells the error of their mean.

use crate::color::Rgb;

/// Samples of one half of a pixel: their mean and spread.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    mean: [f64; 3],
    /// Sum of the squared deviations from the mean.
    deviation: [f64; 3],
    count: u64,
}

impl Moments {
    /// Adds samples but for those that are not finite; whether all were.
    #[inline]
    fn add_samples(&mut self, values: &[Rgb]) -> bool {
        let before = self.count;
        // Not in memory, from sample to sample.
        let Self {
            mut mean,
            mut deviation,
            mut count,
        } = *self;
        for value in values.iter().filter(|value| value.is_finite()) {
            count += 1;
            let share = 1.0 / count as f64;
            for (i, c) in value.channels().into_iter().enumerate() {
                // Welford 1962, "Note on a Method for Calculating Corrected Sums of Squares".
                let off = f64::from(c) - mean[i];
                mean[i] += off * share;
                deviation[i] += off * (f64::from(c) - mean[i]);
            }
        }
        *self = Self {
            mean,
            deviation,
            count,
        };
        count - before == values.len() as u64
    }

    /// Their mean by channel; 0 where there are none.
    #[inline]
    pub fn mean(&self) -> [f64; 3] {
        self.mean
    }

    /// Variance of a single sample by channel; 0 where there are fewer than two. Over the count it
    /// overstates the variance of the mean of a stratified pattern, often several times over.
    #[inline]
    pub fn sample_variance(&self) -> [f64; 3] {
        let degrees = self.count.saturating_sub(1).max(1) as f64;
        self.deviation.map(|d| d / degrees)
    }

    /// Sums of the samples and of their squares, by channel.
    #[inline]
    pub(super) fn sums(&self) -> [[f64; 3]; 2] {
        let count = self.count as f64;
        let squares = |c: usize| self.deviation[c] + count * self.mean[c] * self.mean[c];
        [self.mean.map(|m| count * m), std::array::from_fn(squares)]
    }

    /// Their number.
    #[inline]
    pub fn count(&self) -> u64 {
        self.count
    }
}

/// The samples of one pixel.
///
/// Its halves are the sets of [`crate::sampling::Pattern::sets`]: independent, each with its own
/// mean. Where both have samples the pixel is the plain average of the two means, however many samples
/// each has, so that no weight depends on a value and a quarter of their squared difference is the
/// average's variance without bias, for every pattern.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pixel {
    halves: [Moments; 2],
}

impl Pixel {
    /// Adds a sample to a half, 0 or 1; `false` where it is not finite, and the pixel stays as it was.
    #[inline]
    pub fn add_sample(&mut self, half: usize, value: Rgb) -> bool {
        self.add_samples(half, &[value])
    }

    /// Adds samples to a half, 0 or 1, but for those that are not finite; whether all were.
    #[inline]
    pub fn add_samples(&mut self, half: usize, values: &[Rgb]) -> bool {
        self.halves[half].add_samples(values)
    }

    /// The two halves.
    #[inline]
    pub fn halves(&self) -> &[Moments; 2] {
        &self.halves
    }

    /// Whether both halves have samples, so that [`Pixel::squared_error`] means something.
    #[inline]
    pub fn has_error(&self) -> bool {
        self.halves.iter().all(|half| half.count > 0)
    }

    /// Its value by channel; black where there are no samples.
    #[inline]
    pub fn value(&self) -> [f64; 3] {
        let [a, b] = &self.halves;
        match (a.count, b.count) {
            (_, 0) => a.mean,
            (0, _) => b.mean,
            _ => std::array::from_fn(|c| 0.5 * (a.mean[c] + b.mean[c])),
        }
    }

    /// Its value in single precision.
    pub fn mean(&self) -> Rgb {
        Rgb::from(self.value().map(|m| m as f32))
    }

    /// The mean of something else than radiance, of which these are the sums over the samples of each half: as in
    /// [`Self::value`] both halves weigh the same.
    pub fn mean_of_sums(&self, sums: [f64; 2]) -> f64 {
        let [a, b] = self.halves.each_ref().map(|half| half.count as f64);
        match (a > 0.0, b > 0.0) {
            (true, true) => 0.5 * (sums[0] / a + sums[1] / b),
            (true, false) => sums[0] / a,
            (false, true) => sums[1] / b,
            (false, false) => 0.0,
        }
    }

    /// The squared error of its value by channel, as the halves tell it: right on average, though by itself
    /// it has one degree of freedom. 0 where one half is empty.
    #[inline]
    pub fn squared_error(&self) -> [f64; 3] {
        if !self.has_error() {
            return [0.0; 3];
        }
        let [a, b] = &self.halves;
        std::array::from_fn(|c| 0.25 * (a.mean[c] - b.mean[c]).powi(2))
    }

    /// How many samples it holds.
    pub fn count(&self) -> u64 {
        self.halves.iter().map(Moments::count).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_a_constant_stays_exact() {
        let mut pixel = Pixel::default();
        for i in 0..(1 << 24) + 3 {
            pixel.add_sample(i % 2, Rgb::splat(0.1));
        }
        assert!((pixel.mean().r - 0.1).abs() < 1e-8);
        assert!(pixel.squared_error()[0] < 1e-20);
        assert!(pixel.halves()[0].sample_variance()[0] < 1e-20);
    }

    #[test]
    fn one_bad_sample_does_no_harm() {
        let mut pixel = Pixel::default();
        assert!(pixel.add_sample(0, Rgb::splat(2.0)));
        assert!(!pixel.add_sample(1, Rgb::new(f32::NAN, 0.0, 0.0)));
        assert!(!pixel.add_sample(1, Rgb::new(0.0, f32::INFINITY, 0.0)));
        assert_eq!(pixel.mean(), Rgb::splat(2.0));
        assert!(pixel.count() == 1 && !pixel.has_error());
    }

    #[test]
    fn halves_of_different_size_weigh_the_same() {
        let mut pixel = Pixel::default();
        for (half, value) in [(0, 1.0), (1, 2.0), (1, 4.0)] {
            pixel.add_sample(half, Rgb::splat(value));
        }
        assert_eq!(pixel.value(), [2.0; 3]);
        assert_eq!(pixel.mean_of_sums([1.0, 6.0]), 2.0);
        assert_eq!(pixel.squared_error(), [1.0; 3]);
        assert_eq!(pixel.halves()[1].sample_variance(), [2.0; 3]);
    }
}
