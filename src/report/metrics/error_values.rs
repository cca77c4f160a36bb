//! An error for every pixel.

use super::Pair;
use crate::math::UVec2;

/// An error for every pixel of a [`Pair`].
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorValues {
    /// Pixels across and down.
    pub size: UVec2,
    /// Row by row from the top; `None` where a pixel is not finite in one of the pictures.
    pub values: Vec<Option<f32>>,
}

impl ErrorValues {
    /// `values` of all pixels of `pair`, of which only those that count are kept.
    pub(super) fn of(pair: &Pair, values: impl Iterator<Item = f32>) -> Self {
        let counted = pair.is_counted().iter();
        Self {
            size: pair.size(),
            values: values
                .zip(counted)
                .map(|(value, is_counted)| is_counted.then_some(value))
                .collect(),
        }
    }

    /// The mean over the pixels that count; 0 where there are none.
    pub fn mean(&self) -> f64 {
        let (sum, count) = self
            .values
            .iter()
            .flatten()
            .fold((0.0, 0u64), |(sum, count), &value| {
                (sum + f64::from(value), count + 1)
            });
        sum / count.max(1) as f64
    }
}
