//! What rays were traced.

use std::fmt;

use super::account::{Account, Seen, Sight, Source};
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
    /// From a surface, one of all directions in which it scatters.
    Scattered,
    /// To the light with this number: those of the scene in file order, then the environment, then
    /// the triangles that shine.
    Shadow(u32),
}

impl fmt::Display for RayKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RayKind::Camera => write!(f, "camera ray"),
            RayKind::Reflected => write!(f, "reflected ray"),
            RayKind::Refracted => write!(f, "refracted ray"),
            RayKind::Scattered => write!(f, "scattered ray"),
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

/// Counts rays; on request keeps them, and what else the samples tell.
#[derive(Clone, Debug, Default)]
pub struct RayLog {
    /// How many of which kind.
    pub counts: RayCounts,
    /// Rays that were not traced since their path had reached its depth.
    pub cut_off: CutOff,
    /// All of them in order, where somebody asked.
    pub records: Option<Vec<RayRecord>>,
    /// What is told of each of the samples that are traced together; none where nobody asked.
    pub accounts: Vec<Account>,
    /// The place of the sample that is told about.
    sample: usize,
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

    /// A log that is told what `accounts` are for: one for each sample that is traced at a time.
    pub fn told(accounts: Vec<Account>) -> Self {
        Self {
            accounts,
            ..Self::default()
        }
    }

    /// Counts a ray; `record` is asked for where rays are kept.
    pub fn add(&mut self, kind: RayKind, record: impl FnOnce() -> RayRecord) {
        match kind {
            RayKind::Camera => self.counts.camera += 1,
            RayKind::Reflected | RayKind::Refracted | RayKind::Scattered => {
                self.counts.secondary += 1
            }
            RayKind::Shadow(_) => self.counts.shadow += 1,
        }
        if let Some(records) = &mut self.records {
            records.push(record());
        }
    }

    /// Whether anything but counts is asked for.
    pub fn is_heard(&self) -> bool {
        self.records.is_some() || self.is_told()
    }

    /// What follows is told of the sample at this place among those that are traced together.
    pub fn turn_to(&mut self, place: usize) {
        self.sample = place;
    }

    /// Whether anybody listens to what is told.
    pub fn is_told(&self) -> bool {
        !self.accounts.is_empty()
    }

    /// Tells that a ray from the camera meets `sight`, which covers `share` of it. Told from front to back.
    pub fn see(&mut self, sight: Sight, share: f32) {
        if let Some(account) = self.accounts.get_mut(self.sample) {
            account.seen.push(Seen { sight, share });
        }
    }

    /// Tells that `weight * radiance` of the sample was given off by `source` and scattered `events` times
    /// on its way to the camera. All that is told of a sample adds up to its radiance.
    pub fn light(&mut self, source: Source, events: u32, weight: Rgb, radiance: Rgb) {
        if let Some(account) = self.accounts.get_mut(self.sample) {
            account.add(source, events, weight * radiance);
        }
    }
}
