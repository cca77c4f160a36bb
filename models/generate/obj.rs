//! Writes a model as OBJ and MTL text.

use std::fmt::Write;

use glam::DVec3;

use super::model::{Finish, Material, Model, Part, Placement};

/// The OBJ text of `model`, which names `materials` as its MTL file. Every place of a mesh is
/// written out.
pub fn write_obj(model: &Model, comment: &str, materials: &str) -> String {
    let mut text = format!("# {comment}\nmtllib {materials}\n");
    let mut first = FirstIndices {
        position: 1,
        normal: 1,
    };
    for group in &model.groups {
        let mesh = &model.meshes[group.mesh];
        for place in &group.places {
            push(&mut text, format_args!("o {}\n", mesh.name));
            for part in &mesh.parts {
                let material = &model.materials[part.material];
                push(&mut text, format_args!("usemtl {}\n", material.name));
                write_part(&mut text, part, place, &mut first);
            }
        }
    }
    text
}

/// OBJ counts vertices and normals through the whole file, from 1.
struct FirstIndices {
    position: u32,
    normal: u32,
}

fn write_part(text: &mut String, part: &Part, place: &Placement, first: &mut FirstIndices) {
    for &p in &part.positions {
        write_vector(text, "v", place.point(p));
    }
    for &n in &part.normals {
        write_vector(text, "vn", place.normal(n));
    }
    for face in &part.faces {
        text.push('f');
        for corner in face {
            push(text, format_args!(" {}", corner + first.position));
            if !part.normals.is_empty() {
                push(text, format_args!("//{}", corner + first.normal));
            }
        }
        text.push('\n');
    }
    first.position += part.positions.len() as u32;
    first.normal += part.normals.len() as u32;
}

fn write_vector(text: &mut String, key: &str, v: DVec3) {
    let [x, y, z] = v.to_array().map(decimal);
    push(text, format_args!("{key} {x} {y} {z}\n"));
}

/// Writing to a string cannot fail.
fn push(text: &mut String, arguments: std::fmt::Arguments) {
    let written = text.write_fmt(arguments);
    debug_assert!(written.is_ok());
}

/// Four decimals (a tenth of a millimetre), without the zeros at the end: sines and cosines, which
/// may differ in their last bits from system to system, give the same text everywhere.
pub fn decimal(v: f64) -> String {
    let text = format!("{v:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

/// The MTL text of the materials of `model`.
pub fn write_mtl(model: &Model, comment: &str) -> String {
    let mut text = format!("# {comment}\n");
    for material in &model.materials {
        write_material(&mut text, material);
    }
    text
}

fn write_material(text: &mut String, material: &Material) {
    let color = material.color.map(decimal).join(" ");
    push(text, format_args!("\nnewmtl {}\n", material.name));
    match material.finish {
        Finish::Matte => push(text, format_args!("Kd {color}\nillum 1\n")),
        Finish::Glossy(roughness) => {
            // The exponent whose lobe is as wide as a microfacet lobe of that roughness.
            let exponent = decimal(2.0 / roughness.powi(4) - 2.0);
            push(
                text,
                format_args!("Kd {color}\nKs 0.04 0.04 0.04\nNs {exponent}\nillum 2\n"),
            );
        }
        Finish::Glass(index) => {
            let index = decimal(index);
            push(
                text,
                format_args!(
                    "Kd 0 0 0\nKs 0.04 0.04 0.04\nNs 1000\nTf {color}\nNi {index}\nillum 7\n"
                ),
            );
        }
        // A metal without roughness: `illum 3` would add a glossy lobe to the mirror.
        Finish::Mirror => push(text, format_args!("Kd {color}\nPm 1\nPr 0\n")),
    }
}
