//! A square of the film: its pixels take samples until each half has as many as it aims at.

use super::Job;
use super::backdrop::Foreground;
use super::stop::Stop;
use crate::camera::{CameraRays, film_position};
use crate::color::Rgb;
use crate::film::{ErrorSums, Film, Pixel, RayCounts, Rect, RejectedSample, StoppedBy};
use crate::integrate::{Account, Aov, FirstSurface, Integrator, RayLog, Sight, Source};
use crate::math::{Ray, UVec2, Vec2};
use crate::sampling::Sampler;

/// Pixels along the edge of a tile.
pub(super) const TILE: u32 = 16;

/// Samples between two looks at the clock.
const SAMPLES_PER_LOOK: u64 = 8;

/// Numbers of samples of the two halves of a pixel.
pub(super) type Halves = [u32; 2];

/// Per pixel the instances that were seen, and the sums of their shares over the samples of each half.
type Objects = Vec<Vec<(u32, [f64; 2])>>;

pub(super) struct Tile {
    rect: Rect,
    pub pixels: Vec<Pixel>,
    /// Samples that were traced, rejected ones included: where each half goes on.
    pub taken: Vec<Halves>,
    /// How many there are to be.
    pub goal: Vec<Halves>,
    /// Per layer and pixel: the sums over the samples of each half.
    layers: Vec<Vec<[[f64; 2]; 3]>>,
    objects: Objects,
    rejected: u64,
    first_rejected: Option<RejectedSample>,
    pub rays: RayCounts,
    /// The error of its pixels; `None` where one does not tell.
    pub error: Option<ErrorSums>,
}

impl Tile {
    fn new(rect: Rect, layers: &[Aov]) -> Self {
        let area = rect.area() as usize;
        Self {
            rect,
            pixels: vec![Pixel::default(); area],
            taken: vec![[0; 2]; area],
            goal: vec![[0; 2]; area],
            layers: vec![vec![[[0.0; 2]; 3]; area]; layers.len()],
            objects: match layers.contains(&Aov::Objects) {
                true => vec![Vec::new(); area],
                false => Vec::new(),
            },
            rejected: 0,
            first_rejected: None,
            rays: RayCounts::default(),
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
        account: Option<&Account>,
        stop: &Stop,
    ) -> u64 {
        let sets = job.settings.sampling.pattern.sets();
        let rays = job.camera.rays(job.settings.size);
        let mut log = RayLog {
            account: account.cloned(),
            ..RayLog::default()
        };
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
                    if let Some(account) = &mut log.account {
                        account.clear();
                    }
                    let value = match &sample {
                        Some((ray, sampler)) => integrator.radiance(ray, sampler, &mut log),
                        None => {
                            log.counts.camera += 1;
                            let radiance = integrator.background();
                            log.light(Source::Background, 0, Rgb::WHITE, radiance);
                            radiance
                        }
                    };
                    if self.pixels[i].add_sample(half, value) {
                        if let Some(account) = &log.account {
                            let ray = sample.as_ref().map(|(ray, _)| ray);
                            self.add_layers(job, [i, half], ray, account);
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
        self.error = self.error_sums();
        done
    }

    /// Adds what `account` tells of a sample along `ray` to the layers, at a pixel's number and half; `None`
    /// for a ray that is known to meet nothing.
    fn add_layers(
        &mut self,
        job: &Job,
        [i, half]: [usize; 2],
        ray: Option<&Ray>,
        account: &Account,
    ) {
        let first = account.seen.first().map(|seen| seen.sight);
        let first = ray.map(|ray| FirstSurface::of(job.scene, ray, first));
        for (layer, aov) in self.layers.iter_mut().zip(&job.layers) {
            let value = match *aov {
                Aov::View(kind) => first.as_ref().map_or([0.0; 3], |first| first.value(kind)),
                Aov::Coverage => [account.coverage(); 3],
                Aov::Light(part) => account.light(part).channels(),
                Aov::Objects => continue,
            };
            for (sums, value) in layer[i].iter_mut().zip(value) {
                sums[half] += f64::from(value);
            }
        }
        if let Some(objects) = self.objects.get_mut(i) {
            for seen in &account.seen {
                if let Sight::Surface(hit) = &seen.sight {
                    add_share(objects, job.scene.instance(hit), half, seen.share);
                }
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

fn add_share(objects: &mut Vec<(u32, [f64; 2])>, instance: u32, half: usize, share: f32) {
    let at = objects.iter().position(|(known, _)| *known == instance);
    let at = at.unwrap_or_else(|| {
        objects.push((instance, [0.0; 2]));
        objects.len() - 1
    });
    objects[at].1[half] += f64::from(share);
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
            Tile::new(rect, &job.layers)
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
        objects: match job.layers.contains(&Aov::Objects) {
            true => vec![Vec::new(); area],
            false => Vec::new(),
        },
        rejected: 0,
        first_rejected: None,
        rays: RayCounts::default(),
        stopped_by,
    };
    for tile in tiles {
        for (i, pixel) in tile.rect.pixels().enumerate() {
            let to = ((pixel.y - crop.y) * crop.width + pixel.x - crop.x) as usize;
            let pixel = &tile.pixels[i];
            film.pixels[to] = *pixel;
            let mean = |sums: [f64; 2]| pixel.mean_of_sums(sums) as f32;
            for (layer, from) in film.layers.iter_mut().zip(&tile.layers) {
                layer[to] = from[i].map(mean);
            }
            if let Some(seen) = tile.objects.get(i) {
                film.objects[to] = seen.iter().map(|(id, sums)| (*id, mean(*sums))).collect();
            }
        }
        film.rejected += tile.rejected;
        film.first_rejected = film.first_rejected.or(tile.first_rejected);
        film.rays.add(&tile.rays);
    }
    film
}
