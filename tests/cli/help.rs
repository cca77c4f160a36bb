//! What `-h` says is so.

use std::fs;
use std::path::Path;

use halfshade::scene::{IntegratorKind, Settings};

use super::{OBJ, folder, render, run, stderr, stdout};

#[test]
fn help_explains_with_an_example() {
    let folder = folder();
    for (arguments, expected) in [
        (&["-h"][..], "render"),
        (&["render", "-h"], "--light-samples"),
        (&["info", "-h"], "--json"),
        (&["compare", "-h"], "--fail-above"),
        (&["converge", "-h"], "--against"),
    ] {
        for help in ["-h", "--help"] {
            let arguments = [&arguments[..arguments.len() - 1], &[help]].concat();
            let output = run(folder.path(), &arguments);
            let text = stdout(&output);
            assert_eq!(output.status.code(), Some(0));
            assert!(text.contains("Example"), "{text}");
            assert!(text.contains(expected), "{text}");
        }
    }
    let version = run(folder.path(), &["--version"]);
    assert_eq!(
        stdout(&version).trim(),
        concat!("halfshade ", env!("CARGO_PKG_VERSION"))
    );
}

/// The commands that `-h` shows, without the remarks behind them.
fn examples(folder: &Path) -> Vec<Vec<String>> {
    let mut examples = Vec::new();
    for command in [
        &["-h"][..],
        &["render", "-h"],
        &["info", "-h"],
        &["compare", "-h"],
    ] {
        let output = run(folder, command);
        let lines = stdout(&output).lines();
        let commands = lines.filter_map(|line| line.trim().strip_prefix("halfshade "));
        examples.extend(commands.map(|line| {
            let command = line.split("   ").next().unwrap_or(line);
            command.split(' ').map(str::to_owned).collect()
        }));
    }
    examples
}

/// The same picture in little time.
fn made_small(example: &[String]) -> Vec<&str> {
    let mut arguments = Vec::new();
    let mut words = example.iter().map(String::as_str);
    while let Some(word) = words.next() {
        if matches!(word, "--size" | "--samples") {
            words.next();
        } else if word == "--frames" {
            words.next();
            arguments.extend([word, "0..1"]);
        } else {
            arguments.push(word);
        }
    }
    if example[0] == "render" {
        // The crop of an example has to fit.
        arguments.extend(["--size", "200x150", "--samples", "1"]);
    }
    arguments
}

#[test]
fn the_examples_of_the_help_work() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("bunny.obj"), OBJ).unwrap();
    for file in ["scenes/house.toml", "models/house.glb"] {
        let copy = path.join(file);
        fs::create_dir_all(copy.parent().unwrap()).unwrap();
        fs::copy(Path::new(env!("CARGO_MANIFEST_DIR")).join(file), copy).unwrap();
    }
    fs::copy(path.join("models/house.glb"), path.join("walk.glb")).unwrap();
    // Equal pictures are within every limit.
    for name in ["quick", "reference"] {
        for extension in ["png", "exr"] {
            let file = format!("{name}.{extension}");
            let output = render(path, &["-o", &file]);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        }
    }
    let examples = examples(path);
    assert!(examples.len() >= 9, "{examples:?}");
    for example in &examples {
        let output = run(path, &made_small(example));
        assert_eq!(
            output.status.code(),
            Some(0),
            "{example:?}: {}",
            stderr(&output)
        );
    }
    for picture in [
        "house.png",
        "bunny.png",
        "bunny.exr",
        "part.exr",
        "walk.0001.png",
        "difference.png",
        "difference.html",
    ] {
        assert!(path.join(picture).is_file(), "{picture}");
    }
}

#[test]
fn the_help_knows_the_defaults() {
    let folder = folder();
    let output = run(folder.path(), &["render", "-h"]);
    // However the lines are wrapped.
    let text: Vec<&str> = stdout(&output).split_whitespace().collect();
    let text = text.join(" ");
    let settings = Settings::default();
    let sampling = settings.sampling;
    for (option, default) in [
        ("--size", format!("{}x{}", settings.size.x, settings.size.y)),
        (
            "--integrator",
            "path for a glTF file by itself, or whitted".to_owned(),
        ),
        (
            "--max-depth",
            format!(
                "{} in path and {} in whitted",
                IntegratorKind::Path.depth(),
                IntegratorKind::Whitted.depth()
            ),
        ),
        ("--samples", sampling.samples.to_string()),
        ("--pattern", sampling.pattern.name().to_owned()),
        ("--target", sampling.target.name().to_owned()),
        ("--seed", sampling.seed.to_string()),
    ] {
        let (_, after) = text.split_once(&format!(" {option} <")).unwrap();
        let about = after.split(" --").next().unwrap();
        let expected = format!("[default: the scene's, or {default}]");
        assert!(about.contains(&expected), "{option}: {about}");
    }
}
