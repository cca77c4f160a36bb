//! Wall time and processor time, and what repeats of them say.

use std::time::Instant;

use serde::Serialize;

/// Processor time of all threads of this process so far, seconds; `None` where the system does not
/// say without unsafe code.
#[cfg(unix)]
pub fn processor_seconds() -> Option<f64> {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

/// Processor time of all threads of this process so far, seconds; `None` where the system does not
/// say without unsafe code.
#[cfg(not(unix))]
pub fn processor_seconds() -> Option<f64> {
    None
}

/// Time that has gone by, seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elapsed {
    /// On the clock on the wall.
    pub wall: f64,
    /// Of all threads of this process; `None` where the system does not say.
    pub processor: Option<f64>,
}

/// Measures from its start.
#[derive(Debug)]
pub struct Stopwatch {
    wall: Instant,
    processor: Option<f64>,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self {
            wall: Instant::now(),
            processor: processor_seconds(),
        }
    }

    /// Since the start.
    pub fn read(&self) -> Elapsed {
        let processor = processor_seconds().zip(self.processor);
        Elapsed {
            wall: self.wall.elapsed().as_secs_f64(),
            processor: processor.map(|(now, start)| now - start),
        }
    }
}

/// The middle and the ends of repeated measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Half of them are below it.
    pub median: f64,
    /// The least.
    pub min: f64,
    /// The greatest.
    pub max: f64,
}

impl Spread {
    /// Of some values; zero where there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let (Some(&min), Some(&max)) = (values.first(), values.last()) else {
            return Self::default();
        };
        let (lower, upper) = ((values.len() - 1) / 2, values.len() / 2);
        Self {
            median: 0.5 * values[lower] + 0.5 * values[upper],
            min,
            max,
        }
    }

    /// `factor` times each.
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            median: factor * self.median,
            min: factor * self.min,
            max: factor * self.max,
        }
    }
}

/// Repeated measurements of one thing, seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Timing {
    /// On the clock on the wall.
    pub wall: Spread,
    /// Of all threads; `None` where the system does not say.
    pub processor: Option<Spread>,
}

impl Timing {
    /// Of some repeats.
    pub fn of(repeats: &[Elapsed]) -> Self {
        let processor: Option<Vec<f64>> = repeats.iter().map(|repeat| repeat.processor).collect();
        Self {
            wall: Spread::of(repeats.iter().map(|repeat| repeat.wall)),
            processor: processor.map(Spread::of),
        }
    }

    /// Of work whose threads were busy all the time, had each had a processor to itself: the
    /// processor time by thread, or the wall time where that is not known.
    pub fn undisturbed(&self, threads: usize) -> Spread {
        let processor = self.processor.map(|s| s.scaled(1.0 / threads as f64));
        processor.unwrap_or(self.wall)
    }

    /// Of `factor` times as much of the same.
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            wall: self.wall.scaled(factor),
            processor: self.processor.map(|spread| spread.scaled(factor)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_is_between_the_middle_two() {
        let spread = Spread::of([4.0, 1.0, 2.0, 9.0]);
        assert_eq!((spread.median, spread.min, spread.max), (3.0, 1.0, 9.0));
        assert_eq!(Spread::of([7.0]).median, 7.0);
        assert_eq!(Spread::of([]), Spread::default());
    }

    #[cfg(unix)]
    #[test]
    fn sleeping_takes_wall_time_but_no_processor_time() {
        let stopwatch = Stopwatch::start();
        std::thread::sleep(std::time::Duration::from_millis(50));
        let elapsed = stopwatch.read();
        assert!(elapsed.wall >= 0.05);
        // Other tests run beside this one, on other threads of this process.
        assert!(elapsed.processor.is_some_and(|seconds| seconds >= 0.0));
    }
}
