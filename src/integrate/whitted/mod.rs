//! Local shading, shadows, mirrors and glass
//! (Whitted 1980, "An Improved Illumination Model for Shaded Display").

mod plain;

use super::met::{LightSurfaces, nearest_visible};
use super::visibility::{straight_through, transmittance};
use super::way::way;
use super::{CameraRow, Integrator, RayKind, RayLog, RayRecord, Sight, Source, light_samples};
use crate::bvh::Hit;
use crate::color::Rgb;
use crate::interaction::Interaction;
use crate::light::LightSample;
use crate::material::{Bsdf, View, reflect, refract};
use crate::math::{ROW, Ray, RayRow, first_places, places};
use crate::prepare::{PlainRow, PreparedScene, Surface};
use crate::sampling::Sampler;
use crate::scene::Settings;

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
    /// Lights that rays can meet: those that the camera sees.
    visible: LightSurfaces<'a>,
    /// Whether the camera sees nothing where it sees the background.
    is_transparent: bool,
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

impl Pending {
    /// The ray of a camera sample.
    fn camera(ray: Ray) -> Self {
        Self {
            kind: RayKind::Camera,
            ray,
            weight: Rgb::WHITE,
            depth: 0,
            vertex: 1,
        }
    }

    /// What is kept of it where it first meets `hit`.
    fn record(&self, hit: Option<&Hit>) -> RayRecord {
        RayRecord {
            kind: self.kind,
            depth: self.depth,
            ray: self.ray,
            t: hit.map(|h| h.t),
            weight: self.weight,
        }
    }
}

/// Shadow rays that wait at most until they are traced together.
const MOST_WAITING: usize = 4096;

/// What is still to be done for some samples.
struct Work {
    /// The place of the sample that is followed, among those that are taken together.
    sample: usize,
    /// Its rays that are still to be followed.
    pending: Vec<Pending>,
    /// Rays to lights, of all samples; all rows but the last are full.
    shadow_rays: Vec<RayRow>,
    /// What they are for.
    shadows: Vec<Shadow>,
    /// What they brought to each sample so far: a sum of its own, so that it does not matter when they are
    /// traced.
    lit: [Rgb; ROW],
}

/// What a shadow ray is for.
struct Shadow {
    /// The place of its sample among those that are taken together.
    sample: usize,
    light: u32,
    /// Scattering events before it.
    depth: u32,
    /// What the light adds to the sample where nothing is in the way.
    value: Rgb,
}

impl Work {
    const NONE: Self = Self {
        sample: 0,
        pending: Vec::new(),
        shadow_rays: Vec::new(),
        shadows: Vec::new(),
        lit: [Rgb::BLACK; ROW],
    };

    /// Adds a shadow ray from a vertex of the sample at this place, `depth` scattering events from the camera, and
    /// what the light adds to it.
    fn add_shadow(&mut self, ray: Ray, sample: usize, light: u32, depth: u32, value: Rgb) {
        if self.shadows.len().is_multiple_of(ROW) {
            self.shadow_rays.push(RayRow::EMPTY);
        }
        if let Some(row) = self.shadow_rays.last_mut() {
            row.push(&ray);
        }
        self.shadows.push(Shadow {
            sample,
            light,
            depth,
            value,
        });
    }
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
            max_depth: settings.depth(),
            smooths_shadows: settings.shadow_terminator,
            samples: scene.lights.iter().map(samples).collect(),
            visible: LightSurfaces::new(
                (0..)
                    .zip(&scene.lights)
                    .filter(|(_, light)| light.is_visible()),
            ),
            is_transparent: settings.transparent,
        }
    }

    /// What comes back along one ray, surfaces that it crosses without a bend included, but for what
    /// waits for the shadow rays that are added to `work`; so are rays that leave in other directions. `first` is the
    /// ray's nearest hit.
    fn follow(
        &self,
        from: &Pending,
        first: Option<Hit>,
        sampler: &Sampler,
        log: &mut RayLog,
        work: &mut Work,
    ) -> Rgb {
        log.add(from.kind, || from.record(first.as_ref()));
        let mut total = Rgb::BLACK;
        let mut weight = from.weight;
        // What no surface covers of the ray, whatever glass lets through.
        let mut clear = 1.0;
        let is_camera = from.kind == RayKind::Camera;
        let mut next = first;
        let mut passed = 0.0;
        loop {
            let end = next.map_or(from.ray.t_max, |hit| hit.t);
            let met = self.visible.between(&from.ray, passed, end);
            if let Some(met) = nearest_visible(&met) {
                if is_camera {
                    log.see(Sight::Light { t: met.t }, clear);
                }
                log.light(Source::Light(met.number), from.depth, weight, met.radiance);
                return total + weight * met.radiance;
            }
            let Some(hit) = next else {
                if is_camera && self.is_transparent {
                    weight = weight - Rgb::splat(clear);
                }
                let radiance = self.scene.radiance_beyond(&from.ray);
                log.light(Source::Background, from.depth, weight, radiance);
                return total + weight * radiance;
            };
            let opacity = self.scene.visibility(&from.ray, &hit);
            if is_camera && opacity > 0.0 {
                log.see(Sight::Surface(hit), clear * opacity);
            }
            clear *= 1.0 - opacity;
            let mut straight = Rgb::splat(1.0 - opacity);
            if opacity > 0.0 {
                let surface = self.scene.surface(&from.ray, &hit);
                let here = Pending {
                    weight: weight * opacity,
                    ..*from
                };
                total += here.weight * self.shade(&surface, &here, sampler, log, work);
                straight += opacity * self.scatter(&surface, &here, log, &mut work.pending);
            }
            weight *= straight;
            if weight.max_channel() < LEAST_WEIGHT {
                return total;
            }
            passed = hit.t;
            next = self.scene.closest_hit(&from.ray, Some(&hit));
        }
    }

    /// Emitted and ambient light that leaves `surface` to the viewer; the direct light waits for shadow rays.
    fn shade(
        &self,
        surface: &Surface,
        from: &Pending,
        sampler: &Sampler,
        log: &mut RayLog,
        work: &mut Work,
    ) -> Rgb {
        let mut at = surface.interaction;
        if !self.smooths_shadows {
            at.smooth_point = None;
        }
        let view = surface.view();
        let ambient = self.scene.background.ambient * surface.material.occlusion(&surface.lookup);
        let emitted = surface.material.emitted(&surface.lookup);
        let ambient = ambient * surface.bsdf.ambient(&view);
        log.light(Source::Surface, from.depth, from.weight, emitted);
        log.light(Source::Background, from.depth + 1, from.weight, ambient);
        let shining = emitted + ambient;
        if from.depth >= self.max_depth {
            return shining;
        }
        let unmirrored = surface.bsdf.without_mirrored();
        for &number in &self.scene.shining {
            let light = &self.scene.lights[number as usize];
            let count = self.samples[number as usize];
            let bsdf = unmirrored.as_ref().filter(|_| light.is_visible());
            let bsdf = bsdf.unwrap_or(&surface.bsdf);
            for j in 0..count {
                let u = sampler.light(from.vertex, number, j, count);
                let shadow = light
                    .sample(at.point, u)
                    .and_then(|sample| self.direct(&at, bsdf, &view, &sample));
                if let Some((ray, value)) = shadow {
                    let value = from.weight * value / count as f32;
                    work.add_shadow(ray, work.sample, number, from.depth, value);
                    self.light_up_if_full(work, log);
                    log.turn_to(work.sample);
                }
            }
        }
        shining
    }

    /// What one sample of a light adds where nothing is in the way of a ray.
    fn direct(
        &self,
        at: &Interaction,
        bsdf: &Bsdf,
        view: &View,
        sample: &LightSample,
    ) -> Option<(Ray, Rgb)> {
        let way = way(at, sample.wi, sample.shadow)?;
        if way.is_behind && !bsdf.is_translucent() {
            return None;
        }
        let scattered = bsdf.shown(view, sample.wi);
        let unshadowed = sample.weight * scattered * way.cos;
        (!unshadowed.is_black()).then_some((way.ray, unshadowed))
    }

    /// Traces the shadow rays that wait, if they are many.
    fn light_up_if_full(&self, work: &mut Work, log: &mut RayLog) {
        if work.shadows.len() >= MOST_WAITING {
            self.light_up(work, log);
        }
    }

    /// Traces the shadow rays, and adds what comes through to what their samples are lit by.
    fn light_up(&self, work: &mut Work, log: &mut RayLog) {
        let Work {
            shadow_rays: rows,
            shadows,
            lit,
            ..
        } = work;
        for (rays, shadows) in rows.iter().zip(shadows.chunks(ROW)) {
            let blocked = self.scene.are_blocked(rays);
            for (i, shadow) in shadows.iter().enumerate() {
                let value = self.unblocked(shadow.value, rays, i, blocked);
                lit[shadow.sample] += value;
                log.turn_to(shadow.sample);
                tell_shadow(log, shadow.light, shadow.depth, value, || rays.get(i));
            }
        }
        shadows.clear();
        rows.clear();
    }

    /// What comes through of `value` along ray `i`; `blocked` is what the scene says of all of them
    /// ([`PreparedScene::are_blocked`]).
    #[inline]
    fn unblocked(&self, value: Rgb, rays: &RayRow, i: usize, blocked: Option<u64>) -> Rgb {
        match blocked {
            Some(blocked) if blocked >> i & 1 != 0 => Rgb::BLACK,
            Some(_) => value,
            None => value * transmittance(self.scene, &rays.get(i), straight_through),
        }
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
        let mut sample = CameraRow::EMPTY;
        sample.rays.push(ray);
        sample.samplers.push(sampler);
        let mut radiances = [Rgb::BLACK; ROW];
        self.radiances(&sample, &mut radiances, log);
        radiances[0]
    }

    fn radiances(&self, samples: &CameraRow, radiances: &mut [Rgb; ROW], log: &mut RayLog) {
        let hits = self.scene.closest_hits(&samples.rays);
        let mut plain = PlainRow::NONE;
        self.see_plain(samples, &hits, &mut plain);
        self.light_plain(&plain, samples, &hits, radiances, log);
        let rest = first_places(samples.rays.count()) & !plain.places();
        if rest == 0 {
            return;
        }
        let mut work = Work::NONE;
        for place in places(rest) {
            let Some(sampler) = samples.samplers.get(place) else {
                continue;
            };
            work.sample = place;
            log.turn_to(place);
            let camera = Pending::camera(samples.rays.get(place));
            let mut total = self.follow(&camera, hits.get(place), &sampler, log, &mut work);
            while let Some(next) = work.pending.pop() {
                let hit = self.scene.closest_hit(&next.ray, None);
                total += self.follow(&next, hit, &sampler, log, &mut work);
            }
            radiances[place] = total;
        }
        self.light_up(&mut work, log);
        for place in places(rest) {
            radiances[place] += work.lit[place];
        }
    }
}

/// Tells `log` of a ray to the light of this number and what came of it.
fn tell_shadow(log: &mut RayLog, light: u32, depth: u32, value: Rgb, ray: impl FnOnce() -> Ray) {
    log.light(Source::Light(light), depth + 1, Rgb::WHITE, value);
    let kind = RayKind::Shadow(light);
    log.add(kind, || RayRecord {
        kind,
        depth,
        ray: ray(),
        t: None,
        weight: value,
    });
}
