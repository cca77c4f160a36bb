//! Layers that extensions add to materials, variants of materials, and tangents.

use halfshade::color::Rgb;
use halfshade::import::{ImportOptions, WarningCode, import_model};
use halfshade::material::AlphaMode;
use serde_json::json;

use super::builder::{Doc, warned, write};
use super::materials::{material, scene, surface, texture_index, with_material};

#[test]
fn coat_sheen_and_film_are_read_with_their_textures() {
    let material = material(
        json!({ "extensions": {
            "KHR_materials_clearcoat": {
                "clearcoatFactor": 0.9, "clearcoatTexture": { "index": 0 },
                "clearcoatRoughnessFactor": 0.2, "clearcoatRoughnessTexture": { "index": 1 },
                "clearcoatNormalTexture": { "index": 2, "scale": 0.5 },
            },
            "KHR_materials_sheen": {
                "sheenColorFactor": [0.1, 0.2, 0.3], "sheenColorTexture": { "index": 0 },
                "sheenRoughnessFactor": 0.4, "sheenRoughnessTexture": { "index": 1 },
            },
            "KHR_materials_iridescence": {
                "iridescenceFactor": 0.8, "iridescenceTexture": { "index": 1 },
                "iridescenceIor": 1.7, "iridescenceThicknessMinimum": 150,
                "iridescenceThicknessTexture": { "index": 2 },
            },
        } }),
        3,
    );
    let surface = surface(&material);
    let coat = surface.clearcoat.as_ref().unwrap();
    assert_eq!((coat.factor.factor, coat.factor.channel), (0.9, 0));
    assert_eq!((coat.roughness.factor, coat.roughness.channel), (0.2, 1));
    assert_eq!(texture_index(coat.roughness.texture), 1);
    let bumps = coat.normal_map.unwrap();
    assert_eq!((bumps.texture.texture.0, bumps.scale), (2, 0.5));
    let sheen = surface.sheen.as_ref().unwrap();
    assert_eq!(sheen.color.factor, Rgb::new(0.1, 0.2, 0.3));
    assert_eq!((sheen.roughness.factor, sheen.roughness.channel), (0.4, 3));
    let film = surface.iridescence.as_ref().unwrap();
    assert_eq!((film.factor.factor, film.factor.channel), (0.8, 0));
    assert_eq!(
        (film.index_of_refraction, film.thickness),
        (1.7, [150.0, 400.0])
    );
    assert_eq!(texture_index(film.thickness_texture), 2);
    assert!(surface.anisotropy.is_none() && surface.diffuse_transmission.is_none());
}

#[test]
fn grain_dispersion_and_diffuse_transmission_are_read() {
    let material = material(
        json!({ "extensions": {
            "KHR_materials_anisotropy": {
                "anisotropyStrength": 0.6, "anisotropyRotation": 1.5,
                "anisotropyTexture": { "index": 0 },
            },
            "KHR_materials_dispersion": { "dispersion": 0.3 },
            "KHR_materials_diffuse_transmission": {
                "diffuseTransmissionFactor": 0.7, "diffuseTransmissionTexture": { "index": 0 },
                "diffuseTransmissionColorFactor": [1.0, 0.5, 0.25],
            },
        } }),
        1,
    );
    let surface = surface(&material);
    let grain = surface.anisotropy.as_ref().unwrap();
    assert_eq!((grain.strength, grain.rotation), (0.6, 1.5));
    assert_eq!(texture_index(grain.texture), 0);
    assert_eq!(surface.dispersion, 0.3);
    let through = surface.diffuse_transmission.as_ref().unwrap();
    assert_eq!((through.factor.factor, through.factor.channel), (0.7, 3));
    assert_eq!(through.color.factor, Rgb::new(1.0, 0.5, 0.25));
}

/// Its diffuse colour lies below a dielectric of just the reflectance that it names.
#[test]
fn specular_glossiness_is_a_dielectric_of_its_own_reflectance() {
    let material = material(
        json!({ "alphaMode": "BLEND", "extensions": { "KHR_materials_pbrSpecularGlossiness": {
            "diffuseFactor": [0.2, 0.3, 0.4, 0.5], "specularFactor": [0.3, 0.2, 0.1],
            "glossinessFactor": 0.75, "specularGlossinessTexture": { "index": 0 },
        } } }),
        1,
    );
    assert_eq!(material.alpha_mode, AlphaMode::Blend);
    assert_eq!(material.opacity.factor, 0.5);
    let surface = surface(&material);
    assert!(surface.is_glossiness);
    assert_eq!(
        (surface.roughness.factor, surface.roughness.channel),
        (0.75, 3)
    );
    assert_eq!(
        (surface.metallic.factor, surface.index_of_refraction),
        (0.0, 0.0)
    );
    assert_eq!(surface.base_color.factor, Rgb::new(0.2, 0.3, 0.4));
    assert_eq!(surface.specular_color.factor, Rgb::new(0.3, 0.2, 0.1));
    assert_eq!(texture_index(surface.specular_color.texture), 0);
}

/// A shoe in two colours and a default one.
fn shoe() -> Doc {
    let mut doc = with_material(json!({ "name": "grey" }), 0);
    doc.push("materials", json!({ "name": "red" }));
    doc.push("materials", json!({ "name": "blue" }));
    doc.primitive()["extensions"] = json!({ "KHR_materials_variants": { "mappings": [
        { "material": 1, "variants": [0] }, { "material": 2, "variants": [1, 2] },
    ] } });
    doc.json["extensionsUsed"] = json!(["KHR_materials_variants"]);
    doc.json["extensions"] = json!({ "KHR_materials_variants": { "variants": [
        { "name": "beach" }, { "name": "street" }, { "name": "night" },
    ] } });
    doc
}

#[test]
fn variants_are_chosen_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shoe.glb");
    write(folder.path(), "shoe.glb", &shoe().glb());
    let shown = |variant: Option<&str>| {
        let options = ImportOptions {
            variant,
            ..ImportOptions::default()
        };
        let imported = import_model(&path, options).map_err(|error| error.to_string())?;
        assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
        let material = imported.scene.instances[0].material.0 as usize;
        Ok(imported.scene.materials[material].name.clone())
    };
    for (variant, name) in [
        (None, "grey"),
        (Some("beach"), "red"),
        (Some("street"), "blue"),
        (Some("night"), "blue"),
    ] {
        assert_eq!(shown(variant), Ok(name.to_owned()));
    }
    let error: String = shown(Some("steet")).unwrap_err();
    let expected = "shoe.glb: no variant is named \"steet\"; did you mean \"street\"?";
    assert!(error.ends_with(expected), "{error}");

    write(
        folder.path(),
        "shoe.glb",
        &with_material(json!({}), 0).glb(),
    );
    let options = ImportOptions {
        variant: Some("beach"),
        ..ImportOptions::default()
    };
    let imported = import_model(&path, options).unwrap();
    assert_eq!(warned(&imported, WarningCode::BadValue), 1);
}

/// Tangents follow u, and the bitangent goes against v; corners of one vertex whose tangents differ
/// are cut apart.
#[test]
fn meshes_that_lack_tangents_get_them_where_something_is_read_along_them() {
    let quad = |us: [f32; 4], is_bumped: bool| {
        let bumps = json!({ "normalTexture": { "index": 0 } });
        let mut doc = with_material(if is_bumped { bumps } else { json!({}) }, 1);
        let corners = [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];
        let positions = doc.floats("VEC3", &corners);
        let normals = doc.floats("VEC3", &[0., 0., 1.].repeat(4));
        let uvs = [us[0], 1., us[1], 1., us[2], 0., us[3], 0.];
        let uvs = doc.floats("VEC2", &uvs);
        let indices = doc.accessor("SCALAR", 5121, 6, &[0, 1, 2, 0, 2, 3]);
        doc.primitive()["attributes"] =
            json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
        doc.primitive()["indices"] = json!(indices);
        scene(&doc).meshes.remove(0)
    };
    let plain = quad([0., 1., 1., 0.], true);
    assert_eq!(plain.tangents(), [[1.0, 0.0, 0.0, 1.0]; 4]);
    assert_eq!(plain.indices(), [[0, 1, 2], [0, 2, 3]]);
    let mirrored = quad([1., 0., 0., 1.], true);
    assert_eq!(mirrored.tangents(), [[-1.0, 0.0, 0.0, -1.0]; 4]);
    // One triangle of it is mirrored: the vertices of the edge between both are there twice.
    let folded = quad([0., 1., 0., 1.], true);
    assert_eq!(folded.positions().len(), 6);
    assert!(quad([0., 1., 1., 0.], false).tangents().is_empty());
}
