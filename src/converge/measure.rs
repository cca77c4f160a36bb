//! Rendering and timing: every method with doubling numbers of samples, in turns.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use super::method::Method;
use super::point::{Point, Repeats};
use super::reference::{About, Reference};
use super::views::View;
use crate::bench::{Elapsed, Stopwatch, Timing};
use crate::camera::Camera;
use crate::film::{Film, Rect};
use crate::prepare::PreparedScene;
use crate::render::{Job, render_within};
use crate::report::metrics::PairError;
use crate::sampling::{Pattern, Target};
use crate::scene::Settings;

/// What pictures are made of.
#[derive(Debug)]
pub struct Subject<'a> {
    /// The scene.
    pub scene: &'a PreparedScene<'a>,
    /// Where it is seen from, in prepared coordinates.
    pub camera: Camera,
    /// How it is rendered, apart from what a [`Method`] says.
    pub settings: &'a Settings,
}

/// How methods are measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What is compared.
    pub methods: Vec<Method>,
    /// Most camera samples of a curve.
    pub max_samples: u32,
    /// Pictures of each point, each with a seed of its own; at least 1.
    pub repeats: u32,
    /// Seconds that one picture may take, about: a curve ends before one that would take longer.
    pub seconds: f64,
    /// Seed of the references; those of the methods come after it.
    pub seed: u64,
}

/// A method that was not measured any further.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// Which.
    pub method: Method,
    /// Camera samples of the first picture that was not made.
    pub samples: u32,
    /// Seconds that it would have taken, about.
    pub seconds: f64,
}

/// What came out.
#[derive(Debug, Default)]
pub struct Measured {
    /// By number of samples, then in the order of the methods.
    pub points: Vec<Point>,
    /// Of each point the first picture, and where it is wrong.
    pub views: Vec<View>,
    /// What would have taken too long.
    pub left_out: Vec<LeftOut>,
}

impl Subject<'_> {
    /// A reference: scrambled Sobol samples, two at least in each pixel, with one shadow ray per light and
    /// shading point, since more of them change nothing but the time.
    ///
    /// # Errors
    /// Where the picture has no finite pixel.
    pub fn reference(&self, about: About, target: Target) -> Result<Reference, PairError> {
        let method = Method {
            pattern: Pattern::Sobol,
            target,
            light_samples: Some(1),
            is_adaptive: false,
            samples: None,
        };
        let (_, film) = self.render(&method, about.samples.max(2), about.seed);
        Reference::of(about, &film)
    }

    fn render(&self, method: &Method, samples: u32, seed: u64) -> (Elapsed, Film) {
        let (settings, limits) = method.settings(self.settings, samples, seed);
        let job = Job {
            scene: self.scene,
            camera: self.camera,
            settings: &settings,
            crop: Rect::full(settings.size),
            layers: Vec::new(),
        };
        let stopwatch = Stopwatch::start();
        let film = render_within(&job, &limits, &AtomicBool::new(false), &|_| {});
        (stopwatch.read(), film)
    }

    /// Shadow rays per light and shading point; `None` where lights differ.
    fn light_samples(&self, method: &Method) -> Option<u32> {
        let asked = method.light_samples.or(self.settings.light_samples);
        let mut counts = self.scene.lights.iter().map(|light| light.samples());
        asked.or_else(|| counts.next().filter(|&first| counts.all(|n| n == first)))
    }
}

/// Measures on the current thread pool; `observe` hears of every finished round, with the number of
/// samples and all that came out so far.
///
/// Methods take turns, so that whatever else the machine does hits all alike.
///
/// # Errors
/// Where a picture has no pixel that is finite in its reference as well.
pub fn measure<E: From<PairError>>(
    subject: &Subject,
    references: &[(Target, Reference)],
    plan: &Plan,
    mut observe: impl FnMut(u32, &Measured) -> Result<(), E>,
) -> Result<Measured, E> {
    let mut run = Run {
        subject,
        plan,
        measured: Measured::default(),
        next_seed: plan.seed.wrapping_add(1),
        seconds_per_sample: vec![None; plan.methods.len()],
        has_ended: vec![false; plan.methods.len()],
    };
    for (samples, methods) in rounds(plan) {
        let reference = |target: Target| references.iter().find(|r| r.0 == target).map(|r| &r.1);
        run.round(samples, &methods, &reference)?;
        observe(samples, &run.measured)?;
    }
    Ok(run.measured)
}

/// Seconds without what else the machine did.
fn busy(elapsed: Elapsed) -> f64 {
    let time = Timing::of(&[elapsed]);
    time.undisturbed(rayon::current_num_threads()).median
}

/// Numbers of samples, and which methods are measured with each.
fn rounds(plan: &Plan) -> BTreeMap<u32, Vec<usize>> {
    let mut rounds: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, method) in plan.methods.iter().enumerate() {
        let mut samples = method.samples.unwrap_or(1);
        let most = method.samples.unwrap_or(plan.max_samples);
        while samples <= most {
            rounds.entry(samples).or_default().push(i);
            samples = samples.saturating_mul(2);
        }
    }
    rounds
}

struct Run<'a> {
    subject: &'a Subject<'a>,
    plan: &'a Plan,
    measured: Measured,
    next_seed: u64,
    /// By method, of its last picture.
    seconds_per_sample: Vec<Option<f64>>,
    /// By method, whether the next picture would take too long.
    has_ended: Vec<bool>,
}

impl<'a> Run<'a> {
    fn round(
        &mut self,
        samples: u32,
        methods: &[usize],
        reference: &dyn Fn(Target) -> Option<&'a Reference>,
    ) -> Result<(), PairError> {
        let first_seed = self.next_seed;
        let repeats = u64::from(self.plan.repeats.max(1));
        self.next_seed = first_seed.wrapping_add(repeats);
        let mut all: Vec<(usize, Repeats)> = Vec::new();
        for &i in methods {
            let method = self.plan.methods[i];
            if let Some(reference) = reference(method.target)
                && self.is_in_time(i, samples)
            {
                let mut repeats = Repeats::new(method, samples, first_seed, reference);
                repeats.light_samples = self.subject.light_samples(&method);
                all.push((i, repeats));
            }
        }
        for repeat in 0..repeats {
            for (i, repeats) in &mut all {
                let method = self.plan.methods[*i];
                let seed = first_seed.wrapping_add(repeat);
                let (elapsed, film) = self.subject.render(&method, samples, seed);
                self.seconds_per_sample[*i] = Some(busy(elapsed) / f64::from(samples));
                repeats.add(elapsed, &film)?;
            }
        }
        for (_, repeats) in &all {
            self.measured.points.push(repeats.point()?);
            self.measured.views.push(View::of(repeats)?);
        }
        Ok(())
    }

    /// Whether a picture of method `i` takes no longer than it may; a first one is tried with one sample.
    fn is_in_time(&mut self, i: usize, samples: u32) -> bool {
        if self.has_ended[i] {
            return false;
        }
        let method = self.plan.methods[i];
        let rate = match self.seconds_per_sample[i] {
            None if samples == 1 => 0.0,
            None => busy(self.subject.render(&method, 1, self.plan.seed).0),
            Some(rate) => rate,
        };
        let seconds = rate * f64::from(samples);
        if seconds > self.plan.seconds {
            self.has_ended[i] = true;
            self.measured.left_out.push(LeftOut {
                method,
                samples,
                seconds,
            });
        }
        !self.has_ended[i]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_double_and_single_points_stand_alone() {
        let methods = ["sobol", "jittered:81@81", "random"].map(|text| text.parse());
        let plan = Plan {
            methods: methods.into_iter().flatten().collect(),
            max_samples: 5,
            repeats: 1,
            seconds: 1.0,
            seed: 0,
        };
        let rounds: Vec<_> = rounds(&plan).into_iter().collect();
        let expected = [1, 2, 4].map(|samples| (samples, vec![0, 2]));
        assert_eq!(rounds[..3], expected);
        assert_eq!(rounds[3], (81, vec![1]));
    }
}
