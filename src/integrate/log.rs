//! What rays were traced.

use std::fmt;

use crate::color::Rgb;
use crate::film::{CutOff, RayCounts};
use crate::math::Ray;

/// Why a ray was traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayKind {
    /// From the camera.
    Camera,
    /// From a mirror.
    Reflected,
    /// Through glass, with a bend.
    Refracted,
    /// To the light with this number.
    Shadow(u32),
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RayKind::Camera => write!(f, "camera ray"),
            RayKind::Reflected => write!(f, "reflected ray"),
            RayKind::Refracted => write!(f, "refracted ray"),
            RayKind::Shadow(light) => write!(f, "shadow ray to light {light}"),
        }
    }
}

/// A ray that was traced, and what came of it.
#[derive(Clone, Copy, Debug)]
pub struct RayRecord {
    /// Why it was traced.
    pub kind: RayKind,
    /// Scattering events before it: 0 for camera rays.
    pub depth: u32,
    /// The ray, in prepared coordinates.
    pub ray: Ray,
    /// Where it met something; `None` where it did not. Shadow rays have none.
    pub t: Option<f32>,
    /// What it counts for in the sample: for shadow rays the share that came through, times what
    /// the light would have given.
    pub weight: Rgb,
}

/// Counts rays; on request keeps them.
#[derive(Clone, Debug, Default)]
pub struct RayLog {
    /// How many of which kind.
    pub counts: RayCounts,
    /// Rays that were not traced since their path had reached its depth.
    pub cut_off: CutOff,
    /// All of them in order, where somebody asked.
    pub records: Option<Vec<RayRecord>>,
}

impl RayLog {
    /// A log that keeps every ray.
    pub fn keeping() -> Self {
        Self {
            records: Some(Vec::new()),
            ..Self::default()
        }
    }

    /// Counts a ray of this weight that is not traced since its path has reached its depth.
    pub fn cut_off(&mut self, weight: Rgb) {
        self.cut_off.rays += 1;
        self.cut_off.weight += f64::from(weight.max_channel());
    }

    /// Counts a ray; `record` is asked for where rays are kept.
    pub fn add(&mut self, kind: RayKind, record: impl FnOnce() -> RayRecord) {
        match kind {
            RayKind::Camera => self.counts.camera += 1,
            RayKind::Reflected | RayKind::Refracted => self.counts.secondary += 1,
            RayKind::Shadow(_) => self.counts.shadow += 1,
        }
        if let Some(records) = &mut self.records {
            records.push(record());
        }
    }
}
