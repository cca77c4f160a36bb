//! Direct light on plain surfaces that the camera sees, for a row of samples at once.
//!
//! It is what [`Whitted::follow`] comes to there, bit for bit, with the arithmetic done in rows.

use super::{Pending, Whitted, tell_shadow};
use crate::bvh::HitRow;
use crate::color::Rgb;
use crate::integrate::way::way_in_front;
use crate::integrate::{CameraRow, RayKind, RayLog, Sight, Source};
use crate::light::LightSampleRow;
use crate::math::{
    FEW, ROW, RayRow, Row, RowJob, Vec2, Vec3, VectorRow, places, those_where, widely,
};
use crate::prepare::PlainRow;

/// Shadow rays of a row of points to one light.
struct WayRow {
    rays: RayRow,
    /// Cosine at the surface.
    cos: Row,
    /// What the light adds where nothing is in the way, if the surface is matte.
    value: VectorRow,
    /// Whether light could come that way.
    is_open: [bool; ROW],
}

impl WayRow {
    const NONE: Self = Self {
        rays: RayRow::EMPTY,
        cos: [0.0; ROW],
        value: VectorRow::ZERO,
        is_open: [false; ROW],
    };
}

/// Finds the ways.
struct Find<'a> {
    surfaces: &'a PlainRow,
    samples: &'a LightSampleRow,
    /// Shadow rays for each point.
    count: f32,
}

impl Find<'_> {
    #[inline(always)]
    fn find(&self, i: usize, ways: &mut WayRow) {
        let at = self.surfaces.lit_side(i);
        let sample = self.samples.get(i);
        let (way, is_in_front) = way_in_front(&at, sample.wi, sample.shadow);
        let is_seen = at.shading_normal.dot(*self.surfaces.wo(i)) > 0.0;
        let matte = sample.weight * self.surfaces.matte(i) * way.cos;
        let is_open = self.samples.is_some(i) & is_seen & is_in_front;
        ways.is_open[i] = is_open & (!matte.is_black() | self.surfaces.is_glossy(i));
        ways.rays.origins.set(i, way.ray.origin);
        ways.rays.directions.set(i, way.ray.direction);
        ways.rays.t_max[i] = way.ray.t_max;
        ways.cos[i] = way.cos;
        ways.value
            .set(i, Vec3::from((matte / self.count).channels()));
    }
}

impl RowJob for Find<'_> {
    type Output = WayRow;

    #[inline(always)]
    fn call(self) -> WayRow {
        let mut ways = WayRow::NONE;
        for i in 0..ROW {
            self.find(i, &mut ways);
        }
        ways
    }
}

impl Whitted<'_> {
    /// Adds those of `samples` whose first hits are on plain surfaces and before all lights to `surfaces`, which has none.
    pub(super) fn see_plain(&self, samples: &CameraRow, hits: &HitRow, surfaces: &mut PlainRow) {
        let rays = &samples.rays;
        let met = self.visible.are_met_by(rays, &hits.t);
        let is_lit = self.max_depth > 0;
        let of = if is_lit { hits.is_hit & !met } else { 0 };
        let is_bulging = self.smooths_shadows;
        self.scene.see_plain(rays, hits, of, is_bulging, surfaces);
    }

    /// The light that all of `surfaces` send to the camera, into `radiances`.
    pub(super) fn light_plain(
        &self,
        surfaces: &PlainRow,
        samples: &CameraRow,
        hits: &HitRow,
        radiances: &mut [Rgb; ROW],
        log: &mut RayLog,
    ) {
        if surfaces.places() == 0 {
            return;
        }
        let ambient = self.scene.background.ambient;
        for i in places(surfaces.places()) {
            radiances[i] = match self.scene.plain_bsdf(surfaces, i) {
                Some(bsdf) if !ambient.is_black() => ambient * bsdf.diffuse(),
                _ => Rgb::BLACK,
            };
        }
        self.tell_seen(surfaces, samples, hits, radiances, log);
        let mut lit = [Rgb::BLACK; ROW];
        let mut row = LightRow {
            u: [Vec2::ZERO; ROW],
            samples: LightSampleRow::NONE,
            ways: WayRow::NONE,
        };
        for &number in &self.scene.shining {
            let light = &self.scene.lights[number as usize];
            let count = self.samples[number as usize];
            for j in 0..count {
                let (of, dimension) = (surfaces.places(), [1, number, j, count]);
                samples.samplers.light(dimension, of, &mut row.u);
                light.sample_row(surfaces.points(), &row.u, of, &mut row.samples);
                let open = self.find_ways(surfaces, count, &mut row);
                let LightRow { ways, .. } = &mut row;
                ways.rays.keep(open);
                let blocked = self.scene.are_blocked(&ways.rays);
                let value = |i: usize| Rgb::from(ways.value.get(i).to_array());
                if let (Some(blocked), false) = (blocked, log.is_heard()) {
                    log.counts.shadow += u64::from(open.count_ones());
                    let is_lit = |ray: &usize| blocked >> ray & 1 == 0;
                    for (_, i) in places(open).enumerate().filter(|(ray, _)| is_lit(ray)) {
                        lit[i] += value(i);
                    }
                    continue;
                }
                for (ray, i) in places(open).enumerate() {
                    let value = self.unblocked(value(i), &ways.rays, ray, blocked);
                    lit[i] += value;
                    log.turn_to(i);
                    tell_shadow(log, number, 0, value, || ways.rays.get(ray));
                }
            }
        }
        for i in places(surfaces.places()) {
            radiances[i] += lit[i];
        }
    }

    /// Finds the shadow rays to the samples of a light; a bit for each place where light could come.
    fn find_ways(&self, surfaces: &PlainRow, count: u32, row: &mut LightRow) -> u64 {
        let find = Find {
            surfaces,
            samples: &row.samples,
            count: count as f32,
        };
        let (of, ways) = (surfaces.places(), &mut row.ways);
        if (of.count_ones() as usize) < FEW {
            places(of).for_each(|i| find.find(i, ways));
        } else {
            *ways = widely(find);
        }
        let mut open = those_where(&ways.is_open) & of;
        for i in places(open & surfaces.glossy()) {
            let sample = row.samples.get(i);
            let normal = surfaces.lit_side(i).shading_normal;
            let bsdf = self.scene.plain_bsdf(surfaces, i);
            let value = bsdf.map_or(Rgb::BLACK, |bsdf| {
                sample.weight * bsdf.eval(normal, surfaces.wo(i), sample.wi) * ways.cos[i]
            });
            if value.is_black() {
                open &= !(1 << i);
            }
            ways.value
                .set(i, Vec3::from((value / count as f32).channels()));
        }
        open
    }

    /// Tells `log` what the camera sees, and what comes from there without a light: `ambient`.
    fn tell_seen(
        &self,
        surfaces: &PlainRow,
        samples: &CameraRow,
        hits: &HitRow,
        ambient: &[Rgb; ROW],
        log: &mut RayLog,
    ) {
        if !log.is_heard() {
            log.counts.camera += u64::from(surfaces.places().count_ones());
            return;
        }
        for i in places(surfaces.places()) {
            let hit = hits.get(i);
            log.turn_to(i);
            log.add(RayKind::Camera, || {
                Pending::camera(samples.rays.get(i)).record(hit.as_ref())
            });
            if let Some(hit) = hit {
                log.see(Sight::Surface(hit), 1.0);
            }
            log.light(Source::Background, 1, Rgb::WHITE, ambient[i]);
        }
    }
}

/// Samples of one light, and the shadow rays to them.
struct LightRow {
    u: [Vec2; ROW],
    samples: LightSampleRow,
    ways: WayRow,
}
