//! One point of a curve: a method with a number of samples, repeated.

use serde::Serialize;

use super::method::Method;
use super::reference::Reference;
use crate::bench::{Elapsed, Timing};
use crate::color::Rgb;
use crate::film::{ErrorEstimate, Film, RayCounts};
use crate::report::Picture;
use crate::report::metrics::{Pair, PairError, flip, relmse, rmse};

/// A method with a number of camera samples, as measured. Errors are means over the repeats, of
/// squares where they are squares; `None` where they drown in the noise of the reference.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// Its name, [`Method`].
    pub method: String,
    /// Layout of the samples.
    pub pattern: &'static str,
    /// What part of a pixel they land in.
    pub target: &'static str,
    /// Whether samples go where the error is.
    pub adaptive: bool,
    /// Camera samples that were asked for.
    pub asked_samples: u32,
    /// Camera samples of a pixel, on average.
    pub samples: f64,
    /// Shadow rays per light and shading point; `None` where lights differ.
    pub light_samples: Option<u32>,
    /// Pictures that were rendered.
    pub repeats: u32,
    /// Their seeds: this one and those after it.
    pub first_seed: u64,
    /// Wall time of a render, median. Import and build are not in it.
    pub seconds: f64,
    /// Processor time of all threads, median.
    pub cpu_seconds: Option<f64>,
    /// What the point stands at in plots and tables: processor time by thread, which is wall time on a
    /// machine that does nothing else; wall time where the system does not tell.
    pub busy_seconds: f64,
    /// All that is known of the time.
    pub time: Timing,
    /// Rays of one picture, mean.
    pub rays: Rays,
    /// Root mean squared error.
    pub rmse: Option<f64>,
    /// relMSE.
    pub relmse: Option<f64>,
    /// Of the mean of the measured relMSE, from the spread of the repeats; `None` for one repeat.
    pub standard_error: Option<f64>,
    /// Root mean squared difference from the reference, whose noise is in it.
    pub measured_rmse: f64,
    /// relMSE against the reference, whose noise is in it.
    pub measured_relmse: f64,
    /// Errors up to this are not known: the upper end of the reference's own relMSE.
    pub floor_relmse: f64,
    /// The part of relMSE that differs from seed to seed; `None` for one repeat.
    pub variance: Option<f64>,
    /// The part of relMSE that all seeds share; `None` where it is not told from 0.
    pub bias_squared: Option<f64>,
    /// Mean FLIP of the first repeat; `None` where it is less than twice the reference's.
    pub flip: Option<f64>,
    /// relMSE as the renders estimated it themselves.
    pub estimated_relmse: Option<f64>,
    /// Share of the repeats whose own 95 % interval holds their error.
    pub coverage: Option<f64>,
}

/// Rays of a picture by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Rays {
    /// From the camera.
    pub camera: u64,
    /// From surfaces to lights.
    pub shadow: u64,
    /// Mirrored and refracted.
    pub secondary: u64,
}

/// The repeats of a point while they come in.
pub struct Repeats<'a> {
    pub method: Method,
    pub asked_samples: u32,
    pub light_samples: Option<u32>,
    pub first_seed: u64,
    pub threads: usize,
    reference: &'a Reference,
    elapsed: Vec<Elapsed>,
    rays: RayCounts,
    samples: f64,
    squares: Vec<[f64; 2]>,
    flip: f64,
    estimates: Vec<Option<ErrorEstimate>>,
    /// Sum of the pictures.
    sum: Vec<[f64; 3]>,
    /// The first picture.
    first: Picture,
}

impl<'a> Repeats<'a> {
    /// None yet.
    pub fn new(
        method: Method,
        asked_samples: u32,
        first_seed: u64,
        reference: &'a Reference,
    ) -> Self {
        Self {
            method,
            asked_samples,
            light_samples: None,
            first_seed,
            threads: rayon::current_num_threads(),
            reference,
            elapsed: Vec::new(),
            rays: RayCounts::default(),
            samples: 0.0,
            squares: Vec::new(),
            flip: 0.0,
            estimates: Vec::new(),
            sum: vec![[0.0; 3]; reference.picture.pixels.len()],
            first: reference.picture.clone(),
        }
    }

    /// One more picture.
    pub fn add(&mut self, elapsed: Elapsed, film: &Film) -> Result<(), PairError> {
        let picture = Picture::from(film);
        let pair = Pair::new(&picture, &self.reference.picture)?;
        self.squares.push([relmse(&pair), rmse(&pair).powi(2)]);
        if self.elapsed.is_empty() {
            self.flip = flip(&pair).mean();
            self.first = picture;
        }
        self.elapsed.push(elapsed);
        self.rays.add(&film.rays);
        self.samples += film.sample_counts().1;
        self.estimates.push(film.error());
        for (sum, pixel) in self.sum.iter_mut().zip(&film.pixels) {
            for (sum, value) in sum.iter_mut().zip(pixel.value()) {
                *sum += value;
            }
        }
        Ok(())
    }

    /// The first picture.
    pub fn first(&self) -> &Picture {
        &self.first
    }

    /// What they are measured against.
    pub fn reference(&self) -> &Picture {
        &self.reference.picture
    }

    /// What they say together.
    pub fn point(&self) -> Result<Point, PairError> {
        let count = self.elapsed.len().max(1) as f64;
        let mean = |values: &dyn Fn(&[f64; 2]) -> f64| {
            self.squares.iter().map(values).sum::<f64>() / count
        };
        let (measured_relmse, measured_mse) = (mean(&|s| s[0]), mean(&|s| s[1]));
        let floors = &self.reference.floors;
        let (variance, bias_squared) = self.parts(measured_relmse)?;
        let time = Timing::of(&self.elapsed);
        let rays = |rays: u64| (rays as f64 / count).round() as u64;
        Ok(Point {
            method: self.method.to_string(),
            pattern: self.method.pattern.name(),
            target: self.method.target.name(),
            adaptive: self.method.is_adaptive,
            asked_samples: self.asked_samples,
            samples: self.samples / count,
            light_samples: self.light_samples,
            repeats: self.elapsed.len() as u32,
            first_seed: self.first_seed,
            seconds: time.wall.median,
            cpu_seconds: time.processor.map(|spread| spread.median),
            busy_seconds: time.undisturbed(self.threads).median,
            time,
            rays: Rays {
                camera: rays(self.rays.camera),
                shadow: rays(self.rays.shadow),
                secondary: rays(self.rays.secondary),
            },
            rmse: floors.mse.subtracted(measured_mse).map(f64::sqrt),
            relmse: floors.relmse.subtracted(measured_relmse),
            standard_error: self.standard_error(measured_relmse),
            measured_rmse: measured_mse.sqrt(),
            measured_relmse,
            floor_relmse: floors.relmse.bound,
            variance,
            bias_squared,
            flip: Some(self.flip).filter(|&flip| flip > 2.0 * self.reference.flip_floor),
            estimated_relmse: self.estimated(),
            coverage: self.coverage(),
        })
    }

    /// Variance and squared bias. With R repeats the mean picture is off by the bias and by an R-th of
    /// the variance; what the single pictures are further off is the rest of the variance.
    fn parts(&self, measured: f64) -> Result<(Option<f64>, Option<f64>), PairError> {
        let count = self.elapsed.len() as f64;
        if count < 2.0 {
            return Ok((None, None));
        }
        let pixels = self
            .sum
            .iter()
            .map(|sum| Rgb::from(sum.map(|s| (s / count) as f32)));
        let mean = Picture {
            size: self.reference.picture.size,
            pixels: pixels.collect(),
        };
        let of_mean = relmse(&Pair::new(&mean, &self.reference.picture)?);
        let variance = ((measured - of_mean) * count / (count - 1.0)).max(0.0);
        let of_chance = variance / count;
        let bias = self.reference.floors.relmse.subtracted(of_mean - of_chance);
        Ok((Some(variance), bias.filter(|&bias| bias > of_chance)))
    }

    fn standard_error(&self, mean: f64) -> Option<f64> {
        let count = self.squares.len() as f64;
        let squares: f64 = self.squares.iter().map(|s| (s[0] - mean).powi(2)).sum();
        (count > 1.0).then(|| (squares / (count - 1.0) / count).sqrt())
    }

    fn estimated(&self) -> Option<f64> {
        let squares: Option<Vec<f64>> = self
            .estimates
            .iter()
            .map(|estimate| Some(estimate.as_ref()?.estimate.powi(2)))
            .collect();
        let squares = squares.filter(|squares| !squares.is_empty())?;
        Some(squares.iter().sum::<f64>() / squares.len() as f64)
    }

    /// Of the repeats whose error is known.
    fn coverage(&self) -> Option<f64> {
        let floor = &self.reference.floors.relmse;
        let known: Vec<bool> = self
            .squares
            .iter()
            .zip(&self.estimates)
            .filter_map(|(square, estimate)| {
                let (error, estimate) = (floor.subtracted(square[0])?.sqrt(), estimate.as_ref()?);
                Some((estimate.low..=estimate.high).contains(&error))
            })
            .collect();
        let held = known.iter().filter(|&&is_held| is_held).count();
        (!known.is_empty()).then(|| held as f64 / known.len() as f64)
    }
}
