//! How fast the error of a render falls, as its own passes tell.

use crate::film::ErrorSums;
use crate::sampling::Pattern;
use crate::scene::IntegratorKind;

/// Standard deviation of the exponent of a pattern whose points avoid each other, before anything is seen.
const UNSURE: f64 = 0.1;
/// Standard deviation of the logarithm of what a pass makes of the error, about what would come of it in the long run: it is
/// known only roughly where the error is, and samples come in powers of two.
const UNEVEN: f64 = 0.17;

/// The power of the number of samples with which the squared error falls, and how sure that is
/// (Kalman 1960, "A New Approach to Linear Filtering and Prediction Problems", in one dimension).
#[derive(Clone, Copy, Debug)]
pub(super) struct Decay {
    exponent: f64,
    variance: f64,
}

impl Decay {
    /// What is known of `pattern` and `technique` by themselves. Squared errors fall with the number of samples where
    /// those, or rounds of jittered cells, are independent; those of nets at edges with its power 1.5 by Ramamoorthi
    /// et al. 2012, "A Theory of Monte Carlo Visibility Sampling". Light that is scattered again and again is a matter of
    /// so many numbers that nets are hardly better there than independent points; that is seen of a path beside the edges.
    pub fn of(pattern: Pattern, technique: IntegratorKind) -> Self {
        let (exponent, deviation) = match (pattern, technique) {
            (Pattern::Grid | Pattern::Jittered | Pattern::Random, _) => (1.0, 0.0),
            (Pattern::Sobol, IntegratorKind::Path) => (1.1, UNSURE),
            (Pattern::Sobol, _) => (1.5, UNSURE),
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
        let noise = relative(before) + relative(after) + UNEVEN * UNEVEN;
        let gain = self.variance / (self.variance + noise / (growth * growth));
        // No fall at all to that of smooth functions: all that there is.
        self.exponent += gain * (seen.clamp(0.0, 3.0) - self.exponent);
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

    /// After this many passes that double the samples.
    fn learned(pattern: Pattern, truth: f64, pixels: u32, passes: u32) -> f64 {
        let mut decay = Decay::of(pattern, IntegratorKind::Whitted);
        for k in 1..=passes {
            let fall = 2f64.powf(-decay.exponent());
            let [before, after] = [k, k + 1].map(|k| sums(f64::from(k).exp2(), truth, pixels));
            decay.learn(fall, &before, &after);
        }
        decay.exponent()
    }

    #[test]
    fn passes_teach_the_exponent_of_nets() {
        for truth in [0.9, 1.0, 1.3, 2.0] {
            let [few, many] = [3, 60].map(|passes| learned(Pattern::Sobol, truth, 100_000, passes));
            let [few, many] = [few, many].map(|exponent| (exponent - truth) / (1.5 - truth));
            assert!(
                (0.3..0.9).contains(&few),
                "{few} of what is not known for {truth}"
            );
            assert!(
                (0.0..0.15).contains(&many),
                "{many} of it after many passes"
            );
        }
        assert_eq!(learned(Pattern::Random, 2.0, 100_000, 9), 1.0);
    }

    #[test]
    fn what_a_few_pixels_say_is_doubted() {
        let [few, many] = [12, 100_000].map(|pixels| learned(Pattern::Sobol, 1.0, pixels, 4));
        assert!(many < few && few < 1.5, "{many} {few}");
        let mut decay = Decay::of(Pattern::Sobol, IntegratorKind::Whitted);
        let none = ErrorSums::default();
        decay.learn(0.5, &none, &none);
        decay.learn(1.0, &sums(1.0, 1.0, 9), &sums(1.0, 1.0, 9));
        assert_eq!(decay.exponent(), 1.5);
    }
}
