//! G1: nothing escapes from a closed mesh.

use rayon::prelude::*;

use crate::bench::Triangles;
use crate::bvh::{Builder, Bvh};
use crate::math::{Mat3, Ray, Vec3};
use crate::stress::meshes::{Random, sphere};
use crate::stress::{Check, Effort};

/// Tries bodies of several shapes, at every scale and place, with every tree.
pub fn run(effort: Effort) -> Vec<Check> {
    let shapes = [Vec3::new(1.0, 1e-3, 1.0), Vec3::new(1e-4, 1.0, 1e-3)];
    let flat: Vec<_> = shapes
        .into_iter()
        .flat_map(|shape| {
            let inside = 0.4 * shape * Vec3::new(0.9, -0.8, 0.7);
            let body = |levels| sphere(levels).map(|p| shape * p);
            [(body(3), Vec3::ZERO), (body(2), inside)]
        })
        .collect();
    let centers = [
        Vec3::ZERO,
        Vec3::new(0.9, -0.3, 0.99),
        Vec3::new(0.999, 0.999, -0.999),
    ];
    let boxes: Vec<_> = centers.map(|c| (box_with_t_junctions(), c)).into();
    let mut checks = vec![
        escapes(
            "spheres, scales 1e-6 1 1e6, moved by 0 1e3..1e6 sizes",
            &placed(3),
        ),
        escapes("flat and needle-shaped bodies", &flat),
        escapes("boxes with T-junctions", &boxes),
        escapes("large triangles that meet small ones", &divided()),
        fan(),
    ];
    if let Effort::Full { rays } = effort {
        checks.push(many(rays));
    }
    checks
}

/// Spheres at scales and places.
fn placed(levels: u32) -> Vec<(Triangles, Vec3)> {
    let at = |scale: f32, shift: f32| {
        let center = scale * shift * Vec3::new(1.0, -0.7, 0.4);
        (sphere(levels).map(|p| scale * p + center), center)
    };
    let scales = [1e-6, 1.0, 1e6];
    let shifts = [0.0, 1e3, 1e4, 1e5, 1e6];
    let places = scales
        .into_iter()
        .flat_map(|s| shifts.map(|shift| (s, shift)));
    places.map(|(scale, shift)| at(scale, shift)).collect()
}

/// Directions from `center` at every vertex, edge midpoint, points of edges, and anywhere.
fn directions(mesh: &Triangles, center: Vec3, random: &mut Random) -> Vec<Vec3> {
    let mut directions: Vec<Vec3> = mesh.positions.iter().map(|p| p - center).collect();
    for triangle in 0..mesh.indices.len() {
        let corners = mesh.corners(triangle);
        for k in 0..3 {
            let (p, q) = (corners[k], corners[(k + 1) % 3]);
            let s = random.unit();
            directions.push(0.5 * (p - center) + 0.5 * (q - center));
            directions.push((1.0 - s) * (p - center) + s * (q - center));
        }
    }
    directions.extend((0..2000).map(|_| random.vector()));
    directions.retain(|d| *d != Vec3::ZERO);
    directions
}

/// Rays from a point inside each body that leave it, with every tree; and rays on which
/// `any_hit` and `closest_hit` do not agree.
fn escapes(what: &str, bodies: &[(Triangles, Vec3)]) -> Check {
    let (rays, wrong) = bodies
        .par_iter()
        .map(|(mesh, center)| {
            let directions = directions(mesh, *center, &mut Random(1));
            let wrong = |(name, tree): &(String, Bvh)| {
                // Without a tree every triangle is looked at: nothing new, and slow.
                let tried = if name.starts_with("none") {
                    0
                } else {
                    directions.len()
                };
                let wrong = directions[..tried].iter().filter(|d| {
                    let ray = Ray::new(*center, **d);
                    tree.closest_hit(&ray).is_none() || !tree.any_hit(&ray)
                });
                (tried as u64, wrong.count() as u64)
            };
            mesh.trees().iter().map(wrong).fold((0, 0), add)
        })
        .reduce(|| (0, 0), add);
    Check::none(format!("{what}: escapes of {rays} rays"), wrong)
}

fn add(a: (u64, u64), b: (u64, u64)) -> (u64, u64) {
    (a.0 + b.0, a.1 + b.1)
}

/// A closed box whose faces are grids with T-junctions: each face has its own number of cells.
fn box_with_t_junctions() -> Triangles {
    let mut mesh = Triangles::default();
    for face in 0..6 {
        let cells = 3 + face;
        let axis = face / 2;
        let side = if face % 2 == 0 { -1.0 } else { 1.0 };
        let point = |i: usize, j: usize| {
            let at = |i: usize| -1.0 + 2.0 * (i as f32 / cells as f32);
            let mut p = [side; 3];
            p[(axis + 1) % 3] = at(i);
            p[(axis + 2) % 3] = at(j);
            Vec3::from(p)
        };
        for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
            mesh.add([point(i, j), point(i + 1, j), point(i, j + 1)]);
            mesh.add([point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]);
        }
    }
    mesh
}

/// Slanted triangles of all sizes, which spatial splits cut: a turned icosahedron, some of whose triangles are divided
/// again and again; seen from its middle and aside, at three scales.
fn divided() -> Vec<(Triangles, Vec3)> {
    let turn = Mat3::from_rotation_x(0.3) * Mat3::from_rotation_z(0.7);
    let mut mesh = sphere(0);
    for round in 0..600 {
        let at = mesh.indices.len() - 1 - round % 3;
        let [a, b, c] = mesh.corners(at);
        let [i, j, k] = mesh.indices[at];
        let new = mesh.positions.len() as u32;
        mesh.positions.push((a + b + c) / 3.0);
        mesh.indices[at] = [i, j, new];
        mesh.indices.extend([[j, k, new], [k, i, new]]);
    }
    let scaled = [1e-6, 1.0, 1e6].map(|scale| {
        let mesh = mesh.clone().map(|p| scale * (turn * p));
        let aside = scale * Vec3::new(0.3, -0.2, 0.4);
        [(mesh.clone(), Vec3::ZERO), (mesh, aside)]
    });
    scaled.into_iter().flatten().collect()
}

/// A double cone: 100,000 triangles meet at each tip.
fn fan() -> Check {
    const SIDES: u32 = 100_000;
    let mut mesh = Triangles::default();
    mesh.positions.extend([Vec3::Z, Vec3::NEG_Z]);
    for i in 0..SIDES {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(SIDES);
        mesh.positions
            .push(Vec3::new(angle.cos() as f32, angle.sin() as f32, 0.0));
    }
    for i in 0..SIDES {
        let (p, q) = (2 + i, 2 + (i + 1) % SIDES);
        mesh.indices.extend([[0, p, q], [1, q, p]]);
    }
    let directions = directions(&mesh, Vec3::ZERO, &mut Random(5));
    let tree = mesh.tree(Builder::Balanced);
    let near = |d: &&Vec3| d.x.hypot(d.y) < 1e-3;
    let chosen: Vec<&Vec3> = directions
        .iter()
        .step_by(997)
        .chain(directions.iter().filter(near))
        .collect();
    let escaped = chosen
        .iter()
        .filter(|d| tree.closest_hit(&Ray::new(Vec3::ZERO, ***d)).is_none());
    let what = format!(
        "100,000 triangles at one vertex: escapes of {} rays",
        chosen.len()
    );
    Check::none(what, escaped.count() as u64)
}

/// About `rays` rays in the twenty places of spheres, to random points of edges and, every fourth, to vertices.
fn many(rays: u64) -> Check {
    const BATCH: u64 = 1 << 16;
    let scales = [1e-6, 1e-3, 1.0, 1e3, 1e6f32];
    let shifts = [0.0, 1e3, 1e5, 1e6f32];
    let places: Vec<_> = scales
        .iter()
        .flat_map(|&s| shifts.map(|o| (s, o)))
        .collect();
    let batches = rays.div_ceil(BATCH * places.len() as u64);
    let escaped: u64 = places
        .iter()
        .map(|&(scale, shift)| {
            let center = scale * shift * Vec3::new(1.0, -0.7, 0.4);
            let mesh = sphere(4).map(|p| scale * p + center);
            let tree = mesh.tree(Builder::Balanced);
            let batch = |number| {
                let mut random = Random(number);
                let escaped = (0..BATCH).filter(|i| {
                    let corners = mesh.corners(random.below(mesh.indices.len()));
                    let k = random.below(3);
                    let s = if i % 4 == 0 { 0.0 } else { random.unit() };
                    let (p, q) = (corners[k] - center, corners[(k + 1) % 3] - center);
                    let direction = (1.0 - s) * p + s * q;
                    // Far away, a vertex may round to the centre.
                    direction != Vec3::ZERO && !tree.any_hit(&Ray::new(center, direction))
                });
                escaped.count() as u64
            };
            (0..batches).into_par_iter().map(batch).sum::<u64>()
        })
        .sum();
    let total = batches * BATCH * places.len() as u64;
    let what =
        format!("edges and vertices of spheres, 5 scales, 4 offsets: escapes of {total} rays");
    Check::none(what, escaped)
}
