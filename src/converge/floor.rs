//! The noise of a reference, and what can be known of errors measured against it.

use serde::Serialize;

use crate::film::{ErrorSums, RELATIVE_FLOOR};
use crate::report::Picture;

/// The squared error of a reference, over all pixels, as its halves tell it.
///
/// The reference and what is measured are independent, so that the squared difference of the two is on
/// average the sum of their squared errors: the floor is subtracted. What is left is an error only where it
/// is larger than the floor could be by chance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Floor {
    /// As estimated; what is subtracted.
    pub estimate: f64,
    /// The upper end of its 95 % interval: smaller errors are not known. `null` in JSON where it
    /// has none, and no error is known.
    pub bound: f64,
}

impl Floor {
    /// The error of a picture that is `measured` from the reference, both squared; `None` where it
    /// is no larger than [`Self::bound`].
    pub fn subtracted(&self, measured: f64) -> Option<f64> {
        let error = measured - self.estimate;
        (error > self.bound).then_some(error)
    }

    fn of(sums: &ErrorSums) -> Self {
        let (estimate, high) = sums
            .estimate()
            .map_or((0.0, 0.0), |error| (error.estimate, error.high));
        Self {
            estimate: estimate.powi(2),
            bound: high.powi(2),
        }
    }
}

/// The floor of every squared error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Floors {
    /// Of relMSE.
    pub relmse: Floor,
    /// Of the mean squared error.
    pub mse: Floor,
}

impl Floors {
    /// Of a reference from its value and half the difference of its two halves, whose square is
    /// its variance in every pixel.
    pub fn of(picture: &Picture, noise: &Picture) -> Self {
        let (mut relative, mut absolute) = (ErrorSums::default(), ErrorSums::default());
        for (value, noise) in picture.pixels.iter().zip(&noise.pixels) {
            let both = value.channels().into_iter().zip(noise.channels());
            let (mut weighted, mut plain) = (0.0, 0.0);
            for (value, noise) in both.map(|(v, n)| (f64::from(v), f64::from(n))) {
                weighted += noise * noise / (value * value + RELATIVE_FLOOR);
                plain += noise * noise;
            }
            relative.add(weighted);
            absolute.add(plain);
        }
        Self {
            relmse: Floor::of(&relative),
            mse: Floor::of(&absolute),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::math::UVec2;

    #[test]
    fn the_floor_is_the_mean_variance() {
        let size = UVec2::new(10, 10);
        let picture = Picture::from_fn(size, |_, _| Rgb::splat(0.3));
        let noise = Picture::from_fn(size, |x, _| Rgb::splat(if x < 5 { 0.01 } else { -0.03 }));
        let floors = Floors::of(&picture, &noise);
        let variance = 0.5 * (0.01f64.powi(2) + 0.03f64.powi(2));
        assert!((floors.mse.estimate / variance - 1.0).abs() < 1e-6);
        assert!((floors.relmse.estimate / (variance / 0.1) - 1.0).abs() < 1e-6);
        assert!(floors.mse.bound > floors.mse.estimate);
    }

    #[test]
    fn errors_of_the_size_of_the_floor_are_not_known() {
        let floor = Floor {
            estimate: 1.0,
            bound: 1.2,
        };
        assert_eq!(floor.subtracted(4.0), Some(3.0));
        // Twice the noise of the reference: as good as the reference itself.
        assert_eq!(floor.subtracted(2.0), None);
        assert_eq!(floor.subtracted(0.0), None);
        let unknown = Floor {
            estimate: 1.0,
            bound: f64::INFINITY,
        };
        assert_eq!(unknown.subtracted(1e9), None);
    }
}
