//! What a render that has a limit is going to need, and to reach.

use std::fmt;
use std::time::Instant;

use super::Limits;
use super::allot::Outcome;
use super::course::Course;
use crate::film::StoppedBy;

/// What is expected of a render, once a part of it is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Seconds that it will have taken, from its start.
    pub seconds: f64,
    /// Its √relMSE at the end.
    pub error: f64,
    /// Its √relMSE now.
    pub error_now: f64,
    /// Camera samples in all at the end.
    pub samples: u64,
    /// Which limit ends it.
    pub stopped_by: StoppedBy,
}

impl fmt::Display for Forecast {
    /// Like `about 41 s for 0.01, at present 0.034`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            seconds,
            error,
            error_now,
            ..
        } = self;
        let seconds = Significant(*seconds);
        let (error, error_now) = (Significant(*error), Significant(*error_now));
        match self.stopped_by {
            StoppedBy::Error => write!(f, "about {seconds} s for {error}, at present {error_now}"),
            _ => write!(f, "about {error} after {seconds} s, at present {error_now}"),
        }
    }
}

/// A number with its first three digits that tell something, zeros at the end left out.
pub struct Significant(pub f64);

impl fmt::Display for Significant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let x = self.0;
        if x == 0.0 || !x.is_finite() {
            return write!(f, "{x}");
        }
        let decimals = 2 - x.abs().log10().floor() as i32;
        match decimals {
            ..=0 => write!(f, "{x:.0}"),
            1..=8 => {
                let text = format!("{x:.*}", decimals as usize);
                f.write_str(text.trim_end_matches('0').trim_end_matches('.'))
            }
            _ => write!(f, "{x:.1e}"),
        }
    }
}

/// Measures how fast a render is.
pub(super) struct Pace {
    start: Instant,
    /// With a deadline: when the first samples were there, and how many rays they took. They warm everything up, and do
    /// not count.
    warm: Option<(f64, f64)>,
}

impl Pace {
    pub fn start() -> Self {
        Self {
            start: Instant::now(),
            warm: None,
        }
    }

    /// Seconds since the start.
    pub fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// The first samples are there.
    pub fn warmed_up(&mut self, rays: f64) {
        self.warm = Some((self.seconds(), rays));
    }

    /// When `rays` in all will be there, in seconds from the start, after `now` rays.
    pub fn seconds_at(&self, rays: f64, now: f64) -> f64 {
        let seconds = self.seconds();
        let (since, before) = self
            .warm
            .filter(|(_, before)| *before < now)
            .unwrap_or((0.0, 0.0));
        seconds + (rays - now) * (seconds - since) / (now - before).max(1.0)
    }

    fn seconds_until(&self, instant: Instant) -> f64 {
        instant.saturating_duration_since(self.start).as_secs_f64()
    }
}

/// What keeps an outcome within the limits.
pub(super) struct Bounds<'a> {
    pub limits: &'a Limits,
    pub pace: &'a Pace,
    /// Samples of the whole picture.
    pub most_samples: u64,
    pub now: Outcome,
    /// √relMSE now.
    pub error_now: f64,
}

impl Bounds<'_> {
    /// √relMSE at `outcome`.
    pub fn error(&self, outcome: &Outcome) -> f64 {
        if self.now.error > 0.0 {
            self.error_now * (outcome.error / self.now.error).sqrt()
        } else {
            self.error_now
        }
    }

    pub fn is_in_time(&self, outcome: &Outcome) -> bool {
        self.limits
            .deadline
            .is_none_or(|deadline| self.seconds(outcome) <= self.pace.seconds_until(deadline))
    }

    /// Whether the error is still larger than what is asked for, times `share`.
    pub fn is_short_of(&self, outcome: &Outcome, share: f64) -> bool {
        self.limits
            .error
            .is_none_or(|error| self.error(outcome) > share * error)
    }

    fn seconds(&self, outcome: &Outcome) -> f64 {
        self.pace.seconds_at(outcome.rays, self.now.rays)
    }

    /// Where `course` leads to.
    pub fn forecast(&self, course: &Course) -> Forecast {
        let is_possible = |o: &Outcome| o.samples <= self.most_samples && self.is_in_time(o);
        let mut end = course.furthest(is_possible).outcome;
        let mut error = self.error(&end);
        let mut stopped_by = StoppedBy::Time;
        if let Some(enough) = self.limits.error.filter(|enough| error <= *enough) {
            let before = |o: &Outcome| is_possible(o) && self.is_short_of(o, 1.0);
            end = course.furthest(before).outcome;
            error = enough;
            stopped_by = StoppedBy::Error;
        } else if self.limits.deadline.is_none()
            || 1.1 * end.samples as f64 > self.most_samples as f64
        {
            stopped_by = StoppedBy::Samples;
        }
        Forecast {
            seconds: self.seconds(&end),
            error,
            error_now: self.error_now,
            samples: end.samples,
            stopped_by,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forecasts_read_well() {
        let mut forecast = Forecast {
            seconds: 41.04,
            error: 0.010_001,
            error_now: 0.034_4,
            samples: 1,
            stopped_by: StoppedBy::Error,
        };
        assert_eq!(
            forecast.to_string(),
            "about 41 s for 0.01, at present 0.0344"
        );
        forecast.stopped_by = StoppedBy::Time;
        assert_eq!(
            forecast.to_string(),
            "about 0.01 after 41 s, at present 0.0344"
        );
        assert_eq!(Significant(1234.5).to_string(), "1234");
        assert_eq!(Significant(1.2e-12).to_string(), "1.2e-12");
    }
}
