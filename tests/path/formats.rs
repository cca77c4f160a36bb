//! The same triangles of the same matte material, once as glTF and once as OBJ: the same picture.

use std::fmt::Write;
use std::path::Path;

use halfshade::film::{Film, relative_weights};
use halfshade::math::Vec3;

use crate::project::{film, load};

/// A hilly ground of 2 x 14 x 14 triangles, and a box on it.
fn triangles() -> Vec<[Vec3; 3]> {
    const SIDE: i32 = 14;
    let ground = |i: i32, j: i32| {
        let (x, z) = (i as f32 / 7.0 - 1.0, j as f32 / 7.0 - 1.0);
        Vec3::new(x, 0.15 * ((5.0 * x).sin() + (4.0 * z).cos()), z)
    };
    let quad = |a, b, c, d| [[a, b, c], [a, c, d]];
    let mut triangles = Vec::new();
    for i in 0..SIDE {
        for j in 0..SIDE {
            let [a, b, c, d] = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(p, q)| ground(i + p, j + q));
            triangles.extend(quad(a, b, c, d));
        }
    }
    let corner = |x: f32, y: f32, z: f32| Vec3::new(0.3 * x + 0.1, 0.35 * y + 0.4, 0.25 * z - 0.2);
    for turn in 0..3 {
        for side in [-1.0f32, 1.0] {
            let [a, b, c, d] =
                [(-1.0, -1.0), (side, -side), (1.0, 1.0), (-side, side)].map(|(p, q)| {
                    let mut v = [0.0; 3];
                    (v[turn], v[(turn + 1) % 3], v[(turn + 2) % 3]) = (side, p, q);
                    corner(v[0], v[1], v[2])
                });
            triangles.extend(quad(a, b, c, d));
        }
    }
    triangles
}

fn obj(triangles: &[[Vec3; 3]]) -> String {
    let mut text = "mtllib scene.mtl\nusemtl matte\n".to_owned();
    for (i, triangle) in triangles.iter().enumerate() {
        for v in triangle {
            writeln!(text, "v {} {} {}", v.x, v.y, v.z).unwrap();
        }
        writeln!(text, "f {} {} {}", 3 * i + 1, 3 * i + 2, 3 * i + 3).unwrap();
    }
    text
}

/// The document, and its buffer.
fn gltf(triangles: &[[Vec3; 3]]) -> (String, Vec<u8>) {
    let points = triangles.as_flattened();
    let bytes: Vec<u8> = (points.iter().flat_map(|v| v.to_array()))
        .flat_map(f32::to_le_bytes)
        .collect();
    let min = points.iter().copied().reduce(Vec3::min).unwrap().to_array();
    let max = points.iter().copied().reduce(Vec3::max).unwrap().to_array();
    let document = serde_json::json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_materials_specular"],
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
        "materials": [{
            "doubleSided": true,
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.7, 0.5, 0.3, 1.0],
                "metallicFactor": 0.0,
            },
            // Without it glTF has a coat of gloss over everything.
            "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } },
        }],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": points.len(), "type": "VEC3",
            "min": min, "max": max,
        }],
        "bufferViews": [{ "buffer": 0, "byteLength": bytes.len() }],
        "buffers": [{ "uri": "scene.bin", "byteLength": bytes.len() }],
    });
    (document.to_string(), bytes)
}

fn scene_file(model: &str, technique: &str, seed: u32) -> String {
    format!(
        "[camera]\nposition = [0.9, 1.6, 2.4]\nlook_at = [0.0, 0.1, 0.0]\nvertical_fov = 40.0\n\
         [film]\nsize = [48, 36]\n[sampling]\nsamples = 64\nseed = {seed}\n\
         [integrator]\nkind = \"{technique}\"\nmax_depth = 5\n\
         [[model]]\nfile = \"{model}\"\n\
         [[light]]\nkind = \"rectangle\"\nposition = [0.5, 2.0, 0.3]\nedge_u = [0.3, 0.0, 0.0]\n\
         edge_v = [0.0, 0.0, 0.3]\nradiance = [9.0, 8.0, 7.0]\n\
         [[light]]\nkind = \"point\"\nposition = [-1.5, 1.5, 1.0]\nintensity = [2.0, 2.5, 3.0]\n"
    )
}

fn render(folder: &Path, model: &str, technique: &str, seed: u32) -> Film {
    let path = folder.join(format!("{technique}-{model}-{seed}.toml"));
    std::fs::write(&path, scene_file(model, technique, seed)).unwrap();
    film(&load(&path, &[]), None)
}

/// √relMSE of two pictures, relative to the mean of both.
fn difference(a: &Film, b: &Film) -> f64 {
    let pixels = a.pixels.iter().zip(&b.pixels);
    let square = |(a, b): (&halfshade::film::Pixel, &halfshade::film::Pixel)| {
        let (a, b) = (a.value(), b.value());
        let weights = relative_weights([0, 1, 2].map(|c| 0.5 * (a[c] + b[c])));
        (0..3)
            .map(|c| (a[c] - b[c]).powi(2) * weights[c])
            .sum::<f64>()
    };
    (pixels.map(square).sum::<f64>() / (3 * a.pixels.len()) as f64).sqrt()
}

/// The mean over the picture, by channel.
fn mean(film: &Film) -> [f64; 3] {
    let values = || film.pixels.iter().map(|pixel| pixel.value());
    [0, 1, 2].map(|c| values().map(|v| v[c]).sum::<f64>() / film.pixels.len() as f64)
}

#[test]
fn gltf_and_obj_give_the_same_picture() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &[u8]| std::fs::write(folder.path().join(name), text).unwrap();
    let triangles = triangles();
    let (document, buffer) = gltf(&triangles);
    write("scene.gltf", document.as_bytes());
    write("scene.bin", &buffer);
    write("scene.obj", obj(&triangles).as_bytes());
    write("scene.mtl", b"newmtl matte\nKd 0.7 0.5 0.3\nillum 1\n");
    let of = |model, technique, seed| render(folder.path(), model, technique, seed);

    // Every number is the same but for rounding.
    let [a, b] = ["scene.gltf", "scene.obj"].map(|model| of(model, "whitted", 0));
    let off = difference(&a, &b);
    println!("whitted: {off:.2e}");
    assert!(mean(&a)[1] > 0.05 && off < 1e-6, "{off}");

    // Other numbers choose the directions: all but noise.
    let [a, b] = [("scene.gltf", 1), ("scene.obj", 2)].map(|(model, seed)| of(model, "path", seed));
    let stated = [&a, &b].map(|film| film.error().unwrap());
    let share = difference(&a, &b) / stated[0].high.hypot(stated[1].high);
    println!("path: {share:.3} of what both state: {stated:?}");
    assert!((0.7..=1.0).contains(&share), "{share}");
    // Over the whole picture noise is far less than of a pixel: a material that is off by a hundredth shows.
    let pixels = a.pixels.len() as f64;
    for (a, b) in mean(&a).into_iter().zip(mean(&b)) {
        let noise = stated[0].high.hypot(stated[1].high) / pixels.sqrt();
        println!("{a} {b}: {:.2e}, noise {noise:.2e}", a / b - 1.0);
        assert!((a / b - 1.0).abs() < 8.0 * noise && noise < 1.5e-3);
    }
}
