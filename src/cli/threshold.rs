//! Thresholds for figures: `relmse=1e-4`.

use halfshade::import::scene_file::suggestion;
use halfshade::report::metrics::{Figures, Metric};

/// A figure and the value that it must not pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    metric: Metric,
    value: f64,
}

impl Threshold {
    /// An upper limit, of a metric that grows with the error.
    pub fn above(text: &str) -> Result<Self, String> {
        parsed(text, false)
    }

    /// A lower limit, of a metric that grows with likeness.
    pub fn below(text: &str) -> Result<Self, String> {
        parsed(text, true)
    }

    /// Why `figures` are beyond it; `None` where they are not.
    pub fn failure(self, figures: &Figures) -> Option<String> {
        let (name, limit) = (self.metric.name(), self.value);
        let Some(value) = self.metric.of(figures) else {
            return Some(format!("{name} is not known of pictures this small"));
        };
        if self.metric.grows_with_likeness() {
            (value < limit).then(|| format!("{name} is {value}, below {limit}"))
        } else {
            (value > limit).then(|| format!("{name} is {value}, above {limit}"))
        }
    }
}

fn parsed(text: &str, grows_with_likeness: bool) -> Result<Threshold, String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("not of the form METRIC=VALUE, like relmse=1e-4")?;
    let (name, value) = (name.trim(), value.trim());
    let Some(&metric) = Metric::ALL.iter().find(|metric| metric.name() == name) else {
        let known: Vec<&str> = Metric::ALL.iter().map(|metric| metric.name()).collect();
        let suggestion = suggestion(name, &known);
        return Err(format!("\"{name}\" is no metric; {suggestion}"));
    };
    if metric.grows_with_likeness() != grows_with_likeness {
        let (better, option) = if grows_with_likeness {
            ("smaller", "--fail-above")
        } else {
            ("larger", "--fail-below")
        };
        return Err(format!("{name} is better the {better} it is; use {option}"));
    }
    let value: Option<f64> = value.parse().ok().filter(|value: &f64| value.is_finite());
    let value = value.ok_or_else(|| format!("the limit of {name} is not a number"))?;
    Ok(Threshold { metric, value })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_metrics_with_numbers() {
        let limit = Threshold {
            metric: Metric::RelMse,
            value: 1e-4,
        };
        assert_eq!(Threshold::above("relmse = 1e-4"), Ok(limit));
        for (text, expected) in [
            ("relmse", "METRIC=VALUE"),
            ("relmes=1", "did you mean \"relmse\"?"),
            ("loss=1", "known: rmse, relmse"),
            ("rmse=nan", "not a number"),
            ("rmse=", "not a number"),
            ("psnr=30", "--fail-below"),
        ] {
            let error = Threshold::above(text).unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
        assert!(Threshold::below("ssim=0.9").is_ok());
        assert!(
            Threshold::below("flip=0.9")
                .unwrap_err()
                .contains("--fail-above")
        );
    }
}
