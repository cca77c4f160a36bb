//! Local shading, shadows, mirrors and glass
//! (Whitted 1980, "An Improved Illumination Model for Shaded Display").

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::interaction::Interaction;
use crate::light::{Light, LightSample, ShadowEnd};
use crate::material::{Bsdf, reflect, refract};
use crate::math::Ray;
use crate::prepare::{PreparedScene, Surface};
use crate::sampling::Sampler;
use crate::scene::Settings;

use super::visibility::transmittance;
use super::{Integrator, RayKind, RayLog, RayRecord, light_samples};

/// Rays that count for less than this in every channel are not followed: what is cut off is at
/// most this share of what they would have brought back.
const LEAST_WEIGHT: f32 = 1e-5;

/// Direct light with shadows on matte and glossy surfaces; mirrors and glass are followed.
#[derive(Debug)]
pub struct Whitted<'a> {
    scene: &'a PreparedScene<'a>,
    max_depth: u32,
    /// Whether shadow rays start on the surface that vertex normals describe.
    smooths_shadows: bool,
    /// Per light: shadow rays per shading point.
    samples: Vec<u32>,
    /// Lights that rays can meet.
    visible: Vec<&'a Light>,
}

/// A ray that waits to be followed.
struct Pending {
    kind: RayKind,
    ray: Ray,
    weight: Rgb,
    /// Scattering events before it.
    depth: u32,
    /// Which vertex of the tree of rays it leads to: 1 is what the camera sees ([`child`]).
    vertex: u32,
}

/// The vertex that a ray leads to which leaves `vertex` by the way of `branch`, an odd number: a
/// step of a linear congruential generator, so that even the deepest have numbers of their own.
fn child(vertex: u32, branch: u32) -> u32 {
    vertex.wrapping_mul(0x9e37_79b1).wrapping_add(branch)
}

impl<'a> Whitted<'a> {
    /// The technique with the depth and shadow rays of `settings`.
    pub fn new(scene: &'a PreparedScene<'a>, settings: &Settings) -> Self {
        let pattern = settings.sampling.pattern;
        let samples = |light| light_samples(light, settings.light_samples, pattern);
        Self {
            scene,
            max_depth: settings.max_depth,
            smooths_shadows: settings.shadow_terminator,
            samples: scene.lights.iter().map(samples).collect(),
            visible: scene.lights.iter().filter(|l| l.is_visible()).collect(),
        }
    }

    /// What comes back along one ray, surfaces that it crosses without a bend included; rays that
    /// leave in other directions are added to `pending`.
    fn follow(
        &self,
        from: &Pending,
        sampler: &Sampler,
        log: &mut RayLog,
        pending: &mut Vec<Pending>,
    ) -> Rgb {
        let mut total = Rgb::BLACK;
        let mut weight = from.weight;
        let mut last: Option<Hit> = None;
        loop {
            let hit = self.scene.closest_hit(&from.ray, last.as_ref());
            if last.is_none() {
                log.add(from.kind, || RayRecord {
                    kind: from.kind,
                    depth: from.depth,
                    ray: from.ray,
                    t: hit.map(|h| h.t),
                    weight,
                });
            }
            let passed = last.map_or(0.0, |h| h.t);
            if let Some(radiance) = self.light_between(&from.ray, passed, hit.as_ref()) {
                return total + weight * radiance;
            }
            let Some(hit) = hit else {
                return total + weight * self.scene.background.radiance;
            };
            let opacity = self.scene.visibility(&from.ray, &hit);
            let mut straight = Rgb::splat(1.0 - opacity);
            if opacity > 0.0 {
                let surface = self.scene.surface(&from.ray, &hit);
                let here = Pending {
                    weight: weight * opacity,
                    ..*from
                };
                total += here.weight * self.shade(&surface, &here, sampler, log);
                straight += opacity * self.scatter(&surface, &here, log, pending);
            }
            weight *= straight;
            if weight.max_channel() < LEAST_WEIGHT {
                return total;
            }
            last = Some(hit);
        }
    }

    /// Radiance of the nearest light whose surface `ray` meets beyond `passed` and before `hit`.
    fn light_between(&self, ray: &Ray, passed: f32, hit: Option<&Hit>) -> Option<Rgb> {
        let end = hit.map_or(ray.t_max, |h| h.t);
        self.visible
            .iter()
            .filter_map(|light| light.emitted(ray))
            .filter(|(t, _)| *t > passed && *t < end)
            .min_by(|(a, _), (b, _)| a.total_cmp(b))
            .map(|(_, radiance)| radiance)
    }

    /// Emitted, ambient and direct light that leaves `surface` to the viewer.
    fn shade(&self, surface: &Surface, from: &Pending, sampler: &Sampler, log: &mut RayLog) -> Rgb {
        let mut at = surface.interaction;
        if !self.smooths_shadows {
            at.smooth_point = None;
        }
        let cos_o = at.shading_normal.dot(*at.wo);
        let ambient = self.scene.background.ambient * surface.material.occlusion(&surface.lookup);
        let mut total =
            surface.material.emitted(&surface.lookup) + ambient * surface.bsdf.ambient(cos_o);
        if from.depth >= self.max_depth {
            return total;
        }
        let unmirrored = surface.bsdf.without_mirrored();
        for &number in &self.scene.shining {
            let light = &self.scene.lights[number as usize];
            let count = self.samples[number as usize];
            let bsdf = if light.is_visible() {
                unmirrored
            } else {
                surface.bsdf
            };
            let mut sum = Rgb::BLACK;
            for j in 0..count {
                let u = sampler.light(from.vertex, number, j, count);
                if let Some(sample) = light.sample(at.point, u) {
                    sum += self.direct(&at, &bsdf, &sample, from, number, log);
                }
            }
            total += sum / count as f32;
        }
        total
    }

    /// What one sample of a light adds.
    fn direct(
        &self,
        at: &Interaction,
        bsdf: &Bsdf,
        sample: &LightSample,
        from: &Pending,
        light: u32,
        log: &mut RayLog,
    ) -> Rgb {
        let cos_i = at.shading_normal.dot(*sample.wi);
        if cos_i <= 0.0 || !at.can_see(*sample.wi) {
            return Rgb::BLACK;
        }
        // The end of the shadow ray may be below the horizon of a point that sees the centre.
        if let ShadowEnd::Point(end) = sample.shadow
            && !at.can_see(end - at.point)
        {
            return Rgb::BLACK;
        }
        let scattered = bsdf.eval(at.shading_normal, at.wo, sample.wi);
        let unshadowed = sample.weight * scattered * cos_i;
        if unshadowed.is_black() {
            return Rgb::BLACK;
        }
        let ray = match sample.shadow {
            ShadowEnd::Point(target) => at.shadow_ray_to(target),
            ShadowEnd::Direction(direction) => at.shadow_ray(*direction),
        };
        let value = unshadowed * transmittance(self.scene, &ray);
        let kind = RayKind::Shadow(light);
        log.add(kind, || RayRecord {
            kind,
            depth: from.depth,
            ray,
            t: None,
            weight: value,
        });
        value
    }

    /// Sends rays on from a mirror or from glass; returns the share that goes straight on.
    fn scatter(
        &self,
        surface: &Surface,
        from: &Pending,
        log: &mut RayLog,
        pending: &mut Vec<Pending>,
    ) -> Rgb {
        let at = &surface.interaction;
        let specular = &surface.bsdf.specular;
        let cos_o = at.shading_normal.dot(*at.wo).min(1.0);
        let eta = surface.relative_index();
        let (mirrored, through) = specular.split(cos_o, eta);
        if from.depth + 1 < self.max_depth {
            let mut send = |kind, direction, weight: Rgb, vertex: u32| {
                let weight = from.weight * weight;
                if weight.max_channel() >= LEAST_WEIGHT {
                    pending.push(Pending {
                        kind,
                        ray: at.spawn_ray(direction),
                        weight,
                        depth: from.depth + 1,
                        vertex,
                    });
                }
            };
            let mirror = Some(reflect(*at.wo, *at.shading_normal))
                .filter(|mirror| at.geometric_normal.dot(*mirror) > 0.0)
                .unwrap_or_else(|| reflect(*at.wo, *at.geometric_normal));
            send(RayKind::Reflected, mirror, mirrored, child(from.vertex, 1));
            // Light must come out on the far side, else a body is entered and never left.
            let beyond = refract(*at.wo, *at.shading_normal, eta)
                .filter(|beyond| at.geometric_normal.dot(*beyond) < 0.0)
                .or_else(|| refract(*at.wo, *at.geometric_normal, eta));
            if let Some(beyond) = beyond.filter(|_| !specular.is_straight()) {
                send(RayKind::Refracted, beyond, through, child(from.vertex, 3));
            }
        } else {
            let bent = if specular.is_straight() {
                Rgb::BLACK
            } else {
                through
            };
            for weight in [mirrored, bent].map(|share| from.weight * share) {
                if weight.max_channel() >= LEAST_WEIGHT {
                    log.cut_off(weight);
                }
            }
        }
        if specular.is_straight() {
            through
        } else {
            Rgb::BLACK
        }
    }
}

impl Integrator for Whitted<'_> {
    fn radiance(&self, ray: &Ray, sampler: &Sampler, log: &mut RayLog) -> Rgb {
        let mut pending = Vec::new();
        let camera = Pending {
            kind: RayKind::Camera,
            ray: *ray,
            weight: Rgb::WHITE,
            depth: 0,
            vertex: 1,
        };
        let mut total = self.follow(&camera, sampler, log, &mut pending);
        while let Some(next) = pending.pop() {
            total += self.follow(&next, sampler, log, &mut pending);
        }
        total
    }

    fn background(&self) -> Rgb {
        self.scene.background.radiance
    }
}
