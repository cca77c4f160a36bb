//! How much light comes through between two points.

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::material::fresnel_dielectric;
use crate::math::Ray;
use crate::prepare::{PreparedScene, Surface};

/// Share of the light that comes through along `ray`, per channel.
///
/// Blockers tint by what they let through and do not bend: glass is crossed in a straight line.
pub fn transmittance(scene: &PreparedScene, ray: &Ray) -> Rgb {
    if scene.is_blocked(ray) {
        return Rgb::BLACK;
    }
    if !scene.has_transparency() {
        return Rgb::WHITE;
    }
    let mut through = Rgb::WHITE;
    let mut last: Option<Hit> = None;
    // From front to back, so that the product does not depend on the shape of the tree.
    while let Some(hit) = scene.closest_hit(ray, last.as_ref()) {
        through *= let_through(&scene.surface(ray, &hit));
        if through.is_black() {
            break;
        }
        last = Some(hit);
    }
    through
}

/// Share of the light that crosses `surface`.
fn let_through(surface: &Surface) -> Rgb {
    let opacity = surface.material.opacity(&surface.lookup);
    let holes = Rgb::splat(1.0 - opacity);
    if opacity == 0.0 {
        return holes;
    }
    let specular = surface.material.bsdf(&surface.lookup).specular;
    if specular.transmit.is_black() {
        return holes;
    }
    let at = &surface.interaction;
    let eta = relative_index(surface);
    let entering = 1.0 - fresnel_dielectric(at.wo.dot(*at.shading_normal).min(1.0), eta);
    holes + specular.transmit * (opacity * entering)
}

/// Index of the side beyond `surface` over the index of the viewer's side.
pub fn relative_index(surface: &Surface) -> f32 {
    let specular = surface.material.bsdf(&surface.lookup).specular;
    if surface.interaction.is_front || specular.is_thin {
        specular.index_of_refraction
    } else {
        1.0 / specular.index_of_refraction
    }
}
