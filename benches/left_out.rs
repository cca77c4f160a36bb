//! `cargo bench --bench left_out`: what each thing that is left out saves, on a scene where it matters.
//!
//! Every scene goes from its file to a picture, in turns with all left out that can be and with one
//! kind of thing kept. `-- KIND left|kept` does it once, for a profiler to count.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../tests/common/project.rs"]
mod project;

use std::fs;
use std::path::{Path, PathBuf};

use halfshade::bench::{Spread, Stopwatch};
use halfshade::import::{SceneOptions, import};
use halfshade::scene::{Keep, Omission};

const TURNS: usize = 5;

/// A scene file that has much of one kind of thing to leave out.
struct Subject {
    kind: Omission,
    name: &'static str,
    text: String,
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let subjects = subjects(folder.path());
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    if let [kind, keep] = arguments.as_slice() {
        let is_asked =
            |subject: &&Subject| format!("{:?}", subject.kind).eq_ignore_ascii_case(kind);
        let subject = subjects.iter().find(is_asked).expect("a kind of omission");
        let keep = match keep.as_str() {
            "kept" => Keep::only(subject.kind),
            _ => Keep::NOTHING,
        };
        println!(
            "{:?}",
            cost(&path_of(subject, folder.path()), keep, subject.kind).1
        );
        return;
    }
    println!("| left out | scene | processor seconds | kept | saved | bytes saved | rays | kept |");
    println!("|---|---|---|---|---|---|---|---|");
    for subject in &subjects {
        println!("{}", row(subject, folder.path()));
    }
}

fn path_of(subject: &Subject, folder: &Path) -> PathBuf {
    let path = folder.join("scene.toml");
    fs::write(&path, &subject.text).unwrap();
    path
}

fn row(subject: &Subject, folder: &Path) -> String {
    let path = path_of(subject, folder);
    let keeps = [Keep::NOTHING, Keep::only(subject.kind)];
    let mut seconds = [Vec::new(), Vec::new()];
    let mut counts = [Counts::default(); 2];
    for _ in 0..TURNS {
        for (i, keep) in keeps.into_iter().enumerate() {
            let (time, count) = cost(&path, keep, subject.kind);
            seconds[i].push(time);
            counts[i] = count;
        }
    }
    let saved = seconds[1]
        .iter()
        .zip(&seconds[0])
        .map(|(with, without)| with - without);
    let saved = Spread::of(saved.collect::<Vec<_>>());
    let [left, kept] = seconds.map(|s| Spread::of(s).median);
    format!(
        "| {:?} | {} | {left:.3} | {kept:.3} | {:.0} % ({:.0} to {:.0}) | {} | {} | {} |",
        subject.kind,
        subject.name,
        100.0 * saved.median / kept,
        100.0 * saved.min / kept,
        100.0 * saved.max / kept,
        counts[0].saved_bytes,
        counts[0].rays,
        counts[1].rays,
    )
}

/// What does not depend on the machine.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    saved_bytes: u64,
    rays: u64,
}

/// Processor seconds from the file to the picture.
fn cost(path: &Path, keep: Keep, kind: Omission) -> (f64, Counts) {
    let watch = Stopwatch::start();
    let options = SceneOptions {
        keep,
        ..SceneOptions::default()
    };
    let imported = import(path, &options).unwrap_or_else(|error| panic!("{error}"));
    let (film, left_out) = project::film_keeping(&imported, Vec::new(), keep);
    let elapsed = watch.read();
    let of_kind = left_out.iter().filter(|entry| entry.kind == kind);
    let counts = Counts {
        saved_bytes: of_kind.map(|entry| entry.saved_bytes).sum(),
        rays: film.rays.total(),
    };
    (elapsed.processor.unwrap_or(elapsed.wall), counts)
}

fn subjects(folder: &Path) -> Vec<Subject> {
    let models = std::env::var("HALFSHADE_MODELS")
        .map_or_else(|_| project::root().join("../shared/models"), PathBuf::from);
    let [house, penumbra, terrain, forest] =
        ["house", "penumbra", "terrain", "forest"].map(scene_text);
    let sized = |text: &str, size: &str| {
        let film = text.find("size = ").unwrap();
        let end = film + text[film..].find('\n').unwrap();
        format!("{}size = {size}{}", &text[..film], &text[end..])
    };
    let depth = |model: &Path| {
        format!(
            "[film]\nsize = [320, 240]\n[sampling]\nsamples = 4\n[integrator]\nkind = \"depth\"\n\
             [[model]]\nfile = {:?}\n",
            model.display().to_string()
        )
    };
    let unused = folder.join("unused.glb");
    fs::write(
        &unused,
        without_nodes(&fs::read(large_model("terrain.glb")).unwrap()),
    )
    .unwrap();
    let black: String = (0..16)
        .map(|i| format!("[[light]]\nkind = \"disk\"\nposition = [{i}, 9, 4]\nnormal = [0, -1, 0]\nradius = 0.5\nradiance = [0, 0, 0]\n"))
        .collect();
    let mut subjects = vec![
        Subject {
            kind: Omission::Meshes,
            name: "the house, and a file with a terrain that no node shows",
            text: sized(&house, "[320, 180]")
                + &format!("[[model]]\nfile = {:?}\n", unused.display().to_string()),
        },
        Subject {
            kind: Omission::Attributes,
            name: "depth of the terrain",
            text: depth(&large_model("terrain.glb")),
        },
        Subject {
            kind: Omission::Lights,
            name: "the house with 16 lights of radiance 0",
            text: sized(&house, "[320, 180]") + &black,
        },
        Subject {
            kind: Omission::Opacity,
            name: "the house",
            text: sized(&house, "[480, 270]"),
        },
        Subject {
            kind: Omission::Opacity,
            name: "the penumbra",
            text: sized(&penumbra, "[480, 270]"),
        },
        Subject {
            kind: Omission::Opacity,
            name: "the terrain",
            text: sized(&terrain, "[480, 270]"),
        },
        Subject {
            kind: Omission::Opacity,
            name: "the forest",
            text: sized(&forest, "[480, 270]"),
        },
    ];
    let textured = models.join("gltf/FlightHelmet-512/glTF/FlightHelmet.gltf");
    if textured.is_file() {
        subjects.push(Subject {
            kind: Omission::Images,
            name: "depth of a helmet with 15 textures",
            text: depth(&textured),
        });
    }
    subjects
}

/// The text of a scene of this project, with whole paths.
fn scene_text(name: &str) -> String {
    let scenes = project::root().join("scenes");
    let text = fs::read_to_string(scenes.join(name).with_extension("toml")).unwrap();
    text.replace("\"../", &format!("\"{}/", project::root().display()))
}

fn large_model(name: &str) -> PathBuf {
    project::make_large_models();
    project::root().join("target/models").join(name)
}

/// The file `glb` with scenes that show nothing.
fn without_nodes(glb: &[u8]) -> Vec<u8> {
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    let end = 20 + word(12);
    let mut root: serde_json::Value = serde_json::from_slice(&glb[20..end]).unwrap();
    root["scenes"] = serde_json::json!([{}]);
    let mut json = root.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = (20 + json.len() + glb.len() - end) as u32;
    let header = [&glb[..8], &length.to_le_bytes()].concat();
    let chunk = [&(json.len() as u32).to_le_bytes(), &glb[16..20]].concat();
    [header, chunk, json, glb[end..].to_vec()].concat()
}
