//! `[[light]]`.

use super::document::{Node, Source};
use super::section::{Section, string_of};
use super::value::{Domain, NON_NEGATIVE, POSITIVE, Value, normalize};
use crate::color::Rgb;
use crate::import::ImportError;
use crate::light::{
    DiskLight, DistantLight, Falloff, Light, PointLight, RectangleLight, SphereLight, SpotLight,
};
use crate::math::{DVec3, UnitVec3, Vec3};
use crate::scene::{MAX_LIGHT_SAMPLES, Placed};

const HEADING: &str = "[[light]]";

const HALF_ANGLE: Domain = Domain {
    words: "a number of degrees from 0 to 180",
    contains: |v| (0.0..=180.0).contains(&v),
};

const SKY_ANGLE: Domain = Domain {
    words: "a number of degrees from 0 to below 180",
    contains: |v| (0.0..180.0).contains(&v),
};

type Reader = fn(&Section) -> Result<Placed<Light>, ImportError>;

/// A kind of light: its keys, and what makes it of them.
type KindOfLight = (&'static [&'static str], Reader);

const KINDS: &[(&str, KindOfLight)] = &[
    (
        "point",
        (
            &[
                "kind",
                "name",
                "position",
                "intensity",
                "radius",
                "samples",
                "falloff",
            ],
            point,
        ),
    ),
    (
        "spot",
        (
            &[
                "kind",
                "name",
                "position",
                "direction",
                "intensity",
                "inner_angle",
                "outer_angle",
                "radius",
                "samples",
                "falloff",
            ],
            spot,
        ),
    ),
    (
        "distant",
        (
            &[
                "kind",
                "name",
                "direction",
                "irradiance",
                "angle",
                "samples",
            ],
            distant,
        ),
    ),
    (
        "disk",
        (
            &[
                "kind", "name", "position", "normal", "radius", "radiance", "samples", "visible",
            ],
            disk,
        ),
    ),
    (
        "rectangle",
        (
            &[
                "kind", "name", "position", "edge_u", "edge_v", "radiance", "samples", "visible",
            ],
            rectangle,
        ),
    ),
    (
        "sphere",
        (
            &[
                "kind", "name", "position", "radius", "radiance", "samples", "visible",
            ],
            sphere,
        ),
    ),
];

/// Reads one `[[light]]`.
pub fn read(source: &Source, node: &Node) -> Result<Placed<Light>, ImportError> {
    let kind = string_of(source, node, HEADING, "kind")?;
    let kind = kind.ok_or_else(|| {
        let kinds: Vec<_> = KINDS.iter().map(|(name, _)| *name).collect();
        let kinds = kinds.join(", ");
        source.invalid(&node.place, format!("{HEADING} needs \"kind\": {kinds}"))
    })?;
    let (name, (keys, reader)) = kind.one_of(KINDS, |(name, _)| name)?;
    let heading = format!("{HEADING} of kind \"{name}\"");
    let section = Section::new(source, node, heading, keys)?;
    let mut light = reader(&section)?;
    light.name = (section.get("name", |v| v.string().map(str::to_owned))?).unwrap_or_default();
    Ok(light)
}

/// A distant light; `direction` has a length above 0, `angle` is in degrees.
pub fn distant_light(
    direction: DVec3,
    irradiance: Rgb,
    angle: f64,
    samples: u32,
) -> Option<Placed<Light>> {
    let light = DistantLight {
        direction: unit(normalize(direction)?)?,
        irradiance,
        angle_radians: angle.to_radians() as f32,
        samples,
    };
    Some(placed(DVec3::ZERO, Light::Distant(light)))
}

fn placed(origin: DVec3, item: Light) -> Placed<Light> {
    Placed {
        name: String::new(),
        origin,
        item,
    }
}

fn unit(v: DVec3) -> Option<UnitVec3> {
    UnitVec3::normalize(v.as_vec3())
}

fn position(section: &Section) -> Result<DVec3, ImportError> {
    section.require("position", |v| v.vector())
}

/// The direction `key`, of length 1.
fn direction(section: &Section, key: &'static str) -> Result<UnitVec3, ImportError> {
    let direction = section.require(key, |v| v.direction())?;
    unit(direction).ok_or_else(|| section.invalid(format!("{key} must be a direction")))
}

fn emission(section: &Section, key: &'static str) -> Result<Rgb, ImportError> {
    section.require(key, |v| v.color(NON_NEGATIVE))
}

fn samples(section: &Section) -> Result<u32, ImportError> {
    let samples = section.get("samples", |v| v.integer_u32(1, MAX_LIGHT_SAMPLES))?;
    Ok(samples.unwrap_or(1))
}

fn is_visible(section: &Section) -> Result<bool, ImportError> {
    Ok(section.get("visible", |v| v.boolean())?.unwrap_or(true))
}

/// The radius that shadow rays of a point aim at.
fn shadow_radius(section: &Section) -> Result<f32, ImportError> {
    let radius = section.get("radius", |v| v.single(NON_NEGATIVE))?;
    Ok(radius.unwrap_or(0.0))
}

fn falloff(section: &Section) -> Result<Falloff, ImportError> {
    section
        .get("falloff", read_falloff)
        .map(|falloff| falloff.unwrap_or(Falloff::INVERSE_SQUARE))
}

fn read_falloff(value: Value) -> Result<Falloff, ImportError> {
    let keys = &["constant", "linear", "quadratic"];
    let section = Section::new(value.source, value.node, "falloff", keys)?;
    let term = |key| section.get(key, |v| v.single(NON_NEGATIVE));
    let falloff = Falloff {
        constant: term("constant")?.unwrap_or(0.0),
        linear: term("linear")?.unwrap_or(0.0),
        quadratic: term("quadratic")?.unwrap_or(0.0),
        range: f32::INFINITY,
    };
    if falloff.constant + falloff.linear + falloff.quadratic > 0.0 {
        Ok(falloff)
    } else {
        Err(section.invalid("one of constant, linear and quadratic must be above 0"))
    }
}

fn point(section: &Section) -> Result<Placed<Light>, ImportError> {
    let light = PointLight {
        position: Vec3::ZERO,
        intensity: emission(section, "intensity")?,
        radius: shadow_radius(section)?,
        samples: samples(section)?,
        falloff: falloff(section)?,
    };
    Ok(placed(position(section)?, Light::Point(light)))
}

fn spot(section: &Section) -> Result<Placed<Light>, ImportError> {
    let angle = |key| section.get(key, |v| v.number(HALF_ANGLE));
    let outer = angle("outer_angle")?.unwrap_or(45.0);
    let inner = angle("inner_angle")?.unwrap_or(0.0);
    if inner > outer || outer == 0.0 {
        return Err(section.invalid(format!(
            "inner_angle, {inner:?}, must not be above outer_angle, {outer:?}, nor that be 0"
        )));
    }
    let inner = inner.to_radians() as f32;
    let light = SpotLight {
        position: Vec3::ZERO,
        direction: direction(section, "direction")?,
        intensity: emission(section, "intensity")?,
        inner_angle_radians: inner,
        // Equal angles, a cone with a sharp edge, leave one step of rounding to fade in.
        outer_angle_radians: (outer.to_radians() as f32).max(inner.next_up()),
        radius: shadow_radius(section)?,
        samples: samples(section)?,
        falloff: falloff(section)?,
    };
    Ok(placed(position(section)?, Light::Spot(light)))
}

fn distant(section: &Section) -> Result<Placed<Light>, ImportError> {
    let light = distant_light(
        section.require("direction", |v| v.direction())?,
        emission(section, "irradiance")?,
        section
            .get("angle", |v| v.number(SKY_ANGLE))?
            .unwrap_or(0.0),
        samples(section)?,
    );
    light.ok_or_else(|| section.invalid("direction must not be zero"))
}

fn disk(section: &Section) -> Result<Placed<Light>, ImportError> {
    let light = DiskLight {
        center: Vec3::ZERO,
        normal: direction(section, "normal")?,
        radius: section.require("radius", |v| v.single(POSITIVE))?,
        radiance: emission(section, "radiance")?,
        is_visible: is_visible(section)?,
        samples: samples(section)?,
    };
    Ok(placed(position(section)?, Light::Disk(light)))
}

fn rectangle(section: &Section) -> Result<Placed<Light>, ImportError> {
    let edge = |key| section.require(key, |v| v.direction().and_then(|_| v.vector()));
    let (u, v) = (edge("edge_u")?, edge("edge_v")?);
    let normal = normalize(u)
        .zip(normalize(v))
        .and_then(|(u, v)| normalize(u.cross(v)));
    if normal.is_none() {
        return Err(section.invalid("edge_u and edge_v must not be parallel"));
    }
    let light = RectangleLight {
        center: Vec3::ZERO,
        half_u: u.as_vec3(),
        half_v: v.as_vec3(),
        radiance: emission(section, "radiance")?,
        is_visible: is_visible(section)?,
        samples: samples(section)?,
    };
    if !(light.half_u.is_finite() && light.half_v.is_finite()) {
        return Err(section.invalid("edge_u and edge_v must be below 3.4e38"));
    }
    Ok(placed(position(section)?, Light::Rectangle(light)))
}

fn sphere(section: &Section) -> Result<Placed<Light>, ImportError> {
    let light = SphereLight {
        center: Vec3::ZERO,
        radius: section.require("radius", |v| v.single(POSITIVE))?,
        radiance: emission(section, "radiance")?,
        is_visible: is_visible(section)?,
        samples: samples(section)?,
    };
    Ok(placed(position(section)?, Light::Sphere(light)))
}
