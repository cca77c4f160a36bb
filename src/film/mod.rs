//! Pixels being accumulated.
//!
//! Means are kept in double precision, so that neither 2^24 samples in one pixel nor radiances of
//! very different size lose digits. A sample that is not finite is dropped, counted, and the
//! first is kept with what it takes to trace it again. The two halves of every pixel tell how wrong the
//! picture is ([`ErrorEstimate`]).

mod estimate;
mod pixel;
mod unmet;

pub use estimate::{ErrorEstimate, ErrorSums, RELATIVE_FLOOR, relative_weights};
pub use pixel::{Moments, Pixel};

use rayon::prelude::*;

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

    /// The number of the pixel at `place`, row by row.
    pub fn index(&self, place: UVec2) -> usize {
        (place.y - self.y) as usize * self.width as usize + (place.x - self.x) as usize
    }

    /// Its pixels, row by row.
    pub fn pixels(self) -> impl Iterator<Item = UVec2> {
        (self.y..self.y + self.height)
            .flat_map(move |y| (self.x..self.x + self.width).map(move |x| UVec2::new(x, y)))
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

/// Rays that were traced, and what was taken from what they brought.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RayCounts {
    /// From the camera.
    pub camera: u64,
    /// From surfaces to lights.
    pub shadow: u64,
    /// Mirrored, refracted and scattered.
    pub secondary: u64,
    /// The luminance that clamping took from all samples together, W/(m² sr).
    pub clamped: f64,
}

impl RayCounts {
    /// Rays of every kind.
    pub fn total(&self) -> u64 {
        self.camera + self.shadow + self.secondary
    }

    /// Adds those of `other`.
    pub fn add(&mut self, other: &Self) {
        self.camera += other.camera;
        self.shadow += other.shadow;
        self.secondary += other.secondary;
        self.clamped += other.clamped;
    }
}

/// Rays that were not followed since their path had as many scattering events as it may have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CutOff {
    /// How many.
    pub rays: u64,
    /// What they count for in their samples, by their largest channel, summed up. Each would have added at
    /// most this share of the radiance that it would have brought back.
    pub weight: f64,
}

impl CutOff {
    /// Adds those of `other`.
    pub fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.weight += other.weight;
    }
}

/// A picture: the pixels of a rectangle of the film.
#[derive(Clone, Debug)]
pub struct Film {
    /// Which part of the film it is.
    pub rect: Rect,
    /// Its pixels, row by row.
    pub pixels: Vec<Pixel>,
    /// Layers that were asked for, in order: per pixel the mean over its samples, taken like that of
    /// their radiance ([`Pixel::mean_of_sums`]).
    pub layers: Vec<Vec<[f32; 3]>>,
    /// Per pixel the instances of the scene that cover it, by their numbers, and the shares of it that
    /// they cover; empty where nobody asked.
    pub objects: Vec<Vec<(u32, f32)>>,
    /// Samples that were dropped since they are not finite.
    pub rejected: u64,
    /// The first of them, in the order of tiles.
    pub first_rejected: Option<RejectedSample>,
    /// Rays that were traced.
    pub rays: RayCounts,
    /// Rays that were cut off by the depth limit.
    pub cut_off: CutOff,
    /// Why it has no more samples.
    pub stopped_by: StoppedBy,
}

/// Why a render ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoppedBy {
    /// The samples that were asked for are there.
    Samples,
    /// The deadline.
    Time,
    /// The error is as small as was asked for.
    Error,
    /// The user.
    Interrupt,
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

    /// Variance of each pixel's value, without bias, though of one degree of freedom by pixel
    /// ([`Pixel::squared_error`]).
    pub fn variances(&self) -> Vec<Rgb> {
        let variance = |pixel: &Pixel| Rgb::from(pixel.squared_error().map(|v| v as f32));
        self.pixels.iter().map(variance).collect()
    }

    /// The means of each pixel's half number `half`, 0 or 1; black where it has no samples.
    pub fn half(&self, half: usize) -> Vec<Rgb> {
        let mean = |pixel: &Pixel| Rgb::from(pixel.halves()[half].mean().map(|m| m as f32));
        self.pixels.iter().map(mean).collect()
    }

    /// Each pixel's part of the estimated √relMSE: the square root of the mean over the channels
    /// of its squared error over (value² + 0.01).
    pub fn errors(&self) -> Vec<f32> {
        let error = |pixel: &Pixel| {
            let square = pixel.relative_squared_error().unwrap_or(0.0);
            (square / 3.0).sqrt() as f32
        };
        self.pixels.iter().map(error).collect()
    }

    /// What [`ErrorEstimate`] is made from; `None` where the picture's pattern or its samples do not tell.
    pub fn error_sums(&self) -> Option<ErrorSums> {
        ErrorSums::of(&self.pixels)
    }

    /// How wrong the picture is; `None` where its pattern or its samples do not tell.
    pub fn error(&self) -> Option<ErrorEstimate> {
        ErrorEstimate::of(&self.pixels, self.rect.width as usize)
    }

    /// Share of the luminance of all samples that clamping took; 0 where it took nothing.
    pub fn clamped_share(&self) -> f64 {
        let taken = self.rays.clamped;
        if taken <= 0.0 {
            return 0.0;
        }
        let of_half = |half: &Moments| {
            let [r, g, b] = half.mean().map(|m| m as f32);
            half.count() as f64 * f64::from(Rgb::new(r, g, b).luminance())
        };
        let halves = self.pixels.iter().flat_map(|pixel| pixel.halves());
        let kept: f64 = halves.map(of_half).sum();
        taken / (taken + kept)
    }

    /// Smallest, mean and largest number of samples of a pixel.
    pub fn sample_counts(&self) -> (u64, f64, u64) {
        let count = |pixel: &Pixel| [pixel.count(); 3];
        let both = |a: [u64; 3], b: [u64; 3]| [a[0].min(b[0]), a[1] + b[1], a[2].max(b[2])];
        let counts = self.pixels.par_iter().map(count);
        let [least, total, most] = counts.reduce(|| [u64::MAX, 0, 0], both);
        let pixels = self.pixels.len().max(1);
        (least.min(most), total as f64 / pixels as f64, most)
    }
}
