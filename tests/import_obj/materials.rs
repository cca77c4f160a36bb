//! MTL: every statement, its maps, and the files it names.

use halfshade::color::Rgb;
use halfshade::import::{Imported, WarningCode};
use halfshade::material::{AlphaMode, Material, MetallicRoughness, Phong, Surface};
use halfshade::math::Vec2;
use halfshade::texture::Wrap;

use super::common::{Folder, warnings};

const FACE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";

/// A picture of one pixel.
fn png(pixel: [u8; 4]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbaImage::from_pixel(2, 2, image::Rgba(pixel));
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    bytes.into_inner()
}

/// A face of the material `m` of a library with `statements`, beside the files given.
fn import_with(statements: &str, files: &[(&str, &[u8])]) -> Imported {
    let folder = Folder::with(files);
    folder.add("a.mtl", format!("newmtl m\n{statements}\n").as_bytes());
    folder.add(
        "a.obj",
        format!("mtllib a.mtl\n{FACE}usemtl m\nf 1/1 2/1 3/1\n").as_bytes(),
    );
    folder.import("a.obj").unwrap()
}

fn material(statements: &str) -> Material {
    let imported = import_with(statements, &[]);
    assert!(
        imported.warnings.is_empty(),
        "{statements}: {:?}",
        imported.warnings
    );
    imported.scene.materials[0].clone()
}

fn phong(statements: &str) -> Phong {
    match material(statements).surface {
        Surface::Phong(phong) => phong,
        other => panic!("{statements}: {other:?}"),
    }
}

fn physical(statements: &str) -> MetallicRoughness {
    match material(statements).surface {
        Surface::MetallicRoughness(surface) => *surface,
        other => panic!("{statements}: {other:?}"),
    }
}

#[test]
fn colours_and_numbers_are_taken_as_written() {
    let m =
        material("Kd 0.1 0.2 0.3 # red\n\tKs 0.4\nKe 17 12 4\nNs 96.5\nNi 1.45\nKa 9 9 9\nillum 2");
    assert_eq!(m.emission.factor, Rgb::new(17.0, 12.0, 4.0));
    assert_eq!(m.alpha_mode, AlphaMode::Opaque);
    let Surface::Phong(p) = m.surface else {
        panic!("{m:?}")
    };
    assert_eq!(p.diffuse.factor, Rgb::new(0.1, 0.2, 0.3));
    assert_eq!(p.specular.factor, Rgb::splat(0.4));
    assert_eq!(p.exponent.factor, 96.5);
    assert_eq!(p.index_of_refraction, 1.45);
    assert_eq!((p.reflect, p.transmit), (Rgb::BLACK, Rgb::BLACK));
    // The white of equal energy in CIE XYZ.
    let white = phong("Kd xyz 0.9505 1 1.089").diffuse.factor;
    assert!(
        white.channels().iter().all(|c| (c - 1.0).abs() < 1e-3),
        "{white:?}"
    );
}

#[test]
fn what_a_material_does_not_say_has_a_documented_value() {
    let p = phong("");
    assert_eq!(p.diffuse.factor, Rgb::splat(0.8));
    assert!(p.specular.factor.is_black());
    assert_eq!((p.exponent.factor, p.index_of_refraction), (10.0, 1.0));
}

#[test]
fn dissolve_and_transparency_are_two_ways_to_say_one_thing() {
    for (statements, opacity) in [
        ("d 0.25", 0.25),
        ("Tr 0.75", 0.25),
        ("d 0.25\nTr 0.5", 0.25),
        ("Tr 0.5\nd 0.25", 0.25),
    ] {
        let m = material(statements);
        assert_eq!(
            (m.opacity.factor, m.alpha_mode),
            (opacity, AlphaMode::Blend),
            "{statements}"
        );
    }
    for statements in ["d 1", "Tr 0", "d 1\nTr 1", "d 7"] {
        assert_eq!(
            material(statements).alpha_mode,
            AlphaMode::Opaque,
            "{statements}"
        );
    }
}

#[test]
fn illumination_models_mean_what_the_specification_says() {
    let ks = Rgb::splat(0.25);
    let black = Rgb::BLACK;
    let common = "Kd 0.5 0.5 0.5\nKs 0.25 0.25 0.25\nNi 1.5\nd 0.5\n";
    // Glossy, mirrored, transmitted, diffuse, and what is left of plain opacity.
    for (illum, glossy, reflect, transmit, diffuse, opacity) in [
        (1, black, black, black, 0.5, 0.5),
        (2, ks, black, black, 0.5, 0.5),
        (3, ks, ks, black, 0.5, 0.5),
        (4, ks, ks, Rgb::splat(0.5), 0.25, 1.0),
        (5, ks, ks, black, 0.5, 0.5),
        (6, ks, ks, Rgb::splat(0.375), 0.25, 1.0),
        (7, ks, black, Rgb::splat(0.5), 0.25, 1.0),
        (8, ks, ks, black, 0.5, 0.5),
        (9, ks, black, Rgb::splat(0.5), 0.25, 1.0),
        (10, ks, black, black, 0.5, 0.5),
    ] {
        let m = material(&format!("{common}illum {illum}"));
        let Surface::Phong(p) = &m.surface else {
            panic!("{m:?}")
        };
        assert_eq!(p.specular.factor, glossy, "illum {illum}");
        assert_eq!(p.reflect, reflect, "illum {illum}");
        assert_eq!(p.transmit, transmit, "illum {illum}");
        assert_eq!(p.diffuse.factor, Rgb::splat(diffuse), "illum {illum}");
        assert_eq!(m.opacity.factor, opacity, "illum {illum}");
        assert_eq!(p.index_of_refraction, 1.5);
    }
    let unlit = material(&format!("{common}illum 0")).surface;
    assert!(matches!(unlit, Surface::Unlit(color) if color.factor == Rgb::splat(0.5)));
    let tinted = phong("Kd 0 0 0\nTf 0.9 0.8 0.7\nNi 1.5\nillum 7");
    assert_eq!(tinted.transmit, Rgb::new(0.9, 0.8, 0.7));
}

#[test]
fn any_physically_based_key_makes_metallic_roughness() {
    let m = physical("Kd 0.9 0.5 0.1\nPr 0.3\nPm 1\nPs 0\nPc 0");
    assert_eq!(m.base_color.factor, Rgb::new(0.9, 0.5, 0.1));
    assert_eq!((m.roughness.factor, m.metallic.factor), (0.3, 1.0));
    let m = physical("Pm 0.5\nNs 30\nNi 1.33");
    assert_eq!((m.metallic.factor, m.index_of_refraction), (0.5, 1.33));
    assert!(
        (m.roughness.factor - 0.5).abs() < 1e-6,
        "2/(30+2) is a half to the fourth"
    );
    let coated = import_with("Pr 0.5\nPc 1", &[]);
    assert_eq!(warnings(&coated, WarningCode::Approximated).len(), 1);
}

#[test]
fn every_map_is_kept_with_its_factor() {
    let grey = png([9, 9, 9, 255]);
    let statements = "Kd 0.5 0.5 0.5\nmap_Kd a.png\nmap_Ks a.png\nmap_Ns a.png\nNs 7\nmap_Ke a.png\nmap_d a.png\nbump -bm 0.2 a.png";
    let imported = import_with(statements, &[("a.png", &grey)]);
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    let scene = &imported.scene;
    assert_eq!(
        (scene.images.len(), scene.textures.len()),
        (1, 1),
        "the image is read once"
    );
    let m = &scene.materials[0];
    let Surface::Phong(p) = &m.surface else {
        panic!("{m:?}")
    };
    assert!(p.diffuse.texture.is_some() && p.diffuse.factor == Rgb::splat(0.5));
    assert!(p.specular.texture.is_some() && p.specular.factor == Rgb::WHITE);
    assert!(p.exponent.texture.is_some() && p.exponent.factor == 7.0);
    assert!(m.emission.texture.is_some() && m.emission.factor == Rgb::WHITE);
    assert!(m.opacity.texture.is_some() && m.opacity.channel == 0);
    assert_eq!(m.alpha_mode, AlphaMode::Blend);
    let bump = m.normal_map.unwrap();
    assert!(bump.is_height && bump.scale == 0.2);

    let imported = import_with(
        "map_Pr a.png\nmap_Pm -imfchan b a.png\nnorm a.png",
        &[("a.png", &grey)],
    );
    let m = &imported.scene.materials[0];
    let Surface::MetallicRoughness(s) = &m.surface else {
        panic!("{m:?}")
    };
    assert!(s.roughness.texture.is_some() && s.roughness.factor == 1.0 && s.roughness.channel == 0);
    assert!(s.metallic.texture.is_some() && s.metallic.channel == 2);
    assert!(!m.normal_map.unwrap().is_height);
}

#[test]
fn opacity_is_read_from_alpha_where_the_image_has_it() {
    let channel = |statement: &str, pixel: [u8; 4]| {
        let imported = import_with(statement, &[("a.png", &png(pixel))]);
        imported.scene.materials[0].opacity.channel
    };
    assert_eq!(channel("map_d a.png", [200, 200, 200, 255]), 0);
    assert_eq!(channel("map_d a.png", [200, 200, 200, 100]), 3);
    assert_eq!(channel("map_d -imfchan g a.png", [200, 200, 200, 100]), 1);
}

#[test]
fn a_bump_map_with_the_colours_of_normals_is_one() {
    let imported = import_with("map_Bump a.png", &[("a.png", &png([128, 127, 254, 255]))]);
    assert!(!imported.scene.materials[0].normal_map.unwrap().is_height);
    assert_eq!(warnings(&imported, WarningCode::Approximated).len(), 1);
    let grey = import_with("map_Bump a.png", &[("a.png", &png([128, 128, 128, 255]))]);
    assert!(grey.scene.materials[0].normal_map.unwrap().is_height);
}

#[test]
fn options_place_the_image_with_v_upwards() {
    let statements = "map_Kd -clamp on -s 2 4 1 -o 0.5 0.25 a.png\nmap_Ks a.png";
    let imported = import_with(statements, &[("a.png", &png([1, 1, 1, 255]))]);
    let scene = &imported.scene;
    let Surface::Phong(p) = &scene.materials[0].surface else {
        panic!()
    };
    let diffuse = p.diffuse.texture.unwrap();
    assert_eq!(
        scene.textures[diffuse.texture.0 as usize].wrap,
        [Wrap::ClampToEdge; 2]
    );
    let glossy = p.specular.texture.unwrap();
    assert_eq!(
        scene.textures[glossy.texture.0 as usize].wrap,
        [Wrap::Repeat; 2]
    );
    assert_eq!(scene.images.len(), 1);
    // (u, v) in the file is (u, 1 - v) in the mesh.
    let (u, v) = (0.125, 0.375);
    let got = diffuse.transform.transform_point2(Vec2::new(u, 1.0 - v));
    assert_eq!(got, Vec2::new(2.0 * u + 0.5, 1.0 - (4.0 * v + 0.25)));
}

#[test]
fn files_are_found_however_they_are_written() {
    let pixel = png([1, 2, 3, 255]);
    for (written, stored) in [
        ("wood.png", "wood.png"),
        ("my wood.png", "my wood.png"),
        ("Textures\\Wood.PNG", "textures/wood.png"),
        ("textures//wood.png", "textures/wood.png"),
        (".\\textures\\..\\wood.png", "textures/../wood.png"),
        ("C:\\Users\\me\\wood.png", "wood.png"),
        ("/home/me/wood.png", "wood.png"),
        ("\"wood.png\"", "wood.png"),
        ("-s 1 1 1 -o 0 0 0 2.png", "2.png"),
        ("grün.png", "GRÜN.png"),
    ] {
        let imported = import_with(
            &format!("map_Kd {written}"),
            &[("textures/.keep", b""), (stored, &pixel)],
        );
        assert!(
            imported.warnings.is_empty(),
            "{written}: {:?}",
            imported.warnings
        );
        assert_eq!(imported.scene.images.len(), 1, "{written}");
    }
}

#[test]
fn a_texture_is_looked_for_beside_the_library_and_then_beside_the_model() {
    let folder = Folder::with(&[
        (
            "a.obj",
            format!("mtllib Lib\\a.MTL\n{FACE}usemtl m\nf 1/1 2/1 3/1\n").as_bytes(),
        ),
        ("lib/a.mtl", b"newmtl m\nmap_Kd one.png\nmap_Ks two.png\n"),
        ("lib/one.png", &png([1, 1, 1, 255])),
        ("one.png", b"not this one"),
        ("two.png", &png([2, 2, 2, 255])),
    ]);
    let imported = folder.import("a.obj").unwrap();
    assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
    assert_eq!(imported.scene.images.len(), 2);
}

#[test]
fn what_is_missing_is_a_warning() {
    let codes = |imported: &Imported| imported.warnings.iter().map(|w| w.code).collect::<Vec<_>>();
    let imported = import_with("map_Kd none.png", &[]);
    assert_eq!(codes(&imported), [WarningCode::MissingFile]);
    let imported = import_with(
        "map_Kd broken.png",
        &[("broken.png", b"\x89PNG\r\n\x1a\nxx")],
    );
    assert_eq!(codes(&imported), [WarningCode::BadImage]);
    assert!(imported.scene.textures.is_empty());

    let text = format!("mtllib none.mtl\n{FACE}usemtl m\nf 1 2 3\nusemtl n\nf 1 2 3\n");
    let imported = Folder::with(&[("a.obj", text.as_bytes())])
        .import("a.obj")
        .unwrap();
    let missing = WarningCode::MissingMaterial;
    assert_eq!(
        codes(&imported),
        [WarningCode::MissingFile, missing, missing]
    );
    assert_eq!(imported.scene.materials[1].name, "n");
}

#[test]
fn statements_with_bad_values_cost_no_more_than_themselves() {
    let imported = import_with(
        "Kd 1 x 0\nKs\nNs inf\nmap_Kd\nKd 0.1 0.2\nKe 1 1 1\nnonsense\nrefl a.png",
        &[],
    );
    let count = |code| {
        warnings(&imported, code)
            .iter()
            .map(|w| w.count)
            .sum::<u64>()
    };
    assert_eq!(count(WarningCode::BadValue), 5);
    assert_eq!(count(WarningCode::UnknownStatement), 1);
    assert_eq!(count(WarningCode::Approximated), 1);
    let m = &imported.scene.materials[0];
    assert_eq!(m.emission.factor, Rgb::WHITE);
    let bad = warnings(&imported, WarningCode::BadValue);
    assert!(bad[0].message.starts_with("a.mtl, line 2: `Kd`"), "{bad:?}");
}

#[test]
fn several_libraries_may_be_named_and_the_first_definition_counts() {
    let folder = Folder::with(&[
        (
            "a.obj",
            format!("mtllib my one.mtl two.mtl\nmtllib three.mtl\n{FACE}usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl\nf 1 2 3\n").as_bytes(),
        ),
        ("my one.mtl", b"newmtl a\nKd 1 0 0\n"),
        ("two.mtl", b"newmtl b\nKd 0 1 0\nnewmtl a\nKd 1 1 1\n"),
        ("three.mtl", b"newmtl \nKd 0 0 1\n"),
    ]);
    let imported = folder.import("a.obj").unwrap();
    let colors: Vec<_> = imported
        .scene
        .materials
        .iter()
        .map(|m| match &m.surface {
            Surface::Phong(p) => p.diffuse.factor.channels(),
            other => panic!("{other:?}"),
        })
        .collect();
    assert_eq!(colors, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(warnings(&imported, WarningCode::BadValue).len(), 1);
}

#[test]
fn a_textured_face_without_coordinates_is_told() {
    let folder = Folder::with(&[
        (
            "a.obj",
            format!("mtllib a.mtl\n{FACE}usemtl m\nf 1 2 3\nf 1/1 2/1 3/1\n").as_bytes(),
        ),
        ("a.mtl", b"newmtl m\nmap_Kd a.png\n"),
        ("a.png", &png([1, 1, 1, 255])),
    ]);
    let imported = folder.import("a.obj").unwrap();
    assert_eq!(warnings(&imported, WarningCode::BadAttribute)[0].count, 3);
}

#[test]
fn an_image_under_many_names_is_read_once() {
    let names = ["a.png", "./a.png", "x/../a.png", "x/./..//a.png"];
    let library: String = (names.iter().enumerate())
        .map(|(i, name)| format!("newmtl m{i}\nmap_Kd {name}\n"))
        .collect();
    let faces: String = (0..names.len())
        .map(|i| format!("usemtl m{i}\nf 1/1 2/1 3/1\n"))
        .collect();
    let folder = Folder::with(&[
        ("a.obj", format!("mtllib a.mtl\n{FACE}{faces}").as_bytes()),
        ("a.mtl", library.as_bytes()),
        ("a.png", &png([1, 2, 3, 255])),
        ("x/y", b""),
    ]);
    let imported = folder.import("a.obj").unwrap();
    assert_eq!(imported.scene.materials.len(), names.len());
    assert_eq!(imported.scene.images.len(), 1);
}

#[test]
fn an_absolute_name_is_opened_where_it_points() {
    let elsewhere = Folder::with(&[("deep/wood.png", &png([1, 2, 3, 255]))]);
    let name = elsewhere.path("deep/wood.png");
    let folder = Folder::with(&[
        (
            "a.obj",
            format!("mtllib a.mtl\n{FACE}usemtl m\nf 1/1 2/1 3/1\n").as_bytes(),
        ),
        (
            "a.mtl",
            format!("newmtl m\nmap_Kd {}\n", name.display()).as_bytes(),
        ),
    ]);
    let imported = folder.import("a.obj").unwrap();
    assert_eq!(imported.scene.images.len(), 1);
    assert!(imported.warnings.is_empty());
}
