//! Every mistake is an error that says where it is and what would be right.

use std::error::Error;
use std::fs;
use std::path::Path;

use halfshade::import::SceneOptions;
use proptest::prelude::*;

use crate::files::{Files, scene};

/// What is wrong, the line that must be named, and words that must be in the message.
const MISTAKES: &[(&str, usize, &[&str])] = &[
    // Keys.
    (
        "[camera]\n\n[fillm]\n",
        3,
        &["\"fillm\"", "did you mean \"film\"?"],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\nintensity = [1, 1, 1]\nraduis = 1\n",
        5,
        &[
            "unknown key \"raduis\" in [[light]]",
            "did you mean \"radius\"?",
        ],
    ),
    (
        "[[light]]\nkind = \"point\"\npostion = [0, 0, 0]\n",
        3,
        &["\"postion\"", "\"position\""],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\nintensity = [1, 1, 1]\nvisible = true\n",
        5,
        &[
            "unknown key \"visible\"",
            "point",
            "known: kind, name, position",
        ],
    ),
    ("[film]\nwidth = 3\n", 2, &["\"width\"", "known: size"]),
    (
        "[sampling]\nsample = 3\n",
        2,
        &["did you mean \"samples\"?"],
    ),
    (
        "[integrator]\ndepth = 3\n",
        2,
        &["\"depth\"", "kind, max_depth, clamp, shadow_terminator"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nrotation = [0, 0, 0]\n",
        3,
        &["did you mean \"rotate\"?"],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1,1,1]\nfalloff = { constnt = 1 }\n",
        5,
        &["unknown key \"constnt\" in falloff", "\"constant\""],
    ),
    // Syntax.
    ("[film]\nsize = [1280, 720\n\n[camera]\n", 4, &[]),
    ("[film]\n\nsize = = 3\n", 3, &[]),
    ("[film]\n[film]\n", 2, &["duplicate"]),
    // Shapes.
    ("\nfilm = 3\n", 2, &["[film] must be a table, not 3"]),
    ("[model]\nfile = \"a.obj\"\n", 1, &["write [[model]]"]),
    (
        "[[camera]]\nname = \"a\"\n",
        1,
        &["[camera] must be a table"],
    ),
    ("light = [1]\n", 1, &["[[light]] must be a table, not 1"]),
    // Types and ranges.
    (
        "[film]\nsize = \"large\"\n",
        2,
        &["size must be [width, height], not \"large\""],
    ),
    ("[film]\nsize = [0, 720]\n", 2, &["from 1 to 65536, not 0"]),
    ("[film]\nsize = [100000, 720]\n", 2, &["not 100000"]),
    (
        "[film]\nsize = [65536, 65536]\n",
        2,
        &["at most 268435456 pixels"],
    ),
    ("[film]\nsize = [1280.0, 720]\n", 2, &["whole number"]),
    ("[film]\nsize = [1, 2, 3]\n", 2, &["not a list of 3"]),
    (
        "[sampling]\nsamples = 0\n",
        2,
        &["samples must be a whole number from 1"],
    ),
    ("[sampling]\nseed = -1\n", 2, &["seed must be"]),
    (
        "[sampling]\npattern = \"jitered\"\n",
        2,
        &["unknown pattern \"jitered\"", "\"jittered\""],
    ),
    ("[sampling]\ntarget = 3\n", 2, &["target must be text"]),
    (
        "[integrator]\nkind = \"whited\"\n",
        2,
        &["did you mean \"whitted\"?"],
    ),
    (
        "[integrator]\nkind = \"pat\"\n",
        2,
        &["did you mean \"path\"?"],
    ),
    (
        "[integrator]\nclamp = 0\n",
        2,
        &["clamp must be a number above 0"],
    ),
    ("[integrator]\nmax_depth = 0\n", 2, &["max_depth must be"]),
    (
        "[background]\nenvironment = 3\n",
        2,
        &["environment must be text"],
    ),
    (
        "[background]\nrotate = 90\n",
        2,
        &["\"rotate\" needs \"environment\""],
    ),
    (
        "[background]\nradiance = [-1, 0, 0]\n",
        2,
        &["at least 0, not -1"],
    ),
    ("[background]\nradiance = \"#12345\"\n", 2, &["\"#rrggbb\""]),
    (
        "[background]\nradiance = \"#12g456\"\n",
        2,
        &["\"#rrggbb\""],
    ),
    ("[background]\nradiance = \"#12é45\"\n", 2, &["\"#rrggbb\""]),
    ("[background]\nradiance = 1979-05-27\n", 2, &["not a date"]),
    // Cameras.
    (
        "[camera]\nposition = [0, nan, 0]\nlook_at = [0, 0, 1]\n",
        2,
        &["finite"],
    ),
    (
        "[camera]\nposition = [0, inf, 0]\nlook_at = [0, 0, 1]\n",
        2,
        &["finite"],
    ),
    (
        "[camera]\nposition = [0, 1, 0]\n",
        1,
        &["[camera] needs \"look_at\""],
    ),
    (
        "[camera]\nposition = [1, 1, 1]\nlook_at = [1, 1, 1]\n",
        1,
        &["the same point"],
    ),
    (
        "[camera]\nposition = [1, 1, 1]\nlook_at = [0, 0, 0]\nup = [0, 0, 0]\n",
        4,
        &["up", "not be zero"],
    ),
    (
        "[camera]\nlook_at = [1, 1, 1]\n",
        2,
        &["needs \"position\""],
    ),
    (
        "[camera]\nname = \"a\"\nposition = [1, 1, 1]\nlook_at = [0, 0, 0]\n",
        2,
        &["only one of them"],
    ),
    ("[camera]\nvertical_fov = 0\n", 2, &["between 0 and 180"]),
    ("[camera]\nvertical_fov = 180\n", 2, &["between 0 and 180"]),
    (
        "[camera]\nvertical_fov = 179.9999999999\n",
        2,
        &["between 0 and 180"],
    ),
    ("[camera]\nlens_radius = -0.1\n", 2, &["at least 0"]),
    ("[camera]\nfocus_distance = 0\n", 2, &["above 0"]),
    ("[camera]\nname = 3\n", 2, &["name must be text"]),
    ("[camera]\nname = \"a\"\n", 2, &["no camera is named \"a\""]),
    // Models.
    ("[[model]]\n", 1, &["[[model]] needs \"file\""]),
    (
        "[[model]]\nfile = \"no.obj\"\n",
        2,
        &["there is no file \"no.obj\""],
    ),
    (
        "[[model]]\n\nfile = \"scene.toml\"\n",
        3,
        &["\"scene.toml\" is not a model", ".gltf, .glb or .obj"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nscale = 0\n",
        3,
        &["scale", "other than 0"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nscale = [1, 0, 1]\n",
        3,
        &["scale", "other than 0"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nscale = [1, 1]\n",
        3,
        &["scale", "a list of 2"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nmatrix = [1, 2]\n",
        3,
        &["16 numbers"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nmatrix = [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n",
        3,
        &["column-major"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nmatrix = [1,2,3,0, 2,4,6,0, 0,0,1,0, 0,0,0,1]\n",
        3,
        &["flat"],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nscale = 2\nmatrix = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n",
        3,
        &["\"scale\" and \"matrix\""],
    ),
    (
        "[[material]]\nname = \"brass\"\nkind = \"phong\"\n[[model]]\nfile = \"triangle.obj\"\nmaterial = \"bras\"\n",
        6,
        &[
            "no [[material]] is named \"bras\"",
            "did you mean \"brass\"?",
        ],
    ),
    (
        "[[model]]\nfile = \"triangle.obj\"\nlights = 0\n",
        3,
        &["lights must be true or false"],
    ),
    // Materials.
    ("[[material]]\nkind = \"phong\"\n", 1, &["needs \"name\""]),
    ("[[material]]\nname = \"a\"\n", 1, &["needs \"kind\""]),
    (
        "[[material]]\nname = \"a\"\nkind = \"pong\"\n",
        3,
        &["did you mean \"phong\"?"],
    ),
    (
        "[[material]]\nname = \"a\"\nkind = \"phong\"\ndiffuse = [1.5, 0, 0]\n",
        4,
        &["from 0 to 1, not 1.5"],
    ),
    (
        "[[material]]\nname = \"a\"\nkind = \"phong\"\nroughness = 1\n",
        4,
        &["unknown key \"roughness\"", "phong"],
    ),
    (
        "[[material]]\nname = \"a\"\nkind = \"gltf\"\nmetallic = 2\n",
        4,
        &["metallic must be"],
    ),
    (
        "[[material]]\nname = \"a\"\nkind = \"phong\"\nindex_of_refraction = 0\n",
        4,
        &["above 0"],
    ),
    (
        "[[material]]\nname = \"a\"\nkind = \"phong\"\nexponent = -1\n",
        4,
        &["at least 0"],
    ),
    (
        "[[material]]\nname = \"a\"\nkind = \"phong\"\n[[material]]\nname = \"a\"\nkind = \"gltf\"\n",
        4,
        &["two materials named \"a\""],
    ),
    // Lights.
    (
        "[[light]]\nposition = [0, 0, 0]\n",
        1,
        &["needs \"kind\"", "rectangle"],
    ),
    (
        "[[light]]\nkind = \"dsik\"\n",
        2,
        &["did you mean \"disk\"?"],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\n",
        1,
        &["needs \"intensity\""],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1,1,1]\nradius = -1\n",
        5,
        &["radius", "not -1"],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1e39,1,1]\n",
        4,
        &["below 3.4e38"],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1,1,1]\nsamples = 0\n",
        5,
        &["samples"],
    ),
    (
        "[[light]]\nkind = \"point\"\nposition = [0,0,0]\nintensity = [1,1,1]\nfalloff = {}\n",
        5,
        &["must be above 0"],
    ),
    (
        "[[light]]\nkind = \"spot\"\nposition = [0,0,0]\ndirection = [0,0,0]\nintensity = [1,1,1]\n",
        4,
        &["direction", "not be zero"],
    ),
    (
        "[[light]]\nkind = \"spot\"\nposition = [0,0,0]\ndirection = [0,1,0]\nintensity = [1,1,1]\ninner_angle = 40\nouter_angle = 30\n",
        1,
        &["inner_angle, 40.0, must not be above outer_angle, 30.0"],
    ),
    (
        "[[light]]\nkind = \"distant\"\ndirection = [0,1,0]\nirradiance = [1,1,1]\nangle = 180\n",
        5,
        &["angle"],
    ),
    (
        "[[light]]\nkind = \"disk\"\nposition = [0,0,0]\nnormal = [0,1,0]\nradiance = [1,1,1]\nradius = 0\n",
        6,
        &["radius must be a number above 0, not 0"],
    ),
    (
        "[[light]]\nkind = \"rectangle\"\nposition = [0,0,0]\nedge_u = [0,1,0]\nedge_v = [0,2,0]\nradiance = [1,1,1]\n",
        1,
        &["parallel"],
    ),
];

#[test]
fn mistakes_are_named_with_their_line() {
    let files = Files::new();
    let mut wrong = String::new();
    for (text, line, words) in MISTAKES {
        let place = format!("scene.toml, line {line}: ");
        match files.scene(text, &SceneOptions::default()) {
            Ok(_) => wrong += &format!("{text}no error\n\n"),
            Err(error) => {
                let is_right = error.starts_with(&place)
                    && words.iter().all(|word| error.contains(word))
                    && !error.trim().contains('\n');
                if !is_right {
                    wrong += &format!("{text}{error}\nnot {place}… {words:?}\n\n");
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn files_that_are_no_scenes_are_named() {
    let files = Files::new();
    files.write("scene.txt", "");
    fs::create_dir(files.write("x", "").with_file_name("folder.toml")).unwrap();
    files.write("bytes.toml", b"[film]\n\n# \xff\n");
    for (name, words) in [
        ("scene.txt", ".toml, .gltf, .glb or .obj"),
        ("missing.toml", "missing.toml: "),
        ("missing.obj", "missing.obj: "),
        ("folder.toml", "folder.toml: is a directory, not a file"),
        ("bytes.toml", "bytes.toml, line 3: not text in UTF-8"),
    ] {
        let error = files
            .import(name, &SceneOptions::default())
            .expect_err(name);
        assert!(error.starts_with(name) && error.contains(words), "{error}");
    }
}

#[test]
fn keys_too_deep_are_an_error_on_a_line() {
    let deep = format!("a{} = 1\n", ".a".repeat(1_000));
    let error = scene(&deep).unwrap_err();
    assert!(error.starts_with("scene.toml, line 1: "), "{error}");
}

#[test]
#[cfg(unix)]
fn devices_are_not_read() {
    let files = Files::new();
    let link = files.write("x", "").with_file_name("device.toml");
    std::os::unix::fs::symlink("/dev/null", link).unwrap();
    let error = files.import("device.toml", &SceneOptions::default());
    assert_eq!(error.unwrap_err(), "device.toml: is not a regular file");
}

#[test]
fn what_is_in_the_message_is_not_its_source_too() {
    for text in ["[fillm]\n", "[[model]]\nfile = \"broken.gltf\"\n"] {
        let files = Files::new();
        files.write("broken.gltf", "{}");
        let path = files.write("scene.toml", text);
        let error = halfshade::import::import(&path, &SceneOptions::default()).unwrap_err();
        assert!(error.source().is_none(), "{error}: {:?}", error.source());
    }
    let error = halfshade::import::import(Path::new("missing.toml"), &SceneOptions::default());
    let error = error.unwrap_err();
    let source = error.source().map(ToString::to_string);
    assert!(!source.is_some_and(|source| error.to_string().contains(&source)));
}

const EXAMPLE: &str = "[camera]\nposition = [0.0, 1.6, 9.0]\nlook_at = [0.0, 1.5, 0.0]\n\
[film]\nsize = [12, 7]\n[[light]]\nkind = \"point\"\nposition = [4.0, 6.0, 3.0]\n\
intensity = \"#ff8040\"\nfalloff = { constant = 1.0 }\n[[material]]\nname = \"m\"\nkind = \"gltf\"\n";

proptest! {
    /// Any one part of a scene file may be replaced by anything.
    #[test]
    fn damaged_files_do_no_harm(start in 0..EXAMPLE.len(), length in 0..30usize, with in "[\\[\\]{}\"#=.,\n a-z0-9é-]{0,12}") {
        let end = (start + length).min(EXAMPLE.len());
        let text = format!("{}{with}{}", &EXAMPLE[..start], &EXAMPLE[end..]);
        if let Err(error) = scene(&text) {
            prop_assert!(error.starts_with("scene.toml, line "), "{}", error);
        }
    }
}
