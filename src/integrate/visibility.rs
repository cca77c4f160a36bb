//! How much light comes through between two points.

use crate::color::Rgb;
use crate::material::fresnel_dielectric;
use crate::math::Ray;
use crate::prepare::{PreparedScene, Surface};

/// Share of the light that comes through along `ray`, per channel.
///
/// Blockers tint by what they let through and do not bend: glass is crossed in a straight line.
pub fn transmittance(scene: &PreparedScene, ray: &Ray) -> Rgb {
    match scene.crossings(ray) {
        None => Rgb::BLACK,
        Some(crossed) => crossed
            .iter()
            .map(|hit| let_through(&scene.surface(ray, hit)))
            .fold(Rgb::WHITE, |through, share| through * share),
    }
}

/// Share of the light that crosses `surface`.
fn let_through(surface: &Surface) -> Rgb {
    let opacity = surface.material.opacity(&surface.lookup);
    let holes = Rgb::splat(1.0 - opacity);
    let transmit = surface.bsdf.specular.transmit;
    if opacity == 0.0 || transmit.is_black() {
        return holes;
    }
    let at = &surface.interaction;
    let cos = at.wo.dot(*at.shading_normal).min(1.0);
    let entering = 1.0 - fresnel_dielectric(cos, surface.relative_index());
    holes + transmit * (opacity * entering)
}
