//! A square of the film: its pixels take samples until each half has as many as it aims at.

use rayon::prelude::*;

use super::Job;
use super::stop::Stop;
use crate::camera::{CameraRays, film_position};
use crate::color::Rgb;
use crate::film::{CutOff, ErrorSums, Film, Pixel, RayCounts, Rect, RejectedSample, StoppedBy};
use crate::integrate::{Account, Aov, CameraRow, FirstSurface, Integrator, RayLog, Sight};
use crate::math::{ROW, Ray, UVec2, Vec2, morton_pixel};
use crate::sampling::{Sampler, Samplers};

/// Pixels along the edge of a tile.
pub(super) const TILE: u32 = 16;

/// Samples that are taken together, and between two looks at the clock.
const BATCH: usize = ROW;

/// Numbers of samples of the two halves of a pixel.
pub(super) type Halves = [u32; 2];

/// Per pixel the instances that were seen, and the sums of their shares over the samples of each half.
type Objects = Vec<Vec<(u32, [f64; 2])>>;

/// The pixels of a tile: its part of each of its rows.
pub(super) type Rows<'a> = Vec<&'a mut [Pixel]>;

/// What of a tile is not in its pixels; by pixel, row by row.
pub(super) struct Tile {
    rect: Rect,
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
    cut_off: CutOff,
    /// The error of its pixels; `None` where one does not tell.
    pub error: Option<ErrorSums>,
}

impl Tile {
    pub fn new(rect: Rect, layers: &[Aov]) -> Self {
        let area = rect.area() as usize;
        Self {
            rect,
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
            cut_off: CutOff::default(),
            error: None,
        }
    }

    /// Its place on the film.
    pub fn rect(&self) -> Rect {
        self.rect
    }

    /// Takes the samples that its `pixels` lack, until `stop`; returns how many.
    ///
    /// The samples of a half are added in the order of their indices.
    pub fn render(
        &mut self,
        mut pixels: Rows,
        job: &Job,
        integrator: &dyn Integrator,
        account: Option<&Account>,
        stop: &Stop,
    ) -> u64 {
        if self.taken == self.goal {
            return 0;
        }
        let samplers = Samplers::new(&job.settings.sampling);
        let mut batch = Batch::new(job, integrator, account);
        let is_stopped = || stop.is_cancelled() || stop.is_late();
        let mut done = 0;
        'pixels: for (i, pixel) in self.pixels_by_neighbourhood() {
            if self.taken[i] == self.goal[i] {
                continue;
            }
            for half in 0..2 {
                let numbers = self.taken[i][half]..self.goal[i][half];
                if numbers.is_empty() {
                    continue;
                }
                let first = samplers.of_set(pixel, half as u32);
                for number in numbers {
                    if batch.count() == 0 && is_stopped() {
                        break 'pixels;
                    }
                    done += 1;
                    batch.add(Place { i, half, pixel }, &first.at(number));
                    if batch.count() == BATCH {
                        self.take(&mut pixels, job, &mut batch);
                    }
                }
            }
        }
        self.take(&mut pixels, job, &mut batch);
        self.rays.add(&batch.log.counts);
        self.cut_off.add(&batch.log.cut_off);
        self.error = ErrorSums::of(pixels.iter().flat_map(|row| row.iter()));
        done
    }

    /// Its pixels with their places in its vectors, neighbours near each other: what is traced together is to
    /// be near.
    fn pixels_by_neighbourhood(&self) -> impl Iterator<Item = (usize, UVec2)> + use<> {
        let rect = self.rect;
        (0..TILE * TILE).filter_map(move |code| {
            let UVec2 { x, y } = morton_pixel(code);
            let place = (y * rect.width + x) as usize;
            let pixel = UVec2::new(rect.x + x, rect.y + y);
            (x < rect.width && y < rect.height).then_some((place, pixel))
        })
    }

    /// Takes the samples of `batch`, and empties it.
    fn take(&mut self, pixels: &mut Rows, job: &Job, batch: &mut Batch) {
        let count = batch.count();
        if count == 0 {
            return;
        }
        batch.trace();
        let mut end = 0;
        for run in batch.places[..count].chunk_by(Place::is_same_half) {
            let Place { i, half, pixel } = run[0];
            let numbers = end..end + run.len();
            end = numbers.end;
            self.taken[i][half] += run.len() as u32;
            let row = &mut pixels[(pixel.y - self.rect.y) as usize];
            let at = &mut row[(pixel.x - self.rect.x) as usize];
            let are_added = at.add_samples(half, &batch.radiances[numbers.clone()]);
            if are_added && batch.log.accounts.is_empty() {
                continue;
            }
            for number in numbers {
                if !batch.radiances[number].is_finite() {
                    self.rejected += 1;
                    let index = batch.samples.samplers.get(number).map(|s| s.index());
                    let sample = index.map(|index| RejectedSample { pixel, index });
                    self.first_rejected = self.first_rejected.or(sample);
                } else if let Some(account) = batch.log.accounts.get(number) {
                    let ray = batch.samples.rays.get(number);
                    self.add_layers(job, [i, half], &ray, account);
                }
            }
        }
        batch.samples.samplers.clear();
    }

    /// Adds what `account` tells of a sample along `ray` to the layers, at a pixel's number and half.
    fn add_layers(&mut self, job: &Job, [i, half]: [usize; 2], ray: &Ray, account: &Account) {
        let first = account.seen.first().map(|seen| seen.sight);
        let first = FirstSurface::of(job.scene, ray, first);
        for (layer, aov) in self.layers.iter_mut().zip(&job.layers) {
            let value = match *aov {
                Aov::View(kind) => first.value(kind),
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
}

/// Samples that are taken together.
struct Batch<'a> {
    job: &'a Job<'a>,
    integrator: &'a dyn Integrator,
    rays: CameraRays<'a>,
    /// Where each of them goes.
    places: [Place; BATCH],
    /// Their rays are found when they are traced.
    samples: CameraRow,
    radiances: [Rgb; BATCH],
    log: RayLog,
}

/// Where a sample goes.
#[derive(Clone, Copy, Default)]
struct Place {
    /// The pixel's place in the vectors of its tile.
    i: usize,
    half: usize,
    pixel: UVec2,
}

impl Place {
    fn is_same_half(&self, other: &Self) -> bool {
        self.i == other.i && self.half == other.half
    }
}

impl<'a> Batch<'a> {
    fn new(job: &'a Job, integrator: &'a dyn Integrator, account: Option<&Account>) -> Self {
        Self {
            job,
            integrator,
            rays: job.camera.rays(job.settings.size),
            places: [Place::default(); BATCH],
            samples: CameraRow::EMPTY,
            radiances: [Rgb::BLACK; BATCH],
            log: RayLog::told(account.map_or(Vec::new(), |account| vec![account.clone(); BATCH])),
        }
    }

    fn count(&self) -> usize {
        self.samples.samplers.count()
    }

    fn add(&mut self, place: Place, sampler: &Sampler) {
        self.places[self.count()] = place;
        self.samples.samplers.push(sampler);
    }

    fn trace(&mut self) {
        let count = self.count();
        self.find_rays();
        let told = self.log.accounts.iter_mut().take(count);
        told.for_each(Account::clear);
        self.integrator
            .radiances(&self.samples, &mut self.radiances, &mut self.log);
    }

    /// As [`camera_sample`] finds each of them.
    fn find_rays(&mut self) {
        let mut film = [Vec2::ZERO; ROW];
        let mut lens = [Vec2::ZERO; ROW];
        let CameraRow { rays, samplers } = &mut self.samples;
        samplers.camera(&mut film);
        for (film, place) in film.iter_mut().zip(&self.places) {
            *film = film_position(place.pixel, *film);
        }
        if self.job.camera.lens_radius > 0.0 {
            for (i, place) in lens.iter_mut().enumerate() {
                *place = samplers
                    .get(i)
                    .map_or(Vec2::ZERO, |s| lens_position(self.job, &s));
            }
        }
        *rays = self.rays.row(&film, &lens, samplers.count());
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
    (rays.at(film, lens_position(job, &sampler)), sampler)
}

/// Where on the lens a sample starts, in the unit disk; a pinhole needs no number for it.
fn lens_position(job: &Job, sampler: &Sampler) -> Vec2 {
    if job.camera.lens_radius > 0.0 {
        sampler.lens()
    } else {
        Vec2::ZERO
    }
}

/// The pixels of the job's part of the film, row by row, without samples.
pub(super) fn pixels(job: &Job) -> Vec<Pixel> {
    let all = 0..job.crop.area() as usize;
    all.into_par_iter().map(|_| Pixel::default()).collect()
}

/// The tiles of the job's part of the film, row by row.
pub(super) fn tiles(job: &Job) -> Vec<Tile> {
    let tile = |rect| Tile::new(rect, &job.layers);
    // Most of it is the system's work for memory that is new.
    places(job.crop).into_par_iter().map(tile).collect()
}

/// Where the tiles of `film` are.
fn places(film: Rect) -> Vec<Rect> {
    let steps = |start: u32, length: u32| (start..start + length).step_by(TILE as usize);
    let corners =
        steps(film.y, film.height).flat_map(|y| steps(film.x, film.width).map(move |x| (x, y)));
    let rect = |(x, y)| Rect {
        x,
        y,
        width: TILE.min(film.x + film.width - x),
        height: TILE.min(film.y + film.height - y),
    };
    corners.map(rect).collect()
}

/// The error of all tiles, summed in their order; `None` where one does not tell.
pub(super) fn error_of(tiles: &[Tile]) -> Option<ErrorSums> {
    let mut sums = ErrorSums::default();
    for tile in tiles {
        sums.add_all(tile.error.as_ref()?);
    }
    Some(sums)
}

/// The pixels of each of the [`tiles`] of `film`.
pub(super) fn rows(film: Rect, pixels: &mut [Pixel]) -> Vec<Rows<'_>> {
    let width = (film.width as usize).max(1);
    let bands = pixels.chunks_mut(TILE as usize * width);
    let tiles = bands.flat_map(|band| {
        let mut tiles = Vec::new();
        for row in band.chunks_mut(width) {
            let parts = row.chunks_mut(TILE as usize);
            tiles.resize_with(parts.len(), || Rows::with_capacity(TILE as usize));
            for (tile, part) in tiles.iter_mut().zip(parts) {
                tile.push(part);
            }
        }
        tiles
    });
    tiles.collect()
}

/// Puts pixels and tiles together.
pub(super) fn assemble(
    job: &Job,
    pixels: Vec<Pixel>,
    tiles: &[Tile],
    stopped_by: StoppedBy,
) -> Film {
    let crop = job.crop;
    let area = pixels.len();
    let mut film = Film {
        rect: crop,
        pixels,
        layers: vec![vec![[0.0; 3]; area]; job.layers.len()],
        objects: match job.layers.contains(&Aov::Objects) {
            true => vec![Vec::new(); area],
            false => Vec::new(),
        },
        rejected: 0,
        first_rejected: None,
        rays: RayCounts::default(),
        cut_off: CutOff::default(),
        stopped_by,
    };
    for tile in tiles {
        let has_more = !(film.layers.is_empty() && tile.objects.is_empty());
        for (i, at) in tile.rect.pixels().enumerate().filter(|_| has_more) {
            let to = crop.index(at);
            let pixel = &film.pixels[to];
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
        film.cut_off.add(&tile.cut_off);
    }
    film
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_is_in_the_rows_of_its_tile() {
        for (width, height) in [(1, 40), (40, 1), (16, 16), (35, 33), (17, 15)] {
            let film = Rect {
                x: 3,
                y: 5,
                width,
                height,
            };
            // The number of each pixel is that of its samples.
            let pixel = |number: usize| {
                let mut pixel = Pixel::default();
                pixel.add_samples(0, &vec![Rgb::WHITE; number + 1]);
                pixel
            };
            let mut pixels: Vec<_> = (0..film.area() as usize).map(pixel).collect();
            let tiles = places(film);
            let rows = rows(film, &mut pixels);
            assert_eq!(rows.len(), tiles.len());
            let mut seen = 0;
            for (rows, rect) in rows.iter().zip(tiles) {
                let pixels: Vec<&Pixel> = rows.iter().flat_map(|row| row.iter()).collect();
                assert_eq!(pixels.len() as u64, rect.area());
                for (pixel, place) in pixels.into_iter().zip(rect.pixels()) {
                    assert_eq!(pixel.count(), film.index(place) as u64 + 1);
                    seen += 1;
                }
            }
            assert_eq!(seen, film.area());
        }
    }
}
