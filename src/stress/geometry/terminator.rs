//! G11: the border between day and night on a coarse sphere with smooth normals.

use crate::bvh::Builder;
use crate::color::Rgb;
use crate::light::{DistantLight, Light};
use crate::math::{UnitVec3, Vec3};
use crate::prepare::prepare;
use crate::sampling::Pattern;
use crate::scene::Scene;
use crate::stress::floor::{matte, settings};
use crate::stress::scenes::{add_light, add_sphere, radiance_in};
use crate::stress::{Check, Effort, Sweep};

/// Why edges of facets show, up to this share of full light.
const SHORTFALL: (f64, &str) = (
    0.05,
    "the horizon of each flat facet cuts the light off, whatever the interpolated normal says",
);

/// Follows meridians of spheres of 8 to 64 rows from the lit pole to the dark one.
pub fn run(effort: Effort) -> Vec<Check> {
    let steps = effort.pick(2_000, 20_000);
    let rows = [8, 16, 32, 64];
    let meridians = rows.map(|rows| meridian(rows, steps));
    let sweep = |y, measure: fn(&[f64]) -> f64| {
        let points = rows.iter().zip(&meridians);
        let points = points.map(|(&rows, values)| (f64::from(rows), measure(values)));
        Sweep::of("rows of the sphere", y, points.collect())
    };
    vec![
        Check::worst(
            "8..64 rows: largest jump of radiance along a meridian, of full light",
            1e-2,
            sweep("largest jump, share of full light", |values| {
                let jumps = values.windows(2).map(|w| (w[1] - w[0]).abs());
                jumps.fold(0.0, f64::max)
            }),
        )
        .or_degraded(SHORTFALL.0, SHORTFALL.1),
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
    ]
}

/// Radiance from the lit pole to the dark one, as a share of the brightest.
fn meridian(rows: u32, steps: u32) -> Vec<f64> {
    let mut scene = Scene::default();
    add_sphere(&mut scene, Vec3::ZERO, 1.0, rows, matte());
    if let Some(mesh) = scene.meshes.pop() {
        let normals = mesh.positions().to_vec();
        scene.meshes.extend(mesh.with_normals(normals));
    }
    let direction = UnitVec3::normalize(Vec3::new(-1.0, -0.3, -0.2)).unwrap_or(UnitVec3::Z);
    add_light(
        &mut scene,
        Light::Distant(DistantLight {
            direction,
            irradiance: Rgb::WHITE,
            angle_radians: 0.0,
            samples: 1,
        }),
    );
    let prepared = prepare(&scene, Builder::default()).scene;
    let settings = settings(1, Pattern::Sobol);
    let across = direction.any_orthonormal_vector();
    let values: Vec<f64> = (0..=steps)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::PI * f64::from(i) / f64::from(steps)).sin_cos();
            let place = -*direction * cos as f32 + across * sin as f32;
            f64::from(radiance_in(&prepared, 3.0 * place, -place, &settings).g)
        })
        .collect();
    let brightest = values.iter().copied().fold(0.0, f64::max);
    values.iter().map(|value| value / brightest).collect()
}
