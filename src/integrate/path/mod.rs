//! All light, by whatever way it comes (Kajiya 1986, "The Rendering Equation").
//!
//! A path goes from surface to surface, in directions that the materials choose. At each surface a light
//! is looked at as well, and where a path might have met that light by itself, both ways of
//! finding it are weighed against each other (Veach and Guibas 1995, "Optimally Combining Sampling
//! Techniques for Monte Carlo Rendering").

mod lights;
mod shadow;

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::light::{Light, Receiver, ShadowEnd};
use crate::material::BsdfSample;
use crate::math::{Ray, UnitVec3};
use crate::prepare::{PreparedScene, Surface, TriangleId};
use crate::sampling::Sampler;
use crate::scene::Settings;

use super::{Integrator, RayKind, RayLog, RayRecord, light_samples};
use lights::{Incident, Lights, Place};
use shadow::{is_pane, straight_share, transmittance};

/// Scattering events before a path may be ended by chance.
const SURE_EVENTS: u32 = 4;

/// Full light transport.
#[derive(Debug)]
pub struct PathTracer<'a> {
    scene: &'a PreparedScene<'a>,
    lights: Lights<'a>,
    max_depth: u32,
    clamp: f32,
    /// Per light of the scene: samples at a surface that the camera sees.
    samples: Vec<u32>,
    /// Lights of the scene that have a surface, which rays can meet.
    surfaces: Vec<u32>,
    can_meet_light: bool,
}

/// A path on its way.
struct Walk {
    ray: Ray,
    kind: RayKind,
    /// What light from here on counts for.
    throughput: Rgb,
    /// Scattering events so far.
    scattered: u32,
    /// The number of the next vertex, by which random numbers are named.
    vertex: u32,
    /// Where the ray comes from, if lights were looked at from there.
    departure: Option<Departure>,
    /// Whether it has met mirrors and glass only: then it sees what the camera would see.
    is_viewing: bool,
    /// What the body that it is in takes from it, per metre.
    absorption: Option<Rgb>,
    /// How far along the ray it has come.
    passed: Option<Hit>,
}

/// A scattering by which a light may have been found in place of being looked at.
#[derive(Clone, Copy)]
struct Departure {
    place: Place,
    /// Of the ray's direction, by solid angle.
    density: f64,
}

/// What a walk came to.
enum End<'a> {
    /// A surface that scatters it.
    Surface(Surface<'a>),
    /// Nothing more.
    Nothing,
}

impl<'a> PathTracer<'a> {
    /// The technique with the depth of `settings`.
    pub fn new(scene: &'a PreparedScene<'a>, settings: &Settings) -> Self {
        let pattern = settings.sampling.pattern;
        let lights = Lights::of(scene);
        let has_surface = |light: &u32| match &scene.lights[*light as usize] {
            Light::Point(_) | Light::Spot(_) | Light::Distant(_) => false,
            light => !light.is_delta() && !light.is_black(),
        };
        Self {
            scene,
            max_depth: settings.max_depth,
            clamp: settings.clamp.unwrap_or(f32::INFINITY),
            samples: (scene.lights.iter())
                .map(|light| light_samples(light, settings.light_samples, pattern))
                .collect(),
            surfaces: scene.shining.iter().copied().filter(has_surface).collect(),
            can_meet_light: lights.can_be_met(),
            lights,
        }
    }

    /// Follows the ray to the next surface that scatters, adding the light that it meets.
    fn advance(
        &self,
        walk: &mut Walk,
        sampler: &Sampler,
        log: &mut RayLog,
        total: &mut Rgb,
    ) -> End<'a> {
        loop {
            let hit = self.scene.closest_hit(&walk.ray, walk.passed.as_ref());
            if walk.passed.is_none() {
                log.add(walk.kind, || RayRecord {
                    kind: walk.kind,
                    depth: walk.scattered,
                    ray: walk.ray,
                    t: hit.map(|h| h.t),
                    weight: walk.throughput,
                });
            }
            let (radiance, is_end) = self.lights_before(walk, hit.as_ref());
            self.add(total, walk, radiance, walk.scattered, log);
            if is_end {
                return End::Nothing;
            }
            let Some(hit) = hit else {
                let through = self.through_body(walk, f32::INFINITY);
                let radiance = through * self.beyond(walk);
                self.add(total, walk, radiance, walk.scattered, log);
                return End::Nothing;
            };
            walk.throughput = walk.throughput * self.through_body(walk, hit.t);
            walk.passed = Some(hit);
            if let Some(surface) = self.met(walk, &hit, sampler) {
                let radiance = self.emitted(walk, &surface, &hit);
                self.add(total, walk, radiance, walk.scattered, log);
                return End::Surface(surface);
            }
        }
    }

    /// The surface at `hit`, unless the walk goes on as if it were not there.
    fn met(&self, walk: &mut Walk, hit: &Hit, sampler: &Sampler) -> Option<Surface<'a>> {
        if walk.is_viewing && self.scene.visibility(&walk.ray, hit) <= 0.0 {
            return None;
        }
        let surface = self.scene.surface(&walk.ray, hit);
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

    /// Adds light that was scattered `scattered` times, what is left of it.
    fn add(&self, total: &mut Rgb, walk: &Walk, radiance: Rgb, scattered: u32, log: &mut RayLog) {
        let value = walk.throughput * radiance;
        let most = value.max_channel();
        if scattered < 2 || most <= self.clamp || !value.is_finite() {
            *total += value;
            return;
        }
        let kept = value * (self.clamp / most);
        log.counts.clamped += f64::from((value - kept).luminance());
        *total += kept;
    }

    /// Light of the scene's lights whose surfaces the ray meets before `hit`, and whether it ends
    /// at one of them.
    ///
    /// A camera, and its image in a mirror, sees lights as things that hide what is behind them. For rays
    /// that are weighed against shadow rays lights hide nothing, as they do for those.
    fn lights_before(&self, walk: &Walk, hit: Option<&Hit>) -> (Rgb, bool) {
        let start = walk.passed.map_or(0.0, |h| h.t);
        let end = hit.map_or(walk.ray.t_max, |h| h.t);
        let met = self.surfaces.iter().filter_map(|&number| {
            let light = &self.scene.lights[number as usize];
            let (t, radiance) = light.met(&walk.ray)?;
            (t > start && t < end).then_some((number, light.is_visible(), t, radiance))
        });
        let mut total = Rgb::BLACK;
        if let Some(departure) = &walk.departure {
            for (number, _, t, radiance) in met {
                let weight = self.weight(departure, number, &walk.ray);
                total += radiance * weight * self.through_body(walk, t);
            }
            return (total, false);
        }
        let last = (met.clone())
            .filter(|(_, is_visible, ..)| *is_visible)
            .min_by(|(_, _, a, _), (_, _, b, _)| a.total_cmp(b));
        let end = last.map_or(f32::INFINITY, |(_, _, t, _)| t);
        for (_, is_visible, t, radiance) in met {
            if t == end && is_visible || walk.scattered > 0 && !is_visible && t < end {
                total += radiance * self.through_body(walk, t);
            }
        }
        (total, last.is_some())
    }

    /// Light from beyond the scene.
    fn beyond(&self, walk: &Walk) -> Rgb {
        let mut total = self.scene.background.radiance;
        let Some(wi) = UnitVec3::normalize(walk.ray.direction) else {
            return total;
        };
        if walk.scattered == 0 {
            return self.scene.radiance_beyond(&walk.ray);
        }
        for (light, radiance) in self.lights.beyond(wi) {
            if !radiance.is_black() {
                let weight =
                    (walk.departure.as_ref()).map_or(1.0, |d| self.weight(d, light, &walk.ray));
                total += radiance * weight;
            }
        }
        total
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
        power(departure.density, looked)
    }

    /// Samples of a light at a surface that the camera sees, where all lights are looked at.
    fn samples_of(&self, light: u32) -> u32 {
        self.samples.get(light as usize).copied().unwrap_or(1)
    }

    /// Direct light at `surface`, what of it leaves along the walk.
    fn direct(
        &self,
        surface: &Surface,
        walk: &Walk,
        place: &Place,
        sampler: &Sampler,
        log: &mut RayLog,
    ) -> Rgb {
        if let Some(all) = self.lights.all_from(place) {
            let mut total = Rgb::BLACK;
            for (order, &light) in (0..).zip(all) {
                let count = self.samples_of(light);
                for j in 0..count {
                    let u = sampler.light(walk.vertex, order, j, count);
                    if let Some(incident) = self.lights.sample(light, place.receiver.point, u) {
                        total += self.gathered(surface, walk, light, &incident, count.into(), log);
                    }
                }
            }
            return total;
        }
        let chosen = self.lights.choose(place, sampler.light_choice(walk.vertex));
        let Some((light, probability)) = chosen else {
            return Rgb::BLACK;
        };
        let u = sampler.light(walk.vertex, 0, 0, 1);
        (self.lights.sample(light, place.receiver.point, u)).map_or(Rgb::BLACK, |incident| {
            self.gathered(surface, walk, light, &incident, probability, log)
        })
    }

    /// What one sample of a light adds, of which `expected` are taken.
    fn gathered(
        &self,
        surface: &Surface,
        walk: &Walk,
        light: u32,
        incident: &Incident,
        expected: f64,
        log: &mut RayLog,
    ) -> Rgb {
        let at = &surface.interaction;
        let wi = incident.wi;
        let cos = at.shading_normal.dot(*wi);
        let side = at.geometric_normal.dot(*wi);
        if cos * side <= 0.0 {
            return Rgb::BLACK;
        }
        // The end of the shadow ray may be on the other side than the centre of the light.
        if let ShadowEnd::Point(end) = incident.shadow
            && at.geometric_normal.dot(end - at.point) * side <= 0.0
        {
            return Rgb::BLACK;
        }
        let scattered = surface.eval(wi) * cos.abs();
        if scattered.is_black() {
            return Rgb::BLACK;
        }
        let weight = power(expected * incident.density, surface.pdf(wi).into());
        let weight = if incident.density == 0.0 { 1.0 } else { weight };
        let unshadowed = incident.weight * scattered * (weight / expected as f32);
        let ray = match incident.shadow {
            ShadowEnd::Point(target) => at.spawn_ray_to(target),
            ShadowEnd::Direction(direction) => at.spawn_ray(*direction),
        };
        let way = match incident.shadow {
            ShadowEnd::Point(target) => target.distance(at.point),
            ShadowEnd::Direction(_) => f32::INFINITY,
        };
        let around = if side > 0.0 {
            walk.absorption
        } else {
            beyond(surface)
        };
        let absorbed = around.map_or(Rgb::WHITE, |absorption| {
            through(absorption, self.scene.world_distance(way))
        });
        let value = unshadowed * absorbed * transmittance(self.scene, &ray);
        let kind = RayKind::Shadow(light);
        log.add(kind, || RayRecord {
            kind,
            depth: walk.scattered,
            ray,
            t: None,
            weight: walk.throughput * value,
        });
        value
    }

    /// Sends the walk on from `surface`; `false` where it ends.
    fn scatter(&self, surface: &Surface, walk: &mut Walk, place: Place, sampler: &Sampler) -> bool {
        let at = &surface.interaction;
        let [lobe, survival] = sampler.lobe_and_survival(walk.vertex);
        let Some(sample) = surface.sample(lobe, sampler.direction(walk.vertex)) else {
            return false;
        };
        walk.vertex += 1;
        walk.throughput = walk.throughput * sample.weight;
        if walk.throughput.is_black() {
            return false;
        }
        if sample.is_specular && sample.is_transmitted && is_pane(surface) {
            // It goes on along its ray as if nothing had happened.
            return true;
        }
        let cos = at.shading_normal.dot(*sample.wi);
        let side = at.geometric_normal.dot(*sample.wi);
        if !sample.is_specular && cos * side <= 0.0 {
            return false;
        }
        walk.scattered += 1;
        let may_end_at_a_light = self.can_meet_light || walk.scattered < self.max_depth;
        if !may_end_at_a_light || !survives(walk, survival) {
            return false;
        }
        walk.kind = kind_of(&sample);
        walk.departure = (!sample.is_specular).then(|| Departure {
            place,
            density: sample.pdf.into(),
        });
        walk.is_viewing &= sample.is_specular;
        if side < 0.0 {
            walk.absorption = beyond(surface);
        }
        walk.ray = at.spawn_ray(*sample.wi);
        walk.passed = None;
        true
    }
}

/// What the body on the far side of `surface` takes from light, per metre.
fn beyond(surface: &Surface) -> Option<Rgb> {
    surface
        .absorption()
        .filter(|_| surface.interaction.is_front)
}

/// Share of the light that comes through `metres` of a body (Beer's law).
fn through(absorption: Rgb, metres: f32) -> Rgb {
    absorption.map(|a| if a > 0.0 { (-a * metres).exp() } else { 1.0 })
}

/// The weight of the technique of density `a` against that of density `b` (Veach and Guibas's power
/// heuristic).
fn power(a: f64, b: f64) -> f32 {
    if a == 0.0 {
        return 0.0;
    }
    let ratio = b / a;
    (1.0 / (1.0 + ratio * ratio)) as f32
}

/// Ends paths by chance that count for little; those that go on count for more, so that the mean is
/// the same (Arvo and Kirk 1990, "Particle Transport and Image Synthesis").
fn survives(walk: &mut Walk, u: f32) -> bool {
    if walk.scattered < SURE_EVENTS {
        return true;
    }
    let chance = walk.throughput.max_channel();
    if chance >= 1.0 {
        return true;
    }
    walk.throughput = walk.throughput / chance;
    u < chance
}

fn kind_of(sample: &BsdfSample) -> RayKind {
    match (sample.is_specular, sample.is_transmitted) {
        (false, _) => RayKind::Scattered,
        (true, false) => RayKind::Reflected,
        (true, true) => RayKind::Refracted,
    }
}

impl Integrator for PathTracer<'_> {
    fn radiance(&self, ray: &Ray, sampler: &Sampler, log: &mut RayLog) -> Rgb {
        let mut total = Rgb::BLACK;
        let mut walk = Walk {
            ray: *ray,
            kind: RayKind::Camera,
            throughput: Rgb::WHITE,
            scattered: 0,
            vertex: 1,
            departure: None,
            is_viewing: true,
            absorption: None,
            passed: None,
        };
        while let End::Surface(surface) = self.advance(&mut walk, sampler, log, &mut total) {
            if walk.scattered >= self.max_depth {
                // Panes do not scatter: what is behind them was looked at through them as well.
                if !is_pane(&surface) {
                    break;
                }
                walk.throughput = walk.throughput * straight_share(&surface);
                continue;
            }
            let at = &surface.interaction;
            let place = Place {
                receiver: Receiver {
                    point: at.point,
                    normal: (!surface.material.is_glass()).then_some(at.shading_normal),
                },
                is_first: walk.scattered == 0,
            };
            let direct = self.direct(&surface, &walk, &place, sampler, log);
            self.add(&mut total, &walk, direct, walk.scattered + 1, log);
            if !self.scatter(&surface, &mut walk, place, sampler) {
                break;
            }
        }
        total
    }

    fn background(&self) -> Rgb {
        self.scene.background.radiance
    }
}
