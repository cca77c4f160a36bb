//! G3: input without area, without extent, or with numbers that are none.

use std::io;
use std::path::Path;

use rayon::ThreadPoolBuilder;

use crate::bench::{Stopwatch, Triangles};
use crate::bvh::Builder;
use crate::import::{ImportOptions, import_model};
use crate::math::{Ray, Vec3};
use crate::prepare::prepare;
use crate::stress::meshes::{Random, sphere};
use crate::stress::{Check, Effort, Sweep};

/// Builders whose trees are held to a depth: a median tree and one with splits by cost.
const BUILDERS: [Builder; 2] = [Builder::Median, Builder::Balanced];

/// Levels of nodes that a tree may have: what the traversal's stack holds.
const DEEPEST: f64 = 64.0;

/// Tries files with mistakes, and trees over triangles that cannot be told apart.
pub fn run(effort: Effort) -> Vec<Check> {
    let n = effort.pick(100_000, 1_000_000);
    let (deep, identical_hit) = identical(n);
    let mut checks = files().unwrap_or_else(|error| {
        let check = Check::none("files with mistakes", 1);
        vec![check.refused(format!("no temporary folder: {error}"))]
    });
    checks.extend([
        hidden(),
        Check::at_most(
            format!("{n} identical triangles: depth of the tree"),
            deep,
            DEEPEST,
        ),
        Check::none(
            "identical triangles: rays that do not hit the first",
            identical_hit,
        ),
        Check::at_most(
            "equal centroids: depth of the tree",
            equal_centroids(),
            DEEPEST,
        ),
        Check::at_most("geometric spacing: depth of the tree", spacing(), DEEPEST),
        growth(effort),
    ]);
    checks
}

/// What is wrong with files is named, and what is left out of them is counted.
fn files() -> io::Result<Vec<Check>> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("mistake.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n")?;
    let unnamed = match import_model(&path, ImportOptions::default()) {
        Ok(_) => 1,
        Err(error) => {
            let text = error.to_string();
            u64::from(!(text.contains("mistake.obj") && text.contains("line 5")))
        }
    };
    std::fs::write(
        &path,
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv inf 0 0\nv 2 0 0\n\
         f 1 2 3\nf 4 2 3\nf 1 5 3\nf 1 1 2\nf 1 2 6\n",
    )?;
    let silent = left_out(&path).map_or(4, |named| 4u64.abs_diff(named));
    Ok(vec![
        Check::none(
            "OBJ index out of range: errors without file and line",
            unnamed,
        ),
        Check::none(
            "OBJ with 2 non-finite, 2 flat triangles of 5: left out in silence",
            silent,
        ),
    ])
}

/// How many triangles of a model are reported as left out; `None` where it is refused as a whole.
fn left_out(path: &Path) -> Option<u64> {
    let imported = import_model(path, ImportOptions::default()).ok()?;
    let prepared = prepare(&imported.scene, Builder::default());
    let warnings = imported.warnings.iter().chain(prepared.warnings.iter());
    Some(
        warnings
            .filter(|warning| warning.message.contains("left out"))
            .map(|warning| warning.count)
            .sum(),
    )
}

/// Triangles without area or with bad corners among those of a sphere: rays on which they show.
fn hidden() -> Check {
    let plain = sphere(2);
    let mut random = Random(41);
    let mut mesh = Triangles::default();
    let mut original = Vec::new();
    for i in 0..plain.indices.len() {
        let (p, q) = (random.vector(), random.vector());
        mesh.add([p, p, p]);
        mesh.add([p, q, p]);
        mesh.add([Vec3::splat(f32::NAN), p, q]);
        mesh.add([p, q, Vec3::new(0.0, f32::INFINITY, 0.0)]);
        original.push(mesh.indices.len() as u32);
        mesh.add(plain.corners(i));
    }
    let clean = plain.tree(Builder::Balanced);
    let rays = plain.rays(1000, 42);
    let mut wrong = 0;
    for (_, tree) in mesh.trees() {
        for ray in &rays {
            let expected = clean
                .closest_hit(ray)
                .map(|h| (h.t, original[h.triangle as usize]));
            let found = tree.closest_hit(ray).map(|h| (h.t, h.triangle));
            wrong += u64::from(found != expected);
        }
    }
    Check::none(
        "bad triangles among good ones: rays that see a difference",
        wrong,
    )
}

/// The greatest depth of a tree over `count` identical triangles, and how many trees do not answer with the first.
fn identical(count: usize) -> (f64, u64) {
    let mut mesh = Triangles::default();
    (0..count).for_each(|_| mesh.add([Vec3::X, Vec3::Y, Vec3::Z]));
    let ray = Ray::new(Vec3::ZERO, Vec3::ONE);
    let trees = BUILDERS.map(|builder| mesh.tree(builder));
    let is_wrong = |hit: Option<u32>| u64::from(hit != Some(0));
    let wrong = trees
        .iter()
        .map(|tree| is_wrong(tree.closest_hit(&ray).map(|h| h.triangle)));
    let wrong = wrong.sum();
    let depth = trees.iter().map(|tree| tree.stats().depth).max();
    (depth.map_or(f64::NAN, |depth| depth as f64), wrong)
}

fn deepest(mesh: &Triangles) -> f64 {
    let depths = BUILDERS.map(|builder| mesh.tree(builder).stats().depth);
    depths
        .into_iter()
        .max()
        .map_or(f64::NAN, |depth| depth as f64)
}

/// Triangles whose boxes are all centred on the origin.
fn equal_centroids() -> f64 {
    let mut random = Random(43);
    let mut mesh = Triangles::default();
    for _ in 0..20_000 {
        let a = random.vector();
        mesh.add([a, -a, Vec3::new(a.y, -a.x, 0.0).clamp(-a.abs(), a.abs())]);
    }
    deepest(&mesh)
}

/// Spacing that halves from one triangle to the next drives binned splits to their worst.
fn spacing() -> f64 {
    let mut mesh = Triangles::default();
    for i in 0..200_000 {
        let x = 0.999f32.powi(i % 100_000) * if i < 100_000 { 1.0 } else { 1e-20 };
        mesh.add([
            Vec3::splat(x),
            x * Vec3::new(1.0, 1.001, 1.0),
            x * Vec3::new(1.001, 1.0, 1.0),
        ]);
    }
    for k in 0..127 {
        let x = 2f32.powi(-k);
        (0..17).for_each(|i| mesh.add([x * Vec3::X, x * Vec3::Y, (1.0 + i as f32) * x * Vec3::Z]));
    }
    let depths = mesh.trees().into_iter().map(|(_, tree)| tree.stats().depth);
    depths.max().map_or(f64::NAN, |depth| depth as f64)
}

/// The exponent of the build time in `n log n`, on one thread: 1 as promised, about 1.9 for time in n².
fn growth(effort: Effort) -> Check {
    let largest = effort.pick(160_000, 1_280_000);
    let points = [largest / 16, largest / 4, largest].map(|n| (n as f64, build_seconds(n)));
    let work = |n: f64| n * n.ln();
    let [first, _, last] = points;
    let exponent = (last.1 / first.1).ln() / (work(last.0) / work(first.0)).ln();
    Check::at_most(
        "identical triangles: build time as a power of n log n",
        exponent,
        1.2,
    )
    .shown(Sweep::of("triangles", "seconds", points.into()))
    .noted("1 is n log n, 1.9 would be n²; 0.2 is for the noise of the clock")
}

/// The least of five times.
fn build_seconds(triangles: usize) -> f64 {
    let mut mesh = Triangles::default();
    (0..triangles).for_each(|_| mesh.add([Vec3::X, Vec3::Y, Vec3::Z]));
    let time = || {
        let clock = Stopwatch::start();
        let tree = mesh.tree(Builder::Balanced);
        let elapsed = clock.read();
        drop(tree);
        elapsed.processor.unwrap_or(elapsed.wall)
    };
    let times = || (0..5).map(|_| time()).fold(f64::INFINITY, f64::min);
    // The waiting of idle threads would count as well.
    let pool = ThreadPoolBuilder::new().num_threads(1).build();
    pool.map_or(f64::NAN, |pool| pool.install(times))
}
