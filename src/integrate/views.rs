//! Views of the first surface: normals, depth, base colour.

use std::cell::OnceCell;

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::math::Ray;
use crate::prepare::{PreparedScene, Surface};
use crate::sampling::Sampler;
use crate::scene::{IntegratorKind, Needs};

use super::{Integrator, RayKind, RayLog, RayRecord};

/// What is shown of the first surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewKind {
    /// Shading normal in world axes.
    Normal,
    /// Distance from the start of the ray, metres; 0 where there is nothing.
    Depth,
    /// Diffuse reflectance or base colour.
    Albedo,
}

impl ViewKind {
    /// What it reads.
    pub fn needs(self) -> Needs {
        Needs::of(match self {
            Self::Normal => IntegratorKind::Normal,
            Self::Depth => IntegratorKind::Depth,
            Self::Albedo => IntegratorKind::Albedo,
        })
    }
}

/// The first surface along a ray that can be seen.
#[derive(Clone, Debug)]
pub struct FirstSurface<'a> {
    scene: &'a PreparedScene<'a>,
    ray: Ray,
    seen: Option<Hit>,
    /// What is there, once something reads more of it than where it is.
    surface: OnceCell<Surface<'a>>,
}

impl<'a> FirstSurface<'a> {
    /// Looks for it along `ray`.
    pub fn along(scene: &'a PreparedScene<'a>, ray: &Ray) -> Self {
        let mut last = None;
        while let Some(hit) = scene.closest_hit(ray, last.as_ref()) {
            if scene.visibility(ray, &hit) > 0.0 {
                return Self::of(scene, ray, Some(hit));
            }
            last = Some(hit);
        }
        Self::of(scene, ray, None)
    }

    fn of(scene: &'a PreparedScene<'a>, ray: &Ray, seen: Option<Hit>) -> Self {
        Self {
            scene,
            ray: *ray,
            seen,
            surface: OnceCell::new(),
        }
    }

    /// What `kind` shows of it; normals are in `[-1, 1]`, and zero is where there is nothing.
    pub fn value(&self, kind: ViewKind) -> [f32; 3] {
        let Some(hit) = &self.seen else {
            return [0.0; 3];
        };
        let surface = || {
            self.surface
                .get_or_init(|| self.scene.surface(&self.ray, hit))
        };
        match kind {
            ViewKind::Normal => surface().interaction.shading_normal.to_array(),
            ViewKind::Depth => [self.scene.world_distance(hit.t); 3],
            ViewKind::Albedo => surface().material.albedo(&surface().lookup).channels(),
        }
    }
}

/// Shows the first surface that can be seen.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The scene.
    pub scene: &'a PreparedScene<'a>,
    /// What is shown.
    pub kind: ViewKind,
}

impl Integrator for View<'_> {
    fn radiance(&self, ray: &Ray, _sampler: &Sampler, log: &mut RayLog) -> Rgb {
        let first = FirstSurface::along(self.scene, ray);
        let value = Rgb::from(first.value(self.kind));
        log.add(RayKind::Camera, || RayRecord {
            kind: RayKind::Camera,
            depth: 0,
            ray: *ray,
            t: first.seen.map(|hit| hit.t),
            weight: Rgb::WHITE,
        });
        match self.kind {
            // A picture holds no negative values; nothing stays black.
            ViewKind::Normal if !value.is_black() => value.map(|c| 0.5 * c + 0.5),
            _ => value,
        }
    }

    fn background(&self) -> Rgb {
        Rgb::BLACK
    }
}
