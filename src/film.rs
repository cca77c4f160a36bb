//! Pixels being accumulated.
//!
//! Means are kept in double precision, so that neither 2^24 samples in one pixel nor radiances of
//! very different size lose digits. A sample that is not finite is dropped, counted, and the
//! first is kept with what it takes to trace it again.

use crate::color::Rgb;
use crate::math::UVec2;

/// A rectangle of the film, in pixels from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// Left column.
    pub x: u32,
    /// Upper row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rect {
    /// All of a film of `size`.
    pub fn full(size: UVec2) -> Self {
        Self {
            x: 0,
            y: 0,
            width: size.x,
            height: size.y,
        }
    }

    /// Its number of pixels.
    pub fn area(&self) -> u64 {
        u64::from(self.width) * u64::from(self.height)
    }

    /// Pixels across and down.
    pub fn size(&self) -> UVec2 {
        UVec2::new(self.width, self.height)
    }

    /// Its pixels, row by row.
    pub fn pixels(self) -> impl Iterator<Item = UVec2> {
        (self.y..self.y + self.height)
            .flat_map(move |y| (self.x..self.x + self.width).map(move |x| UVec2::new(x, y)))
    }
}

/// The samples of one pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pixel {
    mean: [f64; 3],
    /// Sum of the squared deviations from the mean.
    deviation: [f64; 3],
    count: u64,
}

impl Pixel {
    /// Adds a sample; `false` where it is not finite, and the pixel stays as it was.
    pub fn add_sample(&mut self, value: Rgb) -> bool {
        if !value.is_finite() {
            return false;
        }
        self.count += 1;
        let share = 1.0 / self.count as f64;
        for (i, c) in value.channels().into_iter().enumerate() {
            // Welford 1962, "Note on a Method for Calculating Corrected Sums of Squares".
            let off = f64::from(c) - self.mean[i];
            self.mean[i] += off * share;
            self.deviation[i] += off * (f64::from(c) - self.mean[i]);
        }
        true
    }

    /// The mean of its samples; black where there are none.
    pub fn mean(&self) -> Rgb {
        Rgb::from(self.mean.map(|m| m as f32))
    }

    /// Variance of the mean, as if the samples were independent: for stratified patterns it is
    /// an upper estimate. 0 where there are fewer than two samples.
    pub fn variance(&self) -> Rgb {
        if self.count < 2 {
            return Rgb::BLACK;
        }
        let n = self.count as f64;
        Rgb::from(self.deviation.map(|d| (d / (n * (n - 1.0))) as f32))
    }

    /// How many samples it holds.
    pub fn count(&self) -> u64 {
        self.count
    }
}

/// A sample that was dropped since it is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RejectedSample {
    /// Which pixel.
    pub pixel: UVec2,
    /// Which of its samples.
    pub index: u32,
}

/// Rays that were traced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// From the camera.
    pub camera: u64,
    /// From surfaces to lights.
    pub shadow: u64,
    /// Mirrored and refracted.
    pub secondary: u64,
}

impl RayCounts {
    /// Adds those of `other`.
    pub fn add(&mut self, other: &Self) {
        self.camera += other.camera;
        self.shadow += other.shadow;
        self.secondary += other.secondary;
    }
}

/// A picture: the pixels of a rectangle of the film.
#[derive(Clone, Debug)]
pub struct Film {
    /// Which part of the film it is.
    pub rect: Rect,
    /// Its pixels, row by row.
    pub pixels: Vec<Pixel>,
    /// Layers that were asked for, in order: per pixel the mean over its samples.
    pub layers: Vec<Vec<[f32; 3]>>,
    /// Samples that were dropped since they are not finite.
    pub rejected: u64,
    /// The first of them, in the order of tiles.
    pub first_rejected: Option<RejectedSample>,
    /// Rays that were traced.
    pub rays: RayCounts,
    /// Whether every pixel has all its samples.
    pub is_complete: bool,
}

impl Film {
    /// Pixels across and down.
    pub fn size(&self) -> UVec2 {
        self.rect.size()
    }

    /// Linear radiance of each pixel, row by row.
    pub fn means(&self) -> Vec<Rgb> {
        self.pixels.iter().map(Pixel::mean).collect()
    }

    /// Variance of each pixel's mean.
    pub fn variances(&self) -> Vec<Rgb> {
        self.pixels.iter().map(Pixel::variance).collect()
    }

    /// Smallest, mean and largest number of samples of a pixel.
    pub fn sample_counts(&self) -> (u64, f64, u64) {
        let counts = || self.pixels.iter().map(Pixel::count);
        let total: u64 = counts().sum();
        (
            counts().min().unwrap_or(0),
            total as f64 / self.pixels.len().max(1) as f64,
            counts().max().unwrap_or(0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_a_constant_stays_exact() {
        let mut pixel = Pixel::default();
        for _ in 0..(1 << 24) + 3 {
            pixel.add_sample(Rgb::splat(0.1));
        }
        assert!((pixel.mean().r - 0.1).abs() < 1e-8);
        assert!(pixel.variance().r < 1e-20);
    }

    #[test]
    fn one_bad_sample_does_no_harm() {
        let mut pixel = Pixel::default();
        assert!(pixel.add_sample(Rgb::splat(2.0)));
        assert!(!pixel.add_sample(Rgb::new(f32::NAN, 0.0, 0.0)));
        assert!(!pixel.add_sample(Rgb::new(0.0, f32::INFINITY, 0.0)));
        assert_eq!(pixel.mean(), Rgb::splat(2.0));
        assert_eq!(pixel.count(), 1);
    }

    #[test]
    fn variance_is_that_of_the_mean() {
        let mut pixel = Pixel::default();
        for v in [1.0, 3.0] {
            pixel.add_sample(Rgb::splat(v));
        }
        // Sample variance 2, over 2 samples.
        assert!((pixel.variance().g - 1.0).abs() < 1e-6);
    }
}
