//! Lights (`KHR_lights_punctual`).

use serde::Deserialize;

use super::document::{Document, place};
use super::extensions::LIGHTS;
use crate::color::Rgb;
use crate::import::{WarningCode, Warnings};
use crate::light::{DistantLight, Falloff, Light, PointLight, SpotLight};
use crate::math::{DAffine3, UnitVec3, Vec3};
use crate::scene::Placed;

/// The extension's object in the root.
#[derive(Default, Deserialize)]
#[serde(default)]
struct LightList {
    lights: Vec<LightEntry>,
}

/// The extension's object in a node.
#[derive(Deserialize)]
struct LightUse {
    light: usize,
}

#[derive(Deserialize)]
#[serde(default)]
struct LightEntry {
    name: Option<String>,
    #[serde(rename = "type")]
    kind: LightKind,
    color: [f32; 3],
    intensity: f32,
    range: Option<f32>,
    spot: SpotEntry,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum LightKind {
    Point,
    Spot,
    Directional,
    #[default]
    #[serde(other)]
    Unknown,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct SpotEntry {
    inner_cone_angle: f32,
    outer_cone_angle: f32,
}

impl Default for LightEntry {
    fn default() -> Self {
        Self {
            name: None,
            kind: LightKind::default(),
            color: [1.0; 3],
            intensity: 1.0,
            range: None,
            spot: SpotEntry::default(),
        }
    }
}

impl Default for SpotEntry {
    fn default() -> Self {
        Self {
            inner_cone_angle: 0.0,
            outer_cone_angle: std::f32::consts::FRAC_PI_4,
        }
    }
}

/// The lights of a document, before they are placed.
pub struct Lights {
    entries: Vec<LightEntry>,
}

impl Lights {
    /// Reads the document's list; none, with a warning, where it is not well-formed.
    pub fn read(document: &Document, warnings: &mut Warnings) -> Self {
        let list = document.extensions.read::<LightList>(LIGHTS);
        let list = list.unwrap_or_else(|what| {
            warnings.add(WarningCode::BadLight, what);
            None
        });
        Self {
            entries: list.unwrap_or_default().lights,
        }
    }

    /// The light of node `index`; `None` where it has none, or one that cannot shine.
    pub fn of_node(
        &self,
        document: &Document,
        index: usize,
        world: &DAffine3,
        warnings: &mut Warnings,
    ) -> Option<Placed<Light>> {
        let node = &document.nodes[index];
        let used = match node.extensions.read::<LightUse>(LIGHTS) {
            Ok(used) => used?.light,
            Err(what) => {
                let message = format!("{}: {what}", document.node_place(index));
                warnings.add(WarningCode::BadLight, message);
                return None;
            }
        };
        let Some(entry) = self.entries.get(used) else {
            let message = format!("{}: light {used} is not there", document.node_place(index));
            warnings.add(WarningCode::BadLight, message);
            return None;
        };
        let name = entry.name.as_deref();
        match light(entry, world, &place("light", used, name), warnings) {
            Ok(item) => Some(Placed {
                name: name.or(node.name.as_deref()).unwrap_or("").into(),
                origin: world.translation,
                item,
            }),
            Err(what) => {
                let message = format!("{} {what}; it is left out", place("light", used, name));
                warnings.add(WarningCode::BadLight, message);
                None
            }
        }
    }
}

fn light(
    entry: &LightEntry,
    world: &DAffine3,
    place: &str,
    warnings: &mut Warnings,
) -> Result<Light, String> {
    let color = Rgb::from(entry.color) * entry.intensity;
    if !color.is_finite() || color.channels().into_iter().any(|channel| channel < 0.0) {
        return Err("has a colour or intensity below 0, or not finite".into());
    }
    let direction = UnitVec3::normalize((-world.matrix3.z_axis).normalize_or_zero().as_vec3());
    let direction = direction.ok_or("has no direction");
    let falloff = Falloff {
        range: range(entry.range, place, warnings),
        ..Falloff::INVERSE_SQUARE
    };
    match entry.kind {
        LightKind::Point => Ok(Light::Point(PointLight {
            position: Vec3::ZERO,
            intensity: color,
            radius: 0.0,
            samples: 1,
            falloff,
        })),
        LightKind::Spot => {
            let (inner, outer) = cone(&entry.spot, place, warnings);
            Ok(Light::Spot(SpotLight {
                position: Vec3::ZERO,
                direction: direction?,
                intensity: color,
                inner_angle_radians: inner,
                outer_angle_radians: outer,
                radius: 0.0,
                samples: 1,
                falloff,
            }))
        }
        LightKind::Directional => Ok(Light::Distant(DistantLight {
            direction: direction?,
            irradiance: color,
            angle_radians: 0.0,
            samples: 1,
        })),
        LightKind::Unknown => Err("is of a type that is not known".into()),
    }
}

fn range(range: Option<f32>, place: &str, warnings: &mut Warnings) -> f32 {
    match range {
        None => f32::INFINITY,
        Some(range) if range > 0.0 => range,
        Some(range) => {
            let message = format!("{place}: its range is {range}; it has none");
            warnings.add(WarningCode::BadValue, message);
            f32::INFINITY
        }
    }
}

/// Half angles of the inner and outer cone, the inner one below the outer one.
fn cone(spot: &SpotEntry, place: &str, warnings: &mut Warnings) -> (f32, f32) {
    let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
    let right_angle = std::f32::consts::FRAC_PI_2;
    if inner >= 0.0 && inner < outer && outer <= right_angle {
        return (inner, outer);
    }
    let legal_outer = if outer > 0.0 {
        outer.min(right_angle)
    } else {
        SpotEntry::default().outer_cone_angle
    };
    let legal_inner = inner.max(0.0).min(legal_outer.next_down());
    let message = format!(
        "{place}: its cones of {inner} and {outer} radians became {legal_inner} and {legal_outer}"
    );
    warnings.add(WarningCode::BadValue, message);
    (legal_inner, legal_outer)
}
