//! G6: far from the origin a scene keeps its shape.

use std::fs;
use std::io;
use std::path::Path;

use rayon::prelude::*;

use crate::film::Film;
use crate::import::{SceneOptions, import};
use crate::stress::scenes::{picture, relative_rmse};
use crate::stress::{Check, Curve, Effort, Sweep};

/// Extent of the scene, metres.
const SIZE: f64 = 8.0;

/// Where the shift is written.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// In the coordinates of an OBJ file, as georeferenced scans have it.
    Obj,
    /// In the matrix of a glTF node.
    GltfNode,
    /// In the scene file.
    SceneFile,
}

/// Moves a scene and its camera by 0 and up to 1e9 times its size.
pub fn run(effort: Effort) -> Vec<Check> {
    let exponents: Vec<i32> = match effort {
        Effort::Short => vec![0, 3, 6, 9],
        Effort::Full { .. } => (0..=9).collect(),
    };
    [
        (Place::Obj, "OBJ coordinates"),
        (Place::GltfNode, "glTF node matrix"),
        (Place::SceneFile, "scene file"),
    ]
    .into_par_iter()
    .map(|(place, name)| {
        let what = format!("shift of 1..1e9 sizes in {name}: relative RMSE");
        match sweep(place, name, &exponents) {
            Ok(sweep) => Check::worst(what, 1e-5, sweep),
            Err(error) => Check::at_most(what, f64::NAN, 1e-5).noted(error.to_string()),
        }
    })
    .collect()
}

fn sweep(place: Place, name: &str, exponents: &[i32]) -> io::Result<Sweep> {
    let reference = film(place, 0.0)?;
    let point = |&k: &i32| {
        let shift = 10f64.powi(k);
        let error = relative_rmse(&reference, &film(place, shift * SIZE)?);
        Ok((shift, error))
    };
    let points = exponents.par_iter().map(point).collect::<io::Result<_>>()?;
    let curves = vec![Curve::new(name, points)];
    Ok(Sweep::several(
        "shift, sizes of the scene",
        "relative RMSE against no shift",
        curves,
    ))
}

/// A picture of a small town, moved by `shift` along x and against z, by way of real files.
fn film(place: Place, shift: f64) -> io::Result<Film> {
    let folder = tempfile::tempdir()?;
    let [x, z] = [shift, -shift];
    let (model, translate) = match place {
        Place::Obj => (write_obj(folder.path(), [x, z])?, [0.0, 0.0]),
        Place::GltfNode => (write_gltf(folder.path(), [x, z])?, [0.0, 0.0]),
        Place::SceneFile => (write_obj(folder.path(), [0.0, 0.0])?, [x, z]),
    };
    let [tx, tz] = translate;
    let text = format!(
        "[camera]\nposition = [{:?}, 5.0, {:?}]\nlook_at = [{x:?}, 0.5, {z:?}]\n\
         [film]\nsize = [64, 48]\n[sampling]\nsamples = 4\n\
         [[model]]\nfile = \"{model}\"\ntranslate = [{tx:?}, 0.0, {tz:?}]\n\
         [[light]]\nkind = \"point\"\nposition = [{:?}, 6.0, {:?}]\n\
         intensity = [300.0, 250.0, 200.0]\nradius = 0.25\n",
        x + 6.0,
        z + 7.0,
        x - 3.0,
        z + 2.0
    );
    let path = folder.path().join("scene.toml");
    fs::write(&path, text)?;
    let imported = import(&path, &SceneOptions::default()).map_err(io::Error::other)?;
    let camera = imported.scene.cameras.first();
    let camera = camera.ok_or_else(|| io::Error::other("no camera"))?;
    Ok(picture(&imported.scene, camera, &imported.settings))
}

/// Corners of a floor and nine boxes of different heights; all are binary fractions.
fn town() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut corners = Vec::new();
    let mut triangles = Vec::new();
    let mut quad = |p: [[f64; 3]; 4]| {
        let first = corners.len() as u32;
        corners.extend(p);
        triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|i: u32| first + i)));
    };
    let half = 0.5 * SIZE;
    let floor = [[-half, -half], [-half, half], [half, half], [half, -half]];
    quad(floor.map(|[x, z]| [x, 0.0, z]));
    for i in 0..9 {
        let (x, z) = (f64::from(i % 3) * 2.0 - 2.0, f64::from(i / 3) * 2.0 - 2.0);
        let (w, h) = (
            0.375 + 0.0625 * f64::from(i % 4),
            0.5 + 0.25 * f64::from(i % 5),
        );
        let ring = [[-w, -w], [-w, w], [w, w], [w, -w]].map(|[a, b]| [x + a, z + b]);
        quad(ring.map(|[x, z]| [x, h, z]));
        for k in 0..4 {
            let ([ax, az], [bx, bz]) = (ring[k], ring[(k + 1) % 4]);
            quad([[ax, 0.0, az], [bx, 0.0, bz], [bx, h, bz], [ax, h, az]]);
        }
    }
    (corners, triangles)
}

fn write_obj(folder: &Path, [dx, dz]: [f64; 2]) -> io::Result<&'static str> {
    let (corners, triangles) = town();
    let vertices = corners
        .iter()
        .map(|[x, y, z]| format!("v {} {y} {}\n", x + dx, z + dz));
    let faces = triangles.iter().map(|t| {
        let [a, b, c] = t.map(|i| i + 1);
        format!("f {a} {b} {c}\n")
    });
    fs::write(
        folder.join("town.obj"),
        vertices.chain(faces).collect::<String>(),
    )?;
    Ok("town.obj")
}

fn write_gltf(folder: &Path, [dx, dz]: [f64; 2]) -> io::Result<&'static str> {
    let (corners, triangles) = town();
    let positions = corners
        .as_flattened()
        .iter()
        .flat_map(|&x| (x as f32).to_le_bytes());
    let indices = triangles
        .as_flattened()
        .iter()
        .flat_map(|i| i.to_le_bytes());
    let bytes: Vec<u8> = positions.chain(indices).collect();
    let split = corners.len() * 12;
    let document = serde_json::json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "matrix": [
            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, dx, 0, dz, 1
        ] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": corners.len() },
            { "bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 3 * triangles.len() }
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": split },
            { "buffer": 0, "byteOffset": split, "byteLength": bytes.len() - split }
        ],
        "buffers": [{ "uri": "town.bin", "byteLength": bytes.len() }]
    });
    fs::write(folder.join("town.bin"), bytes)?;
    fs::write(folder.join("town.gltf"), document.to_string())?;
    Ok("town.gltf")
}
