//! Light that is looked for: from a surface straight to the lights.

use super::PathTracer;
use super::lights::{Incident, Place};
use super::shadow::let_through;
use super::walk::{Walk, beyond, through};
use crate::color::Rgb;
use crate::integrate::visibility::transmittance;
use crate::integrate::way::way;
use crate::integrate::{RayKind, RayLog, RayRecord};
use crate::light::ShadowEnd;
use crate::prepare::Surface;
use crate::sampling::Sampler;

impl PathTracer<'_> {
    /// Samples of a light at a surface that the camera sees, where all lights are looked at.
    pub(super) fn samples_of(&self, light: u32) -> u32 {
        self.samples.get(light as usize).copied().unwrap_or(1)
    }

    /// Direct light at `surface`, what of it leaves along the walk; `each` hears of the lights that it comes from.
    pub(super) fn direct(
        &self,
        surface: &Surface,
        walk: &Walk,
        place: &Place,
        sampler: &Sampler,
        log: &mut RayLog,
        mut each: impl FnMut(u32, Rgb),
    ) -> Rgb {
        if let Some(all) = self.lights.all_from(place) {
            let mut total = Rgb::BLACK;
            for (order, &light) in (0..).zip(all) {
                let count = self.samples_of(light);
                for j in 0..count {
                    let u = sampler.light(walk.vertex, order, j, count);
                    if let Some(incident) = self.lights.sample(light, place.receiver.point, u) {
                        let value =
                            self.gathered(surface, walk, light, &incident, count.into(), log);
                        each(light, value);
                        total += value;
                    }
                }
            }
            return total;
        }
        let chosen = self
            .lights
            .choose(place, || sampler.light_choice(walk.vertex));
        let Some((light, probability)) = chosen else {
            return Rgb::BLACK;
        };
        let u = sampler.light(walk.vertex, 0, 0, 1);
        (self.lights.sample(light, place.receiver.point, u)).map_or(Rgb::BLACK, |incident| {
            let value = self.gathered(surface, walk, light, &incident, probability, log);
            each(light, value);
            value
        })
    }

    /// What one sample of a light adds, of which `expected` are taken.
    ///
    /// Shadow rays start on the smooth surface that vertex normals describe, paths go on from the triangle. Light below the
    /// horizon of the triangle, which scattering never finds, is looked at alone, with its full weight.
    /// Above it both ways count, and start apart by the height of the bulge: what stands so near that the one start sees
    /// past it and the other does not is counted by the share of either.
    fn gathered(
        &self,
        surface: &Surface,
        walk: &Walk,
        light: u32,
        incident: &Incident,
        expected: f64,
        log: &mut RayLog,
    ) -> Rgb {
        let mut at = surface.interaction;
        if !self.smooths_shadows {
            at.smooth_point = None;
        }
        let wi = incident.wi;
        let Some(way) = way(&at, wi, incident.shadow) else {
            return Rgb::BLACK;
        };
        let (value, found) = surface.eval_and_pdf(wi, at.smooth_point.is_some());
        let scattered = value * way.cos;
        if scattered.is_black() {
            return Rgb::BLACK;
        }
        // What has no surface is not found by scattering.
        let met = match incident.density > 0.0 {
            true => f64::from(found),
            false => 0.0,
        };
        let weight = (self.weighing).weight(true, expected * incident.density, met);
        let unshadowed = incident.weight * scattered * (weight / expected as f32);
        let distance = match incident.shadow {
            ShadowEnd::Point(target) => target.distance(at.point),
            ShadowEnd::Direction(_) => f32::INFINITY,
        };
        let around = match way.is_behind {
            true => beyond(surface),
            false => walk.absorption,
        };
        let absorbed = around.map_or(Rgb::WHITE, |absorption| {
            through(absorption, self.scene.world_distance(distance))
        });
        let value = unshadowed * absorbed * transmittance(self.scene, &way.ray, let_through);
        let kind = RayKind::Shadow(light);
        log.add(kind, || RayRecord {
            kind,
            depth: walk.scattered,
            ray: way.ray,
            t: None,
            weight: walk.throughput * value,
        });
        value
    }
}
