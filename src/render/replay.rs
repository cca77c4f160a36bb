//! One sample of one pixel, traced again with its rays kept.

use std::fmt;

use super::Job;
use super::tile::camera_sample;
use crate::color::Rgb;
use crate::integrate::{RayKind, RayLog, RayRecord, integrator};
use crate::math::{DVec3, UVec2, Vec3};

/// One sample of one pixel, traced again.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Its value.
    pub value: Rgb,
    /// Every ray that was traced for it, in order.
    pub rays: Vec<ReplayedRay>,
}

/// A ray in world coordinates.
#[derive(Clone, Copy, Debug)]
pub struct ReplayedRay {
    /// Why it was traced.
    pub kind: RayKind,
    /// Scattering events before it.
    pub depth: u32,
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes; of length 1.
    pub direction: Vec3,
    /// How far away it met something, metres; `None` where it did not, and for shadow rays.
    pub distance: Option<f64>,
    /// As in [`RayRecord::weight`].
    pub weight: Rgb,
}

/// Traces sample `index` of `pixel` again and keeps its rays.
pub fn replay(job: &Job, pixel: UVec2, index: u32) -> Replay {
    let (ray, sampler) = camera_sample(job, &job.camera.rays(job.settings.size), pixel, index);
    let mut log = RayLog::keeping();
    let value = integrator(job.scene, job.settings).radiance(&ray, &sampler, &mut log);
    let in_world = |record: RayRecord| {
        let length = f64::from(record.ray.direction.length());
        let to_world = length / job.scene.placement.scale;
        ReplayedRay {
            kind: record.kind,
            depth: record.depth,
            origin: job.scene.world_point(record.ray.origin),
            direction: record.ray.direction.normalize_or_zero(),
            distance: record.t.map(|t| f64::from(t) * to_world),
            weight: record.weight,
        }
    };
    Replay {
        value,
        rays: log.records.into_iter().flatten().map(in_world).collect(),
    }
}

impl fmt::Display for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for ray in &self.rays {
            let indent = 2 * ray.depth as usize;
            let Rgb { r, g, b } = ray.weight;
            let (origin, direction) = (ray.origin, ray.direction);
            write!(
                f,
                "{:indent$}{} from {origin} along {direction}",
                "", ray.kind
            )?;
            match (ray.kind, ray.distance) {
                (RayKind::Shadow(_), _) => writeln!(f, " brings {r} {g} {b}")?,
                (_, Some(distance)) => writeln!(f, " hits at {distance} m, weight {r} {g} {b}")?,
                (_, None) => writeln!(f, " leaves the scene, weight {r} {g} {b}")?,
            }
        }
        let Rgb { r, g, b } = self.value;
        writeln!(f, "radiance {r} {g} {b}")
    }
}
