//! Scene files: a camera, settings, materials, lights and placed models, in TOML.
//!
//! A mistake is an error that names file, line, key and the nearest known key. Every section and,
//! where a default is given, every key may be left out. Paths are relative to the scene file.
//! Lengths are in metres, angles in degrees, y is up. A model by itself is read as a scene
//! file whose only section is one `[[model]]`.
//!
//! A *colour* is `[red, green, blue]`, linear with Rec. 709 primaries, or an sRGB string
//! `"#rrggbb"` or `"#rgb"`, which is decoded to linear. A *vector* is a list of three numbers. All
//! numbers are finite.
//!
//! # `[camera]`
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `position` | vector | | the eye; it makes a camera of the scene file's own |
//! | `look_at` | vector | needed with `position` | the middle of the picture |
//! | `up` | vector, not 0 | `[0, 1, 0]` | up in the picture; only with `position` |
//! | `name` | text | the first one | picks the camera of a model; not with `position` |
//! | `vertical_fov` | degrees in (0, 180) | 40, or the model's | full angle from bottom to top |
//! | `lens_radius` | metres ≥ 0 | 0 | radius of the thin lens; 0 is a pinhole |
//! | `focus_distance` | metres > 0 | distance to `look_at` | the plane in focus, along the view; needed where the camera of a model gets a lens |
//!
//! Without `position` the keys for lens and angle apply to the camera of a model or to the default one:
//! where no model has a camera, one that frames everything from the front, from a little above and to the right.
//!
//! # `[film]`
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `size` | `[width, height]`, 1 to 65,536 each and 2^28 in all | `[1280, 720]` | pixels |
//! | `transparent` | true, false | false | pictures have an opacity, and the background is seen by nothing but mirrors and glass |
//!
//! # `[sampling]`
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `samples` | 1 to 2^30 | 64 | camera samples per pixel |
//! | `pattern` | `"grid"`, `"jittered"`, `"random"`, `"sobol"` | `"sobol"` | their layout |
//! | `target` | `"rectangle"`, `"circle"` | `"rectangle"` | the whole pixel, or its inscribed disk |
//! | `seed` | 0 to 2^64 − 1 | 0 | other seeds give other random numbers |
//!
//! # `[integrator]`
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `kind` | `"whitted"`, `"path"`, `"normal"`, `"depth"`, `"albedo"` | `"whitted"`; `"path"` for a glTF file by itself | how light is followed, or what else is shown |
//! | `max_depth` | 1 to 1,024 | 64 in `path`, 8 in `whitted` | scattering events of a path; 1 is direct light only |
//! | `clamp` | > 0 | none | most radiance that light brings which was scattered more than once; what that takes away is said (`path`) |
//! | `shadow_terminator` | `true`, `false` | `true` | whether shadow rays start on the smooth surface that vertex normals describe, so that no facets show where light ends |
//!
//! # `[background]`
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `radiance` | colour ≥ 0 | black; with default lights 0.15 in `path`; with an environment white | what rays that leave the scene bring back, W/(m² sr); an environment is multiplied with it |
//! | `ambient` | colour ≥ 0 | black; with default lights 0.15 in `whitted` | irradiance / π added to every matte surface (`whitted`) |
//!
//! | `environment` | path | | a picture of the surroundings in latitude and longitude (EXR, HDR, or as textures): its middle is at −z, its top is up; in `path` it lights the scene |
//! | `rotate` | degrees | 0 | turns it about y, counter-clockwise seen from above |
//!
//! # `[[model]]`
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `file` | path | needed | `.gltf`, `.glb` or `.obj`; a file named twice is imported once and its meshes are shared |
//! | `scale` | number or vector, nothing 0 | 1 | first; a negative one mirrors |
//! | `rotate` | vector, degrees | `[0, 0, 0]` | then about x, then about y, then about z |
//! | `translate` | vector, metres | `[0, 0, 0]` | then |
//! | `matrix` | 16 numbers, column-major | | in place of the three above |
//! | `material` | name of a `[[material]]` | | replaces every material of the model |
//! | `lights` | true, false | true | whether the model brings its lights |
//! | `variant` | text | that of the file | which of several sets of materials the model shows (`KHR_materials_variants`) |
//!
//! Lights and cameras are placed with their model. A light is as bright on the scaled model as it was
//! on the model by itself, which stands nearer or farther.
//!
//! # `[[material]]`
//!
//! `name` and `kind` are needed. Of `kind = "phong"`:
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `diffuse` | colour in 0 to 1 | black | matte reflectance |
//! | `specular` | colour in 0 to 1 | black | reflectance of the glossy lobe |
//! | `exponent` | ≥ 0 | 32 | of the glossy lobe; the higher, the smaller the highlight |
//! | `reflect` | colour in 0 to 1 | black | perfect mirror |
//! | `transmit` | colour in 0 to 1 | black | share that is let through, refracted |
//! | `index_of_refraction` | > 0 | 1.5 | of the inside against the outside |
//! | `emission` | colour ≥ 0 | black | radiance that it gives off, W/(m² sr) |
//!
//! The four shares `diffuse`, `specular`, `reflect` and `transmit` should add up to no more than 1;
//! where they add up to more there is a warning, and `path` takes from the highlight, then dims all of them.
//! (`whitted` shows what is asked for.)
//!
//! Of `kind = "gltf"` (the metallic-roughness model; defaults are glTF's):
//!
//! | key | range | default | |
//! |---|---|---|---|
//! | `base_color` | colour in 0 to 1 | white | |
//! | `metallic` | 0 to 1 | 1 | 0 dielectric, 1 metal |
//! | `roughness` | 0 to 1 | 1 | perceptual roughness |
//! | `ior` | > 0 | 1.5 | index of refraction |
//! | `transmission` | 0 to 1 | 0 | share of the light that enters and is not absorbed |
//! | `opacity` | 0 to 1 | 1 | below 1 that share of the surface is there (glTF's BLEND) |
//! | `emissive` | colour ≥ 0 | black | radiance that it gives off, W/(m² sr), … |
//! | `emissive_strength` | ≥ 0 | 1 | … times this |
//!
//! # `[[light]]`
//!
//! `kind` is needed, and so are the keys without a default. Where a scene file has any light, the
//! lights of its models are left out. Where neither it nor its models have one, it gets a key, a
//! fill and a rim light (surfaces that emit are not counted, an environment is in `path`); `light = []` keeps it dark.
//!
//! | kind | key | range | default | |
//! |---|---|---|---|---|
//! | all | `name` | text | its number | of its layer; lights of one name share it |
//! | | `samples` | 1 to 2^24 | 1 | shadow rays per shading point |
//! | point, spot | `position` | vector | | |
//! | | `intensity` | colour ≥ 0 | | radiant intensity, W/sr |
//! | | `radius` | metres ≥ 0 | 0 | of the disk that shadow rays aim at; 0 is a hard shadow (a lamp to be seen in mirrors is better a `sphere`) |
//! | | `falloff` | `{ constant, linear, quadratic }`, each ≥ 0 and 0 by default, not all 0 | 1/d² | intensity / (constant + linear d + quadratic d²) |
//! | spot | `direction` | vector, not 0 | | the way the light travels |
//! | | `inner_angle` | degrees, 0 to `outer_angle` | 0 | from the axis to where the light begins to fade |
//! | | `outer_angle` | degrees, above 0 to 180 | 45 | from the axis to where there is none |
//! | distant | `direction` | vector, not 0 | | the way the light travels |
//! | | `irradiance` | colour ≥ 0 | | on a surface that faces the light, W/m² |
//! | | `angle` | degrees in [0, 180) | 0 | that the light covers in the sky; 0 is a hard shadow |
//! | disk, rectangle, sphere | `position` | vector | | the centre |
//! | | `radiance` | colour ≥ 0 | | W/(m² sr) |
//! | | `visible` | true, false | true | whether camera rays see it |
//! | disk, sphere | `radius` | metres > 0 | | |
//! | disk | `normal` | vector, not 0 | | the side that shines |
//! | rectangle | `edge_u`, `edge_v` | vectors, not parallel | | half edges; the side of `edge_u × edge_v` shines |

mod build;
mod camera;
mod defaults;
mod document;
mod light;
mod material;
mod merge;
mod model;
mod nearest;
mod overrides;
mod placement;
mod print;
mod section;
mod settings;
mod value;

use std::path::Path;

use super::{ImportError, Imported, Pose};
use crate::camera::Camera;
use crate::math::DVec3;
use crate::scene::{IntegratorKind, Keep, Needs, Placed};
pub use defaults::Defaults;
use document::{Entry, Kind, Node, Source};
pub use nearest::suggestion;

/// How to import a scene.
#[derive(Clone, Debug, Default)]
pub struct SceneOptions {
    /// Whether an extension that a model requires and we lack is an error.
    pub is_strict: bool,
    /// Keys of the scene file and their values, as `light.0.radius` and `0`: they replace what the
    /// file says, one after the other.
    pub overrides: Vec<(String, String)>,
    /// The variant of materials that models show which have several; `None` for what the scene file
    /// says.
    pub variant: Option<String>,
    /// The name of the camera to look through; `None` for what the file says.
    pub camera: Option<String>,
    /// The moment of its animations that is shown; `None` for all models at rest.
    pub pose: Option<Pose>,
    /// What layers beside the picture read.
    pub layers: Needs,
    /// What is kept though neither the integrator of the settings nor the layers read it: by
    /// default everything, so that the scene can be rendered in any other way too.
    pub keep: Keep,
}

/// The camera that a scene within the box `bounds` gets where it has none, for a picture of this
/// width over height; `None` where the box is so far away that its size is lost.
pub fn framing_camera(bounds: (DVec3, DVec3), aspect: f64) -> Option<Placed<Camera>> {
    defaults::view(Some(bounds), aspect, camera::DEFAULT_VERTICAL_FOV).camera()
}

/// Imports a scene file.
pub(super) fn import_scene(path: &Path, options: &SceneOptions) -> Result<Imported, ImportError> {
    let source = Source::read(path)?;
    let root = source.parse()?;
    import_tree(&source, root, options)
}

/// Imports a model as a scene file would that only names it.
pub(super) fn import_bare(path: &Path, options: &SceneOptions) -> Result<Imported, ImportError> {
    let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
        return Err(ImportError::invalid(path, "the name is not text in UTF-8"));
    };
    let entry = |key: &str, kind| Entry {
        key: key.to_owned(),
        place: document::Place::Implied,
        node: Node::implied(kind),
    };
    let file = entry("file", Kind::String(name.to_owned()));
    let model = Node::implied(Kind::Table(vec![file]));
    let mut sections = vec![entry("model", Kind::Array(vec![model]))];
    // glTF's materials are made for all light; OBJ's for what lights send straight to them.
    if super::extension(path) != "obj" {
        let kind = IntegratorKind::Path.name().to_owned();
        let kind = entry("kind", Kind::String(kind));
        sections.push(entry("integrator", Kind::Table(vec![kind])));
    }
    let root = Kind::Table(sections);
    import_tree(&Source::without_text(path), Node::implied(root), options)
}

fn import_tree(
    source: &Source,
    mut root: Node,
    options: &SceneOptions,
) -> Result<Imported, ImportError> {
    for (path, value) in &options.overrides {
        overrides::apply(source, &mut root, path, value)?;
    }
    build::build(source, &root, options)
}
