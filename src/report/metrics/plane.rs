//! One number a pixel, and filters over it that are products of a row and a column.

use std::ops::{AddAssign, Mul};

use rayon::prelude::*;

use crate::math::UVec2;

/// A number that planes are made of: `f32` or `f64`.
pub trait Number: Copy + Default + Send + Sync + AddAssign + Mul<Output = Self> {}

impl<T: Copy + Default + Send + Sync + AddAssign + Mul<Output = T>> Number for T {}

/// One number for every pixel, row by row from the top.
#[derive(Clone, Debug)]
pub struct Plane<T> {
    size: UVec2,
    /// `size.x * size.y` numbers.
    pub values: Vec<T>,
}

impl<T: Number> Plane<T> {
    /// From `size.x * size.y` numbers; there is at least one.
    pub fn new(size: UVec2, values: Vec<T>) -> Self {
        debug_assert_eq!(values.len(), size.x as usize * size.y as usize);
        Self { size, values }
    }

    /// Weights every pixel's surroundings with `across` along the row and `down` along the
    /// column, both of odd length and centred on the pixel. Beyond the border the outermost
    /// pixels go on.
    pub fn filtered(&self, across: &[T], down: &[T]) -> Self {
        self.filtered_across(across).filtered_down(down)
    }

    /// [`Self::filtered`] along rows alone.
    pub fn filtered_across(&self, weights: &[T]) -> Self {
        let width = self.width();
        let radius = weights.len() / 2;
        let mut values = vec![T::default(); self.values.len()];
        let rows = values
            .par_chunks_mut(width)
            .zip(self.values.par_chunks(width));
        rows.for_each(|(sums, row)| {
            let before = std::iter::repeat_n(row[0], radius);
            let after = std::iter::repeat_n(row[width - 1], radius);
            let extended: Vec<T> = before.chain(row.iter().copied()).chain(after).collect();
            for (i, &weight) in weights.iter().enumerate() {
                add_scaled(sums, &extended[i..i + width], weight);
            }
        });
        Self::new(self.size, values)
    }

    /// [`Self::filtered`] along columns alone.
    pub fn filtered_down(&self, weights: &[T]) -> Self {
        let width = self.width();
        let radius = weights.len() / 2;
        let last = self.values.len() / width - 1;
        let mut values = vec![T::default(); self.values.len()];
        let rows = values.par_chunks_mut(width).enumerate();
        rows.for_each(|(y, sums)| {
            for (i, &weight) in weights.iter().enumerate() {
                let from = (y + i).saturating_sub(radius).min(last);
                add_scaled(sums, &self.values[from * width..(from + 1) * width], weight);
            }
        });
        Self::new(self.size, values)
    }

    fn width(&self) -> usize {
        self.size.x as usize
    }
}

fn add_scaled<T: Number>(sums: &mut [T], values: &[T], weight: T) {
    for (sum, &value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}
