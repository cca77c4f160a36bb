//! G2: needles and slivers, against exact integer arithmetic.

use rayon::prelude::*;

use crate::bench::Triangles;
use crate::bvh::Bvh;
use crate::math::{DVec3, Ray, UNIT_ROUNDOFF, Vec3};
use crate::stress::meshes::Random;
use crate::stress::{Check, Effort, Sweep};

/// Tries triangles with integer corners, whose exact hits are known, and others up to a width of 1e-40.
pub fn run(effort: Effort) -> Vec<Check> {
    let mut checks = exact(effort.pick(4_000, 60_000));
    checks.push(unharmed(effort.pick(200, 1000)));
    checks
}

/// Aimed at from far away: misses, and errors of `t`.
fn exact(count: u32) -> Vec<Check> {
    let mut random = Random(31);
    let slivers: Vec<_> = (0..count)
        .filter_map(|i| aimed_sliver(4 + i % 20, &mut random))
        .collect();
    // By tree: the error of `t`, `None` of a miss.
    let errors: Vec<_> = slivers
        .par_iter()
        .map(|(corners, ray, exact_t)| {
            let mut mesh = Triangles::default();
            mesh.add(corners.map(vector));
            let error = |(_, tree): &(String, Bvh)| {
                let t = f64::from(tree.closest_hit(ray)?.t);
                Some((t / exact_t - 1.0).abs() / f64::from(UNIT_ROUNDOFF))
            };
            mesh.trees().iter().map(error).collect::<Vec<_>>()
        })
        .collect();
    let tested: usize = errors.iter().map(Vec::len).sum();
    let missed = errors.iter().flatten().filter(|e| e.is_none()).count() as u64;
    // Worst error by decade of the aspect ratio.
    let mut worst = [None::<f64>; 16];
    for ((corners, ..), errors) in slivers.iter().zip(&errors) {
        let worst = &mut worst[(aspect(*corners).log10() as usize).min(15)];
        for &error in errors.iter().flatten() {
            *worst = Some(worst.map_or(error, |w| w.max(error)));
        }
    }
    let points = worst
        .iter()
        .enumerate()
        .filter_map(|(decade, w)| Some((10f64.powi(decade as i32), (*w)?)))
        .collect();
    let sweep = Sweep::of("aspect ratio", "largest error of t, units of 2^-24", points);
    vec![
        Check::none(format!("slivers aimed at: misses of {tested} rays"), missed),
        Check::worst(
            "slivers of aspect 1 to 1e13: error of t / 2^-24",
            8.0,
            sweep,
        ),
    ]
}

/// A sliver, a ray to a point inside of it, and the exact parameter of the hit; `None` where they do not fit
/// into single precision, or f64 could not tell either.
fn aimed_sliver(steps: u32, random: &mut Random) -> Option<([[i64; 3]; 3], Ray, f64)> {
    let corners = sliver(steps, random);
    // The direction is exactly `total` times the way to a point inside, so t is 1 / total.
    let weights = [0, 1, 2].map(|_| 1 + random.below(2) as i64);
    let total: i64 = weights.iter().sum();
    let origin = [0, 1, 2].map(|_| random.below(100_000) as i64 - 50_000);
    let direction = [0, 1, 2].map(|k| {
        (0..3)
            .map(|i| weights[i] * (corners[i][k] - origin[k]))
            .sum::<i64>()
    });
    let is_exact = |p: &[i64; 3]| p.iter().all(|&x| x.abs() < 1 << 24);
    let fits = corners.iter().chain([&direction]).all(is_exact);
    (fits && !is_edge_on(corners, direction)).then(|| {
        let ray = Ray::new(vector(origin), vector(direction));
        (corners, ray, 1.0 / total as f64)
    })
}

/// A triangle with integer corners and twice the area `|e × f|`, a small number, however long
/// its edges: `e` and `f` are consecutive rows of a matrix of determinant 1, embedded in space.
fn sliver(steps: u32, random: &mut Random) -> [[i64; 3]; 3] {
    let (mut e, mut f) = ([1i64, 0], [0i64, 1]);
    for _ in 0..steps {
        let factor = 1 + random.below(3) as i64;
        (e, f) = ([factor * e[0] + f[0], factor * e[1] + f[1]], e);
    }
    let lift = |[x, y]: [i64; 2]| [x, y, x - y];
    let corner = [0, 1, 2].map(|_| random.below(1000) as i64 - 500);
    let mut corners = [corner, plus(corner, lift(e)), plus(corner, lift(f))];
    let axis = random.below(3);
    corners.iter_mut().for_each(|p| p.rotate_left(axis));
    corners
}

fn plus(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [0, 1, 2].map(|k| a[k] + b[k])
}

fn vector(p: [i64; 3]) -> Vec3 {
    Vec3::from(p.map(|x| x as f32))
}

fn double(p: [i64; 3]) -> DVec3 {
    DVec3::from(p.map(|x| x as f64))
}

/// Longest edge over least height.
fn aspect(corners: [[i64; 3]; 3]) -> f64 {
    let [a, b, c] = corners.map(double);
    let longest = (b - a).length().max((c - a).length()).max((c - b).length());
    longest * longest / (b - a).cross(c - a).length()
}

/// Whether the ray runs nearly in the triangle's plane, so that its projection is thinner than
/// the rounding of f64 at the distance of the corners.
fn is_edge_on(corners: [[i64; 3]; 3], direction: [i64; 3]) -> bool {
    let [a, b, c] = corners.map(double);
    let (e, f) = (b - a, c - a);
    let longest = e.length().max(f.length());
    let thickness = (e.cross(f).dot(double(direction).normalize()) / longest).abs();
    thickness < 1e-9
}

/// Soups of slivers of width 1e-3 to 1e-40: hits that are not numbers or outside of their triangle, and
/// trees that do not agree.
fn unharmed(triangles: u32) -> Check {
    let mut random = Random(32);
    let (mut wrong, mut tested) = (0, 0);
    for exponent in 3..=40 {
        let mesh = soup_of_slivers(10f32.powi(-exponent), triangles, &mut random);
        let aimed = (0..mesh.indices.len()).map(|i| {
            let [a, b, c] = mesh.corners(i);
            let origin = random.vector();
            Ray::new(origin, 0.3 * a + 0.3 * b + 0.4 * c - origin)
        });
        let mut rays = mesh.rays(100, exponent as u64);
        rays.extend(aimed);
        let trees = mesh.trees();
        let is_wrong = |ray: &&Ray| {
            let hit = trees[0].1.closest_hit(ray);
            let agree = trees.iter().all(|(_, tree)| tree.closest_hit(ray) == hit);
            let is_sane = hit.is_none_or(|hit| {
                hit.t.is_finite()
                    && hit.u >= 0.0
                    && hit.v >= 0.0
                    && hit.u + hit.v <= 1.0 + f32::EPSILON
            });
            !(agree && is_sane)
        };
        tested += rays.len();
        wrong += rays.par_iter().filter(is_wrong).count() as u64;
    }
    Check::none(
        format!("soups of slivers, widths 1e-3..1e-40: bad hits of {tested} rays"),
        wrong,
    )
}

fn soup_of_slivers(width: f32, triangles: u32, random: &mut Random) -> Triangles {
    let mut mesh = Triangles::default();
    for _ in 0..triangles {
        let (corner, along) = (random.vector(), random.vector());
        mesh.add([
            corner,
            corner + along,
            corner + 0.5 * along + width * random.vector(),
        ]);
        mesh.add([width * random.vector(), along, width * random.vector()]);
    }
    mesh
}
