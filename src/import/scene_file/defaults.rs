//! A camera and lights for scenes that have none.
//!
//! Both follow the bounds of the scene and nothing else, so that a model shows the same picture at
//! any size. They are described in the words of a scene file first, and made of that
//! description: [`Defaults::text`] reproduces them bit for bit.

use super::camera::View;
use super::light::distant_light;
use super::print;
use crate::camera::Camera;
use crate::color::Rgb;
use crate::light::Light;
use crate::math::DVec3;
use crate::scene::{Background, Placed};

/// What was added to a scene that lacked it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Defaults {
    /// The sections of a scene file that say the same; each takes the place of one that is there.
    pub text: String,
    /// How many of the scene's cameras were added: 0 or 1. It is the first.
    pub cameras: usize,
    /// How many of the scene's lights were added: 0 or all of them.
    pub lights: usize,
}

/// A default light: its part, where it stands as (right, up, back) of the camera, its
/// irradiance, and the degrees that it covers.
pub struct RigLight {
    /// Its part.
    pub name: &'static str,
    /// The way the light travels, world space.
    pub direction: DVec3,
    /// Irradiance in every channel, W/m².
    pub irradiance: f32,
    /// Degrees across.
    pub angle: f64,
}

/// What stands in for the light of the surroundings beside the default lights, as ambient light or as
/// radiance from everywhere: without it rough
/// metal, which has nothing to mirror, is black but for its highlights.
pub const AMBIENT: Rgb = Rgb::splat(0.15);

/// Room around the scene, as a factor of the camera's distance.
const MARGIN: f64 = 1.08;

/// From the middle of the scene to the camera: from the front, a little to the right and above.
const TO_CAMERA: DVec3 = DVec3::new(0.45, 0.35, 1.0);

/// A camera that frames the box `bounds`, or what is about the origin where there is none.
///
/// `aspect` is width over height of the picture.
pub fn view(bounds: Option<(DVec3, DVec3)>, aspect: f64, vertical_fov: f64) -> View {
    let (center, half) = match bounds {
        Some((min, max)) => (0.5 * min + 0.5 * max, 0.5 * max - 0.5 * min),
        None => (DVec3::ZERO, DVec3::ONE),
    };
    // All that follows is relative to the longest edge: nothing under- or overflows, and scenes
    // that differ by a power of two get the same digits. One point alone gets a size of 1.
    let size = half.max_element();
    let size = if size > 0.0 && size.is_finite() {
        size
    } else {
        1.0
    };
    let to_camera = TO_CAMERA.normalize();
    let distance = MARGIN * size * framing_distance(half / size, to_camera, aspect, vertical_fov);
    // At least some roundings away from a centre that is far from the origin.
    let distance = distance.max(8.0 * f64::EPSILON * center.abs().max_element());
    View {
        position: center + distance * to_camera,
        look_at: center,
        up: DVec3::Y,
        vertical_fov,
        lens_radius: 0.0,
        focus_distance: None,
    }
}

/// How far back a camera must stand to see all corners of a box that is `half` to each side.
fn framing_distance(half: DVec3, back: DVec3, aspect: f64, vertical_fov: f64) -> f64 {
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let slope_y = (0.5 * vertical_fov).to_radians().tan();
    let slope_x = slope_y * aspect;
    let mut distance: f64 = 0.0;
    for corner in 0..8 {
        let sign = |axis: u32| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        let corner = half * DVec3::new(sign(0), sign(1), sign(2));
        let needed = (corner.dot(right).abs() / slope_x).max(corner.dot(up).abs() / slope_y);
        distance = distance.max(corner.dot(back) + needed);
    }
    distance
}

/// Key, fill and rim light for what `camera` sees.
///
/// They come from far away: even light and the same sharpness of shadows at any size of scene. A
/// matte surface of reflectance 0.5 that faces the key light shows a radiance of about 0.5.
pub fn lights(camera: &Camera) -> [RigLight; 3] {
    let [right, up, back] = [camera.right, camera.up, camera.back].map(|v| v.get().as_dvec3());
    let light = |name, from: [f64; 3], irradiance, angle| {
        let from = right * from[0] + up * from[1] + back * from[2];
        // Four digits are plenty for a direction, and read well in a file; + 0.0 turns -0 to 0.
        let direction = (-from.normalize() * 1e4).round() / 1e4 + 0.0;
        RigLight {
            name,
            direction,
            irradiance,
            angle,
        }
    };
    [
        light("key: from the upper left", [-0.7, 0.9, 0.8], 3.0, 6.0),
        light("fill: from the right, soft", [1.0, 0.25, 0.7], 0.7, 40.0),
        light("rim: from behind", [0.5, 0.8, -1.0], 1.8, 10.0),
    ]
}

impl RigLight {
    /// The light itself.
    pub fn light(&self) -> Option<Placed<Light>> {
        let irradiance = Rgb::splat(self.irradiance);
        distant_light(self.direction, irradiance, self.angle, 1)
    }
}

/// What was added, in the words of a scene file; `None` where nothing was. Sections that the file has
/// in part are whole in it, to take the place of those.
pub fn report(
    view: Option<&View>,
    background: Option<&Background>,
    lights: &[RigLight],
) -> Option<Defaults> {
    let mut parts: Vec<String> = view.map(print::view).into_iter().collect();
    parts.extend(background.map(print::background));
    parts.extend(lights.iter().map(print::rig_light));
    (!parts.is_empty()).then(|| Defaults {
        text: parts.join("\n"),
        cameras: view.iter().count(),
        lights: lights.len(),
    })
}
