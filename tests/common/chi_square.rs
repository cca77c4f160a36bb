//! Statistics of samples: Pearson's chi-square test, means with their standard error.

/// Probability that counts as uneven as `counts`, or more, come from bins of the probabilities
/// `expected` (they need not sum to 1; ratios count). Bins are meant to expect 10 samples or more.
pub fn p_value(counts: &[u64], expected: &[f64]) -> f64 {
    assert_eq!(counts.len(), expected.len());
    let samples: u64 = counts.iter().sum();
    let total: f64 = expected.iter().sum();
    let statistic: f64 = counts
        .iter()
        .zip(expected)
        .map(|(&count, &share)| {
            let expected = samples as f64 * share / total;
            assert!(
                expected >= 10.0,
                "only {expected} samples expected in a bin"
            );
            (count as f64 - expected).powi(2) / expected
        })
        .sum();
    survival(statistic, counts.len() - 1)
}

/// As [`p_value`], of equally likely bins.
pub fn uniform_p_value(counts: &[u64]) -> f64 {
    p_value(counts, &vec![1.0; counts.len()])
}

/// Probability that a chi-square variable of so many degrees of freedom exceeds `statistic`:
/// the upper regularised gamma function.
pub fn survival(statistic: f64, degrees: usize) -> f64 {
    let (a, x) = (0.5 * degrees as f64, 0.5 * statistic);
    let scale = (a * x.ln() - x - ln_gamma(a)).exp();
    if x <= 0.0 {
        1.0
    } else if x < a + 1.0 {
        // Series of the lower function.
        let mut term = 1.0 / a;
        let mut sum = term;
        for n in 1..10_000 {
            term *= x / (a + f64::from(n));
            sum += term;
        }
        1.0 - scale * sum
    } else {
        // Legendre's continued fraction, from its far end.
        let fraction = (1..10_000).rev().fold(0.0, |tail, n| {
            let n = f64::from(n);
            n * (n - a) / (x + 2.0 * n + 1.0 - a - tail)
        });
        scale / (x + 1.0 - a - fraction)
    }
}

/// Stirling's series, after moving the argument to where it is exact to 1e-13.
fn ln_gamma(mut a: f64) -> f64 {
    let mut product: f64 = 1.0;
    while a < 12.0 {
        product *= a;
        a += 1.0;
    }
    let series = 1.0 / (12.0 * a) - 1.0 / (360.0 * a.powi(3)) + 1.0 / (1260.0 * a.powi(5));
    (a - 0.5) * a.ln() - a + 0.5 * std::f64::consts::TAU.ln() + series - product.ln()
}

/// Mean and variance of what was added (Welford 1962).
#[derive(Clone, Copy, Debug, Default)]
pub struct Moments {
    count: f64,
    mean: f64,
    squares: f64,
}

impl Moments {
    pub fn add(&mut self, value: f64) {
        self.count += 1.0;
        let delta = value - self.mean;
        self.mean += delta / self.count;
        self.squares += delta * (value - self.mean);
    }

    pub fn mean(&self) -> f64 {
        self.mean
    }

    pub fn variance(&self) -> f64 {
        self.squares / (self.count - 1.0)
    }

    pub fn standard_error(&self) -> f64 {
        (self.variance() / self.count).sqrt()
    }

    /// Fails unless `exact` is within 4 standard errors, or rounding, of the mean.
    pub fn assert_mean(&self, exact: f64, what: &str) {
        let slack = 4.0 * self.standard_error() + 1e-6 * exact.abs();
        let error = self.mean - exact;
        assert!(
            error.abs() <= slack,
            "{what}: mean {} for {exact}, {:.1} standard errors off",
            self.mean,
            error / self.standard_error()
        );
    }
}

impl FromIterator<f64> for Moments {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut moments = Self::default();
        values.into_iter().for_each(|value| moments.add(value));
        moments
    }
}

/// Values from tables of the chi-square distribution.
#[test]
fn survival_is_that_of_the_tables() {
    for (statistic, degrees, exact) in [
        (3.841_459, 1, 0.05),
        (6.634_897, 1, 0.01),
        (18.307_038, 10, 0.05),
        (3.940_299, 10, 0.95),
        (124.342_113, 100, 0.05),
        (149.449_253, 100, 0.001),
    ] {
        let p = survival(statistic, degrees);
        assert!(
            (p - exact).abs() < 1e-6 + 1e-5 * exact,
            "{statistic}, {degrees}: {p} for {exact}"
        );
    }
}
