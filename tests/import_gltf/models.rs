//! glTF files of other people give what other people's loaders say: triangles, bounds and counts
//! of `expected.tsv`.
//!
//! The models are not part of this project. They are looked for in `HALFSHADE_MODELS`, or beside
//! the checkout; without them the test says so and does nothing.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use halfshade::import::{ImportOptions, Imported, import_model};
use halfshade::material::Surface;
use halfshade::math::{Affine2, Vec2, Vec3};
use halfshade::scene::Scene;
use halfshade::texture::Pixels;

/// What differs from the table, and why.
const EXPLAINED: &[Difference] = &[
    Difference {
        path: "MeshPrimitiveModes",
        column: "max.y",
        ours: -2.0,
        why: "the table's bounds hold the points and lines too, which are not shown",
    },
    Difference {
        path: "TextureEncodingTest",
        column: "min.x",
        ours: -7.75,
        why: "a rotation of length 0.99985 turns without shrinking: it is normalised",
    },
];

struct Difference {
    path: &'static str,
    column: &'static str,
    ours: f64,
    why: &'static str,
}

/// One line of `expected.tsv`.
struct Row {
    path: String,
    triangles: u64,
    materials: u64,
    cameras: u64,
    lights: u64,
    animations: u64,
    images: u64,
    min: [f64; 3],
    max: [f64; 3],
}

/// The folder of the models; `None`, with a word, where there is none.
pub fn models() -> Option<PathBuf> {
    let beside = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/models");
    let folder = std::env::var("HALFSHADE_MODELS").unwrap_or_else(|_| beside.into());
    let folder = PathBuf::from(folder);
    if folder.join("expected.tsv").is_file() {
        return Some(folder);
    }
    eprintln!("skipped: no models in {}", folder.display());
    None
}

fn rows(models: &Path) -> Vec<Row> {
    let table = fs::read_to_string(models.join("expected.tsv")).unwrap();
    let gltf = table.split("## glTF").nth(1).unwrap();
    let gltf = gltf.split("## OBJ").next().unwrap();
    gltf.lines()
        .filter(|line| line.starts_with("gltf/"))
        .map(row)
        .collect()
}

fn row(line: &str) -> Row {
    let cells: Vec<&str> = line.split('\t').collect();
    let number = |i: usize| cells[i].parse::<u64>().unwrap();
    let vector = |i: usize| {
        let numbers: Vec<f64> = cells[i].split(',').map(|c| c.parse().unwrap()).collect();
        <[f64; 3]>::try_from(numbers).unwrap()
    };
    Row {
        path: cells[0].into(),
        triangles: number(1),
        materials: number(4),
        cameras: number(5),
        lights: number(6),
        animations: number(10),
        // The table's loader counts images, and calls them textures.
        images: number(11),
        min: vector(12),
        max: vector(13),
    }
}

/// The file's own materials: the default one is there only where a primitive has none, and then
/// it is the last.
fn file_materials(imported: &Imported) -> u64 {
    let materials = &imported.scene.materials;
    let is_default_added = materials.last().is_some_and(|m| m.name == "default");
    (materials.len() - usize::from(is_default_added)) as u64
}

/// What differs between a row and what was imported without being explained, one line each.
///
/// Notes in `met` what was explained.
fn differences(row: &Row, imported: &Imported, met: &mut BTreeSet<&'static str>) -> Vec<String> {
    let scene = &imported.scene;
    let mut columns: Vec<(&str, f64, f64, f64)> = [
        ("triangles", row.triangles, scene.triangle_count()),
        ("materials", row.materials, file_materials(imported)),
        ("cameras", row.cameras, scene.cameras.len() as u64),
        ("lights", row.lights, scene.lights.len() as u64),
        ("animations", row.animations, scene.animations as u64),
        ("images", row.images, scene.images.len() as u64),
    ]
    .map(|(column, expected, ours)| (column, expected as f64, ours as f64, 0.0))
    .into();
    let (min, max) = scene.bounds().unwrap();
    let largest = |v: [f64; 3]| v.into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let size = largest(row.min).max(largest(row.max));
    let axes = [
        (["min.x", "min.y", "min.z"], row.min, min.to_array()),
        (["max.x", "max.y", "max.z"], row.max, max.to_array()),
    ];
    for (names, expected, ours) in axes {
        for axis in 0..3 {
            // Half of the sixth digit, and single precision's share of the largest coordinate.
            let tolerance = 5.1e-6 * expected[axis].abs() + 2.5e-7 * size;
            columns.push((names[axis], expected[axis], ours[axis], tolerance));
        }
    }
    let mut found = Vec::new();
    for (column, expected, ours, tolerance) in columns {
        if (ours - expected).abs() <= tolerance {
            continue;
        }
        let explained = EXPLAINED.iter().find(|difference| {
            difference.column == column
                && row.path.contains(difference.path)
                && (difference.ours - ours).abs() <= tolerance
        });
        match explained {
            Some(difference) => {
                println!("{}: {column}: {}", row.path, difference.why);
                met.insert(difference.why);
            }
            None => found.push(format!("{}: {column} {ours}, not {expected}", row.path)),
        }
    }
    found
}

#[test]
fn every_model_is_as_other_loaders_say() {
    let Some(models) = models() else { return };
    let rows = rows(&models);
    assert_eq!(rows.len(), 86, "rows of expected.tsv");
    let (mut found, mut met) = (Vec::new(), BTreeSet::new());
    for row in rows {
        let imported = import_model(&models.join(&row.path), ImportOptions::default());
        match imported {
            Ok(imported) => found.extend(differences(&row, &imported, &mut met)),
            Err(error) => found.push(error.to_string()),
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    assert_eq!(
        met.len(),
        EXPLAINED.len(),
        "explained, but no longer so: {met:?}"
    );
}

#[test]
fn texture_transforms_bring_the_arrows_to_their_markers() {
    let Some(models) = models() else { return };
    let path = models.join("gltf/TextureTransformTest/glTF/TextureTransformTest.gltf");
    let scene = import_model(&path, ImportOptions::default()).unwrap().scene;
    // Where the model puts its green markers on the unit squares that show an arrow: there must
    // be seen what lies beyond the arrow's tip on the diagonal of the image.
    let markers = [
        ("Rotation", Vec2::new(0.420_951_8, 1.016_267_5)),
        ("Scale", Vec2::new(0.518_545, 0.518_545)),
    ];
    for (name, marker) in markers {
        let material = scene.materials.iter().find(|m| m.name == name).unwrap();
        let Surface::MetallicRoughness(surface) = &material.surface else {
            panic!("{name}: not metallic-roughness");
        };
        let texture = surface.base_color.texture.unwrap();
        let uv = texture.transform.transform_point2(marker);
        assert!(
            (uv - Vec2::splat(0.777_817_5)).length() < 1e-6,
            "{name}: {uv}"
        );
    }
}

/// Corners of all triangles of a scene: place in the world, normal, first texture coordinates.
fn corners(scene: &Scene) -> Vec<[f64; 8]> {
    let mut corners = Vec::new();
    for instance in &scene.instances {
        let mesh = scene.mesh(instance.mesh);
        // Of quantised coordinates the transform of the texture is a part.
        let transform = match &scene.materials[instance.material.0 as usize].surface {
            Surface::MetallicRoughness(surface) => surface.base_color.texture,
            _ => None,
        };
        let transform = transform.map_or(Affine2::IDENTITY, |texture| texture.transform);
        for &vertex in mesh.indices().as_flattened() {
            let vertex = vertex as usize;
            let place = mesh.positions()[vertex].as_dvec3();
            let place = instance.transform.transform_point3(place);
            let normal = mesh.normals().get(vertex).copied().unwrap_or(Vec3::ZERO);
            let normal = instance.transform.transform_vector3(normal.as_dvec3());
            let normal = normal.normalize_or_zero();
            let uv = mesh.uv_sets().first().map_or(Vec2::ZERO, |uvs| uvs[vertex]);
            let uv = transform.transform_point2(uv).as_dvec2();
            corners.push([
                place.x, place.y, place.z, normal.x, normal.y, normal.z, uv.x, uv.y,
            ]);
        }
    }
    corners
}

/// How far the corners of `a` are from the nearest of `b`, in the component that differs most.
fn distance(a: &[[f64; 8]], b: &[[f64; 8]]) -> f64 {
    let between = |x: &[f64; 8], y: &[f64; 8]| {
        let pairs = x.iter().zip(y);
        pairs.fold(0.0, |largest: f64, (x, y)| largest.max((x - y).abs()))
    };
    let nearest = |x| {
        b.iter()
            .map(|y| between(x, y))
            .fold(f64::INFINITY, f64::min)
    };
    a.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn compressed_models_are_their_plain_twins() {
    let Some(models) = models() else { return };
    // How coarse the compressed numbers are: Draco's 8 bits of normals and its 11 of places, over
    // lengths of 1 to 9; 8 bits of meshopt's normals.
    let twins = [
        (
            "meshopt-loadersgl/BoxTextured_meshopt.glb",
            "BoxTextured/glTF-Binary/BoxTextured.glb",
            0.01,
        ),
        ("Box/glTF-Draco/Box.gltf", "Box/glTF/Box.gltf", 0.01),
        (
            "RiggedSimple/glTF-Draco/RiggedSimple.gltf",
            "RiggedSimple/glTF-Binary/RiggedSimple.glb",
            0.02,
        ),
        (
            "MorphPrimitivesTest/glTF-Draco/MorphPrimitivesTest.gltf",
            "MorphPrimitivesTest/glTF-Binary/MorphPrimitivesTest.glb",
            0.01,
        ),
    ];
    for (compressed, plain, tolerance) in twins {
        let [compressed_corners, plain_corners] = [compressed, plain].map(|path| {
            let path = models.join("gltf").join(path);
            corners(&import_model(&path, ImportOptions::default()).unwrap().scene)
        });
        assert_eq!(
            compressed_corners.len(),
            plain_corners.len(),
            "{compressed}"
        );
        let there = distance(&compressed_corners, &plain_corners);
        let back = distance(&plain_corners, &compressed_corners);
        println!("{compressed}: {there}, {back}");
        assert!(there.max(back) < tolerance, "{compressed}: {there}, {back}");
    }
}

#[test]
fn ktx2_images_are_their_png_twin() {
    let Some(models) = models() else { return };
    let pixels = |path: &str| {
        let path = models.join("gltf/TextureCoordinateTest").join(path);
        let imported = import_model(&path, ImportOptions::default()).unwrap();
        assert!(imported.warnings.is_empty(), "{:?}", imported.warnings);
        let image = &imported.scene.images[0];
        let Pixels::Rgba8(pixels) = &image.pixels else {
            panic!("not in bytes");
        };
        (image.width, image.height, pixels.clone())
    };
    let plain = pixels("glTF/TextureCoordinateTest.gltf");
    for (kind, tolerance) in [("ETC1S", 12.0), ("UASTC", 3.0)] {
        let path = format!("glTF-KTX-BasisU-{kind}/TextureCoordinateTest.gltf");
        let ours = pixels(&path);
        assert_eq!((ours.0, ours.1), (plain.0, plain.1), "{kind}");
        let pairs = ours.2.as_flattened().iter().zip(plain.2.as_flattened());
        let squares = pairs.map(|(&a, &b)| f64::from(a.abs_diff(b)).powi(2));
        let rmse = (squares.sum::<f64>() / (4 * plain.2.len()) as f64).sqrt();
        println!("{kind}: {rmse} of 255");
        assert!(rmse < tolerance, "{kind}: {rmse} of 255");
    }
}
