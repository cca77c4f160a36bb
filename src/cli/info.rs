//! `halfshade info`: what is in a scene.

use std::fmt::{self, Display};
use std::path::PathBuf;

use clap::Args;
use halfshade::bvh::Builder;
use halfshade::import::{Imported, Warning, Warnings, import};
use halfshade::light::Light;
use halfshade::prepare::prepare_keeping;
use halfshade::scene::{Keep, LeftOut, Scene};
use serde::Serialize;

use super::Failure;
use super::console::{Bytes, print, printable};
#[cfg(feature = "gltf")]
use super::extensions::run as list_extensions;
use super::left_out::LeftOutLine;
use super::measure::measure;
use super::options::{KeepOptions, ReadingOptions};

/// Print what is in a scene or model, what was ignored or repaired, and what is left out
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  halfshade info scenes/house.toml
  halfshade info bunny.obj --json
  halfshade info --extensions
  halfshade info models/house.glb --measure --set integrator.kind=depth
      what a depth picture does not need, and what time and memory that saves")]
pub struct InfoOptions {
    /// A scene file (.toml), or a model by itself (.gltf, .glb, .obj)
    #[arg(required_unless_present = "extensions")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    reading: ReadingOptions,
    #[command(flatten)]
    keep: KeepOptions,
    /// Measure the time that is saved: imports, prepares and renders the scene small, several times
    #[arg(long)]
    measure: bool,
    /// Print what becomes of each extension of glTF, as a page of Markdown, and nothing else
    #[arg(long, conflicts_with = "scene")]
    extensions: bool,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Does what the options say.
pub fn run(options: &InfoOptions) -> Result<(), Failure> {
    let Some(scene) = &options.scene else {
        return list_extensions(options.json);
    };
    let keep = options.keep.keep();
    let mut import_options = options.reading.import_options();
    import_options.keep = keep;
    let imported =
        import(scene, &import_options).map_err(|error| Failure::of_import("info", &error))?;
    let mut info = Info::of(&imported, keep);
    if options.measure {
        measure(scene, &import_options, &mut info.left_out)
            .map_err(|error| Failure::of_import("info", &error))?;
    }
    if options.json {
        let json = serde_json::to_string_pretty(&info).map_err(Failure::job)?;
        print(json)
    } else {
        print(printable(Table {
            name: scene.display().to_string(),
            info: &info,
            imported: &imported,
        }))
    }
}

/// Without glTF there are none.
#[cfg(not(feature = "gltf"))]
fn list_extensions(_: bool) -> Result<(), Failure> {
    Err(Failure::job(
        "glTF (feature \"gltf\" of this build) is not supported",
    ))
}

/// What scripts may rely on; more keys may come to stand beside these.
#[derive(Debug, Serialize)]
struct Info {
    /// As rendered: every instance counts.
    triangles: u64,
    /// As stored: shared meshes count once.
    vertices: u64,
    instances: usize,
    meshes: usize,
    materials: usize,
    textures: usize,
    images: usize,
    /// In the files; default ones do not count.
    lights: usize,
    /// In the files; a default one does not count.
    cameras: usize,
    animations: usize,
    /// World space; `null` where there are no triangles.
    bounds: Option<Bounds>,
    /// Of meshes and images, and of what is made of them for rendering.
    memory_bytes: usize,
    warnings: Vec<Warning>,
    /// What its picture does not need.
    left_out: Vec<LeftOut>,
}

#[derive(Debug, Serialize)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Info {
    fn of(imported: &Imported, keep: Keep) -> Self {
        let scene = &imported.scene;
        let prepared = prepare_keeping(scene, Builder::default(), keep);
        let mut warnings: Warnings = imported.warnings.clone();
        warnings.extend(prepared.warnings);
        let added = imported.defaults.as_ref();
        let left_out = [imported.left_out.as_slice(), &prepared.left_out].concat();
        Self {
            triangles: scene.triangle_count(),
            vertices: scene
                .meshes
                .iter()
                .map(|m| m.positions().len() as u64)
                .sum(),
            instances: scene.instances.len(),
            meshes: scene.meshes.len(),
            materials: scene.materials.len(),
            textures: scene.textures.len(),
            images: scene.images.len(),
            lights: scene.lights.len() - added.map_or(0, |added| added.lights),
            cameras: scene.cameras.len() - added.map_or(0, |added| added.cameras),
            animations: scene.animations,
            bounds: scene.bounds().map(|(min, max)| Bounds {
                min: min.to_array(),
                max: max.to_array(),
            }),
            memory_bytes: scene.memory_bytes() + prepared.scene.memory_bytes(),
            warnings: warnings.iter().collect(),
            left_out,
        }
    }
}

/// The same for people.
struct Table<'a> {
    name: String,
    info: &'a Info,
    imported: &'a Imported,
}

impl Display for Table<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let info = self.info;
        let scene = &self.imported.scene;
        let added = self.imported.defaults.as_ref();
        writeln!(f, "{}", self.name)?;
        let mut row = |name: &str, value: &dyn Display| writeln!(f, "  {name:<11} {value}");
        row("triangles", &info.triangles)?;
        row("vertices", &info.vertices)?;
        row("instances", &info.instances)?;
        row("meshes", &info.meshes)?;
        if let Some(Bounds { min, max }) = &info.bounds {
            row("from", &Corner(min))?;
            row("to", &Corner(max))?;
        }
        row("materials", &info.materials)?;
        row(
            "textures",
            &format!("{} of {} images", info.textures, info.images),
        )?;
        row("lights", &lights(scene, info.lights))?;
        row("cameras", &cameras(scene, info.cameras))?;
        row("animations", &info.animations)?;
        row("memory", &Bytes(info.memory_bytes as u64))?;
        if let Some(added) = added {
            write!(
                f,
                "\nWhat it lacks is added when it is rendered:\n\n{}",
                added.text
            )?;
        }
        if !info.left_out.is_empty() {
            write!(f, "\nLeft out, since the picture does not need it:")?;
        }
        for entry in &info.left_out {
            write!(f, "\n  {}", LeftOutLine(entry))?;
        }
        if !info.warnings.is_empty() {
            write!(f, "\nWarnings:")?;
        }
        for warning in &info.warnings {
            let times = match warning.count {
                1 => String::new(),
                count => format!(" ({count} times)"),
            };
            write!(f, "\n  {}{times}", warning.message)?;
        }
        Ok(())
    }
}

/// Their number, with how many of which kind.
fn lights(scene: &Scene, count: usize) -> String {
    if count == 0 {
        return "0".to_owned();
    }
    let kind = |light: &Light| match light {
        Light::Point(_) => "point",
        Light::Spot(_) => "spot",
        Light::Distant(_) => "distant",
        Light::Disk(_) => "disk",
        Light::Rectangle(_) => "rectangle",
        Light::Sphere(_) => "sphere",
    };
    let mut kinds: Vec<(&str, usize)> = Vec::new();
    for light in scene.lights.iter().take(count) {
        let kind = kind(&light.item);
        match kinds.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, count)) => *count += 1,
            None => kinds.push((kind, 1)),
        }
    }
    let kinds: Vec<String> = kinds.iter().map(|(k, n)| format!("{n} {k}")).collect();
    format!("{count} ({})", kinds.join(", "))
}

/// Their number, with the names that `--camera` takes.
fn cameras(scene: &Scene, count: usize) -> String {
    let names: Vec<&str> = scene
        .cameras
        .iter()
        .map(|camera| camera.name.as_str())
        .filter(|name| !name.is_empty() && count > 0)
        .collect();
    if names.is_empty() {
        count.to_string()
    } else {
        format!("{count} ({})", names.join(", "))
    }
}

struct Corner<'a>(&'a [f64; 3]);

impl Display for Corner<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0;
        // Not `{}`, which writes all 300 digits of a number that broken files hold.
        write!(f, "{x:?} {y:?} {z:?}")
    }
}
