//! Techniques: from a ray to the radiance that comes back along it.

mod account;
mod aov;
mod log;
mod met;
mod path;
mod views;
mod visibility;
mod way;
mod whitted;

pub use account::{Account, LightGroups, LightPart, Seen, Sight, Source};
pub use aov::Aov;
pub use log::{RayKind, RayLog, RayRecord};
pub use path::{PathTracer, Weighing};
pub use views::{FirstSurface, View, ViewKind};
pub use whitted::Whitted;

use crate::color::Rgb;
use crate::light::Light;
use crate::math::{ROW, Ray, RayRow};
use crate::prepare::PreparedScene;
use crate::sampling::{Pattern, Sampler, SamplerRow};
use crate::scene::{IntegratorKind, Settings};

/// Where up to [`ROW`] samples of pixels begin.
#[derive(Clone, Debug)]
pub struct CameraRow {
    /// Their rays from the camera.
    pub rays: RayRow,
    /// Their other numbers, as many.
    pub samplers: SamplerRow,
}

impl CameraRow {
    /// No samples.
    pub const EMPTY: Self = Self {
        rays: RayRow::EMPTY,
        samplers: SamplerRow::EMPTY,
    };

    /// Their rays and samplers.
    pub fn iter(&self) -> impl Iterator<Item = (Ray, Sampler)> {
        let sample = |i| Some((self.rays.get(i), self.samplers.get(i)?));
        (0..self.rays.count()).map_while(sample)
    }
}

/// A technique: what light, or what else, comes back along a ray.
pub trait Integrator: Sync {
    /// Radiance along `ray`, W/(m² sr), with the random numbers of `sampler`.
    ///
    /// The rays that are traced for it are counted, and on request recorded, in `log`, which is also told what
    /// the camera sees and where the light comes from.
    fn radiance(&self, ray: &Ray, sampler: &Sampler, log: &mut RayLog) -> Rgb;

    /// [`Self::radiance`] of each of `samples`, put into the first of `radiances`, with the same bits. Samples of near
    /// places of the film may be quicker together than one by one.
    fn radiances(&self, samples: &CameraRow, radiances: &mut [Rgb; ROW], log: &mut RayLog) {
        for (place, (ray, sampler)) in samples.iter().enumerate() {
            log.turn_to(place);
            radiances[place] = self.radiance(&ray, &sampler, log);
        }
    }
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
