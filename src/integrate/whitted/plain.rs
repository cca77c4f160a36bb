//! Direct light on plain surfaces that the camera sees, for all samples of a batch at once.
//!
//! It is what [`Whitted::follow`] comes to there, bit for bit, with the arithmetic done in rows.

use super::{Pending, Whitted, Work};
use crate::bvh::Hit;
use crate::color::Rgb;
use crate::integrate::way::way_in_front;
use crate::integrate::{CameraSample, RayLog, Sight, Source};
use crate::light::{Light, LightSampleRow};
use crate::material::Bsdf;
use crate::math::{FEW, ROW, Ray, Row, RowJob, Vec2, VectorRow, widely};
use crate::prepare::PlainRow;
use crate::sampling::Sampler;

/// Camera samples that see plain surfaces.
pub(super) struct Plain {
    surfaces: PlainRow,
    /// Their places among those that are taken together.
    places: [usize; ROW],
}

impl Plain {
    pub const NONE: Self = Self {
        surfaces: PlainRow::EMPTY,
        places: [0; ROW],
    };

    /// Whether there is no room for another one.
    pub fn is_full(&self) -> bool {
        self.surfaces.count() == ROW
    }
}

/// Shadow rays of a row of points to one light.
struct WayRow {
    origin: VectorRow,
    direction: VectorRow,
    t_max: Row,
    /// Cosine at the surface.
    cos: Row,
    is_open: [bool; ROW],
}

impl WayRow {
    const NONE: Self = Self {
        origin: VectorRow::ZERO,
        direction: VectorRow::ZERO,
        t_max: [0.0; ROW],
        cos: [0.0; ROW],
        is_open: [false; ROW],
    };

    #[inline(always)]
    fn find(&mut self, i: usize, surfaces: &PlainRow, samples: &LightSampleRow) {
        let at = surfaces.lit_side(i);
        let sample = samples.get(i);
        let (way, is_in_front) = way_in_front(&at, sample.wi, sample.shadow);
        let is_seen = at.shading_normal.dot(*surfaces.wo(i)) > 0.0;
        self.is_open[i] = samples.is_some(i) & is_seen & is_in_front;
        self.origin.set(i, way.ray.origin);
        self.direction.set(i, way.ray.direction);
        self.t_max[i] = way.ray.t_max;
        self.cos[i] = way.cos;
    }

    #[inline(always)]
    fn ray(&self, i: usize) -> Ray {
        Ray {
            t_max: self.t_max[i],
            ..Ray::new(self.origin.get(i), self.direction.get(i))
        }
    }
}

struct Find<'a> {
    surfaces: &'a PlainRow,
    samples: &'a LightSampleRow,
}

impl RowJob for Find<'_> {
    type Output = WayRow;

    #[inline(always)]
    fn call(self) -> WayRow {
        let mut ways = WayRow::NONE;
        for i in 0..ROW {
            ways.find(i, self.surfaces, self.samples);
        }
        ways
    }
}

impl Whitted<'_> {
    /// Adds a camera ray whose first `hit` is on a plain surface to `plain`, and returns the ambient light that the
    /// surface sends back; its direct light is found by [`Self::light_plain`]. `None` where it has to be
    /// followed.
    pub(super) fn see_plain(
        &self,
        camera: &Pending,
        hit: &Hit,
        place: usize,
        plain: &mut Plain,
        log: &mut RayLog,
    ) -> Option<Rgb> {
        let ray = &camera.ray;
        if self.max_depth == 0 || self.light_between(ray, 0.0, Some(hit)).is_some() {
            return None;
        }
        let i = plain.surfaces.count();
        if !self.scene.add_plain(&mut plain.surfaces, ray, hit) {
            return None;
        }
        plain.places[i] = place;
        log.add(camera.kind, || camera.record(Some(hit)));
        log.see(Sight::Surface(*hit), 1.0);
        let albedo = self.scene.plain_bsdf(&plain.surfaces, i).map(Bsdf::diffuse);
        let ambient = self.scene.background.ambient * albedo.unwrap_or(Rgb::BLACK);
        log.light(Source::Background, 1, Rgb::WHITE, ambient);
        Some(ambient)
    }

    /// Sends the shadow rays from all of `plain` to all lights, and empties it.
    pub(super) fn light_plain(
        &self,
        plain: &mut Plain,
        samples: &[CameraSample],
        work: &mut Work,
        log: &mut RayLog,
    ) {
        let Plain { surfaces, places } = plain;
        let places = &places[..surfaces.count()];
        if places.is_empty() {
            return;
        }
        surfaces.locate(self.smooths_shadows);
        let mut row = LightRow {
            u: [Vec2::ZERO; ROW],
            samples: LightSampleRow::NONE,
            ways: WayRow::NONE,
        };
        for &number in &self.scene.shining {
            let light = &self.scene.lights[number as usize];
            let count = self.samples[number as usize];
            for j in 0..count {
                let samplers = places.iter().map(|&place| &samples[place].sampler);
                Sampler::light_row(samplers, [1, number, j, count], &mut row.u);
                row.sample(light, surfaces);
                for (i, &place) in places.iter().enumerate() {
                    if let Some((ray, value)) = self.direct_plain(surfaces, &row, i) {
                        let value = value / count as f32;
                        work.add_shadow(ray, place, number, 0, value);
                    }
                }
                self.light_up_if_full(work, log);
            }
        }
        surfaces.clear();
    }

    /// What the sample of a light adds to sample `i` where nothing is in the way of a ray.
    fn direct_plain(&self, surfaces: &PlainRow, row: &LightRow, i: usize) -> Option<(Ray, Rgb)> {
        if !row.ways.is_open[i] {
            return None;
        }
        let sample = row.samples.get(i);
        let bsdf = self.scene.plain_bsdf(surfaces, i)?;
        let scattered = bsdf.matte().unwrap_or_else(|| {
            let normal = surfaces.lit_side(i).shading_normal;
            bsdf.eval(normal, surfaces.wo(i), sample.wi)
        });
        let unshadowed = sample.weight * scattered * row.ways.cos[i];
        (!unshadowed.is_black()).then(|| (row.ways.ray(i), unshadowed))
    }
}

/// Samples of one light, and the shadow rays to them.
struct LightRow {
    u: [Vec2; ROW],
    samples: LightSampleRow,
    ways: WayRow,
}

impl LightRow {
    fn sample(&mut self, light: &Light, surfaces: &PlainRow) {
        let Self { u, samples, ways } = self;
        let count = surfaces.count();
        light.sample_row(surfaces.points(), u, count, samples);
        if count < FEW {
            (0..count).for_each(|i| ways.find(i, surfaces, samples));
        } else {
            *ways = widely(Find { surfaces, samples });
        }
    }
}
