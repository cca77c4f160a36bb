//! Views of the first surface: normals, depth, base colour, places.

use std::cell::OnceCell;

use crate::color::Rgb;
use crate::math::{Ray, Vec3};
use crate::prepare::{PreparedScene, Surface};
use crate::sampling::Sampler;
use crate::scene::{IntegratorKind, Needs};

use super::{Integrator, RayKind, RayLog, RayRecord, Sight};

/// What is shown of the first surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewKind {
    /// Shading normal in world axes.
    Normal,
    /// Distance from the start of the ray, metres; 0 where there is nothing.
    Depth,
    /// Diffuse reflectance or base colour.
    Albedo,
    /// The point in world coordinates, metres.
    Position,
    /// The first pair of texture coordinates, and 0.
    Uv,
}

impl ViewKind {
    /// What it reads.
    pub fn needs(self) -> Needs {
        match self {
            Self::Normal => Needs::of(IntegratorKind::Normal),
            Self::Depth | Self::Position => Needs::of(IntegratorKind::Depth),
            Self::Albedo => Needs::of(IntegratorKind::Albedo),
            Self::Uv => Needs {
                uv: true,
                ..Needs::default()
            },
        }
    }
}

/// The first thing along a ray that can be seen.
#[derive(Clone, Debug)]
pub struct FirstSurface<'a> {
    scene: &'a PreparedScene<'a>,
    ray: Ray,
    seen: Option<Sight>,
    /// What is there, once something reads more of it than where it is.
    surface: OnceCell<Surface<'a>>,
}

impl<'a> FirstSurface<'a> {
    /// Looks for a triangle along `ray`.
    pub fn along(scene: &'a PreparedScene<'a>, ray: &Ray) -> Self {
        let mut last = None;
        while let Some(hit) = scene.closest_hit(ray, last.as_ref()) {
            if scene.visibility(ray, &hit) > 0.0 {
                return Self::of(scene, ray, Some(Sight::Surface(hit)));
            }
            last = Some(hit);
        }
        Self::of(scene, ray, None)
    }

    /// What an integrator has `seen` first along `ray`.
    pub fn of(scene: &'a PreparedScene<'a>, ray: &Ray, seen: Option<Sight>) -> Self {
        Self {
            scene,
            ray: *ray,
            seen,
            surface: OnceCell::new(),
        }
    }

    /// What `kind` shows of it; normals are in `[-1, 1]`, and zero is where there is nothing. Of a light
    /// only its place is shown.
    pub fn value(&self, kind: ViewKind) -> [f32; 3] {
        let hit = match &self.seen {
            None => return [0.0; 3],
            Some(Sight::Surface(hit)) => hit,
            Some(Sight::Light { t }) => return self.light(*t, kind),
        };
        let surface = || {
            self.surface
                .get_or_init(|| self.scene.surface(&self.ray, hit))
        };
        match kind {
            ViewKind::Normal => surface().interaction.shading_normal.to_array(),
            ViewKind::Depth => [self.scene.world_distance(hit.t); 3],
            ViewKind::Albedo => surface().material.albedo(&surface().lookup).channels(),
            ViewKind::Position => self.place(surface().interaction.point),
            ViewKind::Uv => surface().lookup.uvs[0].extend(0.0).to_array(),
        }
    }

    fn light(&self, t: f32, kind: ViewKind) -> [f32; 3] {
        match kind {
            ViewKind::Depth => [self.scene.world_distance(t); 3],
            ViewKind::Position => self.place(self.ray.at(t)),
            ViewKind::Normal | ViewKind::Albedo | ViewKind::Uv => [0.0; 3],
        }
    }

    fn place(&self, point: Vec3) -> [f32; 3] {
        self.scene.world_point(point).as_vec3().to_array()
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
        if let Some(sight) = first.seen {
            log.see(sight, 1.0);
        }
        log.add(RayKind::Camera, || RayRecord {
            kind: RayKind::Camera,
            depth: 0,
            ray: *ray,
            t: first.seen.map(Sight::t),
            weight: Rgb::WHITE,
        });
        match self.kind {
            // A picture holds no negative values; nothing stays black.
            ViewKind::Normal if !value.is_black() => value.map(|c| 0.5 * c + 0.5),
            _ => value,
        }
    }
}
