//! All light, by whatever way it comes (Kajiya 1986, "The Rendering Equation").
//!
//! A path goes from surface to surface, in directions that the materials choose. At each surface a light
//! is looked at as well, and where a path might have met that light by itself, both ways of
//! finding it are weighed against each other (Veach and Guibas 1995, "Optimally Combining Sampling
//! Techniques for Monte Carlo Rendering").

mod direct;
mod lights;
mod shadow;
mod walk;
mod weighing;

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::light::Receiver;
use crate::material::BsdfSample;
use crate::math::{ROW, Ray};
use crate::prepare::{PreparedScene, Surface};
use crate::sampling::Sampler;
use crate::scene::Settings;

use super::met::LightSurfaces;
use super::{CameraRow, Integrator, RayKind, RayLog, light_samples};
use lights::{Lights, Place};
use shadow::through_pane;
use walk::{Departure, Walk, beyond};
pub use weighing::Weighing;

/// Scattering events before a path may be ended by chance.
const SURE_EVENTS: u32 = 4;

/// Full light transport.
#[derive(Debug)]
pub struct PathTracer<'a> {
    scene: &'a PreparedScene<'a>,
    lights: Lights<'a>,
    max_depth: u32,
    /// Whether shadow rays start on the surface that vertex normals describe.
    smooths_shadows: bool,
    clamp: f32,
    /// Per light of the scene: samples at a surface that the camera sees.
    samples: Vec<u32>,
    /// Lights of the scene that have a surface, which rays can meet.
    surfaces: LightSurfaces<'a>,
    can_meet_light: bool,
    weighing: Weighing,
    /// Whether the camera sees nothing where it sees the background.
    is_transparent: bool,
}

impl<'a> PathTracer<'a> {
    /// The technique with the depth of `settings`.
    pub fn new(scene: &'a PreparedScene<'a>, settings: &Settings) -> Self {
        let pattern = settings.sampling.pattern;
        let lights = Lights::of(scene);
        let shining = (scene.shining.iter())
            .map(|&number| (number, &scene.lights[number as usize]))
            .filter(|(_, light)| !light.is_black());
        Self {
            scene,
            max_depth: settings.depth(),
            smooths_shadows: settings.shadow_terminator,
            clamp: settings.clamp.unwrap_or(f32::INFINITY),
            samples: (scene.lights.iter())
                .map(|light| light_samples(light, settings.light_samples, pattern))
                .collect(),
            surfaces: LightSurfaces::new(shining),
            can_meet_light: lights.can_be_met(),
            lights,
            weighing: Weighing::default(),
            is_transparent: settings.transparent,
        }
    }

    /// The same with other weights.
    pub fn weighing(self, weighing: Weighing) -> Self {
        Self { weighing, ..self }
    }

    /// Sends the walk on from `surface`; `false` where it ends.
    fn scatter(&self, surface: &Surface, walk: &mut Walk, place: Place, sampler: &Sampler) -> bool {
        let at = &surface.interaction;
        let [direction, chance] = sampler.scattering(walk.vertex);
        let Some(sample) = surface.sample(chance.x, direction) else {
            return false;
        };
        walk.vertex += 1;
        walk.throughput *= sample.weight;
        if walk.throughput.is_black() {
            return false;
        }
        if sample.is_specular && sample.is_transmitted && through_pane(surface).is_some() {
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
        if !may_end_at_a_light || !survives(walk, chance.y) {
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

/// Whether lights behind a surface show on it.
fn passes_light(surface: &Surface) -> bool {
    surface.material.is_glass() || surface.material.is_translucent()
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
        self.follow(ray, self.scene.closest_hit(ray, None), sampler, log)
    }

    fn radiances(&self, samples: &CameraRow, radiances: &mut [Rgb; ROW], log: &mut RayLog) {
        let hits = self.scene.closest_hits(&samples.rays);
        for (i, (ray, sampler)) in samples.iter().enumerate() {
            log.turn_to(i);
            radiances[i] = self.follow(&ray, hits.get(i), &sampler, log);
        }
    }
}

impl PathTracer<'_> {
    /// The radiance along a ray from the camera whose nearest hit is `first`.
    fn follow(&self, ray: &Ray, first: Option<Hit>, sampler: &Sampler, log: &mut RayLog) -> Rgb {
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
            is_clear: true,
            passed: None,
            found: Some(first),
        };
        while let Some(surface) = self.advance(&mut walk, sampler, log, &mut total) {
            if walk.scattered >= self.max_depth {
                // Panes do not scatter: what is behind them was looked at through them as well.
                let Some(straight) = through_pane(&surface) else {
                    break;
                };
                walk.throughput *= straight;
                continue;
            }
            let at = &surface.interaction;
            let place = Place {
                receiver: Receiver {
                    point: at.point,
                    normal: (!passes_light(&surface)).then_some(at.shading_normal),
                },
                is_first: walk.scattered == 0,
            };
            let is_told = log.is_told();
            let mut parts = Vec::new();
            let direct = self.direct(&surface, &walk, &place, sampler, log, |light, value| {
                if is_told {
                    parts.push((light, value));
                }
            });
            let kept = self.add(&mut total, &walk, direct, walk.scattered + 1, log);
            for (light, value) in parts {
                log.light(self.source_of(light), walk.scattered + 1, kept, value);
            }
            if !self.scatter(&surface, &mut walk, place, sampler) {
                break;
            }
        }
        total
    }
}
