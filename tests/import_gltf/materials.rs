//! Materials keep every value; textures their wrapping, transforms and images.

use std::io::Cursor;

use halfshade::color::Rgb;
use halfshade::import::WarningCode;
use halfshade::material::{AlphaMode, Material, MetallicRoughness, Surface};
use halfshade::math::Vec2;
use halfshade::scene::Scene;
use halfshade::texture::{Filter, Pixels, TextureRef, Wrap};
use image::{ImageFormat, Rgba, RgbaImage};
use serde_json::{Value, json};

use super::builder::{Doc, warned};

/// An image of one pixel.
fn encoded(pixel: [u8; 4], format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = RgbaImage::from_pixel(1, 1, Rgba(pixel));
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A triangle of one material, with `textures` textures of one image each.
pub fn with_material(material: Value, textures: usize) -> Doc {
    let mut doc = Doc::triangle();
    doc.push("materials", material);
    doc.primitive()["material"] = json!(0);
    for i in 0..textures {
        let view = doc.view(&encoded([i as u8, 0, 0, 255], ImageFormat::Png));
        let image = doc.push(
            "images",
            json!({ "bufferView": view, "mimeType": "image/png" }),
        );
        doc.push("textures", json!({ "source": image }));
    }
    doc
}

pub fn scene(doc: &Doc) -> Scene {
    let imported = doc.import().unwrap();
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    imported.scene
}

pub fn material(entry: Value, textures: usize) -> Material {
    scene(&with_material(entry, textures)).materials.remove(0)
}

pub fn surface(material: &Material) -> &MetallicRoughness {
    match &material.surface {
        Surface::MetallicRoughness(surface) => surface,
        other => panic!("{other:?}"),
    }
}

pub fn texture_index(texture: Option<TextureRef>) -> u32 {
    texture.unwrap().texture.0
}

#[test]
fn every_value_of_the_base_layer_is_kept() {
    let material = material(
        json!({
            "name": "brass",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.1, 0.2, 0.3, 0.4],
                "baseColorTexture": { "index": 0 },
                "metallicFactor": 0.5, "roughnessFactor": 0.25,
                "metallicRoughnessTexture": { "index": 1 },
            },
            "normalTexture": { "index": 2, "scale": -0.5 },
            "occlusionTexture": { "index": 3, "strength": 0.75, "texCoord": 1 },
            "emissiveTexture": { "index": 4 }, "emissiveFactor": [1, 0.5, 0],
            "alphaMode": "MASK", "alphaCutoff": 0.6, "doubleSided": true,
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 10 } },
        }),
        5,
    );
    assert_eq!(material.name, "brass");
    assert!(material.is_double_sided);
    assert_eq!(material.alpha_mode, AlphaMode::Mask { cutoff: 0.6 });
    assert_eq!(
        (material.opacity.factor, material.opacity.channel),
        (0.4, 3)
    );
    assert_eq!(texture_index(material.opacity.texture), 0);
    assert_eq!(material.emission.factor, Rgb::new(10.0, 5.0, 0.0));
    assert_eq!(texture_index(material.emission.texture), 4);
    let normal_map = material.normal_map.unwrap();
    assert_eq!((normal_map.texture.texture.0, normal_map.scale), (2, -0.5));
    let surface = surface(&material);
    assert_eq!(surface.base_color.factor, Rgb::new(0.1, 0.2, 0.3));
    assert_eq!(texture_index(surface.base_color.texture), 0);
    assert_eq!(
        (surface.metallic.factor, surface.metallic.channel),
        (0.5, 2)
    );
    assert_eq!(
        (surface.roughness.factor, surface.roughness.channel),
        (0.25, 1)
    );
    assert_eq!(texture_index(surface.roughness.texture), 1);
    assert_eq!(
        (surface.occlusion.factor, surface.occlusion.channel),
        (0.75, 0)
    );
    assert_eq!(surface.occlusion.texture.unwrap().uv_set, 1);
}

#[test]
fn every_value_of_the_extensions_is_kept() {
    let material = material(
        json!({ "extensions": {
            "KHR_materials_ior": { "ior": 1.33 },
            "KHR_materials_specular": {
                "specularFactor": 0.5, "specularTexture": { "index": 0 },
                "specularColorFactor": [2, 1, 0], "specularColorTexture": { "index": 1 },
            },
            "KHR_materials_transmission": {
                "transmissionFactor": 0.9, "transmissionTexture": { "index": 2 },
            },
            "KHR_materials_volume": {
                "thicknessFactor": 3, "thicknessTexture": { "index": 3 },
                "attenuationDistance": 7, "attenuationColor": [0.9, 0.8, 0.7],
            },
        } }),
        4,
    );
    let surface = surface(&material);
    assert_eq!(surface.index_of_refraction, 1.33);
    assert_eq!(
        (surface.specular.factor, surface.specular.channel),
        (0.5, 3)
    );
    assert_eq!(surface.specular_color.factor, Rgb::new(2.0, 1.0, 0.0));
    assert_eq!(texture_index(surface.specular_color.texture), 1);
    assert_eq!(
        (surface.transmission.factor, surface.transmission.channel),
        (0.9, 0)
    );
    assert_eq!(
        (surface.thickness.factor, surface.thickness.channel),
        (3.0, 1)
    );
    assert_eq!(texture_index(surface.thickness.texture), 3);
    assert_eq!(surface.attenuation_distance, 7.0);
    assert_eq!(surface.attenuation_color, Rgb::new(0.9, 0.8, 0.7));
}

#[test]
fn what_a_material_does_not_say_is_as_the_specification_says() {
    let material = material(json!({}), 0);
    let surface = surface(&material);
    assert_eq!(surface.base_color.factor, Rgb::WHITE);
    assert_eq!(
        (surface.metallic.factor, surface.roughness.factor),
        (1.0, 1.0)
    );
    assert_eq!(surface.index_of_refraction, 1.5);
    assert_eq!(material.alpha_mode, AlphaMode::Opaque);
    assert!(!material.is_double_sided && material.emission.factor.is_black());
}

#[test]
fn unlit_materials_are_their_base_colour() {
    let material = material(
        json!({
            "pbrMetallicRoughness": { "baseColorFactor": [0.5, 0.6, 0.7, 0.8] },
            "emissiveFactor": [1, 1, 1], "alphaMode": "BLEND",
            "extensions": { "KHR_materials_unlit": {} },
        }),
        0,
    );
    let Surface::Unlit(color) = material.surface else {
        panic!()
    };
    assert_eq!(color.factor, Rgb::new(0.5, 0.6, 0.7));
    assert_eq!(
        (material.alpha_mode, material.opacity.factor),
        (AlphaMode::Blend, 0.8)
    );
    assert!(material.emission.factor.is_black());
}

#[test]
fn values_out_of_range_become_the_nearest_legal_ones() {
    let doc = with_material(
        json!({
            "pbrMetallicRoughness": { "metallicFactor": 2, "roughnessFactor": -1 },
            "emissiveFactor": [1e300, 0, 0], "alphaMode": "SOLID",
            "extensions": { "KHR_materials_ior": { "ior": 0.5 },
                            "KHR_materials_specular": { "specularFactor": "much" } },
        }),
        0,
    );
    let imported = doc.import().unwrap();
    let material = &imported.scene.materials[0];
    let surface = surface(material);
    assert_eq!(
        (surface.metallic.factor, surface.roughness.factor),
        (1.0, 0.0)
    );
    assert_eq!(
        (surface.index_of_refraction, surface.specular.factor),
        (1.0, 1.0)
    );
    assert_eq!(material.emission.factor.r, f32::MAX);
    assert_eq!(warned(&imported, WarningCode::BadValue), 6);
}

#[test]
fn texture_coordinates_are_scaled_then_turned_then_moved() {
    let transform = json!({ "offset": [0.5, 0.25], "rotation": std::f32::consts::FRAC_PI_2,
                            "scale": [2, 3], "texCoord": 1 });
    let info = json!({ "index": 0, "texCoord": 2,
                       "extensions": { "KHR_texture_transform": transform } });
    let material = material(
        json!({ "pbrMetallicRoughness": { "baseColorTexture": info } }),
        1,
    );
    let texture = surface(&material).base_color.texture.unwrap();
    assert_eq!(texture.uv_set, 1, "the extension's set wins");
    // +u turns to -v and +v to +u.
    let uv = texture.transform.transform_point2(Vec2::new(1.0, 1.0));
    assert!((uv - Vec2::new(3.5, -1.75)).length() < 1e-6, "{uv}");
}

#[test]
fn samplers_say_what_lies_beyond_and_between_pixels() {
    let info = json!({ "baseColorTexture": { "index": 0 } });
    let mut doc = with_material(json!({ "pbrMetallicRoughness": info }), 1);
    let texture = scene(&doc).textures[0];
    assert_eq!(
        (texture.wrap, texture.filter),
        ([Wrap::Repeat; 2], Filter::Linear)
    );
    doc.json["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 }]);
    doc.json["textures"][0]["sampler"] = json!(0);
    let texture = scene(&doc).textures[0];
    assert_eq!(texture.wrap, [Wrap::ClampToEdge, Wrap::MirroredRepeat]);
    assert_eq!(texture.filter, Filter::Nearest);
    doc.json["samplers"] = json!([{ "wrapS": 1 }]);
    assert_eq!(warned(&doc.import().unwrap(), WarningCode::BadValue), 1);
}

#[test]
fn images_are_decoded_once_and_only_if_used() {
    let mut doc = with_material(json!({}), 2);
    let broken = doc.view(b"not an image");
    doc.push("images", json!({ "bufferView": broken }));
    doc.push("textures", json!({ "source": 1 }));
    let scene = scene(&doc);
    let first_levels: Vec<u8> = scene
        .images
        .iter()
        .map(|image| match &image.pixels {
            Pixels::Rgba8(pixels) => pixels[0][0],
            Pixels::Rgba32F(_) => panic!("floats"),
        })
        .collect();
    assert_eq!(first_levels, [0, 1]);
    let used: Vec<u32> = scene.textures.iter().map(|t| t.image.0).collect();
    assert_eq!(used, [0, 1, 1]);
}

#[test]
fn webp_is_preferred_where_it_is_there() {
    let info = json!({ "baseColorTexture": { "index": 0 } });
    let mut doc = with_material(json!({ "pbrMetallicRoughness": info }), 1);
    let webp = doc.view(&encoded([77, 0, 0, 255], ImageFormat::WebP));
    let image = doc.push(
        "images",
        json!({ "bufferView": webp, "mimeType": "image/webp" }),
    );
    doc.json["textures"][0]["extensions"] = json!({ "EXT_texture_webp": { "source": image } });
    let scene = scene(&doc);
    assert_eq!(scene.images.len(), 1);
    assert!(matches!(&scene.images[0].pixels, Pixels::Rgba8(p) if p[0] == [77, 0, 0, 255]));
}

#[test]
fn materials_go_without_textures_that_cannot_be_read() {
    let info = json!({ "baseColorTexture": { "index": 0 } });
    let good = with_material(json!({ "pbrMetallicRoughness": info }), 1);
    type Damage = fn(&mut Doc);
    let cases: [(Damage, WarningCode); 7] = [
        (
            |doc| doc.json["textures"] = json!([]),
            WarningCode::BadValue,
        ),
        (
            |doc| doc.json["textures"][0] = json!({}),
            WarningCode::BadImage,
        ),
        (
            |doc| doc.json["textures"][0] = json!({ "source": 9 }),
            WarningCode::BadImage,
        ),
        (
            |doc| doc.json["images"][0] = json!({}),
            WarningCode::BadImage,
        ),
        (
            |doc| doc.json["images"][0] = json!({ "bufferView": 99 }),
            WarningCode::BadImage,
        ),
        (
            |doc| doc.json["images"][0] = json!({ "bufferView": 0 }),
            WarningCode::BadImage,
        ),
        (
            |doc| doc.json["images"][0] = json!({ "uri": "gone.png" }),
            WarningCode::MissingFile,
        ),
    ];
    for (i, (damage, code)) in cases.into_iter().enumerate() {
        let mut doc = good.clone();
        damage(&mut doc);
        let imported = doc.import().unwrap();
        assert_eq!(
            warned(&imported, code),
            1,
            "case {i}: {:?}",
            imported.warnings
        );
        let material = &imported.scene.materials[0];
        assert!(surface(material).base_color.texture.is_none(), "case {i}");
    }
}

#[test]
fn a_ktx2_image_is_passed_over_where_there_is_another() {
    let info = json!({ "baseColorTexture": { "index": 0 } });
    let mut doc = with_material(json!({ "pbrMetallicRoughness": info }), 1);
    let basisu = json!({ "KHR_texture_basisu": { "source": 5 } });
    doc.json["textures"][0]["extensions"] = basisu.clone();
    assert_eq!(scene(&doc).textures.len(), 1);
    doc.json["textures"][0] = json!({ "extensions": basisu });
    let imported = doc.import().unwrap();
    assert!(imported.scene.textures.is_empty());
    assert_eq!(warned(&imported, WarningCode::BadImage), 1);
}
