//! All that was measured of a scene, and what follows from it.

use serde::Serialize;

use super::against::OtherPoint;
use super::fit::ErrorLaw;
use super::floor::Floors;
use super::measure::Measured;
use super::point::Point;
use super::reference::Reference;
use super::time_to_error::{GOALS, Reached, Step, time_to};

/// All that was measured of a scene, as scripts get it; more keys may come to stand beside these.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    /// Name of its file.
    pub scene: String,
    /// Of the scene and the settings.
    pub digest: String,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Triangles, every instance counted.
    pub triangles: u64,
    /// Of this program.
    pub version: &'static str,
    /// Where it ran.
    pub machine: Machine,
    /// The options, as far as they are not in the points.
    pub settings: Vec<(String, String)>,
    /// Wall time of what is not in the points.
    pub seconds: Seconds,
    /// One for each target.
    pub references: Vec<ReferenceReport>,
    /// By number of samples.
    pub points: Vec<Point>,
    /// One for each method that is a curve.
    pub slopes: Vec<Slope>,
    /// One for each method.
    pub time_to_error: Vec<TimeToError>,
    /// What was measured elsewhere.
    pub against: Vec<OtherPoint>,
    /// What would have taken too long.
    pub left_out: Vec<String>,
}

/// Where it ran.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// The processor's name, where the system tells; its architecture elsewhere.
    pub processor: String,
    /// The system's name.
    pub system: &'static str,
    /// Threads that rendered.
    pub threads: usize,
}

/// Wall time of what happens once.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Seconds {
    /// Files to scene.
    pub import: f64,
    /// Scene to tree.
    pub prepare: f64,
    /// The references; 0 where they had been kept.
    pub reference: f64,
}

/// What is said about a reference.
#[derive(Clone, Debug, Serialize)]
pub struct ReferenceReport {
    /// What part of a pixel its samples fill.
    pub target: String,
    /// Camera samples of a pixel.
    pub samples: u32,
    /// Its seed, which no point has.
    pub seed: u64,
    /// Its squared errors.
    pub floors: Floors,
    /// What FLIP finds between it and the truth, about.
    pub flip_floor: f64,
}

impl From<&Reference> for ReferenceReport {
    fn from(reference: &Reference) -> Self {
        Self {
            target: reference.about.target.clone(),
            samples: reference.about.samples,
            seed: reference.about.seed,
            floors: reference.floors,
            flip_floor: reference.flip_floor,
        }
    }
}

/// How the error of a method falls with the number of samples.
#[derive(Clone, Debug, Serialize)]
pub struct Slope {
    /// Which.
    pub method: String,
    /// Of √relMSE and its square; `None` where too few errors are known.
    pub law: Option<ErrorLaw>,
}

/// How long a method takes to each of [`GOALS`].
#[derive(Clone, Debug, Serialize)]
pub struct TimeToError {
    /// Which.
    pub method: String,
    /// In the order of [`GOALS`].
    pub goals: Vec<Goal>,
}

/// When a method reaches an error.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Goal {
    /// The error.
    pub relmse: f64,
    /// When it is reached: busy seconds of one picture.
    #[serde(flatten)]
    pub reached: Reached,
    /// Its seconds in those of the fastest method, where both are known between two points.
    pub ratio: Option<f64>,
}

impl Study {
    /// Puts in what was measured, and what follows from it.
    pub fn fill(&mut self, measured: &Measured) {
        self.points.clone_from(&measured.points);
        let left_out = measured.left_out.iter().map(|left_out| {
            let (method, samples) = (left_out.method, left_out.samples);
            format!(
                "{method} from {samples} samples on: a picture would take about {:.0} s",
                left_out.seconds
            )
        });
        self.left_out = left_out.collect();
        let curves = self.curves();
        self.slopes = curves
            .iter()
            .filter(|(_, points)| points.len() > 1)
            .map(|(method, points)| {
                let known = points.iter().filter_map(|p| Some((p.samples, p.relmse?)));
                Slope {
                    method: (*method).to_owned(),
                    law: ErrorLaw::fit(&known.collect::<Vec<_>>()),
                }
            })
            .collect();
        self.time_to_error = time_to_error(&self.steps());
    }

    /// The points of each method, in the order in which the methods first appear.
    pub fn curves(&self) -> Vec<(&str, Vec<&Point>)> {
        grouped(&self.points, |point| &point.method)
    }

    /// The points from elsewhere by method, in their order in the file.
    pub fn others(&self) -> Vec<(&str, Vec<&OtherPoint>)> {
        grouped(&self.against, |point| &point.method)
    }

    /// The curves as steps in time, those from elsewhere last.
    fn steps(&self) -> Vec<(String, Vec<Step>)> {
        let own = self.curves().into_iter().map(|(method, points)| {
            let steps = points.iter().map(|p| Step {
                seconds: p.busy_seconds,
                relmse: p.relmse,
                floor: p.floor_relmse,
            });
            (method.to_owned(), steps.collect())
        });
        let floor = self
            .references
            .first()
            .map_or(0.0, |r| r.floors.relmse.bound);
        let others = self.others().into_iter().map(|(method, points)| {
            let steps = points.iter().map(|p| Step {
                seconds: p.seconds,
                relmse: p.relmse,
                floor,
            });
            (method.to_owned(), steps.collect())
        });
        own.chain(others).collect()
    }
}

/// The points that no other point beats in both time and error, by time: seconds and relMSE.
pub fn pareto_front(study: &Study) -> Vec<(f64, f64)> {
    let own = study.points.iter().map(|p| (p.busy_seconds, p.relmse));
    let others = study.against.iter().map(|p| (p.seconds, p.relmse));
    let known = own
        .chain(others)
        .filter_map(|(seconds, relmse)| Some((seconds, relmse?)));
    unbeaten(known.collect())
}

fn unbeaten(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut least = f64::INFINITY;
    points.retain(|&(_, error)| {
        let is_better = error < least;
        least = least.min(error);
        is_better
    });
    points
}

fn grouped<T>(points: &[T], name: fn(&T) -> &String) -> Vec<(&str, Vec<&T>)> {
    let mut groups: Vec<(&str, Vec<&T>)> = Vec::new();
    for point in points {
        match groups.iter_mut().find(|group| group.0 == name(point)) {
            Some(group) => group.1.push(point),
            None => groups.push((name(point), vec![point])),
        }
    }
    groups
}

fn time_to_error(curves: &[(String, Vec<Step>)]) -> Vec<TimeToError> {
    let best = GOALS.map(|goal| {
        let reached = curves.iter().filter_map(|(_, curve)| time_to(goal, curve));
        let seconds = reached.filter_map(|reached| match reached {
            Reached::About(seconds) => Some(seconds),
            _ => None,
        });
        seconds.fold(f64::INFINITY, f64::min)
    });
    let goals = |curve: &[Step]| {
        let goals = GOALS.iter().zip(best).filter_map(|(&relmse, best)| {
            let reached = time_to(relmse, curve)?;
            let ratio = match reached {
                Reached::About(seconds) => Some(seconds / best),
                _ => None,
            };
            Some(Goal {
                relmse,
                reached,
                ratio,
            })
        });
        goals.collect()
    };
    curves
        .iter()
        .map(|(method, curve)| TimeToError {
            method: method.clone(),
            goals: goals(curve),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_another_point_beats_is_not_on_the_front() {
        let points = vec![(3.0, 0.1), (1.0, 0.5), (2.0, 0.6), (1.0, 0.4), (4.0, 0.1)];
        assert_eq!(unbeaten(points), [(1.0, 0.4), (3.0, 0.1)]);
    }

    #[test]
    fn ratios_are_to_the_fastest() {
        let curve = |name: &str, factor: f64| {
            let step = |seconds: f64, relmse: f64| Step {
                seconds: factor * seconds,
                relmse: Some(relmse),
                floor: 0.0,
            };
            (name.to_owned(), vec![step(1.0, 1.0), step(1e6, 1e-6)])
        };
        let times = time_to_error(&[curve("slow", 3.0), curve("fast", 1.0)]);
        for (times, expected) in times.iter().zip([3.0, 1.0]) {
            assert_eq!(times.goals.len(), GOALS.len());
            for goal in &times.goals {
                let ratio = goal.ratio.unwrap_or(f64::NAN);
                assert!((ratio - expected).abs() < 1e-9, "{goal:?}");
            }
        }
    }
}
