//! How one quantity grows with another.

/// `y = factor * x^exponent`, fitted to points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The slope of the line in a log-log plot.
    pub exponent: f64,
    /// Of the exponent, from the scatter of the points about the line.
    pub standard_error: f64,
    /// `y` at `x = 1`.
    pub factor: f64,
}

impl PowerLaw {
    /// Least squares over the logarithms of `(x, y)`.
    ///
    /// `None` where there are fewer than three points, all `x` are the same, or a number is not
    /// positive and finite.
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let is_positive = |v: f64| v > 0.0 && v.is_finite();
        if points.len() < 3
            || !points
                .iter()
                .all(|&(x, y)| is_positive(x) && is_positive(y))
        {
            return None;
        }
        let n = points.len() as f64;
        let logs: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (x.ln(), y.ln())).collect();
        let mean_x = logs.iter().map(|p| p.0).sum::<f64>() / n;
        let mean_y = logs.iter().map(|p| p.1).sum::<f64>() / n;
        let xx: f64 = logs.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
        let xy: f64 = logs.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
        if xx <= 0.0 {
            return None;
        }
        let exponent = xy / xx;
        let residual = |&(x, y): &(f64, f64)| y - mean_y - exponent * (x - mean_x);
        let squares: f64 = logs.iter().map(|p| residual(p).powi(2)).sum();
        Some(Self {
            exponent,
            standard_error: (squares / (n - 2.0) / xx).sqrt(),
            factor: (mean_y - exponent * mean_x).exp(),
        })
    }
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_found_exactly() {
        let points: Vec<_> = (1..9)
            .map(|i| (f64::from(i), 3.0 * f64::from(i).powf(-0.75)))
            .collect();
        let fit = PowerLaw::fit(&points).expect("a fit");
        assert!((fit.exponent + 0.75).abs() < 1e-12 && (fit.factor - 3.0).abs() < 1e-12);
        assert!(fit.standard_error < 1e-12);
    }

    /// Points at ln x = -1, 0, 1 that are off the line by 1, -2, 1 times d: the squares are 6 d², one
    /// degree of freedom is left, and the variance of x is 2.
    #[test]
    fn scatter_shows_in_the_standard_error() {
        let d = 0.01f64;
        let point = |x: f64, off: f64| (x.exp(), (2.0 * x + off * d).exp());
        let fit = PowerLaw::fit(&[point(-1.0, 1.0), point(0.0, -2.0), point(1.0, 1.0)]);
        let fit = fit.expect("a fit");
        assert!((fit.exponent - 2.0).abs() < 1e-12);
        assert!((fit.standard_error - 3f64.sqrt() * d).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_slope_is_refused() {
        assert_eq!(PowerLaw::fit(&[(1.0, 1.0), (2.0, 2.0)]), None);
        assert_eq!(PowerLaw::fit(&[(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)]), None);
        assert_eq!(PowerLaw::fit(&[(1.0, 1.0), (2.0, 0.0), (3.0, 1.0)]), None);
    }
}
