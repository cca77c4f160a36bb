//! How long a method takes until its error is small enough.

use serde::Serialize;

/// The relMSE that is asked for.
pub const GOALS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];

/// When a curve reaches a goal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "known", content = "seconds", rename_all = "snake_case")]
pub enum Reached {
    /// After about this many seconds, between two points that were measured.
    About(f64),
    /// With its first point, which took this many seconds, or with one whose error is below
    /// the noise of the reference: no later than that.
    AtMost(f64),
    /// Not within the seconds of its last point.
    Not(f64),
    /// The goal is below the noise of the reference, and the curve gets there.
    BelowTheFloor,
}

impl Reached {
    /// The seconds, where they are known at least from above.
    pub fn seconds(self) -> Option<f64> {
        match self {
            Self::About(seconds) | Self::AtMost(seconds) => Some(seconds),
            Self::Not(_) | Self::BelowTheFloor => None,
        }
    }
}

/// A point of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// What it took.
    pub seconds: f64,
    /// Its relMSE; `None` where that is below `floor`.
    pub relmse: Option<f64>,
    /// The least relMSE that is known.
    pub floor: f64,
}

/// When the curve, in the order of its points, first reaches `goal`: between points errors follow a
/// power of the time. `None` for a curve without points.
pub fn time_to(goal: f64, curve: &[Step]) -> Option<Reached> {
    let last = curve.last()?;
    let mut before: Option<(f64, f64)> = None;
    for step in curve {
        match (step.relmse, before) {
            (None, _) if step.floor > goal => return Some(Reached::BelowTheFloor),
            (None, _) => return Some(Reached::AtMost(step.seconds)),
            (Some(error), None) if error <= goal => return Some(Reached::AtMost(step.seconds)),
            (Some(error), Some((seconds, worse))) if error <= goal => {
                let share = (worse / goal).ln() / (worse / error).ln();
                let factor = (step.seconds / seconds).powf(share);
                return Some(Reached::About(seconds * factor));
            }
            (Some(error), _) => before = Some((step.seconds, error)),
        }
    }
    Some(Reached::Not(last.seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(errors: &[Option<f64>]) -> Vec<Step> {
        (0i32..)
            .zip(errors)
            .map(|(i, &relmse)| Step {
                seconds: 4f64.powi(i),
                relmse,
                floor: 2e-5,
            })
            .collect()
    }

    #[test]
    fn goals_are_reached_between_points() {
        let curve = curve(&[Some(1e-2), Some(1e-3), Some(1e-4), None]);
        let Some(Reached::About(seconds)) = time_to(10f64.powf(-3.5), &curve) else {
            panic!("{:?}", time_to(1e-4, &curve));
        };
        assert!((seconds - 8.0).abs() < 1e-9);
        assert_eq!(time_to(0.1, &curve), Some(Reached::AtMost(1.0)));
    }

    #[test]
    fn what_the_noise_hides_is_not_told() {
        let hidden = curve(&[Some(1e-2), None]);
        assert_eq!(time_to(1e-5, &hidden), Some(Reached::BelowTheFloor));
        assert_eq!(time_to(1e-4, &hidden), Some(Reached::AtMost(4.0)));
        let short = curve(&[Some(1e-2), Some(1e-3)]);
        assert_eq!(time_to(1e-4, &short), Some(Reached::Not(4.0)));
        assert_eq!(time_to(1e-4, &[]), None);
    }
}
