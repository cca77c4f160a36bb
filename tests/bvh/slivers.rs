//! G2: needles and slivers, against exact integer arithmetic.

use glam::Vec3;
use halfshade::math::{Ray, UNIT_ROUNDOFF};

use super::meshes::{Mesh, Random};

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

/// Longest edge over least height.
fn aspect([a, b, c]: [[i64; 3]; 3]) -> f64 {
    let double = |p: [i64; 3]| glam::DVec3::from(p.map(|x| x as f64));
    let (a, b, c) = (double(a), double(b), double(c));
    let longest = (b - a).length().max((c - a).length()).max((c - b).length());
    longest * longest / (b - a).cross(c - a).length()
}

#[test]
fn t_is_right_for_slivers_up_to_aspect_ratios_of_1e12() {
    let mut random = Random(31);
    let mut most = 0.0f64;
    let mut tested = 0;
    for steps in (4..17).cycle().take(4000) {
        let corners = sliver(steps, &mut random);
        most = most.max(aspect(corners));
        // The direction is exactly `total` times the way to a point inside, so t is 1 / total.
        let weights = [0, 1, 2].map(|_| 1 + random.below(2) as i64);
        let total: i64 = weights.iter().sum();
        let origin = [0, 1, 2].map(|_| random.below(100_000) as i64 - 50_000);
        let direction = [0, 1, 2].map(|k| {
            (0..3)
                .map(|i| weights[i] * (corners[i][k] - origin[k]))
                .sum::<i64>()
        });
        let exact = |p: &[i64; 3]| p.iter().all(|&x| x.abs() < 1 << 24);
        if !corners.iter().chain([&direction]).all(exact) || edge_on(corners, direction) {
            continue;
        }
        let mut mesh = Mesh::default();
        mesh.add(corners.map(vector));
        let ray = Ray::new(vector(origin), vector(direction));
        for (name, tree) in mesh.trees() {
            let hit = tree.closest_hit(&ray);
            let hit = hit.unwrap_or_else(|| panic!("{name} misses {corners:?}: {ray:?}"));
            let error = (f64::from(hit.t) * total as f64 - 1.0).abs();
            assert!(
                error <= 8.0 * f64::from(UNIT_ROUNDOFF),
                "{name}: {error}, {corners:?}, {ray:?}"
            );
        }
        tested += 1;
    }
    assert!(
        tested > 3000 && most > 1e12,
        "{tested} slivers, up to {most}"
    );
}

/// Whether the ray runs nearly in the triangle's plane, so that its projection is thinner than
/// the rounding of f64 at the distance of the corners.
fn edge_on([a, b, c]: [[i64; 3]; 3], direction: [i64; 3]) -> bool {
    let double = |p: [i64; 3]| glam::DVec3::from(p.map(|x| x as f64));
    let (e, f) = (double(b) - double(a), double(c) - double(a));
    let longest = e.length().max(f.length());
    let thickness = (e.cross(f).dot(double(direction).normalize()) / longest).abs();
    thickness < 1e-9
}

#[test]
fn slivers_of_any_ratio_neither_crash_nor_make_nan() {
    let mut random = Random(32);
    for exponent in 3..=40 {
        let width = 10f32.powi(-exponent);
        let mut mesh = Mesh::default();
        for _ in 0..200 {
            let (corner, along) = (random.vector(), random.vector());
            mesh.add([
                corner,
                corner + along,
                corner + 0.5 * along + width * random.vector(),
            ]);
            mesh.add([width * random.vector(), along, width * random.vector()]);
        }
        let rays = mesh.rays(100, exponent as u64);
        let aimed = (0..mesh.indices.len()).map(|i| {
            let [a, b, c] = mesh.corners(i);
            let origin = random.vector();
            Ray::new(origin, 0.3 * a + 0.3 * b + 0.4 * c - origin)
        });
        let rays: Vec<Ray> = rays.into_iter().chain(aimed).collect();
        let trees = mesh.trees();
        for ray in rays {
            let hit = trees[0].1.closest_hit(&ray);
            assert!(trees.iter().all(|(_, tree)| tree.closest_hit(&ray) == hit));
            if let Some(hit) = hit {
                assert!(hit.t.is_finite() && hit.u >= 0.0 && hit.v >= 0.0);
                assert!(hit.u + hit.v <= 1.0 + f32::EPSILON, "{hit:?}");
            }
        }
    }
}
