//! A square of the film: its pixels take samples until each half has as many as it aims at.

use super::Job;
use super::backdrop::Foreground;
use super::stop::Stop;
use crate::camera::{CameraRays, film_position};
use crate::film::{CutOff, ErrorSums, Film, Pixel, RayCounts, Rect, RejectedSample, StoppedBy};
use crate::integrate::{FirstSurface, Integrator, RayLog};
use crate::math::{Ray, UVec2, Vec2};
use crate::sampling::Sampler;

/// Pixels along the edge of a tile.
pub(super) const TILE: u32 = 16;

/// Samples between two looks at the clock.
const SAMPLES_PER_LOOK: u64 = 8;

/// Numbers of samples of the two halves of a pixel.
pub(super) type Halves = [u32; 2];

pub(super) struct Tile {
    rect: Rect,
    pub pixels: Vec<Pixel>,
    /// Samples that were traced, rejected ones included: where each half goes on.
    pub taken: Vec<Halves>,
    /// How many there are to be.
    pub goal: Vec<Halves>,
    layers: Vec<Vec<[f64; 3]>>,
    rejected: u64,
    first_rejected: Option<RejectedSample>,
    pub rays: RayCounts,
    cut_off: CutOff,
    /// The error of its pixels; `None` where one does not tell.
    pub error: Option<ErrorSums>,
}

impl Tile {
    fn new(rect: Rect, layers: usize) -> Self {
        let area = rect.area() as usize;
        Self {
            rect,
            pixels: vec![Pixel::default(); area],
            taken: vec![[0; 2]; area],
            goal: vec![[0; 2]; area],
            layers: vec![vec![[0.0; 3]; area]; layers],
            rejected: 0,
            first_rejected: None,
            rays: RayCounts::default(),
            cut_off: CutOff::default(),
            error: None,
        }
    }

    /// Its place on the film.
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// Takes the samples that its pixels lack, until `stop`; returns how many.
    ///
    /// The samples of a half are added in the order of their indices.
    pub fn render(
        &mut self,
        job: &Job,
        integrator: &dyn Integrator,
        foreground: &Foreground,
        stop: &Stop,
    ) -> u64 {
        let sets = job.settings.sampling.pattern.sets();
        let rays = job.camera.rays(job.settings.size);
        let mut log = RayLog::default();
        let mut done = 0;
        'pixels: for (i, pixel) in self.rect.pixels().enumerate() {
            let is_beyond = foreground.is_beyond(pixel);
            for half in 0..2 {
                for sample in self.taken[i][half]..self.goal[i][half] {
                    if stop.is_cancelled() || (done % SAMPLES_PER_LOOK == 0 && stop.is_late()) {
                        break 'pixels;
                    }
                    let index = sample * sets + half as u32;
                    let sample = (!is_beyond).then(|| camera_sample(job, &rays, pixel, index));
                    let value = match &sample {
                        Some((ray, sampler)) => integrator.radiance(ray, sampler, &mut log),
                        None => {
                            log.counts.camera += 1;
                            integrator.background()
                        }
                    };
                    if self.pixels[i].add_sample(half, value) {
                        if let Some((ray, _)) = &sample {
                            self.add_layers(job, i, ray);
                        }
                    } else {
                        self.rejected += 1;
                        let sample = RejectedSample { pixel, index };
                        self.first_rejected = self.first_rejected.or(Some(sample));
                    }
                    self.taken[i][half] += 1;
                    done += 1;
                }
            }
        }
        self.rays.add(&log.counts);
        self.cut_off.add(&log.cut_off);
        self.error = self.error_sums();
        done
    }

    /// Adds what the layers show along `ray` to the tile's pixel number `i`.
    fn add_layers(&mut self, job: &Job, i: usize, ray: &Ray) {
        if job.layers.is_empty() {
            return;
        }
        let first = FirstSurface::along(job.scene, ray);
        for (layer, &kind) in self.layers.iter_mut().zip(&job.layers) {
            for (sum, value) in layer[i].iter_mut().zip(first.value(kind)) {
                *sum += f64::from(value);
            }
        }
    }

    fn error_sums(&self) -> Option<ErrorSums> {
        let mut sums = ErrorSums::default();
        for pixel in &self.pixels {
            sums.add(pixel.relative_squared_error()?);
        }
        Some(sums)
    }
}

/// Sample `index` of `pixel`: its ray from the camera, and its other numbers.
pub(super) fn camera_sample(
    job: &Job,
    rays: &CameraRays<'_>,
    pixel: UVec2,
    index: u32,
) -> (Ray, Sampler) {
    let sampler = Sampler::new(&job.settings.sampling, pixel, index);
    let film = film_position(pixel, sampler.camera());
    let lens = if job.camera.lens_radius > 0.0 {
        sampler.lens()
    } else {
        Vec2::ZERO
    };
    (rays.at(film, lens), sampler)
}

/// The tiles of the job's part of the film, row by row.
pub(super) fn tiles(job: &Job) -> Vec<Tile> {
    let crop = job.crop;
    let steps = |start: u32, length: u32| (start..start + length).step_by(TILE as usize);
    steps(crop.y, crop.height)
        .flat_map(|y| steps(crop.x, crop.width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let rect = Rect {
                x,
                y,
                width: TILE.min(crop.x + crop.width - x),
                height: TILE.min(crop.y + crop.height - y),
            };
            Tile::new(rect, job.layers.len())
        })
        .collect()
}

/// The error of all tiles, summed in their order; `None` where one does not tell.
pub(super) fn error_of(tiles: &[Tile]) -> Option<ErrorSums> {
    let mut sums = ErrorSums::default();
    for tile in tiles {
        sums.add_all(tile.error.as_ref()?);
    }
    Some(sums)
}

/// Puts the tiles together.
pub(super) fn assemble(job: &Job, tiles: &[Tile], stopped_by: StoppedBy) -> Film {
    let crop = job.crop;
    let area = crop.area() as usize;
    let mut film = Film {
        rect: crop,
        pixels: vec![Pixel::default(); area],
        layers: vec![vec![[0.0; 3]; area]; job.layers.len()],
        rejected: 0,
        first_rejected: None,
        rays: RayCounts::default(),
        cut_off: CutOff::default(),
        stopped_by,
    };
    for tile in tiles {
        for (i, pixel) in tile.rect.pixels().enumerate() {
            let to = ((pixel.y - crop.y) * crop.width + pixel.x - crop.x) as usize;
            film.pixels[to] = tile.pixels[i];
            let taken = tile.pixels[i].count().max(1) as f64;
            for (layer, from) in film.layers.iter_mut().zip(&tile.layers) {
                layer[to] = from[i].map(|sum| (sum / taken) as f32);
            }
        }
        film.rejected += tile.rejected;
        film.first_rejected = film.first_rejected.or(tile.first_rejected);
        film.rays.add(&tile.rays);
        film.cut_off.add(&tile.cut_off);
    }
    film
}
