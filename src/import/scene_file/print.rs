//! The camera, background and lights back to the words of a scene file.
//!
//! Numbers are printed with as many digits as it takes to read the same number again.

use std::fmt::Write;

use super::camera::View;
use super::defaults::RigLight;
use crate::color::Rgb;
use crate::math::DVec3;
use crate::scene::Background;

/// `[camera]`.
pub fn view(view: &View) -> String {
    let mut text = format!(
        "[camera]\nposition = {}\nlook_at = {}\nup = {}\nvertical_fov = {:?}\n",
        vector(view.position),
        vector(view.look_at),
        vector(view.up),
        view.vertical_fov
    );
    // Writing to a string cannot fail.
    if view.lens_radius > 0.0 {
        let _ = writeln!(text, "lens_radius = {:?}", view.lens_radius);
    }
    if let Some(distance) = view.focus_distance {
        let _ = writeln!(text, "focus_distance = {distance:?}");
    }
    text
}

/// `[background]`.
pub fn background(background: &Background) -> String {
    let color = |Rgb { r, g, b }: Rgb| format!("[{r:?}, {g:?}, {b:?}]");
    let mut text = "[background]\n".to_owned();
    // Writing to a string cannot fail.
    if background.radiance != Rgb::BLACK {
        let _ = writeln!(text, "radiance = {}", color(background.radiance));
    }
    if background.ambient != Rgb::BLACK {
        let _ = writeln!(text, "ambient = {}", color(background.ambient));
    }
    text
}

/// `[[light]]`.
pub fn rig_light(light: &RigLight) -> String {
    let e = light.irradiance;
    format!(
        "[[light]] # {}\nkind = \"distant\"\ndirection = {}\nirradiance = [{e:?}, {e:?}, {e:?}]\nangle = {:?}\n",
        light.name,
        vector(light.direction),
        light.angle
    )
}

fn vector(v: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}
