//! All that gives light, and which of it is looked at from a point.

use rayon::prelude::*;

use crate::color::Rgb;
use crate::light::{
    EnvironmentSampler, Light, LightBounds, LightTree, Receiver, SeenTriangle, ShadowEnd,
};
use crate::material::{Material, Surface};
use crate::math::{DVec3, UnitVec3, Vec2, Vec3};
use crate::prepare::{EmissiveRun, PreparedScene, TriangleId};

/// Up to so many lights are all looked at from what the camera sees; from among more one is chosen.
const FEW: usize = 4;

/// Everything that gives light.
///
/// Lights are numbered: first those of the scene in file order, then the environment, then the
/// triangles that shine.
#[derive(Debug)]
pub(super) struct Lights<'a> {
    scene: &'a PreparedScene<'a>,
    environment: Option<EnvironmentSampler<'a>>,
    /// Rows of triangles, and the number of the first of each.
    runs: Vec<(EmissiveRun, u32)>,
    /// Over those that are somewhere.
    tree: LightTree,
    /// The numbers of those that are infinitely far away.
    infinite: Vec<u32>,
    /// All, where they are few.
    few: Option<Vec<u32>>,
}

/// A place from which light is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// The point and its normal.
    pub receiver: Receiver,
    /// Whether the camera sees it.
    pub is_first: bool,
}

/// One way in which light may come to a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Incident {
    /// Towards the light.
    pub wi: UnitVec3,
    /// Radiance over solid-angle density (for lights without area: irradiance on a surface that
    /// faces them).
    pub weight: Rgb,
    /// By solid angle; 0 for lights that no ray can meet.
    pub density: f64,
    /// What the shadow ray goes to.
    pub shadow: ShadowEnd,
}

impl<'a> Lights<'a> {
    /// All of `scene`.
    pub fn of(scene: &'a PreparedScene<'a>) -> Self {
        let environment = (scene.scene.environment.as_ref()).and_then(EnvironmentSampler::new);
        let mut next = scene.lights.len() as u32 + 1;
        let runs: Vec<_> = (scene.emissive_runs().into_iter())
            .map(|run| {
                let first = next;
                next += run.count;
                (run, first)
            })
            .collect();
        let mut lights = Self {
            scene,
            environment,
            runs,
            tree: LightTree::default(),
            infinite: Vec::new(),
            few: None,
        };
        let bounds: Vec<Option<LightBounds>> = (0..next)
            .into_par_iter()
            .map(|light| lights.bounds(light))
            .collect();
        lights.tree = LightTree::build(&bounds);
        lights.infinite = (scene.shining.iter().copied())
            .filter(|&light| match &scene.lights[light as usize] {
                Light::Distant(distant) => !distant.irradiance.is_black(),
                _ => false,
            })
            .chain(
                lights
                    .environment
                    .is_some()
                    .then_some(lights.environment_number()),
            )
            .collect();
        let finite = (0..next).filter(|&light| bounds[light as usize].is_some());
        let all: Vec<u32> = finite
            .chain(lights.infinite.iter().copied())
            .take(FEW + 1)
            .collect();
        lights.few = (all.len() <= FEW).then_some(all);
        lights
    }

    fn environment_number(&self) -> u32 {
        self.scene.lights.len() as u32
    }

    /// Of a light that is somewhere.
    fn bounds(&self, light: u32) -> Option<LightBounds> {
        match self.scene.lights.get(light as usize) {
            Some(light) => light.light_bounds(),
            None => self.scene.emission_bounds(self.triangle(light)?),
        }
    }

    /// The triangle with this number.
    fn triangle(&self, light: u32) -> Option<TriangleId> {
        let run = self.runs.partition_point(|(_, first)| *first <= light);
        let (run, first) = self.runs.get(run.checked_sub(1)?)?;
        Some(TriangleId {
            triangle: run.first.triangle + (light - first),
            ..run.first
        })
    }

    /// The number of a triangle; `None` where it does not shine.
    pub fn number_of(&self, id: TriangleId) -> Option<u32> {
        let run = self.runs.partition_point(|(run, _)| run.first <= id);
        let (run, first) = self.runs.get(run.checked_sub(1)?)?;
        let offset = id.triangle.checked_sub(run.first.triangle)?;
        (id.instance == run.first.instance && offset < run.count).then_some(first + offset)
    }

    /// The lights of the scene that are looked at from `place` one and all, where they are so few.
    pub fn all_from(&self, place: &Place) -> Option<&[u32]> {
        self.few.as_deref().filter(|_| place.is_first)
    }

    /// Chooses a light for `place` by `u` in `[0, 1)`, which is asked for where there is a choice; its number and
    /// the probability of the choice.
    pub fn choose(&self, place: &Place, u: impl FnOnce() -> f64) -> Option<(u32, f64)> {
        if let Some([only]) = self.few.as_deref() {
            return Some((*only, 1.0));
        }
        let groups = self.infinite.len() + usize::from(!self.tree.is_empty());
        let scaled = u() * groups as f64;
        let group = (scaled as usize).min(groups.checked_sub(1)?);
        let share = 1.0 / groups as f64;
        match self.infinite.get(group) {
            Some(&light) => Some((light, share)),
            None => {
                let u = (scaled - group as f64).min(1.0 - f64::EPSILON);
                let (light, probability) = self.tree.choose(&place.receiver, u)?;
                Some((light, probability * share))
            }
        }
    }

    /// How many samples of `light` are taken from `place`: the mean of what [`Self::choose`] does, or
    /// `count` where all lights are looked at so often.
    pub fn expected(&self, place: &Place, light: u32, count: impl Fn(u32) -> u32) -> f64 {
        if let Some(few) = self.all_from(place) {
            return if few.contains(&light) {
                count(light).into()
            } else {
                0.0
            };
        }
        let groups = self.infinite.len() + usize::from(!self.tree.is_empty());
        if groups == 0 {
            return 0.0;
        }
        let share = 1.0 / groups as f64;
        if self.infinite.contains(&light) {
            share
        } else {
            share * self.tree.probability(&place.receiver, light)
        }
    }

    /// One sample of `light` as seen from `point`, for `u` in `[0, 1)²`.
    pub fn sample(&self, light: u32, point: Vec3, u: Vec2) -> Option<Incident> {
        if let Some(light) = self.scene.lights.get(light as usize) {
            let sample = light.sample(point, u)?;
            return Some(Incident {
                wi: sample.wi,
                weight: sample.weight,
                density: sample.density,
                shadow: sample.shadow,
            });
        }
        if light == self.environment_number() {
            let sample = self.environment.as_ref()?.sample(u)?;
            return Some(Incident {
                wi: sample.wi,
                weight: sample.radiance * (1.0 / sample.density) as f32,
                density: sample.density,
                shadow: ShadowEnd::Direction(sample.wi),
            });
        }
        self.sample_triangle(self.triangle(light)?, point, u)
    }

    fn sample_triangle(&self, id: TriangleId, point: Vec3, u: Vec2) -> Option<Incident> {
        let point = point.as_dvec3();
        let seen = self.seen(id, point)?;
        let sample = seen.sample(u)?;
        let radiance = self.scene.emission(id, sample.barycentric);
        let weight = radiance.map(|c| (f64::from(c) / sample.density) as f32);
        let end = (point + sample.direction * sample.distance).as_vec3();
        (!weight.is_black() && weight.is_finite() && end.is_finite()).then(|| Incident {
            wi: UnitVec3::from_normalized(sample.direction.as_vec3()),
            weight,
            density: sample.density,
            shadow: ShadowEnd::Point(end),
        })
    }

    /// A triangle as seen from `point`; `None` where its dark side is.
    fn seen(&self, id: TriangleId, point: DVec3) -> Option<SeenTriangle> {
        let corners = self.scene.corners(id).map(|corner| corner - point);
        let seen = SeenTriangle::new(corners)?;
        (seen.is_front() || self.scene.shines_from_back(id)).then_some(seen)
    }

    /// The density by solid angle with which [`Self::sample`] of `light` takes `wi`, a direction in
    /// which it is seen from `point`.
    pub fn density(&self, light: u32, point: Vec3, wi: UnitVec3) -> f64 {
        if let Some(light) = self.scene.lights.get(light as usize) {
            return light.density(point, wi);
        }
        if light == self.environment_number() {
            return (self.environment.as_ref()).map_or(0.0, |sampler| sampler.density(wi));
        }
        self.triangle(light)
            .and_then(|id| self.seen(id, point.as_dvec3()))
            .map_or(0.0, |seen| seen.density(wi.as_dvec3().normalize()))
    }

    /// The lights that a ray meets which leaves the scene, with the radiance that they send along it.
    pub fn beyond(&self, wi: UnitVec3) -> impl Iterator<Item = (u32, Rgb)> + '_ {
        let environment = self.scene.scene.environment.as_ref();
        self.infinite.iter().map(move |&light| {
            let radiance = match self.scene.lights.get(light as usize) {
                Some(Light::Distant(distant)) => distant.radiance_from(wi),
                Some(_) => Rgb::BLACK,
                None => environment.map_or(Rgb::BLACK, |map| map.radiance(wi)),
            };
            (light, radiance)
        })
    }

    /// Whether a ray from a surface can meet any light, so that it is worth following though no
    /// scattering may come after it.
    pub fn can_be_met(&self) -> bool {
        let has_surface = |&light: &u32| match &self.scene.lights[light as usize] {
            Light::Point(_) | Light::Spot(_) => false,
            other => !other.is_delta(),
        };
        // Unlit surfaces give off their colour, though they are not looked at as lights.
        let glows = |material: &Material| {
            !material.emission.factor.is_black() || matches!(material.surface, Surface::Unlit(_))
        };
        self.environment.is_some()
            || self.scene.scene.materials.iter().any(glows)
            || !self.scene.background.radiance.is_black()
            || self.scene.shining.iter().any(has_surface)
    }
}
