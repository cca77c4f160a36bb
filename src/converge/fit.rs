//! How the error falls with the number of samples, and what of it stays.

use serde::Serialize;

use crate::report::power_law::PowerLaw;

/// `error² = bias² + factor · N^-exponent`, fitted to a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorLaw {
    /// Decades of error (not squared) for each decade of samples: half of minus the exponent.
    pub slope: f64,
    /// Ends of the slope's 95 % interval, from the scatter of the points about the curve: lower
    /// and upper.
    pub slope_interval: [f64; 2],
    /// The squared error that more samples do not take away; 0 where the points fit no worse
    /// without.
    pub bias_squared: f64,
    /// The squared error of one sample, without the bias.
    pub factor: f64,
    /// Points that it was fitted to.
    pub points: usize,
}

/// The exponents that a curve with a bias is tried with.
const EXPONENTS: (f64, f64) = (0.1, 5.0);
const EXPONENT_STEPS: usize = 245;
/// Steps in which the share of the bias is looked for before it is refined.
const SHARE_STEPS: usize = 40;
/// Mean squared relative distances from a curve that are rounding and nothing else.
const ROUNDING: f64 = 1e-20;

impl ErrorLaw {
    /// Least squares over the logarithms of `(samples, squared error)`.
    ///
    /// A bias is in it where it makes the fit better than chance would (F test, 95 %). `None` where a
    /// slope cannot be told: fewer than three points, or numbers that are not positive.
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let plain = PowerLaw::fit(points)?;
        Self::with_bias(points, &plain).or_else(|| {
            let half_width = student(points.len() - 2) * plain.standard_error;
            Some(Self {
                slope: 0.5 * plain.exponent,
                slope_interval: [-1.0, 1.0].map(|side| 0.5 * (plain.exponent + side * half_width)),
                bias_squared: 0.0,
                factor: plain.factor,
                points: points.len(),
            })
        })
    }

    /// The fit with a bias, where it is called for.
    fn with_bias(points: &[(f64, f64)], plain: &PowerLaw) -> Option<Self> {
        let degrees = points.len().checked_sub(3).filter(|&degrees| degrees > 0)?;
        let significant = student(degrees).powi(2) / degrees as f64;
        let step = (EXPONENTS.1 - EXPONENTS.0) / EXPONENT_STEPS as f64;
        let fits: Vec<Trial> = (0..=EXPONENT_STEPS)
            .map(|i| Trial::best(points, EXPONENTS.0 + i as f64 * step))
            .collect();
        let best = fits.iter().min_by(|a, b| a.squares.total_cmp(&b.squares))?;
        let without = Trial::new(points, -plain.exponent, 0.0).squares;
        let is_rounding = without < ROUNDING * points.len() as f64;
        if best.share == 0.0 || is_rounding || without <= best.squares * (1.0 + significant) {
            return None;
        }
        // All exponents that fit no worse than chance allows.
        let allowed = best.squares * (1.0 + significant);
        let inside = || fits.iter().filter(|fit| fit.squares <= allowed);
        let ends = [
            inside().map(|fit| fit.exponent).fold(f64::MIN, f64::max) + 0.5 * step,
            inside().map(|fit| fit.exponent).fold(f64::MAX, f64::min) - 0.5 * step,
        ];
        Some(Self {
            slope: -0.5 * best.exponent,
            slope_interval: ends.map(|exponent| -0.5 * exponent),
            bias_squared: best.factor * best.share,
            factor: best.factor,
            points: points.len(),
        })
    }
}

/// `factor · (share + N^-exponent)`, with the factor that fits best.
#[derive(Clone, Copy)]
struct Trial {
    exponent: f64,
    share: f64,
    factor: f64,
    /// Sum of the squared differences of logarithms.
    squares: f64,
}

impl Trial {
    fn new(points: &[(f64, f64)], exponent: f64, share: f64) -> Self {
        let distance = |&(n, square): &(f64, f64)| square.ln() - (share + n.powf(-exponent)).ln();
        let mean = points.iter().map(distance).sum::<f64>() / points.len() as f64;
        Self {
            exponent,
            share,
            factor: mean.exp(),
            squares: points.iter().map(|p| (distance(p) - mean).powi(2)).sum(),
        }
    }

    /// With the share that fits best; 0 may.
    fn best(points: &[(f64, f64)], exponent: f64) -> Self {
        let of_log = |log: f64| Self::new(points, exponent, log.exp());
        let powers = || points.iter().map(|p| -exponent * p.0.ln());
        let low = powers().fold(f64::INFINITY, f64::min) - 6.0;
        let high = powers().fold(f64::NEG_INFINITY, f64::max) + 6.0;
        let step = (high - low) / SHARE_STEPS as f64;
        let steps = (0..=SHARE_STEPS).map(|i| low + i as f64 * step);
        let squares = |log: f64| of_log(log).squares;
        let start = steps.min_by(|&a, &b| squares(a).total_cmp(&squares(b)));
        let start = start.unwrap_or(low);
        let fitted = of_log(least(squares, start - step, start + step));
        let without = Self::new(points, exponent, 0.0);
        if fitted.squares < without.squares {
            fitted
        } else {
            without
        }
    }
}

/// Where `f`, which has one valley between `low` and `high`, is least (Kiefer 1953, "Sequential
/// Minimax Search for a Maximum").
fn least(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    for _ in 0..25 {
        let (a, b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        if f(a) < f(b) {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}

/// The 97.5 % quantile of Student's t, within 1 % (Abramowitz and Stegun 1964, 26.7.5).
fn student(degrees: usize) -> f64 {
    let z: f64 = 1.959_964;
    let n = degrees as f64;
    match degrees {
        0 => f64::INFINITY,
        1 => 12.706,
        2 => 4.303,
        _ => {
            let first = (z.powi(3) + z) / 4.0;
            let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
            let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
            z + first / n + second / n.powi(2) + third / n.powi(3)
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Doubling numbers of samples with errors off the law by `scatter`, up and down in turn.
    fn curve(bias_squared: f64, factor: f64, exponent: f64, scatter: f64) -> Vec<(f64, f64)> {
        (0..11)
            .map(|i| {
                let n = f64::from(1 << i);
                let off = 1.0 + scatter * [1.0, -1.0, 0.3, -0.6, 0.2][i as usize % 5];
                (n, off * (bias_squared + factor * n.powf(-exponent)))
            })
            .collect()
    }

    #[test]
    fn exact_laws_are_recovered() {
        for exponent in [0.5, 1.0, 1.5, 2.0] {
            let fit = ErrorLaw::fit(&curve(0.0, 0.3, exponent, 0.0)).unwrap();
            assert!((fit.slope + 0.5 * exponent).abs() < 1e-9, "{fit:?}");
            assert!(fit.bias_squared == 0.0 && (fit.factor - 0.3).abs() < 1e-9);
            let fit = ErrorLaw::fit(&curve(1e-3, 0.3, exponent, 0.0)).unwrap();
            assert!((fit.slope + 0.5 * exponent).abs() < 0.006, "{fit:?}");
            assert!((fit.bias_squared / 1e-3 - 1.0).abs() < 0.02, "{fit:?}");
        }
    }

    #[test]
    fn intervals_hold_the_slope_of_scattered_points() {
        for bias_squared in [0.0, 1e-3] {
            let fit = ErrorLaw::fit(&curve(bias_squared, 0.3, 1.0, 0.08)).unwrap();
            let [low, high] = fit.slope_interval;
            assert!(low < -0.5 && -0.5 < high && high - low < 0.25, "{fit:?}");
            assert!(low < fit.slope && fit.slope < high, "{fit:?}");
            let off = (fit.bias_squared - bias_squared).abs();
            assert!(off <= 0.25 * bias_squared, "{fit:?}");
        }
    }

    #[test]
    fn a_bias_needs_more_points_than_unknowns() {
        let few = &curve(1e-3, 0.3, 1.0, 0.0);
        assert_eq!(ErrorLaw::fit(&few[8..]).unwrap().bias_squared, 0.0);
        assert_eq!(ErrorLaw::fit(&few[9..]), None);
    }

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (degrees, quantile) in [(3, 3.182), (5, 2.571), (10, 2.228), (30, 2.042)] {
            assert!((student(degrees) / quantile - 1.0).abs() < 0.01);
        }
    }
}
