//! What is left out of a document that has everything, why, and how many bytes that is.

use std::fs;
use std::path::Path;

use halfshade::integrate::ViewKind;
use halfshade::scene::{Keep, LeftOut, Omission};

use super::document::{self, SIDE};
use super::{Ask, picture};

/// Bytes of an image's pixels.
const IMAGE_BYTES: u64 = (SIDE * SIDE * 4) as u64;

fn left_out(path: &Path, integrator: &str, layers: &[ViewKind]) -> Vec<LeftOut> {
    picture(path, &Ask { integrator, layers }, Keep::NOTHING).1
}

/// What was left out of one kind: what, why, bytes.
fn of_kind(left_out: &[LeftOut], kind: Omission) -> Vec<(&str, &str, u64)> {
    let entries = left_out.iter().filter(|entry| entry.kind == kind);
    entries
        .map(|entry| (&*entry.what, &*entry.why, entry.saved_bytes))
        .collect()
}

/// Which of the images of the document were left out.
fn images(left_out: &[LeftOut]) -> Vec<&'static str> {
    let entries = of_kind(left_out, Omission::Images);
    let is_out = |name: &&str| entries.iter().any(|(what, ..)| what.contains(*name));
    document::IMAGES.into_iter().filter(is_out).collect()
}

fn attributes(left_out: &[LeftOut]) -> Vec<&str> {
    let entries = of_kind(left_out, Omission::Attributes);
    entries.iter().map(|(what, ..)| *what).collect()
}

#[test]
fn a_picture_reads_no_image_that_only_hidden_surfaces_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = document::write(folder.path());
    let whitted = left_out(&path, "whitted", &[]);
    // A model by itself gets lights, and with them ambient light, which occlusion dims.
    assert_eq!(images(&whitted), ["hidden", "unnamed", "dark", "broken"]);
    assert_eq!(
        of_kind(&whitted, Omission::Images),
        [
            (
                "2 images: image \"unnamed\", image \"broken\"",
                "no material names them",
                2 * IMAGE_BYTES
            ),
            (
                "1 image: image \"hidden\"",
                "nothing that is shown is made of their materials",
                IMAGE_BYTES
            ),
            (
                "1 image: image \"dark\"",
                "their factors are 0",
                IMAGE_BYTES
            ),
        ]
    );
    // Four corners: positions, normals, tangents, two sets of texture coordinates, colours, and
    // six indices.
    let bytes = 4 * (12 + 12 + 16 + 2 * 8 + 16) + 6 * 4;
    assert_eq!(
        of_kind(&whitted, Omission::Meshes),
        [(
            "1 of 2 meshes",
            "no node of the shown scene uses them",
            bytes
        )]
    );
    assert_eq!(attributes(&whitted), [""; 0]);
}

#[test]
fn paths_read_all_but_what_dims_ambient_light() {
    let folder = tempfile::tempdir().unwrap();
    let path = document::write(folder.path());
    let unread = left_out(&path, "path", &[]);
    assert_eq!(
        images(&unread),
        ["occlusion", "hidden", "unnamed", "dark", "broken"]
    );
    assert_eq!(attributes(&unread), [""; 0]);
}

#[test]
fn views_read_what_they_show() {
    let folder = tempfile::tempdir().unwrap();
    let path = document::write(folder.path());
    let shown = |integrator, layers: &[ViewKind]| {
        let left_out = left_out(&path, integrator, layers);
        let unread = images(&left_out);
        let read = document::IMAGES.into_iter().filter(|n| !unread.contains(n));
        let attributes = attributes(&left_out).join(", ");
        (read.collect::<Vec<_>>().join(" "), attributes)
    };
    let [normals, tangents, uvs, colors] = [
        "normals of 1 mesh",
        "tangents of 1 mesh",
        "texture coordinates of 1 mesh",
        "colours of vertices of 1 mesh",
    ];
    assert_eq!(
        shown("depth", &[]),
        (String::new(), [normals, tangents, uvs, colors].join(", "))
    );
    assert_eq!(shown("normal", &[]), ("normal".into(), colors.into()));
    assert_eq!(
        shown("albedo", &[]),
        // The second set of texture coordinates is the normal map's.
        ("base".into(), [normals, tangents, uvs].join(", "))
    );
    assert_eq!(
        shown("depth", &[ViewKind::Normal, ViewKind::Albedo]),
        ("base normal".into(), String::new())
    );
}

#[test]
fn without_ambient_light_nothing_is_occluded() {
    let folder = tempfile::tempdir().unwrap();
    document::write(folder.path());
    let path = folder.path().join("scene.toml");
    let text = "[[model]]\nfile = \"everything.gltf\"\n[[light]]\nkind = \"point\"\n\
                position = [0, 0, 2]\nintensity = [9, 9, 9]\n[[light]]\nkind = \"point\"\n\
                position = [0, 1, 2]\nintensity = [0, 0, 0]\nradius = 0.5\n";
    fs::write(&path, text).unwrap();
    let dark = left_out(&path, "whitted", &[]);
    assert!(images(&dark).contains(&"occlusion"));
    assert_eq!(
        of_kind(&dark, Omission::Lights),
        [("samples of 1 of 2 lights", "they give no light", 0)]
    );
    fs::write(&path, format!("background.ambient = [0.1, 0, 0]\n{text}")).unwrap();
    assert!(!images(&left_out(&path, "whitted", &[])).contains(&"occlusion"));
}

#[test]
fn a_material_in_place_of_the_models_leaves_its_images_unread() {
    let folder = tempfile::tempdir().unwrap();
    document::write(folder.path());
    let path = folder.path().join("scene.toml");
    let text = "[[model]]\nfile = \"everything.gltf\"\nmaterial = \"brass\"\n\
                [[material]]\nname = \"brass\"\nkind = \"gltf\"\n";
    fs::write(&path, text).unwrap();
    let left_out = left_out(&path, "whitted", &[]);
    assert_eq!(images(&left_out), document::IMAGES);
    assert_eq!(
        attributes(&left_out),
        ["tangents of 1 mesh", "texture coordinates of 1 mesh"]
    );
}

#[test]
fn the_picture_of_everything_stays_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = document::write(folder.path());
    super::equality::assert_same(&path);
}
