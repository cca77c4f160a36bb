//! The way of a path from one surface that scatters it to the next, and the light that it meets there.

use std::cmp::Ordering;

use super::PathTracer;
use super::lights::Place;
use crate::bvh::Hit;
use crate::color::Rgb;
use crate::integrate::met::nearest_visible;
use crate::integrate::{RayKind, RayLog, RayRecord, Sight, Source};
use crate::math::{Ray, UnitVec3};
use crate::prepare::{Surface, TriangleId};
use crate::sampling::Sampler;

/// A path on its way.
pub(super) struct Walk {
    pub ray: Ray,
    pub kind: RayKind,
    /// What light from here on counts for.
    pub throughput: Rgb,
    /// Scattering events so far.
    pub scattered: u32,
    /// The number of the next vertex, by which random numbers are named.
    pub vertex: u32,
    /// Where the ray comes from, if lights were looked at from there.
    pub departure: Option<Departure>,
    /// Whether it has met mirrors and glass only: then it sees what the camera would see.
    pub is_viewing: bool,
    /// What the body that it is in takes from it, per metre.
    pub absorption: Option<Rgb>,
    /// Whether nothing is between it and the camera, not even glass.
    pub is_clear: bool,
    /// How far along the ray it has come.
    pub passed: Option<Hit>,
    /// What the ray meets first, where that has been found already.
    pub found: Option<Option<Hit>>,
}

/// A scattering by which a light may have been found in place of being looked at.
#[derive(Clone, Copy)]
pub(super) struct Departure {
    pub place: Place,
    /// Of the ray's direction, by solid angle.
    pub density: f64,
}

impl<'a> PathTracer<'a> {
    /// Follows the ray to the next surface that scatters, adding the light that it meets; `None` where there is
    /// no such surface.
    pub(super) fn advance(
        &self,
        walk: &mut Walk,
        sampler: &Sampler,
        log: &mut RayLog,
        total: &mut Rgb,
    ) -> Option<Surface<'a>> {
        loop {
            let find = || self.scene.closest_hit(&walk.ray, walk.passed.as_ref());
            let hit = walk.found.take().unwrap_or_else(find);
            if walk.passed.is_none() {
                log.add(walk.kind, || RayRecord {
                    kind: walk.kind,
                    depth: walk.scattered,
                    ray: walk.ray,
                    t: hit.map(|h| h.t),
                    weight: walk.throughput,
                });
            }
            let mut radiance = Rgb::BLACK;
            let end = self.lights_before(walk, hit.as_ref(), |_, light| radiance += light);
            let kept = self.add(total, walk, radiance, walk.scattered, log);
            if log.is_told() && !radiance.is_black() {
                self.lights_before(walk, hit.as_ref(), |number, light| {
                    log.light(self.source_of(number), walk.scattered, kept, light);
                });
            }
            if let Some(t) = end {
                self.see(walk, Sight::Light { t }, log);
                return None;
            }
            let Some(hit) = hit else {
                let through = self.through_body(walk, f32::INFINITY);
                let mut radiance = Rgb::BLACK;
                self.beyond(walk, |_, light| radiance += light);
                let kept = self.add(total, walk, through * radiance, walk.scattered, log);
                if log.is_told() && !radiance.is_black() {
                    self.beyond(walk, |source, light| {
                        log.light(source, walk.scattered, kept, through * light);
                    });
                }
                return None;
            };
            walk.throughput *= self.through_body(walk, hit.t);
            walk.passed = Some(hit);
            if let Some(surface) = self.met(walk, &hit, sampler) {
                self.see(walk, Sight::Surface(hit), log);
                let radiance = self.emitted(walk, &surface, &hit);
                let kept = self.add(total, walk, radiance, walk.scattered, log);
                log.light(Source::Surface, walk.scattered, kept, radiance);
                return Some(surface);
            }
        }
    }

    /// What the camera sees is told once: it covers all that is behind it.
    fn see(&self, walk: &mut Walk, sight: Sight, log: &mut RayLog) {
        if walk.is_clear {
            log.see(sight, 1.0);
            walk.is_clear = false;
        }
    }

    /// What the light with this number is.
    pub(super) fn source_of(&self, light: u32) -> Source {
        match (light as usize).cmp(&self.scene.lights.len()) {
            Ordering::Less => Source::Light(light),
            Ordering::Equal => Source::Background,
            Ordering::Greater => Source::Surface,
        }
    }

    /// The surface at `hit`, unless the walk goes on as if it were not there.
    fn met(&self, walk: &mut Walk, hit: &Hit, sampler: &Sampler) -> Option<Surface<'a>> {
        if walk.is_viewing && self.scene.visibility(&walk.ray, hit) <= 0.0 {
            return None;
        }
        let mut surface = self.scene.surface(&walk.ray, hit);
        surface.bsdf = surface.bsdf.conserving();
        let opacity = surface.material.opacity(&surface.lookup);
        if opacity >= 1.0 {
            return Some(surface);
        }
        if opacity <= 0.0 {
            return None;
        }
        let u = sampler.crossing(walk.vertex);
        walk.vertex += 1;
        (u < opacity).then_some(surface)
    }

    /// Share of the light that the body around the walk lets through from where it is to `t`.
    fn through_body(&self, walk: &Walk, t: f32) -> Rgb {
        let Some(absorption) = walk.absorption else {
            return Rgb::WHITE;
        };
        let way = (t - walk.passed.map_or(0.0, |h| h.t)) * walk.ray.direction.length();
        through(absorption, self.scene.world_distance(way))
    }

    /// Adds light that was scattered `scattered` times, what is left of it; returns what it was counted for.
    pub(super) fn add(
        &self,
        total: &mut Rgb,
        walk: &Walk,
        radiance: Rgb,
        scattered: u32,
        log: &mut RayLog,
    ) -> Rgb {
        let value = walk.throughput * radiance;
        let most = value.max_channel();
        if scattered < 2 || most <= self.clamp || !value.is_finite() {
            *total += value;
            return walk.throughput;
        }
        let share = self.clamp / most;
        let kept = value * share;
        log.counts.clamped += f64::from((value - kept).luminance());
        *total += kept;
        walk.throughput * share
    }

    /// Gives `add` the number and the light of each of the scene's lights whose surfaces the ray meets before
    /// `hit`; returns where it ends, if at one of them.
    ///
    /// A camera, and its image in a mirror, sees lights as things that hide what is behind them. For rays
    /// that are weighed against shadow rays lights hide nothing, as they do for those.
    fn lights_before(
        &self,
        walk: &Walk,
        hit: Option<&Hit>,
        mut add: impl FnMut(u32, Rgb),
    ) -> Option<f32> {
        let start = walk.passed.map_or(0.0, |h| h.t);
        let end = hit.map_or(walk.ray.t_max, |h| h.t);
        let met = self.surfaces.between(&walk.ray, start, end);
        if let Some(departure) = &walk.departure {
            for light in &met {
                let weight = self.weight(departure, light.number, &walk.ray);
                let through = self.through_body(walk, light.t);
                add(light.number, light.radiance * weight * through);
            }
            return None;
        }
        let last = nearest_visible(&met).map(|light| light.t);
        let end = last.unwrap_or(f32::INFINITY);
        for light in &met {
            let is_seen = light.t == end && light.is_visible;
            let is_unseen_before = walk.scattered > 0 && !light.is_visible && light.t < end;
            if is_seen || is_unseen_before {
                let through = self.through_body(walk, light.t);
                add(light.number, light.radiance * through);
            }
        }
        last
    }

    /// Gives `add` what comes from beyond the scene, and where from.
    fn beyond(&self, walk: &Walk, mut add: impl FnMut(Source, Rgb)) {
        if walk.is_clear && self.is_transparent {
            return;
        }
        let Some(wi) = UnitVec3::normalize(walk.ray.direction) else {
            return add(Source::Background, self.scene.background.radiance);
        };
        if walk.scattered == 0 {
            return add(Source::Background, self.scene.radiance_beyond(&walk.ray));
        }
        add(Source::Background, self.scene.background.radiance);
        for (light, radiance) in self.lights.beyond(wi) {
            if !radiance.is_black() {
                let weight =
                    (walk.departure.as_ref()).map_or(1.0, |d| self.weight(d, light, &walk.ray));
                add(self.source_of(light), radiance * weight);
            }
        }
    }

    /// Light that `surface` gives off along the walk.
    fn emitted(&self, walk: &Walk, surface: &Surface, hit: &Hit) -> Rgb {
        // The back of what is seen from one side only gives no light.
        if !surface.interaction.is_front && !surface.material.is_seen_from_back() {
            return Rgb::BLACK;
        }
        let radiance = surface.material.emitted(&surface.lookup);
        match (&walk.departure, radiance.is_black()) {
            (Some(departure), false) => match self.lights.number_of(TriangleId::of(hit)) {
                Some(light) => radiance * self.weight(departure, light, &walk.ray),
                None => radiance,
            },
            _ => radiance,
        }
    }

    /// What a light counts for that was met by a ray from `departure`: the power heuristic.
    fn weight(&self, departure: &Departure, light: u32, ray: &Ray) -> f32 {
        let Some(wi) = UnitVec3::normalize(ray.direction) else {
            return 1.0;
        };
        let place = &departure.place;
        let expected = self
            .lights
            .expected(place, light, |light| self.samples_of(light));
        if expected == 0.0 {
            return 1.0;
        }
        let looked = expected * self.lights.density(light, place.receiver.point, wi);
        self.weighing.weight(false, departure.density, looked)
    }
}

/// What the body on the far side of `surface` takes from light, per metre.
pub(super) fn beyond(surface: &Surface) -> Option<Rgb> {
    surface
        .absorption()
        .filter(|_| surface.interaction.is_front)
}

/// Share of the light that comes through `metres` of a body (Beer's law).
pub(super) fn through(absorption: Rgb, metres: f32) -> Rgb {
    absorption.map(|a| if a > 0.0 { (-a * metres).exp() } else { 1.0 })
}
