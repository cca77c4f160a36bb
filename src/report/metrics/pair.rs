//! Two pictures that can be compared.

use thiserror::Error;

use crate::color::Rgb;
use crate::math::UVec2;
use crate::report::Picture;

/// A picture and its reference, of one size.
///
/// A pixel that is not finite in one of them counts in no mean. Metrics that look at the
/// surroundings of a pixel find black in its place in both.
#[derive(Clone, Debug)]
pub struct Pair {
    size: UVec2,
    test: Vec<Rgb>,
    reference: Vec<Rgb>,
    is_counted: Vec<bool>,
    counted: usize,
    non_finite: [NonFinite; 2],
}

/// The pixels of one picture with a channel that is not a finite number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NonFinite {
    /// How many there are.
    pub count: usize,
    /// The first of them, row by row; `None` where there is none.
    pub first: Option<UVec2>,
}

/// Why two pictures cannot be compared.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum PairError {
    /// They are not of one size.
    #[error(
        "the sizes differ: {}x{} and {}x{} pixels",
        test.x, test.y, reference.x, reference.y
    )]
    SizesDiffer {
        /// Size of the picture that is measured.
        test: UVec2,
        /// Size of its reference.
        reference: UVec2,
    },
    /// There is nothing to take a mean of.
    #[error("no pixel is finite in both pictures")]
    NothingFinite,
}

impl Pair {
    /// `test` is measured against `reference`.
    ///
    /// # Errors
    /// Where the sizes differ, or no pixel is finite in both.
    pub fn new(test: &Picture, reference: &Picture) -> Result<Self, PairError> {
        if test.size != reference.size || test.pixels.len() != reference.pixels.len() {
            return Err(PairError::SizesDiffer {
                test: test.size,
                reference: reference.size,
            });
        }
        let both = || test.pixels.iter().zip(&reference.pixels);
        let is_counted: Vec<bool> = both()
            .map(|(a, b)| a.is_finite() && b.is_finite())
            .collect();
        let counted = is_counted.iter().filter(|&&is_counted| is_counted).count();
        if counted == 0 {
            return Err(PairError::NothingFinite);
        }
        let kept = |pixels: &[Rgb]| -> Vec<Rgb> {
            let both = pixels.iter().zip(&is_counted);
            both.map(|(&pixel, &is)| if is { pixel } else { Rgb::BLACK })
                .collect()
        };
        Ok(Self {
            size: test.size,
            test: kept(&test.pixels),
            reference: kept(&reference.pixels),
            is_counted,
            counted,
            non_finite: [non_finite(test), non_finite(reference)],
        })
    }

    /// Pixels across and down.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The pixels that are not finite, of the picture and of its reference.
    pub fn non_finite(&self) -> [NonFinite; 2] {
        self.non_finite
    }

    /// What is measured, black where a pixel does not count.
    pub(super) fn test(&self) -> &[Rgb] {
        &self.test
    }

    /// What it is measured against, black where a pixel does not count.
    pub(super) fn reference(&self) -> &[Rgb] {
        &self.reference
    }

    /// Whether each pixel is finite in both.
    pub(super) fn is_counted(&self) -> &[bool] {
        &self.is_counted
    }

    /// How many pixels are finite in both; at least 1.
    pub(super) fn counted(&self) -> usize {
        self.counted
    }

    /// The pixel of an index, row by row.
    pub(super) fn place(&self, index: usize) -> UVec2 {
        place(self.size, index)
    }
}

fn non_finite(picture: &Picture) -> NonFinite {
    let mut found = NonFinite::default();
    for (i, pixel) in picture.pixels.iter().enumerate() {
        if !pixel.is_finite() {
            found.count += 1;
            found.first = found.first.or(Some(place(picture.size, i)));
        }
    }
    found
}

fn place(size: UVec2, index: usize) -> UVec2 {
    let width = size.x.max(1) as usize;
    UVec2::new((index % width) as u32, (index / width) as u32)
}
