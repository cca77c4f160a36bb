//! G11: the border between day and night on a coarse sphere with smooth normals.

use crate::bvh::Builder;
use crate::color::Rgb;
use crate::light::{DistantLight, Light};
use crate::math::{UnitVec3, Vec3};
use crate::prepare::prepare;
use crate::sampling::Pattern;
use crate::scene::{Attributes, Mesh, Scene, Settings};
use crate::stress::floor::{matte, settings};
use crate::stress::meshes::Random;
use crate::stress::scenes::{add_light, add_sphere, radiance_in};
use crate::stress::{Check, Effort, Sweep};

/// Follows meridians of spheres of 8 to 64 rows from the lit pole to the dark one.
pub fn run(effort: Effort) -> Vec<Check> {
    let steps = effort.pick(2_000, 20_000);
    let rows = [8, 16, 20, 32, 64];
    let meridians = rows.map(|rows| meridian(&sphere(rows), steps, true, 0.0));
    let sweep = |y, measure: fn(&[f64]) -> f64| {
        let points = rows.iter().zip(&meridians);
        let points = points.map(|(&rows, values)| (f64::from(rows), measure(values)));
        Sweep::of("rows of the sphere", y, points.collect())
    };
    let [with, without] = [true, false].map(|is_on| {
        let turns = (0..8).map(f64::from);
        let errors = turns.map(|turn| error(&meridian(&sphere(20), steps / 4, is_on, turn)));
        (errors.sum::<f64>() / 8.0).sqrt()
    });
    vec![
        Check::worst(
            "8..64 rows: largest jump of radiance along a meridian, of full light",
            1e-2,
            sweep("largest jump, share of full light", |values| {
                let jumps = values.windows(2).map(|w| (w[1] - w[0]).abs());
                jumps.fold(0.0, f64::max)
            }),
        ),
        Check::worst(
            "8..64 rows: largest rise of radiance towards the dark, of full light",
            1e-3,
            sweep("largest rise, share of full light", |values| {
                let mut least = f64::INFINITY;
                values.iter().fold(0.0, |rise, &value| {
                    least = least.min(value);
                    rise.max(value - least)
                })
            }),
        ),
        Check::at_most(
            "20 rows, 8 meridians: error at the terminator, over that of shadow rays from the facets",
            with / without,
            0.2,
        )
        .noted(format!(
            "RMSE within 12 degrees of it, of full light: {with:.1e} and {without:.1e}"
        )),
        Check::none(
            "8..64 rows, seen from inside: lit points",
            rows.iter().map(|&rows| lit_inside(rows, steps)).sum(),
        ),
        Check::none("flat facets: values that change with the switch", {
            let mut flat = sphere(20);
            let meshes = std::mem::take(&mut flat.meshes).into_iter();
            flat.meshes = meshes.map(without_normals).collect();
            let [with, without] = [true, false].map(|is_on| meridian(&flat, steps, is_on, 0.0));
            let pairs = with.iter().zip(&without);
            pairs.filter(|(a, b)| a.to_bits() != b.to_bits()).count() as u64
        }),
    ]
}

/// A matte sphere of radius 1 with smooth normals in light from afar.
fn sphere(rows: u32) -> Scene {
    let mut scene = Scene::default();
    add_sphere(&mut scene, Vec3::ZERO, 1.0, rows, matte());
    if let Some(mesh) = scene.meshes.pop() {
        let normals = mesh.positions().to_vec();
        scene.meshes.extend(mesh.with_normals(normals));
    }
    add_light(
        &mut scene,
        Light::Distant(DistantLight {
            direction: direction(),
            irradiance: Rgb::WHITE,
            angle_radians: 0.0,
            samples: 1,
        }),
    );
    scene
}

fn without_normals(mut mesh: Mesh) -> Mesh {
    mesh.retain_attributes(Attributes::default());
    mesh
}

fn direction() -> UnitVec3 {
    UnitVec3::normalize(Vec3::new(-1.0, -0.3, -0.2)).unwrap_or(UnitVec3::Z)
}

/// Mean square of what `values`, a meridian, are off from a true sphere's within 12 degrees of the terminator.
fn error(values: &[f64]) -> f64 {
    let steps = (values.len() - 1) as f64;
    let cosines = (0..values.len()).map(|i| (std::f64::consts::PI * i as f64 / steps).cos());
    let squares: Vec<f64> = (values.iter().zip(cosines))
        .filter(|(_, cos)| cos.abs() < 0.2)
        .map(|(value, cos)| (value - cos.max(0.0)).powi(2))
        .collect();
    squares.iter().sum::<f64>() / squares.len() as f64
}

/// Rays from the middle of a sphere that see light on it.
fn lit_inside(rows: u32, rays: u32) -> u64 {
    let scene = sphere(rows);
    let prepared = prepare(&scene, Builder::default()).scene;
    let settings = settings(1, Pattern::Sobol);
    let mut random = Random(83);
    let is_lit = |_: &u32| {
        let way = random.vector();
        !radiance_in(&prepared, 0.1 * random.vector(), way, &settings).is_black()
    };
    (0..rays).filter(is_lit).count() as u64
}

/// Radiance from the lit pole to the dark one, as a share of the brightest, on the meridian that is turned by `turn`
/// radians.
fn meridian(scene: &Scene, steps: u32, is_smooth: bool, turn: f64) -> Vec<f64> {
    let prepared = prepare(scene, Builder::default()).scene;
    let settings = Settings {
        shadow_terminator: is_smooth,
        ..settings(1, Pattern::Sobol)
    };
    let (u, v) = direction().any_orthonormal_pair();
    let across = u * turn.cos() as f32 + v * turn.sin() as f32;
    let values: Vec<f64> = (0..=steps)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / f64::from(steps)).sin_cos();
            let place = -*direction() * cos as f32 + across * sin as f32;
            f64::from(radiance_in(&prepared, 3.0 * place, -place, &settings).g)
        })
        .collect();
    let brightest = values.iter().copied().fold(0.0, f64::max);
    values.iter().map(|value| value / brightest).collect()
}
