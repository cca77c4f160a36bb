//! Techniques: from a ray to the radiance that comes back along it.

mod log;
mod path;
mod views;
mod visibility;
mod whitted;

pub use log::{RayKind, RayLog, RayRecord};
pub use path::{PathTracer, Weighing};
pub use views::{FirstSurface, View, ViewKind};
pub use whitted::Whitted;

use crate::color::Rgb;
use crate::light::Light;
use crate::math::Ray;
use crate::prepare::PreparedScene;
use crate::sampling::{Pattern, Sampler};
use crate::scene::{IntegratorKind, Settings};

/// Where a sample of a pixel begins.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// Its ray from the camera.
    pub ray: Ray,
    /// Its other numbers.
    pub sampler: Sampler,
}

/// A technique: what light, or what else, comes back along a ray.
pub trait Integrator: Sync {
    /// Radiance along `ray`, W/(m² sr), with the random numbers of `sampler`.
    ///
    /// The rays that are traced for it are counted, and on request recorded, in `log`.
    fn radiance(&self, ray: &Ray, sampler: &Sampler, log: &mut RayLog) -> Rgb;

    /// [`Self::radiance`] of each of `samples`, appended to `radiances`, with the same bits. Samples of near
    /// places of the film may be quicker together than one by one.
    fn radiances(&self, samples: &[CameraSample], radiances: &mut Vec<Rgb>, log: &mut RayLog) {
        let all = samples.iter();
        radiances.extend(all.map(|s| self.radiance(&s.ray, &s.sampler, log)));
    }

    /// What [`Self::radiance`] is along every ray that meets nothing.
    fn background(&self) -> Rgb;
}

/// The technique that `settings` ask for.
pub fn integrator<'a>(
    scene: &'a PreparedScene<'a>,
    settings: &Settings,
) -> Box<dyn Integrator + 'a> {
    let view = |kind| Box::new(View { scene, kind });
    match settings.integrator {
        IntegratorKind::Whitted => Box::new(Whitted::new(scene, settings)),
        IntegratorKind::Path => Box::new(PathTracer::new(scene, settings)),
        IntegratorKind::Normal => view(ViewKind::Normal),
        IntegratorKind::Depth => view(ViewKind::Depth),
        IntegratorKind::Albedo => view(ViewKind::Albedo),
    }
}

/// Shadow rays per shading point and light: what `asked` or the light says, rounded as `pattern`
/// wants it, and one where all would be the same.
fn light_samples(light: &Light, asked: Option<u32>, pattern: Pattern) -> u32 {
    if light.is_delta() {
        return 1;
    }
    pattern.cells(asked.unwrap_or_else(|| light.samples()))
}
