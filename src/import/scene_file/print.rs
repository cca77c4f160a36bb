//! Settings, cameras and lights back to the words of a scene file.
//!
//! Numbers are printed with as many digits as it takes to read the same number again.

use std::fmt::Write;

use super::camera::View;
use super::defaults::RigLight;
use super::settings::{INTEGRATORS, PATTERNS, TARGETS};
use crate::color::Rgb;
use crate::math::DVec3;
use crate::scene::Settings;

/// `settings` as `[film]`, `[sampling]` and `[integrator]` of a scene file, every key written out.
///
/// `light_samples`, an option of the command line that no key stands for, becomes a comment.
pub fn settings(settings: &Settings) -> String {
    let sampling = &settings.sampling;
    let light_samples = settings.light_samples.map_or_else(String::new, |samples| {
        format!("# every light: samples = {samples}\n")
    });
    light_samples
        + &format!(
            "[film]\nsize = [{}, {}]\n\n\
         [sampling]\nsamples = {}\npattern = \"{}\"\ntarget = \"{}\"\nseed = {}\n\n\
         [integrator]\nkind = \"{}\"\nmax_depth = {}\n",
            settings.size.x,
            settings.size.y,
            sampling.samples,
            name_of(PATTERNS, sampling.pattern),
            name_of(TARGETS, sampling.target),
            sampling.seed,
            name_of(INTEGRATORS, settings.integrator),
            settings.max_depth,
        )
}

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

/// `[background]` with nothing but ambient light.
pub fn ambient(Rgb { r, g, b }: Rgb) -> String {
    format!("[background]\nambient = [{r:?}, {g:?}, {b:?}]\n")
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

fn name_of<T: PartialEq>(names: &[(&'static str, T)], value: T) -> &'static str {
    let found = names.iter().find(|(_, other)| *other == value);
    found.map_or("", |(name, _)| name)
}
