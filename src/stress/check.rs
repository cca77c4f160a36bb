//! What was tried, what came out, and the verdict.

use serde::Serialize;

/// The verdict on a check or a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// There is no right answer, for a reason that the note gives.
    Refused,
    /// Within the bound.
    Pass,
    /// Outside of the bound, by a known shortfall that the note gives.
    Degraded,
    /// Outside of the bound.
    Fail,
}

impl Status {
    /// As in tables and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Refused => "refused",
            Self::Pass => "pass",
            Self::Degraded => "degraded",
            Self::Fail => "fail",
        }
    }
}

/// One measurement with its bound.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// What was tried, and what is measured of it.
    pub tried: String,
    /// What was measured: the worst of all that was tried.
    pub measured: f64,
    /// The most that it may be.
    pub bound: f64,
    /// The verdict.
    pub status: Status,
    /// Why it is not a plain pass; where the worst was met.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// How the measurement depends on what was varied.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sweep: Option<Sweep>,
}

/// Measurements against what was varied.
#[derive(Clone, Debug, Serialize)]
pub struct Sweep {
    /// What was varied, with its unit.
    pub x: &'static str,
    /// What was measured, with its unit.
    pub y: &'static str,
    /// One or more.
    pub curves: Vec<Curve>,
}

/// One curve of a [`Sweep`].
#[derive(Clone, Debug, Serialize)]
pub struct Curve {
    /// What tells it from the others.
    pub name: String,
    /// Varied, measured.
    pub points: Vec<(f64, f64)>,
}

impl Check {
    /// A measurement that may be `bound` at most. What is not a number is outside of every bound.
    pub fn at_most(tried: impl Into<String>, measured: f64, bound: f64) -> Self {
        Self {
            tried: tried.into(),
            measured,
            bound,
            status: if measured <= bound {
                Status::Pass
            } else {
                Status::Fail
            },
            note: None,
            sweep: None,
        }
    }

    /// A number of things that must not be.
    pub fn none(tried: impl Into<String>, count: u64) -> Self {
        Self::at_most(tried, count as f64, 0.0)
    }

    /// The worst of a sweep, which may be `bound` at most everywhere; what is not a number is the worst.
    pub fn worst(tried: impl Into<String>, bound: f64, sweep: Sweep) -> Self {
        let points = sweep.curves.iter().flat_map(|curve| &curve.points);
        let worst = points.fold(0.0, |worst: f64, &(_, y)| {
            if worst.is_nan() || y <= worst {
                worst
            } else {
                y
            }
        });
        Self {
            sweep: Some(sweep),
            ..Self::at_most(tried, worst, bound)
        }
    }

    /// This, with a remark.
    pub fn noted(mut self, note: impl Into<String>) -> Self {
        self.note = Some(note.into());
        self
    }

    /// This, with a sweep to show.
    pub fn shown(mut self, sweep: Sweep) -> Self {
        self.sweep = Some(sweep);
        self
    }

    /// A failure up to `limit` is a known shortfall, for this reason.
    pub fn or_degraded(mut self, limit: f64, why: &str) -> Self {
        if self.status == Status::Fail && self.measured <= limit {
            self.status = Status::Degraded;
            self.note = Some(why.to_owned());
        }
        self
    }

    /// This, where no answer is right, for this reason.
    pub fn refused(mut self, why: impl Into<String>) -> Self {
        self.status = Status::Refused;
        self.note = Some(why.into());
        self
    }

    /// Measured in bounds.
    fn severity(&self) -> f64 {
        if self.bound > 0.0 {
            self.measured / self.bound
        } else {
            self.measured
        }
    }
}

impl Sweep {
    /// A sweep of one curve.
    pub fn of(x: &'static str, y: &'static str, points: Vec<(f64, f64)>) -> Self {
        let name = String::new();
        Self::several(x, y, vec![Curve { name, points }])
    }

    /// A sweep of several curves.
    pub fn several(x: &'static str, y: &'static str, curves: Vec<Curve>) -> Self {
        Self { x, y, curves }
    }
}

impl Curve {
    /// A curve with a name.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self {
            name: name.into(),
            points,
        }
    }
}

/// What a case came to.
#[derive(Clone, Debug)]
pub struct Report {
    /// Of the case.
    pub id: String,
    /// Its name.
    pub case: String,
    /// All that was tried.
    pub checks: Vec<Check>,
}

impl Report {
    /// The worst check; `None` where there is none.
    pub fn worst(&self) -> Option<&Check> {
        let key = |check: &Check| (check.status, check.severity());
        self.checks.iter().max_by(|a, b| {
            let (a, b) = (key(a), key(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
    }

    /// That of the worst check. What is refused counts only where all is.
    pub fn status(&self) -> Status {
        self.worst().map_or(Status::Fail, |check| check.status)
    }
}

/// How many standard errors the mean of `values` is off from `exact`, beyond a rounding of 1e-6: samples are made of
/// single-precision numbers.
pub(super) fn deviation(values: &[f64], exact: f64) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    let error = ((mean - exact).abs() - 1e-6 * exact.abs()).max(0.0);
    if error == 0.0 {
        0.0
    } else {
        error / (squares / (n * (n - 1.0))).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_fails() {
        let points = |y| Sweep::of("x", "y", vec![(1.0, 0.1), (2.0, y), (3.0, 0.2)]);
        assert_eq!(Check::worst("", 1.0, points(f64::NAN)).status, Status::Fail);
        assert_eq!(Check::worst("", 1.0, points(0.5)).measured, 0.5);
        assert_eq!(Check::at_most("", f64::NAN, 1.0).status, Status::Fail);
    }

    #[test]
    fn a_shortfall_has_its_limit() {
        let status = |measured| {
            Check::at_most("", measured, 1.0)
                .or_degraded(2.0, "")
                .status
        };
        assert_eq!(
            [0.5, 1.5, 2.5].map(status),
            [Status::Pass, Status::Degraded, Status::Fail]
        );
    }

    #[test]
    fn a_case_is_as_bad_as_its_worst_check() {
        let report = |checks| Report {
            id: String::new(),
            case: String::new(),
            checks,
        };
        let refused = Check::none("", 9).refused("");
        let pass = Check::at_most("", 0.1, 1.0);
        let close = Check::at_most("", 0.9, 1.0);
        let fail = Check::none("", 1);
        assert_eq!(report(vec![refused.clone()]).status(), Status::Refused);
        let passed = report(vec![close.clone(), pass.clone(), refused]);
        assert_eq!(passed.status(), Status::Pass);
        assert_eq!(passed.worst().map(|check| check.measured), Some(0.9));
        assert_eq!(report(vec![fail, close]).status(), Status::Fail);
    }

    #[test]
    fn deviations_are_in_standard_errors() {
        let values = [0.9, 1.1, 0.9, 1.1];
        // The standard error is 0.1 / sqrt(3).
        assert!((deviation(&values, 0.9) - 3f64.sqrt()).abs() < 1e-3);
        assert_eq!(deviation(&[1.0, 1.0], 1.0), 0.0);
        assert_eq!(deviation(&[1.0, 1.0], 0.9), f64::INFINITY);
    }
}
