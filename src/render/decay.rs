//! How fast the error of a render falls, as its own passes tell.

use crate::film::ErrorSums;
use crate::sampling::Pattern;

/// Standard deviation of the exponent of a pattern whose points avoid each other, before anything is seen: at edges
/// alone it is what theory says, of light that is scattered again and again it is hardly more than 1.
const UNSURE: f64 = 0.4;
/// By how much the exponent wanders while the number of samples grows e-fold: what falls fast is soon gone.
const DRIFT: f64 = 0.1;
/// What it may be: 0 is no fall at all, 3 that of a smooth function.
const POSSIBLE: std::ops::RangeInclusive<f64> = 0.5..=3.0;

/// The power of the number of samples with which the squared error falls, and how sure that is
/// (Kalman 1960, "A New Approach to Linear Filtering and Prediction Problems", in one dimension).
#[derive(Clone, Copy, Debug)]
pub(super) struct Decay {
    exponent: f64,
    variance: f64,
}

impl Decay {
    /// What is known of `pattern` by itself. Squared errors fall with the number of samples where those, or
    /// rounds of jittered cells, are independent; those of nets at edges by Ramamoorthi et al. 2012, "A Theory of Monte
    /// Carlo Visibility Sampling".
    pub fn of(pattern: Pattern) -> Self {
        let (exponent, deviation) = match pattern {
            Pattern::Grid | Pattern::Jittered | Pattern::Random => (1.0, 0.0),
            Pattern::Sobol => (1.5, UNSURE),
        };
        Self {
            exponent,
            variance: deviation * deviation,
        }
    }

    /// The best guess.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// Takes a pass into account after which the squared error was foreseen to be `fall` times what it was, by
    /// this exponent.
    pub fn learn(&mut self, fall: f64, before: &ErrorSums, after: &ErrorSums) {
        // In powers of e by which the samples grew where the error is.
        let growth = -fall.ln() / self.exponent;
        let seen = (before.sum() / after.sum()).ln() / growth;
        if self.variance == 0.0 || !(growth > 0.0 && seen.is_finite()) {
            return;
        }
        // A sum of k squares of normal deviates has a relative variance of 2/k.
        let relative = |sums: &ErrorSums| 2.0 / sums.degrees_of_freedom();
        let noise = (relative(before) + relative(after)) / (growth * growth);
        self.variance += DRIFT * DRIFT * growth;
        let gain = self.variance / (self.variance + noise);
        self.exponent += gain * (seen - self.exponent);
        self.exponent = (self.exponent).clamp(*POSSIBLE.start(), *POSSIBLE.end());
        self.variance *= 1.0 - gain;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error of many pixels alike, after `samples` of each.
    fn sums(samples: f64, exponent: f64, pixels: u32) -> ErrorSums {
        let mut sums = ErrorSums::default();
        for i in 0..pixels {
            // Squares of deviates, about: a few are large.
            let square = if i % 3 == 0 { 3.0 } else { 0.0 };
            sums.add(square * samples.powf(-exponent));
        }
        sums
    }

    fn learned(pattern: Pattern, truth: f64, pixels: u32) -> f64 {
        let mut decay = Decay::of(pattern);
        for k in 1..5 {
            let samples = f64::from(1 << k);
            let fall = 2f64.powf(-decay.exponent());
            let (before, after) = (samples, 2.0 * samples);
            let [before, after] = [before, after].map(|n| sums(n, truth, pixels));
            decay.learn(fall, &before, &after);
        }
        decay.exponent()
    }

    #[test]
    fn passes_teach_the_exponent_of_nets() {
        for truth in [0.9, 1.0, 1.3, 2.0] {
            let exponent = learned(Pattern::Sobol, truth, 100_000);
            assert!((exponent - truth).abs() < 0.01, "{exponent} for {truth}");
        }
        assert_eq!(learned(Pattern::Random, 2.0, 100_000), 1.0);
    }

    #[test]
    fn what_a_few_pixels_say_is_doubted() {
        let exponent = learned(Pattern::Sobol, 1.0, 12);
        assert!((1.02..1.5).contains(&exponent), "{exponent}");
        let mut decay = Decay::of(Pattern::Sobol);
        let none = ErrorSums::default();
        decay.learn(0.5, &none, &none);
        decay.learn(1.0, &sums(1.0, 1.0, 9), &sums(1.0, 1.0, 9));
        assert_eq!(decay.exponent(), 1.5);
    }
}
