//! Models in a scene file: placing, sharing, and their lights and cameras.

use halfshade::camera::Projection;
use halfshade::color::Rgb;
use halfshade::import::{Imported, SceneOptions};
use halfshade::light::Light;
use halfshade::material::Surface;
use halfshade::math::{DVec3, Vec2, Vec3};

use crate::files::{Files, looking_through, scene};

/// The corner of the triangle that its file puts at `p`, in the world.
fn corner(imported: &Imported, instance: usize, p: DVec3) -> DVec3 {
    let placed = &imported.scene.instances[instance];
    let mesh = imported.scene.mesh(placed.mesh);
    // Importers may move a mesh and say so in its transform: go by the vertex's place in the file.
    let vertex = [DVec3::ZERO, DVec3::X, DVec3::Y]
        .iter()
        .position(|&v| v == p)
        .unwrap();
    let index = mesh.indices()[0][vertex] as usize;
    placed
        .transform
        .transform_point3(mesh.positions()[index].as_dvec3())
}

fn triangle(placement: &str) -> Imported {
    scene(&format!(
        "[[model]]\nfile = \"triangle.obj\"\n{placement}\n"
    ))
    .unwrap()
}

#[test]
fn scale_comes_first_then_rotation_then_translation() {
    let imported = triangle("scale = [2, 3, 4]\nrotate = [0, 90, 0]\ntranslate = [10, 20, 30]");
    assert_eq!(corner(&imported, 0, DVec3::X), DVec3::new(10.0, 20.0, 28.0));
    assert_eq!(corner(&imported, 0, DVec3::Y), DVec3::new(10.0, 23.0, 30.0));
}

#[test]
fn rotation_is_about_x_then_y_then_z() {
    let imported = triangle("rotate = [90, 90, 0]");
    // y turns to z about x, and z to x about y.
    assert_eq!(corner(&imported, 0, DVec3::Y), DVec3::X);
    let imported = triangle("rotate = [0, 90, 90]");
    // x turns to -z about y, and z is the axis of the last turn.
    assert_eq!(corner(&imported, 0, DVec3::X), DVec3::NEG_Z);
    let imported = triangle("rotate = [0, 0, -30]");
    let expected = DVec3::new(0.75f64.sqrt(), -0.5, 0.0);
    assert!((corner(&imported, 0, DVec3::X) - expected).length() < 1e-15);
}

#[test]
fn a_matrix_is_column_major() {
    let imported = triangle("matrix = [0,0,-2,0, 0,3,0,0, 4,0,0,0, 10,20,30,1]");
    assert_eq!(corner(&imported, 0, DVec3::X), DVec3::new(10.0, 20.0, 28.0));
    assert_eq!(
        corner(&imported, 0, DVec3::ZERO),
        DVec3::new(10.0, 20.0, 30.0)
    );
}

#[test]
fn placement_is_in_double_precision() {
    let imported = triangle("translate = [123456789.125, 0, 0]");
    assert_eq!(corner(&imported, 0, DVec3::X).x, 123_456_790.125);
}

#[test]
fn a_file_that_is_named_twice_is_imported_once() {
    let imported = scene(
        "[[model]]\nfile = \"triangle.obj\"\n\
         [[model]]\nfile = \"./triangle.obj\"\ntranslate = [5, 0, 0]\n\
         [[model]]\nfile = \"triangle.obj\"\nscale = -1\n",
    )
    .unwrap();
    assert_eq!(imported.scene.meshes.len(), 1);
    assert_eq!(imported.scene.instances.len(), 3);
    assert_eq!(imported.scene.triangle_count(), 3);
    let bounds = imported.scene.bounds().unwrap();
    assert_eq!(
        bounds,
        (DVec3::new(-1.0, -1.0, 0.0), DVec3::new(6.0, 1.0, 0.0))
    );
}

#[test]
fn each_file_keeps_its_own_materials_and_textures() {
    let files = Files::new();
    for (name, color) in [("red", [255u8, 0, 0]), ("blue", [0, 0, 255])] {
        let path = files.write(&format!("{name}.png"), "");
        image::RgbImage::from_pixel(1, 1, image::Rgb(color))
            .save(path)
            .unwrap();
        files.write(
            &format!("{name}.mtl"),
            format!("newmtl {name}\nmap_Kd {name}.png\n"),
        );
        let obj = format!(
            "mtllib {name}.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl {name}\nf 1/1 2/1 3/1\n"
        );
        files.write(&format!("{name}.obj"), obj);
    }
    let text = "[[material]]\nname = \"own\"\nkind = \"phong\"\n\
                [[model]]\nfile = \"red.obj\"\n[[model]]\nfile = \"blue.obj\"\n";
    let imported = files.scene(text, &SceneOptions::default()).unwrap();
    let scene = &imported.scene;
    for (instance, name) in scene.instances.iter().zip(["red", "blue"]) {
        let material = &scene.materials[instance.material.0 as usize];
        assert_eq!(material.name, name);
        let Surface::Phong(phong) = &material.surface else {
            panic!("{material:?}")
        };
        let texture = phong.diffuse.texture.unwrap().texture;
        let image = scene.textures[texture.0 as usize].image;
        let image = &scene.images[image.0 as usize];
        assert!(image.name.contains(name), "{} is not {name}", image.name);
    }
}

#[test]
fn a_material_of_the_scene_file_replaces_those_of_one_model() {
    let imported = scene(
        "[[material]]\nname = \"steel\"\nkind = \"phong\"\n[[material]]\nname = \"brass\"\nkind = \"phong\"\n\
         [[model]]\nfile = \"triangle.obj\"\nmaterial = \"brass\"\n[[model]]\nfile = \"triangle.obj\"\n",
    )
    .unwrap();
    let names: Vec<_> = imported
        .scene
        .instances
        .iter()
        .map(|i| {
            imported.scene.materials[i.material.0 as usize]
                .name
                .as_str()
        })
        .collect();
    assert_eq!(names[0], "brass");
    assert!(names[1] != "brass" && names[1] != "steel", "{names:?}");
}

const STUDIO: &str = "[[model]]\nfile = \"studio.gltf\"\n";

#[test]
fn lights_and_cameras_of_a_model_are_used() {
    for imported in [
        scene(STUDIO).unwrap(),
        Files::new()
            .import("studio.gltf", &SceneOptions::default())
            .unwrap(),
    ] {
        assert_eq!(imported.scene.lights.len(), 1);
        assert_eq!(imported.scene.cameras.len(), 2);
        assert_eq!(imported.scene.cameras[0].name, "front");
        assert!(imported.defaults.is_none());
    }
}

#[test]
fn lights_of_the_scene_file_replace_those_of_models() {
    let lamp = "[[light]]\nkind = \"distant\"\ndirection = [0, -1, 0]\nirradiance = [1, 1, 1]\n";
    let imported = scene(&format!("{STUDIO}{lamp}")).unwrap();
    assert!(matches!(imported.scene.lights[0].item, Light::Distant(_)));
    assert_eq!(imported.scene.lights.len(), 1);
    let dark = scene(&format!("light = []\n{STUDIO}")).unwrap();
    assert!(dark.scene.lights.is_empty());
}

#[test]
fn lights_of_a_model_can_be_left_out() {
    let imported = scene(&format!("{STUDIO}lights = false\n{STUDIO}")).unwrap();
    assert_eq!(imported.scene.lights.len(), 1);
    let imported = scene(&format!("{STUDIO}lights = false\n")).unwrap();
    assert_eq!(imported.defaults.expect("defaults").lights, 3);
}

#[test]
fn a_camera_of_the_scene_file_goes_first() {
    let view = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n";
    let imported = scene(&format!("{view}{STUDIO}")).unwrap();
    assert_eq!(imported.scene.cameras[0].origin, 9.0 * DVec3::Z);
    assert_eq!(imported.scene.cameras.len(), 3);
}

#[test]
fn a_camera_is_picked_by_name() {
    let picked = "[camera]\nname = \"flat\"\n";
    let view = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n";
    let files = Files::new();
    let first = |text: &str, options: &SceneOptions| {
        let imported = files.scene(&format!("{text}{STUDIO}"), options).unwrap();
        imported.scene.cameras[0].name.clone()
    };
    assert_eq!(first(picked, &SceneOptions::default()), "flat");
    assert_eq!(first(picked, &looking_through("front")), "front");
    assert_eq!(first(view, &looking_through("flat")), "flat");
    let bare = files
        .import("studio.gltf", &looking_through("flat"))
        .unwrap();
    assert_eq!(bare.scene.cameras[0].name, "flat");
    let error = files.import("studio.gltf", &looking_through("frnot"));
    let error = error.expect_err("no such camera");
    for words in [
        "no camera is named \"frnot\"",
        "did you mean \"front\"?",
        "front, flat",
    ] {
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn a_camera_of_a_model_can_be_given_a_lens_and_an_angle() {
    let lens = "[camera]\nlens_radius = 0.5\nfocus_distance = 3\nvertical_fov = 90\n";
    let imported = scene(&format!("{lens}{STUDIO}")).unwrap();
    let camera = &imported.scene.cameras[0];
    assert_eq!(
        (
            camera.name.as_str(),
            camera.item.lens_radius,
            camera.item.focus_distance
        ),
        ("front", 0.5, 3.0)
    );
    let vertical_fov_radians = std::f32::consts::FRAC_PI_2;
    assert_eq!(
        camera.item.projection,
        Projection::Perspective {
            vertical_fov_radians
        }
    );
    for (text, words) in [
        (
            "[camera]\nlens_radius = 0.5\n",
            "line 2: \"lens_radius\" needs \"focus_distance\"",
        ),
        (
            "[camera]\nname = \"flat\"\nvertical_fov = 30\n",
            "line 3: an orthographic camera",
        ),
    ] {
        let error = scene(&format!("{text}{STUDIO}")).expect_err(text);
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn lights_and_cameras_are_placed_with_their_model() {
    let placed = format!("{STUDIO}scale = 2\nrotate = [0, 90, 0]\ntranslate = [100, 0, 0]\n");
    let imported = scene(&placed).unwrap();
    // (1, 2, 3) doubled is (2, 4, 6); a quarter turn about y makes it (6, 4, -2).
    assert_eq!(
        imported.scene.lights[0].origin,
        DVec3::new(106.0, 4.0, -2.0)
    );
    // At twice the distance the placed light is as bright as the light was: the model looks as before.
    let lit = |imported: &Imported, offset: Vec3| {
        let sample = imported.scene.lights[0]
            .item
            .sample(offset, Vec2::splat(0.5));
        sample.expect("some light").weight
    };
    let original = scene(STUDIO).unwrap();
    assert_eq!(lit(&original, 4.0 * Vec3::Y), Rgb::new(0.5, 0.25, 0.125));
    assert_eq!(lit(&imported, 8.0 * Vec3::Y), Rgb::new(0.5, 0.25, 0.125));
    let front = &imported.scene.cameras[0];
    assert_eq!(front.origin, DVec3::new(108.0, 0.0, 0.0));
    assert!((front.item.back.get() - Vec3::X).length() < 1e-6);
    assert!((front.item.up.get() - Vec3::Y).length() < 1e-6);
    let flat = imported.scene.cameras[1].item.projection;
    assert_eq!(flat, Projection::Orthographic { half_height: 4.0 });
}

#[test]
fn a_mirrored_model_keeps_its_cameras_right_handed() {
    let imported = scene(&format!("{STUDIO}scale = [-1, 1, 1]\n")).unwrap();
    let camera = imported.scene.cameras[0].item;
    let handedness = camera.right.cross(*camera.up).dot(*camera.back);
    assert!((handedness - 1.0).abs() < 1e-6, "{handedness}");
}

#[test]
fn a_light_that_is_scaled_unevenly_is_warned_about() {
    let imported = scene(&format!("{STUDIO}scale = [1, 2, 1]\n")).unwrap();
    assert_eq!(imported.warnings.iter().count(), 1);
    assert!(
        scene(&format!("{STUDIO}scale = [2, -2, 2]\n"))
            .unwrap()
            .warnings
            .is_empty()
    );
}
