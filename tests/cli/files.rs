//! No file is lost, and no memory asked for that is not there.

use std::fs;

use super::{OBJ, folder, names, render, run, stderr};

#[test]
fn outputs_that_would_replace_one_another_or_the_scene_are_refused() {
    let folder = folder();
    let path = folder.path();
    fs::create_dir(path.join("sub")).unwrap();
    let scene = "[[model]]\nfile = \"scene.obj\"\n";
    fs::write(path.join("json.toml"), scene).unwrap();
    // A scene whose name could be that of an output.
    fs::write(path.join("model.png"), OBJ).unwrap();
    let before = names(path);
    for (arguments, expected) in [
        (&["scene.obj", "--stats", "scene.obj"][..], ".json"),
        (&["scene.obj", "--stats", "x.png", "-o", "x.png"], ".json"),
        (&["scene.obj", "--stats", "x"], ".json"),
        (&["scene.obj", "-o", "a.png", "-o", "./a.png"], "twice"),
        (&["scene.obj", "-o", "a.exr", "-o", "sub/../a.exr"], "twice"),
        (&["model.png"], "is the scene"),
        (&["./model.png", "-o", "sub/../model.png"], "is the scene"),
    ] {
        let output = run(path, &[&["render"], arguments].concat());
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
    }
    assert_eq!(names(path), before);
    assert_eq!(fs::read_to_string(path.join("scene.obj")).unwrap(), OBJ);
    assert_eq!(fs::read_to_string(path.join("model.png")).unwrap(), OBJ);
    // Files of the same name in two folders are two.
    let output = render(path, &["-o", "a.png", "-o", "sub/a.png"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[cfg(target_os = "linux")]
#[test]
fn a_picture_that_memory_does_not_hold_is_refused() {
    let folder = folder();
    let limited = |size: &str| {
        let command = format!(
            "ulimit -v 4000000; exec {} render scene.obj -o a.exr --samples 1 --threads 2 --size {size}",
            env!("CARGO_BIN_EXE_halfshade")
        );
        std::process::Command::new("sh")
            .args(["-c", &command])
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    let output = limited("16384x16384");
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert_eq!(text.matches("error:").count(), 1, "{text}");
    for part in ["16384x16384", "GiB", "memory"] {
        assert!(text.contains(part), "{text}");
    }
    assert_eq!(names(folder.path()), ["scene.obj"]);
    let output = limited("160x120");
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}
