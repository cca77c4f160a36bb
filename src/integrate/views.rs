//! Views of the first surface: normals, depth, base colour.

use crate::color::Rgb;
use crate::math::Ray;
use crate::prepare::{PreparedScene, Surface};
use crate::sampling::Sampler;

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

/// Shows the first surface that can be seen.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The scene.
    pub scene: &'a PreparedScene<'a>,
    /// What is shown.
    pub kind: ViewKind,
}

impl View<'_> {
    /// The value itself, for layers: normals are in `[-1, 1]`. Zero where there is nothing.
    pub fn value(&self, ray: &Ray) -> [f32; 3] {
        let Some((t, surface)) = self.first_surface(ray) else {
            return [0.0; 3];
        };
        match self.kind {
            ViewKind::Normal => surface.interaction.shading_normal.to_array(),
            ViewKind::Depth => [self.scene.world_distance(t); 3],
            ViewKind::Albedo => surface.material.albedo(&surface.lookup).channels(),
        }
    }

    fn first_surface(&self, ray: &Ray) -> Option<(f32, Surface<'_>)> {
        let mut last = None;
        while let Some(hit) = self.scene.closest_hit(ray, last.as_ref()) {
            let surface = self.scene.surface(ray, &hit);
            if surface.visibility() > 0.0 {
                return Some((hit.t, surface));
            }
            last = Some(hit);
        }
        None
    }
}

impl Integrator for View<'_> {
    fn radiance(&self, ray: &Ray, _sampler: &Sampler, log: &mut RayLog) -> Rgb {
        let value = Rgb::from(self.value(ray));
        log.add(RayKind::Camera, || RayRecord {
            kind: RayKind::Camera,
            depth: 0,
            ray: *ray,
            t: None,
            weight: value,
        });
        match self.kind {
            // A picture holds no negative values; nothing stays black.
            ViewKind::Normal if !value.is_black() => value.map(|c| 0.5 * c + 0.5),
            _ => value,
        }
    }
}
