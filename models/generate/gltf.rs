//! Writes a model as a binary glTF 2.0 file.

use std::collections::BTreeSet;

use glam::{DMat3, DQuat, DVec3};

use super::buffer::{Buffer, Target};
use super::model::{Camera, Finish, Group, Light, Material, Model, Part, Placement};
use super::obj::decimal;

/// The bytes of `model` as a `.glb` file. Its metadata say `comment`.
pub fn write_glb(model: &Model, comment: &str) -> Vec<u8> {
    let mut extensions = BTreeSet::new();
    let mut buffer = Buffer::default();
    let meshes = list(&model.meshes, |mesh| {
        let primitives = list(&mesh.parts, |part| primitive(part, &mut buffer));
        format!(r#"{{"name":"{}","primitives":{primitives}}}"#, mesh.name)
    });
    let materials = list(&model.materials, |m| material(m, &mut extensions));
    let nodes = nodes(model, &mut buffer, &mut extensions);
    let roots = (0..nodes.len()).map(|i| i.to_string());
    let roots = roots.collect::<Vec<_>>().join(",");
    let cameras = model.camera.as_ref().map_or(String::new(), |c| {
        let fov = decimal(c.vertical_fov);
        format!(
            r#","cameras":[{{"type":"perspective","perspective":{{"yfov":{fov},"znear":0.1}}}}]"#
        )
    });
    let lights = if model.lights.is_empty() {
        String::new()
    } else {
        extensions.insert("KHR_lights_punctual");
        let lights = list(&model.lights, light);
        format!(r#","extensions":{{"KHR_lights_punctual":{{"lights":{lights}}}}}"#)
    };
    let used = if extensions.is_empty() {
        String::new()
    } else {
        let names: Vec<_> = extensions.iter().collect();
        format!(r#","extensionsUsed":{names:?}"#)
    };
    let json = format!(
        r#"{{"asset":{{"version":"2.0","generator":"{comment}"}}{used}{lights},"scene":0,"scenes":[{{"nodes":[{roots}]}}],"nodes":[{}]{cameras},"materials":{materials},"meshes":{meshes},{}}}"#,
        nodes.join(","),
        buffer.json(),
    );
    container(json, buffer.bytes)
}

fn list<T>(items: &[T], write: impl FnMut(&T) -> String) -> String {
    let items = items.iter().map(write).collect::<Vec<_>>();
    format!("[{}]", items.join(","))
}

/// The two chunks of a `.glb` file, each padded to 4 bytes.
fn container(json: String, mut binary: Vec<u8>) -> Vec<u8> {
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let total = 12 + 8 + json.len() + 8 + binary.len();
    let mut bytes = Vec::with_capacity(total);
    bytes.extend(b"glTF");
    bytes.extend(2u32.to_le_bytes());
    bytes.extend((total as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

fn primitive(part: &Part, buffer: &mut Buffer) -> String {
    let position = buffer.vectors(&part.positions, Target::Vertices);
    let normal = if part.normals.is_empty() {
        String::new()
    } else {
        let normal = buffer.vectors(&part.normals, Target::Vertices);
        format!(r#","NORMAL":{normal}"#)
    };
    let indices = buffer.indices(part.triangles(), part.positions.len());
    let material = part.material;
    format!(
        r#"{{"attributes":{{"POSITION":{position}{normal}}},"indices":{indices},"material":{material}}}"#
    )
}

fn material(material: &Material, extensions: &mut BTreeSet<&str>) -> String {
    let Material {
        name,
        color,
        finish,
    } = material;
    let color = color.map(decimal).join(",");
    let (metallic, roughness) = match *finish {
        Finish::Matte => (0, 1.0),
        Finish::Glossy(roughness) => (0, roughness),
        Finish::Glass(_) => (0, 0.0),
        Finish::Mirror => (1, 0.0),
    };
    let roughness = decimal(roughness);
    let extension = match *finish {
        Finish::Matte => {
            // Else every dielectric shines a little.
            extensions.insert("KHR_materials_specular");
            r#","extensions":{"KHR_materials_specular":{"specularFactor":0}}"#.into()
        }
        Finish::Glass(index) => {
            extensions.extend(["KHR_materials_ior", "KHR_materials_transmission"]);
            let index = decimal(index);
            format!(
                r#","extensions":{{"KHR_materials_ior":{{"ior":{index}}},"KHR_materials_transmission":{{"transmissionFactor":1}}}}"#
            )
        }
        Finish::Glossy(_) | Finish::Mirror => String::new(),
    };
    format!(
        r#"{{"name":"{name}","doubleSided":true,"pbrMetallicRoughness":{{"baseColorFactor":[{color},1],"metallicFactor":{metallic},"roughnessFactor":{roughness}}}{extension}}}"#
    )
}

fn nodes(model: &Model, buffer: &mut Buffer, extensions: &mut BTreeSet<&str>) -> Vec<String> {
    let mut nodes = Vec::new();
    for group in &model.groups {
        let name = &model.meshes[group.mesh].name;
        let mesh = group.mesh;
        if group.is_crowd {
            extensions.insert("EXT_mesh_gpu_instancing");
            let crowd = crowd(group, buffer);
            nodes.push(format!(r#"{{"name":"{name}","mesh":{mesh}{crowd}}}"#));
            continue;
        }
        for place in &group.places {
            let place = placement(place);
            nodes.push(format!(r#"{{"name":"{name}","mesh":{mesh}{place}}}"#));
        }
    }
    for (i, light) in model.lights.iter().enumerate() {
        nodes.push(light_node(i, light));
    }
    nodes.extend(model.camera.as_ref().map(camera_node));
    nodes
}

fn crowd(group: &Group, buffer: &mut Buffer) -> String {
    let vectors = |f: fn(&Placement) -> DVec3| group.places.iter().map(f).collect::<Vec<_>>();
    let translation = buffer.vectors(&vectors(|p| p.translation), Target::None);
    let scale = buffer.vectors(&vectors(|p| p.scale), Target::None);
    let rotation = buffer.rotations(group.places.iter().map(|p| p.rotation));
    format!(
        r#","extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":{translation},"ROTATION":{rotation},"SCALE":{scale}}}}}}}"#
    )
}

fn placement(place: &Placement) -> String {
    let mut text = String::new();
    if place.translation != DVec3::ZERO {
        text += &array("translation", &place.translation.to_array());
    }
    if place.rotation != DQuat::IDENTITY {
        text += &array("rotation", &place.rotation.to_array());
    }
    if place.scale != DVec3::ONE {
        text += &array("scale", &place.scale.to_array());
    }
    text
}

fn array(key: &str, values: &[f64]) -> String {
    let values = values.iter().map(|&v| decimal(v)).collect::<Vec<_>>();
    format!(r#","{key}":[{}]"#, values.join(","))
}

fn light(light: &Light) -> String {
    let (name, kind, color, strength) = match light {
        Light::Point {
            name,
            color,
            intensity,
            ..
        } => (name, "point", color, intensity),
        Light::Directional {
            name,
            color,
            irradiance,
            ..
        } => (name, "directional", color, irradiance),
    };
    let color = color.map(decimal).join(",");
    let strength = decimal(*strength);
    format!(r#"{{"name":"{name}","type":"{kind}","color":[{color}],"intensity":{strength}}}"#)
}

fn light_node(index: usize, light: &Light) -> String {
    let (name, place) = match light {
        Light::Point { name, position, .. } => (name, Placement::at(*position)),
        Light::Directional {
            name, direction, ..
        } => (name, looking(DVec3::ZERO, *direction)),
    };
    let place = placement(&place);
    format!(
        r#"{{"name":"{name}"{place},"extensions":{{"KHR_lights_punctual":{{"light":{index}}}}}}}"#
    )
}

fn camera_node(camera: &Camera) -> String {
    let place = placement(&looking(camera.position, camera.look_at - camera.position));
    format!(r#"{{"name":"camera","camera":0{place}}}"#)
}

/// At `position`, with −z along `direction` and y up.
fn looking(position: DVec3, direction: DVec3) -> Placement {
    let back = -direction.normalize();
    let right = DVec3::Y.cross(back).normalize();
    let axes = DMat3::from_cols(right, back.cross(right), back);
    Placement {
        translation: position,
        rotation: DQuat::from_mat3(&axes),
        scale: DVec3::ONE,
    }
}
