//! The tree of a scene file to a [`Scene`] and its settings.

use std::path::Path;

use super::SceneOptions;
use super::camera::{CameraSection, DEFAULT_VERTICAL_FOV, View};
use super::defaults::{self, RigLight};
use super::document::{Node, Source};
use super::model::Models;
use super::nearest::suggestion;
use super::section::Section;
use super::settings::BackgroundSection;
use super::{light, material, settings};
use crate::color::Rgb;
use crate::import::environment::EnvironmentFile;
use crate::import::undecoded::{self, Undecoded};
use crate::import::{ImportError, ImportOptions, Imported, Warnings, census};
use crate::scene::{Background, IntegratorKind, Keep, LeftOut, Needs, Omission, Scene, Settings};

const SECTIONS: &[&str] = &[
    "camera",
    "film",
    "sampling",
    "integrator",
    "background",
    "model",
    "material",
    "light",
];

/// Makes a scene of what `root` says.
pub fn build(
    source: &Source,
    root: &Node,
    options: &SceneOptions,
) -> Result<Imported, ImportError> {
    let root = Section::new(source, root, "", SECTIONS)?;
    let settings = settings::read(&root)?;
    let camera = CameraSection::read(&root)?;
    let background = settings::background(&root)?;
    let mut warnings = Warnings::default();
    let (mut scene, mut undecoded, mut left_out) = scene(&root, options, &mut warnings)?;
    let view = place_camera(&mut scene, camera, &settings, &source.path, options)?;
    let is_path = settings.integrator == IntegratorKind::Path;
    // Only `path` brings the light of the surroundings to surfaces.
    let is_lit = is_path && background.environment.is_some();
    let lights = light_up(&mut scene, &root, is_lit);
    let (surroundings, was_changed) = surround(&background, &lights, is_path);
    scene.background = surroundings;
    let changed = was_changed.then_some(&scene.background);
    let defaults = defaults::report(view.as_ref(), changed, &lights);
    let needs = options.layers.and(Needs::of(settings.integrator));
    left_out.extend(add_environment(
        &mut scene,
        &background,
        needs,
        options.keep,
    )?);
    left_out.extend(census::leave_out(
        &mut scene,
        &mut undecoded,
        needs,
        options.keep,
    ));
    undecoded::decode(&mut scene, &undecoded, &mut warnings);
    Ok(Imported {
        defaults,
        scene,
        settings,
        warnings,
        left_out,
    })
}

/// Models, materials and lights; the cameras are those of the models. And the images that are not
/// decoded yet, and what the importers of models left out.
fn scene(
    root: &Section,
    options: &SceneOptions,
    warnings: &mut Warnings,
) -> Result<(Scene, Vec<Undecoded>, Vec<LeftOut>), ImportError> {
    let source = root.source;
    let materials = material::read_all(source, root.list("material")?, warnings)?;
    let mut scene = Scene {
        materials: materials.clone(),
        ..Scene::default()
    };
    let own_lights = root
        .list("light")?
        .iter()
        .map(|node| light::read(source, node))
        .collect::<Result<Vec<_>, _>>()?;
    let import_options = ImportOptions {
        is_strict: options.is_strict,
        reads_unused_meshes: options.keep.contains(Omission::Meshes),
        variant: options.variant.as_deref(),
        pose: options.pose.as_ref(),
    };
    let mut models = Models::new(source, import_options, materials);
    for node in root.list("model")? {
        models.add(node, &mut scene, warnings)?;
    }
    if root.value("light").is_some() {
        scene.lights = own_lights;
    }
    Ok((scene, models.undecoded, models.left_out))
}

/// Makes the camera that was asked for the first of the scene; returns the default one, if it is that.
fn place_camera(
    scene: &mut Scene,
    section: CameraSection,
    settings: &Settings,
    path: &Path,
    options: &SceneOptions,
) -> Result<Option<View>, ImportError> {
    if let Some(name) = &options.camera {
        choose(scene, name).map_err(|problem| {
            ImportError::invalid_at(path, format!("--camera {name}"), problem)
        })?;
        // A lens that belongs to a view of the scene file does not fit another camera.
        if section.own.is_some() {
            return Ok(None);
        }
    } else if let Some(own) = section.own {
        scene.cameras.insert(0, own);
        return Ok(None);
    } else if let Some(name) = section.name {
        choose(scene, name.string()?).map_err(|problem| name.invalid(problem))?;
    }
    if let Some(first) = scene.cameras.first_mut() {
        section.adjust(&mut first.item)?;
        return Ok(None);
    }
    let size = settings.size.as_dvec2();
    let fov = section.vertical_fov.unwrap_or(DEFAULT_VERTICAL_FOV);
    let view = View {
        lens_radius: section.lens_radius.unwrap_or(0.0),
        focus_distance: section.focus_distance,
        ..defaults::view(scene.bounds(), size.x / size.y, fov)
    };
    let camera = view.camera();
    let view = camera.is_some().then_some(view);
    scene.cameras.extend(camera);
    Ok(view)
}

/// Makes the camera called `name` the first.
fn choose(scene: &mut Scene, name: &str) -> Result<(), String> {
    let index = scene.cameras.iter().position(|camera| camera.name == name);
    let index = index.ok_or_else(|| {
        let names: Vec<_> = scene
            .cameras
            .iter()
            .map(|camera| camera.name.as_str())
            .filter(|name| !name.is_empty())
            .collect();
        let list = match names.as_slice() {
            [] => "no camera of the scene has a name".to_owned(),
            names => format!("there are: {}", names.join(", ")),
        };
        match suggestion(name, &names) {
            guess if guess.starts_with("did") => {
                format!("no camera is named \"{name}\"; {guess} {list}")
            }
            _ => format!("no camera is named \"{name}\"; {list}"),
        }
    })?;
    scene.cameras[..=index].rotate_right(1);
    Ok(())
}

/// Gives default lights to a scene that has none, unless it says so itself (`light = []`) or its
/// surroundings light it.
fn light_up(scene: &mut Scene, root: &Section, is_lit: bool) -> Vec<RigLight> {
    let is_dark = !is_lit && scene.lights.is_empty() && root.value("light").is_none();
    let Some(camera) = scene.cameras.first().filter(|_| is_dark) else {
        return Vec::new();
    };
    let rig = defaults::lights(&camera.item);
    scene.lights.extend(rig.iter().filter_map(RigLight::light));
    Vec::from(rig)
}

/// The background, and whether default lights brought something into it: ambient light where it is
/// read, else radiance from everywhere, unless the file says how much of that there is.
fn surround(section: &BackgroundSection, lights: &[RigLight], is_path: bool) -> (Background, bool) {
    let mut background = Background {
        // An environment is multiplied with it instead.
        radiance: match section.environment {
            None => section.radiance.unwrap_or_default(),
            Some(_) => Rgb::BLACK,
        },
        ambient: section.ambient.unwrap_or_default(),
    };
    if lights.is_empty() {
        return (background, false);
    }
    let (brought, is_free) = if is_path {
        (&mut background.radiance, section.radiance.is_none())
    } else {
        (&mut background.ambient, section.ambient.is_none())
    };
    if is_free {
        *brought = defaults::AMBIENT;
    }
    (background, is_free)
}

/// Reads the picture of the surroundings, unless nothing needs it.
fn add_environment(
    scene: &mut Scene,
    section: &BackgroundSection,
    needs: Needs,
    keep: Keep,
) -> Result<Option<LeftOut>, ImportError> {
    let Some(path) = &section.environment else {
        return Ok(None);
    };
    let file = EnvironmentFile::read(path)?;
    if !needs.scattering && !keep.contains(Omission::Images) {
        let what = format!("the environment {}", path.display());
        let why = "what is rendered does not read it";
        return Ok(Some(LeftOut::new(
            Omission::Images,
            what,
            why,
            file.decoded_bytes(),
        )));
    }
    let factor = section.radiance.unwrap_or(Rgb::WHITE);
    scene.environment = file.decode(factor, section.rotate_radians)?;
    Ok(None)
}
