//! `[[material]]`.

use super::document::{Node, Source};
use super::nearest::suggestion;
use super::section::{Section, string_of};
use super::value::{NON_NEGATIVE, POSITIVE, SHARE, Value};
use crate::color::Rgb;
use crate::import::{ImportError, WarningCode, Warnings};
use crate::material::{AlphaMode, Material, MaterialId, MetallicRoughness, Phong, Surface};
use crate::texture::{TexturedRgb, TexturedScalar};

const HEADING: &str = "[[material]]";

type Reader = fn(&Section, &mut Warnings) -> Result<Material, ImportError>;

const KINDS: &[(&str, (&[&str], Reader))] = &[
    (
        "phong",
        (
            &[
                "name",
                "kind",
                "diffuse",
                "specular",
                "exponent",
                "reflect",
                "transmit",
                "index_of_refraction",
                "emission",
            ],
            phong,
        ),
    ),
    (
        "gltf",
        (
            &[
                "name",
                "kind",
                "base_color",
                "metallic",
                "roughness",
                "emissive",
                "emissive_strength",
                "ior",
                "transmission",
                "opacity",
            ],
            metallic_roughness,
        ),
    ),
];

/// Reads all `[[material]]` of a scene file.
pub fn read_all(
    source: &Source,
    nodes: &[Node],
    warnings: &mut Warnings,
) -> Result<Vec<Material>, ImportError> {
    let mut materials: Vec<Material> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let material = read(source, node, warnings)?;
        if materials.iter().any(|other| other.name == material.name) {
            return Err(source.invalid(
                &node.place,
                format!("there are two materials named \"{}\"", material.name),
            ));
        }
        materials.push(material);
    }
    Ok(materials)
}

/// The material of `materials` that `value` names.
pub fn named(value: Value, materials: &[Material]) -> Result<MaterialId, ImportError> {
    let name = value.string()?;
    let index = materials.iter().position(|material| material.name == name);
    index.map(|i| MaterialId(i as u32)).ok_or_else(|| {
        let names: Vec<_> = materials.iter().map(|m| m.name.as_str()).collect();
        value.invalid(format!(
            "no [[material]] is named \"{name}\"; {}",
            suggestion(name, &names)
        ))
    })
}

fn read(source: &Source, node: &Node, warnings: &mut Warnings) -> Result<Material, ImportError> {
    let kind = string_of(source, node, HEADING, "kind")?;
    let kind = kind.ok_or_else(|| {
        source.invalid(
            &node.place,
            format!("{HEADING} needs \"kind\": phong or gltf"),
        )
    })?;
    let (name, (keys, reader)) = kind.one_of(KINDS, |(name, _)| name)?;
    let heading = format!("{HEADING} of kind \"{name}\"");
    reader(&Section::new(source, node, heading, keys)?, warnings)
}

fn name(section: &Section) -> Result<String, ImportError> {
    section.require("name", |v| v.string().map(str::to_owned))
}

fn share_or(section: &Section, key: &'static str, default: f32) -> Result<f32, ImportError> {
    Ok(section.get(key, |v| v.single(SHARE))?.unwrap_or(default))
}

fn reflectance(section: &Section, key: &'static str) -> Result<Rgb, ImportError> {
    let color = section.get(key, |v| v.color(SHARE))?;
    Ok(color.unwrap_or(Rgb::BLACK))
}

fn emission(section: &Section, key: &'static str) -> Result<Rgb, ImportError> {
    let color = section.get(key, |v| v.color(NON_NEGATIVE))?;
    Ok(color.unwrap_or(Rgb::BLACK))
}

fn phong(section: &Section, warnings: &mut Warnings) -> Result<Material, ImportError> {
    let name = name(section)?;
    let [diffuse, specular, reflect, transmit] = [
        reflectance(section, "diffuse")?,
        reflectance(section, "specular")?,
        reflectance(section, "reflect")?,
        reflectance(section, "transmit")?,
    ];
    let sum = diffuse + specular + reflect + transmit;
    // Room for the rounding of shares that were meant to add up to 1.
    if sum.max_channel() > 1.0 + 1e-5 {
        let message = format!(
            "material \"{name}\" gives back up to {:.3} times the light that it receives: \
             diffuse, specular, reflect and transmit should add up to no more than 1 (path dims them)",
            sum.max_channel()
        );
        warnings.add(WarningCode::BadValue, message);
    }
    let exponent = section.get("exponent", |v| v.single(NON_NEGATIVE))?;
    let index = section.get("index_of_refraction", |v| v.single(POSITIVE))?;
    let surface = Phong {
        diffuse: TexturedRgb::constant(diffuse),
        specular: TexturedRgb::constant(specular),
        exponent: TexturedScalar::constant(exponent.unwrap_or(32.0)),
        reflect,
        transmit,
        index_of_refraction: index.unwrap_or(1.5),
    };
    Ok(Material {
        surface: Surface::Phong(surface),
        emission: TexturedRgb::constant(emission(section, "emission")?),
        ..Material::matte(name, Rgb::BLACK)
    })
}

fn metallic_roughness(section: &Section, _: &mut Warnings) -> Result<Material, ImportError> {
    let base_color = section.get("base_color", |v| v.color(SHARE))?;
    let index = section.get("ior", |v| v.single(POSITIVE))?;
    let surface = MetallicRoughness {
        base_color: TexturedRgb::constant(base_color.unwrap_or(Rgb::WHITE)),
        metallic: TexturedScalar::constant(share_or(section, "metallic", 1.0)?),
        roughness: TexturedScalar::constant(share_or(section, "roughness", 1.0)?),
        index_of_refraction: index.unwrap_or(1.5),
        transmission: TexturedScalar::constant(share_or(section, "transmission", 0.0)?),
        ..MetallicRoughness::default()
    };
    let strength = section.get("emissive_strength", |v| v.single(NON_NEGATIVE))?;
    let emission = emission(section, "emissive")? * strength.unwrap_or(1.0);
    if !emission.is_finite() {
        return Err(section.invalid("emissive times emissive_strength must be below 3.4e38"));
    }
    let opacity = share_or(section, "opacity", 1.0)?;
    Ok(Material {
        surface: Surface::MetallicRoughness(Box::new(surface)),
        emission: TexturedRgb::constant(emission),
        alpha_mode: if opacity < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        },
        opacity: TexturedScalar::constant(opacity),
        ..Material::matte(name(section)?, Rgb::BLACK)
    })
}
