//! The picture: every pixel's samples, on all cores, in an order that does not matter.
//!
//! The film is cut into tiles, and the samples into waves, each three times as large as all before
//! it: a render that is stopped early has seen the whole picture. A pixel's samples are added in
//! the order of their indices whatever the threads do, so the same job gives the same bits.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use rayon::prelude::*;

use crate::camera::{Camera, film_position};
use crate::color::Rgb;
use crate::film::{Film, Pixel, RayCounts, Rect, RejectedSample};
use crate::integrate::{
    FirstSurface, Integrator, RayKind, RayLog, RayRecord, ViewKind, integrator,
};
use crate::math::{DVec3, Ray, UVec2, Vec2, Vec3};
use crate::prepare::PreparedScene;
use crate::sampling::Sampler;
use crate::scene::Settings;

/// Pixels along the edge of a tile.
const TILE: u32 = 16;

/// What is to be rendered.
#[derive(Debug)]
pub struct Job<'a> {
    /// The scene.
    pub scene: &'a PreparedScene<'a>,
    /// Where it is seen from, in prepared coordinates ([`PreparedScene::camera`]).
    pub camera: Camera,
    /// How it is rendered; its size is that of the whole film.
    pub settings: &'a Settings,
    /// The part of the film that is rendered.
    pub crop: Rect,
    /// Layers beside the picture.
    pub layers: Vec<ViewKind>,
}

impl Job<'_> {
    /// The most memory that [`render`] takes for the film, bytes: tiles and film are there
    /// together while they are put together.
    pub fn memory_bytes(&self) -> u64 {
        let pixel = 2 * size_of::<Pixel>();
        let layer = size_of::<[f64; 3]>() + size_of::<[f32; 3]>();
        self.crop.area() * (pixel + self.layers.len() * layer) as u64
    }
}

/// How far a render has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Camera samples that are done.
    pub done: u64,
    /// Camera samples in all.
    pub total: u64,
}

struct Tile {
    rect: Rect,
    pixels: Vec<Pixel>,
    layers: Vec<Vec<[f64; 3]>>,
    rejected: u64,
    first_rejected: Option<RejectedSample>,
    rays: RayCounts,
}

/// Renders `job` on the current thread pool.
///
/// `observe` hears of every finished tile, from any thread. Once `cancel` is set the render ends
/// within a few samples, and the film holds what there is.
pub fn render(job: &Job, cancel: &AtomicBool, observe: &(dyn Fn(Progress) + Sync)) -> Film {
    let integrator = integrator(job.scene, job.settings);
    let samples = job.settings.sampling.samples_per_pixel();
    let total = job.crop.area() * u64::from(samples);
    let done = AtomicU64::new(0);
    let mut tiles = tiles(job);
    let mut wave = 0..samples.min(1);
    while !wave.is_empty() && !cancel.load(Ordering::Relaxed) {
        tiles.par_iter_mut().for_each(|tile| {
            let taken = tile.render_wave(job, integrator.as_ref(), wave.clone(), cancel);
            let done = done.fetch_add(taken, Ordering::Relaxed) + taken;
            observe(Progress { done, total });
        });
        wave = wave.end..wave.end.saturating_mul(4).min(samples);
    }
    assemble(job, &tiles, done.into_inner() == total)
}

fn tiles(job: &Job) -> Vec<Tile> {
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
            let area = rect.area() as usize;
            Tile {
                rect,
                pixels: vec![Pixel::default(); area],
                layers: vec![vec![[0.0; 3]; area]; job.layers.len()],
                rejected: 0,
                first_rejected: None,
                rays: RayCounts::default(),
            }
        })
        .collect()
}

impl Tile {
    /// Adds the samples of one wave to every pixel; returns how many were taken.
    fn render_wave(
        &mut self,
        job: &Job,
        integrator: &dyn Integrator,
        wave: std::ops::Range<u32>,
        cancel: &AtomicBool,
    ) -> u64 {
        let mut log = RayLog::default();
        let mut taken = 0;
        for (i, pixel) in self.rect.pixels().enumerate() {
            for index in wave.clone() {
                if cancel.load(Ordering::Relaxed) {
                    break;
                }
                let (ray, sampler) = camera_sample(job, pixel, index);
                let value = integrator.radiance(&ray, &sampler, &mut log);
                if self.pixels[i].add_sample(value) {
                    self.add_layers(job, i, &ray);
                } else {
                    self.rejected += 1;
                    let sample = RejectedSample { pixel, index };
                    self.first_rejected = self.first_rejected.or(Some(sample));
                }
                taken += 1;
            }
        }
        self.rays.add(&log.counts);
        taken
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
}

fn camera_sample(job: &Job, pixel: UVec2, index: u32) -> (Ray, Sampler) {
    let sampler = Sampler::new(&job.settings.sampling, pixel, index);
    let film = film_position(pixel, sampler.camera());
    let lens = if job.camera.lens_radius > 0.0 {
        sampler.lens()
    } else {
        Vec2::ZERO
    };
    (job.camera.ray(film, job.settings.size, lens), sampler)
}

fn assemble(job: &Job, tiles: &[Tile], is_complete: bool) -> Film {
    let crop = job.crop;
    let area = crop.area() as usize;
    let mut film = Film {
        rect: crop,
        pixels: vec![Pixel::default(); area],
        layers: vec![vec![[0.0; 3]; area]; job.layers.len()],
        rejected: 0,
        first_rejected: None,
        rays: RayCounts::default(),
        is_complete,
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
    }
    film
}

/// One sample of one pixel, traced again.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Its value.
    pub value: Rgb,
    /// Every ray that was traced for it, in order.
    pub rays: Vec<ReplayedRay>,
}

/// A ray in world coordinates.
#[derive(Clone, Copy, Debug)]
pub struct ReplayedRay {
    /// Why it was traced.
    pub kind: RayKind,
    /// Scattering events before it.
    pub depth: u32,
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes; of length 1.
    pub direction: Vec3,
    /// How far away it met something, metres; `None` where it did not, and for shadow rays.
    pub distance: Option<f64>,
    /// As in [`RayRecord::weight`].
    pub weight: Rgb,
}

/// Traces sample `index` of `pixel` again and keeps its rays.
pub fn replay(job: &Job, pixel: UVec2, index: u32) -> Replay {
    let (ray, sampler) = camera_sample(job, pixel, index);
    let mut log = RayLog::keeping();
    let value = integrator(job.scene, job.settings).radiance(&ray, &sampler, &mut log);
    let in_world = |record: RayRecord| {
        let length = f64::from(record.ray.direction.length());
        let to_world = length / job.scene.placement.scale;
        ReplayedRay {
            kind: record.kind,
            depth: record.depth,
            origin: job.scene.world_point(record.ray.origin),
            direction: record.ray.direction.normalize_or_zero(),
            distance: record.t.map(|t| f64::from(t) * to_world),
            weight: record.weight,
        }
    };
    Replay {
        value,
        rays: log.records.into_iter().flatten().map(in_world).collect(),
    }
}

impl fmt::Display for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for ray in &self.rays {
            let indent = 2 * ray.depth as usize;
            let Rgb { r, g, b } = ray.weight;
            let (origin, direction) = (ray.origin, ray.direction);
            write!(
                f,
                "{:indent$}{} from {origin} along {direction}",
                "", ray.kind
            )?;
            match (ray.kind, ray.distance) {
                (RayKind::Shadow(_), _) => writeln!(f, " brings {r} {g} {b}")?,
                (_, Some(distance)) => writeln!(f, " hits at {distance} m, weight {r} {g} {b}")?,
                (_, None) => writeln!(f, " leaves the scene, weight {r} {g} {b}")?,
            }
        }
        let Rgb { r, g, b } = self.value;
        writeln!(f, "radiance {r} {g} {b}")
    }
}
