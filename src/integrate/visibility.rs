//! How much light comes through between two points.

use crate::color::Rgb;
use crate::math::Ray;
use crate::prepare::{PreparedScene, Surface};

/// Share of the light that comes through along `ray`, per channel, where each surface on the way lets the share
/// `let_through` pass.
pub fn transmittance(
    scene: &PreparedScene,
    ray: &Ray,
    let_through: impl Fn(&Surface) -> Rgb,
) -> Rgb {
    match scene.crossings(ray) {
        None => Rgb::BLACK,
        Some(crossed) => crossed
            .iter()
            .map(|hit| let_through(&scene.surface(ray, hit)))
            .fold(Rgb::WHITE, |through, share| through * share),
    }
}

/// Share of the light that crosses `surface` where blockers tint by what they let through and do not bend: glass is
/// crossed in a straight line.
pub fn straight_through(surface: &Surface) -> Rgb {
    let opacity = surface.material.opacity(&surface.lookup);
    let specular = &surface.bsdf.specular;
    let at = &surface.interaction;
    let cos = at.wo.dot(*at.shading_normal).min(1.0);
    // The ray runs inside as it does outside, without the bend; a body's exit reflects as much
    // as its entrance, so both are taken at the outside's angle.
    let (_, through) = specular.split(cos, specular.index_of_refraction);
    Rgb::splat(1.0 - opacity) + through * opacity
}
