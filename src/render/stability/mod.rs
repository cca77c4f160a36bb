//! What was hard about one render, and whether its picture can be relied on.
//!
//! Takes a prepared scene and the film that was made of it, both with their own counts; gives one
//! [`Stability`], whose verdict fits into a line.

mod lights;

use rayon::prelude::*;
use serde::Serialize;

pub use lights::LightPlace;

use crate::film::{Film, Pixel, StoppedBy};
use crate::prepare::{Leaks, PreparedScene};

/// Largest number that half floats hold.
const LARGEST_HALF: f32 = 65504.0;

/// A render that drops more of its samples than this share is not stable.
const MOST_DROPPED: f64 = 1e-3;

/// What a render says about its own numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stability {
    /// `stable`, `stable, N samples dropped`, or `unstable: …` with the reasons.
    pub verdict: String,
    /// Whether it does not begin with `unstable`.
    pub is_stable: bool,
    /// Samples that were not finite numbers.
    pub dropped: Dropped,
    /// Meshes with triangles that are hard to render.
    pub triangles: Vec<MeshDefects>,
    /// Rays that were not followed since their path had reached `max_depth`.
    pub depth_limit: DepthLimit,
    /// Lights that touch a surface or are inside of a body.
    pub lights: Vec<LightPlace>,
    /// Pixels whose value is too large for half floats; files hold single precision.
    pub beyond_half_float: u64,
    /// Rays that were sent out of closed meshes, where that was asked for.
    pub leaks: Option<LeakCounts>,
}

/// Samples that were dropped since they were not finite numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Dropped {
    /// How many.
    pub samples: u64,
    /// Pixels that have no other samples, and are black.
    pub empty_pixels: u64,
    /// Column, row and index of the first.
    pub first: Option<[u32; 3]>,
    /// The command that traces it again.
    pub replay: Option<String>,
}

/// The triangles of a mesh that are hard to render ([`crate::prepare::Defects`]).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeshDefects {
    /// Its name in the file; may be empty.
    pub mesh: String,
    /// With a vertex that is not a finite number.
    pub non_finite: u64,
    /// Without area.
    pub degenerate: u64,
    /// With the corners of another.
    pub duplicate: u64,
    /// More than a thousand times as long as wide.
    pub needle: u64,
    /// All of that as text.
    #[serde(skip)]
    pub text: String,
}

/// What the limit of the depth cut off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct DepthLimit {
    /// How many rays.
    pub rays: u64,
    /// What they count for in an average sample: the picture lacks at most this share of the radiance that they
    /// would have met.
    pub weight: f64,
}

/// [`Leaks`] as in JSON.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeakCounts {
    /// Closed meshes; every copy counts.
    pub meshes: u64,
    /// Rays that were aimed at their edges and vertices from inside.
    pub rays: u64,
    /// How many of them met nothing.
    pub leaked: u64,
}

impl Stability {
    /// What there is to say of `film`, a picture of `scene`. `command` made it; `None` where no single one does.
    pub fn of(
        scene: &PreparedScene,
        film: &Film,
        leaks: Option<Leaks>,
        command: Option<&str>,
    ) -> Self {
        let samples: u64 = film.pixels.par_iter().map(Pixel::count).sum();
        let dropped = dropped(film, command);
        let lights = lights::places(scene);
        let reasons = reasons(samples, &dropped, &lights, leaks);
        let verdict = match (reasons.as_slice(), dropped.samples) {
            ([], 0) => "stable".to_owned(),
            ([], count) => format!("stable, {count} samples dropped"),
            (reasons, _) => format!("unstable: {}", reasons.join("; ")),
        };
        let beyond = |pixel: &&Pixel| {
            let largest = pixel.mean().max_channel();
            largest > LARGEST_HALF
        };
        let defects = scene.defects().iter().map(|(&mesh, found)| MeshDefects {
            mesh: scene.scene.mesh(mesh).name.clone(),
            non_finite: found.non_finite,
            degenerate: found.degenerate,
            duplicate: found.duplicate,
            needle: found.needle,
            text: found.to_string(),
        });
        Self {
            is_stable: reasons.is_empty(),
            verdict,
            dropped,
            triangles: defects.collect(),
            depth_limit: DepthLimit {
                rays: film.cut_off.rays,
                weight: film.cut_off.weight / samples.max(1) as f64,
            },
            lights,
            beyond_half_float: film.pixels.par_iter().filter(beyond).count() as u64,
            leaks: leaks.map(|leaks| LeakCounts {
                meshes: leaks.meshes,
                rays: leaks.rays,
                leaked: leaks.leaked,
            }),
        }
    }

    /// All but the verdict, a line for each thing that was met.
    pub fn details(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for mesh in &self.triangles {
            lines.push(format!("mesh \"{}\": triangles: {}", mesh.mesh, mesh.text));
        }
        let DepthLimit { rays, weight } = self.depth_limit;
        if rays > 0 {
            lines.push(format!(
                "depth limit: {rays} rays were not followed; the picture lacks at most {:.2} % of what \
                 they would have met",
                100.0 * weight
            ));
        }
        lines.extend(self.lights.iter().map(LightPlace::to_string));
        if self.beyond_half_float > 0 {
            lines.push(format!(
                "{} pixels are brighter than half floats hold ({LARGEST_HALF})",
                self.beyond_half_float
            ));
        }
        if let Some(leaks) = &self.leaks {
            lines.push(format!(
                "leaks: {} of {} rays at edges and vertices of {} closed meshes",
                leaks.leaked, leaks.rays, leaks.meshes
            ));
        }
        lines
    }
}

fn dropped(film: &Film, command: Option<&str>) -> Dropped {
    let first = film
        .first_rejected
        .map(|first| [first.pixel.x, first.pixel.y, first.index]);
    // A render that is stopped may not have come to every pixel.
    let is_whole = film.stopped_by != StoppedBy::Interrupt;
    let is_empty = |pixel: &&Pixel| pixel.count() == 0 && is_whole;
    Dropped {
        samples: film.rejected,
        empty_pixels: film.pixels.par_iter().filter(is_empty).count() as u64,
        first,
        replay: first
            .zip(command)
            .map(|([x, y, index], command)| format!("{command} --replay {x},{y},{index}")),
    }
}

/// Why the picture cannot be relied on; none where it can.
fn reasons(
    samples: u64,
    dropped: &Dropped,
    lights: &[LightPlace],
    leaks: Option<Leaks>,
) -> Vec<String> {
    let mut reasons = Vec::new();
    if dropped.empty_pixels > 0 {
        let count = dropped.empty_pixels;
        reasons.push(format!("{count} pixels have no finite samples"));
    }
    let all = samples + dropped.samples;
    if dropped.samples as f64 > MOST_DROPPED * all as f64 {
        reasons.push(format!("{} of {all} samples dropped", dropped.samples));
    }
    let clashing = lights.iter().filter(|light| light.is_seen_through);
    reasons.extend(clashing.map(|light| {
        format!(
            "light {} lies in a surface, and rounding decides which of the two is seen",
            light.light
        )
    }));
    if let Some(leaks) = leaks.filter(|leaks| leaks.leaked > 0) {
        reasons.push(format!(
            "{} of {} rays leaked through closed meshes",
            leaks.leaked, leaks.rays
        ));
    }
    reasons
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_dropped_samples_do_no_harm_and_many_do() {
        let dropped = |samples, empty_pixels| Dropped {
            samples,
            empty_pixels,
            ..Dropped::default()
        };
        assert!(reasons(999_999, &dropped(1, 0), &[], None).is_empty());
        let many = reasons(99, &dropped(1, 0), &[], None);
        assert_eq!(many, ["1 of 100 samples dropped"]);
        let hole = reasons(999_999, &dropped(1, 1), &[], None);
        assert_eq!(hole, ["1 pixels have no finite samples"]);
    }
}
