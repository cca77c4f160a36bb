//! A scene held against itself: changed in ways that must not show.
//!
//! What can be said of a [`Scene`] in memory: size, place, axes, order of the triangles, instances,
//! trees. What the numbers of its files lost before it got here does not show, nor does what single
//! and double precision would make of it in another tracer.

use crate::bvh::Builder;
use crate::camera::Camera;
use crate::film::{Film, Rect};
use crate::light::Light;
use crate::math::{DAffine3, DMat3, DVec3, UVec2, UnitVec3, Vec3};
use crate::prepare::{FLATTEN_BUDGET, PreparedScene, prepare_within};
use crate::render::{Job, replay};
use crate::scene::{IntegratorKind, Mesh, Placed, Scene, Settings};

use super::meshes::Random;
use super::scenes::{bits, picture_of, relative_rmse};
use super::{Check, Effort, Report};

/// Largest relative RMSE of pictures that differ by rounding alone.
const ROUNDING: f64 = 1e-5;
/// Where rounding puts a few samples on the other side of an edge.
const EDGES: f64 = 1e-2;

/// A change that must not show.
struct Change {
    id: &'static str,
    what: String,
    kind: Kind,
    builder: Builder,
    flatten_budget: u64,
    promise: Promise,
}

enum Kind {
    None,
    /// By a number.
    Scale(f64),
    /// By a vector, metres.
    Shift(DVec3),
    /// By an orthogonal matrix, which may mirror.
    Turn(DMat3),
    /// Triangles in another order.
    Shuffle,
}

/// What must stay the same.
#[derive(Clone, Copy, PartialEq)]
enum Promise {
    Bits,
    /// All but rounding.
    Value,
    /// The frames in which soft lights and lenses are sampled turn with the axes: all but noise.
    Expectation,
}

/// Renders `scene` as it is and changed, by its own technique, and says what moved; `command` renders the same
/// picture, and is shown with the sample that moved most. Views of normals and the like, which do change, give
/// way to `whitted`. [`Effort::Full`] tries every power of two from -40 to 40, and more of ten.
pub fn examine(
    scene: &Scene,
    camera: &Placed<Camera>,
    settings: &Settings,
    effort: Effort,
    command: &str,
) -> Vec<Report> {
    let settings = &Settings {
        integrator: technique(settings.integrator),
        ..settings.clone()
    };
    let prepared = prepare_within(scene, Builder::default(), FLATTEN_BUDGET).scene;
    let reference = View {
        film: picture_of(&prepared, camera, settings),
        scene: &prepared,
        camera,
        settings,
    };
    let changes = changes(scene, camera, settings.integrator, effort);
    let report = |change: &Change| Report {
        id: change.id.to_owned(),
        case: change.what.clone(),
        checks: vec![check(scene, &reference, change, command)],
    };
    changes.iter().map(report).collect()
}

/// What a scene is tried with that is to be rendered with `kind`.
pub fn technique(kind: IntegratorKind) -> IntegratorKind {
    match kind {
        IntegratorKind::Whitted | IntegratorKind::Path => kind,
        IntegratorKind::Normal | IntegratorKind::Depth | IntegratorKind::Albedo => {
            IntegratorKind::Whitted
        }
    }
}

/// A picture, and what it takes to look closer at it.
struct View<'a> {
    film: Film,
    scene: &'a PreparedScene<'a>,
    camera: &'a Placed<Camera>,
    settings: &'a Settings,
}

fn changes(
    scene: &Scene,
    camera: &Placed<Camera>,
    technique: IntegratorKind,
    effort: Effort,
) -> Vec<Change> {
    let plain = |id, what: String, kind, promise| Change {
        id,
        what,
        kind,
        builder: Builder::default(),
        flatten_budget: FLATTEN_BUDGET,
        promise,
    };
    let size = scene
        .bounds()
        .map_or(1.0, |(min, max)| (max - min).max_element());
    let is_path = technique == IntegratorKind::Path;
    let is_soft =
        is_path || camera.item.lens_radius > 0.0 || scene.lights.iter().any(|l| !l.item.is_delta());
    let turned = if is_soft {
        Promise::Expectation
    } else {
        Promise::Value
    };
    let cycle = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
    let mirror = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
    let mut changes = Vec::new();
    for k in effort.pick(vec![-40, -7, 7, 40], beside_zero(40)) {
        let kind = Kind::Scale(2f64.powi(k));
        changes.push(plain(
            "scale-2",
            format!("scaled by 2^{k}"),
            kind,
            Promise::Bits,
        ));
    }
    for k in effort.pick(vec![-6, -3, 3, 6], beside_zero(12)) {
        let kind = Kind::Scale(10f64.powi(k));
        changes.push(plain(
            "scale-10",
            format!("scaled by 1e{k}"),
            kind,
            Promise::Value,
        ));
    }
    for k in effort.pick(vec![1, 3, 6], (1..=9).collect()) {
        let kind = Kind::Shift(DVec3::new(1.0, -0.7, 0.4) * size * 10f64.powi(k));
        changes.push(plain(
            "shift",
            format!("moved by 1e{k} sizes"),
            kind,
            Promise::Value,
        ));
    }
    changes.push(plain(
        "axes",
        "x, y, z become y, z, x".to_owned(),
        Kind::Turn(cycle),
        turned,
    ));
    changes.push(plain(
        "mirror",
        "mirrored along x".to_owned(),
        Kind::Turn(mirror),
        turned,
    ));
    changes.push(plain(
        "order",
        "triangles shuffled".to_owned(),
        Kind::Shuffle,
        Promise::Bits,
    ));
    for (what, flatten_budget) in [("kept", 0), ("flattened", u64::MAX)] {
        changes.push(Change {
            flatten_budget,
            ..plain(
                "instances",
                format!("instances {what}"),
                Kind::None,
                Promise::Value,
            )
        });
    }
    for builder in Builder::ALL.into_iter().filter(|b| *b != Builder::None) {
        changes.push(Change {
            builder,
            ..plain(
                "tree",
                format!("tree by {builder}"),
                Kind::None,
                Promise::Bits,
            )
        });
    }
    changes
}

/// All numbers from `-most` to `most` but 0.
fn beside_zero(most: i32) -> Vec<i32> {
    (-most..=most).filter(|&k| k != 0).collect()
}

fn check(scene: &Scene, reference: &View, change: &Change, command: &str) -> Check {
    let (changed, camera) = applied(scene, reference.camera, &change.kind);
    let prepared = prepare_within(&changed, change.builder, change.flatten_budget).scene;
    let other = View {
        film: picture_of(&prepared, &camera, reference.settings),
        scene: &prepared,
        camera: &camera,
        settings: reference.settings,
    };
    let (before, after) = (&reference.film, &other.film);
    let moved = bits(before)
        .iter()
        .zip(&bits(after))
        .filter(|(a, b)| a != b)
        .count();
    let what = &change.what;
    let check = match change.promise {
        Promise::Bits => Check::none(format!("{what}: pixels that differ"), moved as u64),
        Promise::Value => Check::at_most(
            format!("{what}: relative RMSE"),
            rmse(before, after),
            ROUNDING,
        )
        .or_degraded(EDGES, "rounding puts samples on the other side of an edge"),
        Promise::Expectation => {
            // Both pictures see the same slivers: no room is needed for those.
            let stated = [before, after].map(|film| film.error_sums().and_then(|s| s.estimate()));
            let stated = stated.map(|stated| stated.map_or(f64::INFINITY, |error| error.high));
            Check::at_most(
                format!("{what}: difference over the errors that both pictures state"),
                relative_difference(before, after) / stated[0].hypot(stated[1]).max(ROUNDING),
                1.0,
            )
        }
    };
    if moved == 0 {
        return check;
    }
    let text = closer_look(reference, &other, moved, command);
    match &check.note {
        Some(note) => {
            let text = format!("{note}; {text}");
            check.noted(text)
        }
        None => check.noted(text),
    }
}

/// Relative RMSE; 0 where both pictures are black.
fn rmse(before: &Film, after: &Film) -> f64 {
    let is_black = |film: &Film| film.means().iter().all(|c| c.is_black());
    if is_black(before) && is_black(after) {
        0.0
    } else {
        relative_rmse(before, after)
    }
}

/// How far two pixels are apart: the squares of the differences over those of their mean, which is nearer to the truth
/// than either.
fn square(before: &Film, after: &Film, i: usize) -> f64 {
    let (a, b) = (before.pixels[i].value(), after.pixels[i].value());
    let weights = crate::film::relative_weights([0, 1, 2].map(|c| 0.5 * (a[c] + b[c])));
    (0..3).map(|c| (a[c] - b[c]).powi(2) * weights[c]).sum()
}

/// √relMSE.
fn relative_difference(before: &Film, after: &Film) -> f64 {
    let sum: f64 = (0..before.pixels.len())
        .map(|i| square(before, after, i))
        .sum();
    (sum / (3.0 * before.pixels.len() as f64)).sqrt()
}

/// How many pixels moved, which one most, and how to trace its worst sample again.
fn closer_look(before: &View, after: &View, moved: usize, command: &str) -> String {
    let (a, b) = (&before.film, &after.film);
    let count = a.pixels.len();
    let worst = (0..count).max_by(|&i, &j| square(a, b, i).total_cmp(&square(a, b, j)));
    let Some(worst) = worst else {
        return String::new();
    };
    let width = a.rect.width as usize;
    let pixel = UVec2::new((worst % width) as u32, (worst / width) as u32);
    let sample = worst_sample(before, after, pixel);
    format!(
        "{moved} of {count} pixels move, ({}, {}) most, from {:?} to {:?}: {command} --replay {},{},{sample}",
        pixel.x,
        pixel.y,
        a.pixels[worst].mean().channels(),
        b.pixels[worst].mean().channels(),
        pixel.x,
        pixel.y,
    )
}

fn worst_sample(before: &View, after: &View, pixel: UVec2) -> u32 {
    let samples = before.settings.sampling.samples_per_pixel();
    let difference = |index: u32| {
        let [a, b] = [before, after].map(|view| {
            let job = Job {
                scene: view.scene,
                camera: view.scene.camera(view.camera),
                settings: view.settings,
                crop: Rect::full(view.settings.size),
                layers: Vec::new(),
            };
            replay(&job, pixel, index).value
        });
        let square = (a - b).map(|c| c * c);
        f64::from(square.r + square.g + square.b)
    };
    let differences: Vec<f64> = (0..samples).map(difference).collect();
    let worst = (0..differences.len()).max_by(|&i, &j| differences[i].total_cmp(&differences[j]));
    worst.unwrap_or(0) as u32
}

/// The scene and its camera, changed.
fn applied(scene: &Scene, camera: &Placed<Camera>, kind: &Kind) -> (Scene, Placed<Camera>) {
    let (mut scene, mut camera) = (scene.clone(), camera.clone());
    match *kind {
        Kind::None => {}
        Kind::Scale(factor) => {
            place(&mut scene, DAffine3::from_scale(DVec3::splat(factor)));
            for light in &mut scene.lights {
                light.origin *= factor;
                light.item = light.item.placed(factor as f32, Vec3::ZERO);
            }
            camera.origin *= factor;
            camera.item = camera.item.placed(factor as f32, Vec3::ZERO);
        }
        Kind::Shift(shift) => {
            place(&mut scene, DAffine3::from_translation(shift));
            scene
                .lights
                .iter_mut()
                .for_each(|light| light.origin += shift);
            camera.origin += shift;
        }
        Kind::Turn(turn) => {
            place(&mut scene, DAffine3::from_mat3(turn));
            for light in &mut scene.lights {
                light.origin = turn * light.origin;
                light.item = turned(&light.item, turn);
            }
            camera.origin = turn * camera.origin;
            let Camera {
                position,
                right,
                up,
                back,
                ..
            } = camera.item;
            camera.item.position = vector(turn, position);
            [camera.item.right, camera.item.up, camera.item.back] =
                [right, up, back].map(|v| direction(turn, v));
        }
        Kind::Shuffle => {
            let mut random = Random(1);
            for mesh in &mut scene.meshes {
                if let Some(shuffled) = shuffled(mesh, &mut random) {
                    *mesh = shuffled;
                }
            }
        }
    }
    (scene, camera)
}

fn place(scene: &mut Scene, change: DAffine3) {
    for instance in &mut scene.instances {
        instance.transform = change * instance.transform;
    }
}

fn vector(turn: DMat3, v: Vec3) -> Vec3 {
    (turn * v.as_dvec3()).as_vec3()
}

fn direction(turn: DMat3, v: UnitVec3) -> UnitVec3 {
    UnitVec3::from_normalized(vector(turn, *v))
}

fn turned(light: &Light, turn: DMat3) -> Light {
    let mut light = *light;
    match &mut light {
        Light::Point(light) => light.position = vector(turn, light.position),
        Light::Spot(light) => {
            light.position = vector(turn, light.position);
            light.direction = direction(turn, light.direction);
        }
        Light::Distant(light) => light.direction = direction(turn, light.direction),
        Light::Disk(light) => {
            light.center = vector(turn, light.center);
            light.normal = direction(turn, light.normal);
        }
        Light::Rectangle(light) => {
            light.center = vector(turn, light.center);
            light.half_u = vector(turn, light.half_u);
            // A mirror would make it shine to the other side.
            light.half_v = vector(turn, light.half_v) * turn.determinant().signum() as f32;
        }
        Light::Sphere(light) => light.center = vector(turn, light.center),
    }
    light
}

/// The same triangles in another order (Durstenfeld 1964, "Algorithm 235: Random Permutation").
fn shuffled(mesh: &Mesh, random: &mut Random) -> Option<Mesh> {
    let mut indices = mesh.indices().to_vec();
    for last in (1..indices.len()).rev() {
        indices.swap(last, random.below(last + 1));
    }
    let mut shuffled = Mesh::new(mesh.name.clone(), mesh.positions().to_vec(), indices).ok()?;
    if !mesh.normals().is_empty() {
        shuffled = shuffled.with_normals(mesh.normals().to_vec()).ok()?;
    }
    if !mesh.tangents().is_empty() {
        shuffled = shuffled.with_tangents(mesh.tangents().to_vec()).ok()?;
    }
    if !mesh.colors().is_empty() {
        shuffled = shuffled.with_colors(mesh.colors().to_vec()).ok()?;
    }
    for uvs in mesh.uv_sets() {
        shuffled = shuffled.with_uv_set(uvs.clone()).ok()?;
    }
    Some(shuffled)
}
