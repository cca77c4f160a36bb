//! Builds trees over a mesh and traces ray files: `cargo bench --bench bvh -- [MESH.obj RAYS [WIDTH]]`.
//!
//! WIDTH (`avx512`, `avx2` or `portable`) leaves out all but the default builder in that width.
//! RAYS is the common beginning of `RAYS_primary.ray`, `_shadow` (any hit), `_diffuse` and
//! `_random`, in the RAY1 format. Without arguments: a generated terrain and random rays.

use std::hint::black_box;
use std::time::Instant;

use halfshade::bvh::{Builder, Bvh, Hit, TraversalCounts, Width};
use halfshade::math::{Ray, Vec3};

struct RaySet {
    name: &'static str,
    rays: Vec<Ray>,
}

/// Times that each set is traced; the best is printed, for others may use the machine.
const ROUNDS: usize = 3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| a != "--bench")
        .collect();
    let only_width = arguments.get(2);
    let (positions, indices, sets) = match arguments.as_slice() {
        [mesh, rays, ..] => {
            let (positions, indices) = read_obj(&std::fs::read_to_string(mesh)?)?;
            (positions, indices, read_sets(rays)?)
        }
        _ => {
            let (positions, indices) = terrain(1000);
            (positions, indices, vec![random_rays(500_000)])
        }
    };
    for builder in [Builder::Median, Builder::Balanced] {
        for width in Width::available() {
            let name = format!("{width:?}").to_lowercase();
            if only_width.is_some_and(|only| *only != name || builder != Builder::Balanced) {
                continue;
            }
            let start = Instant::now();
            let Some(tree) = Bvh::build_with(&positions, &indices, builder, width) else {
                continue;
            };
            let seconds = start.elapsed().as_secs_f64();
            let bytes = tree.memory_bytes() as f64 / indices.len() as f64;
            let stats = tree.stats();
            println!(
                "{builder}, {width:?}: {seconds:.3} s, {bytes:.1} bytes a triangle, SAH cost {:.2}, \
                 {:.1} children a node, {:.1} triangles a leaf",
                stats.sah_cost, stats.children_per_node, stats.triangles_per_leaf
            );
            for set in &sets {
                println!("  {}", measure(&tree, set));
            }
        }
    }
    Ok(())
}

fn measure(tree: &Bvh, set: &RaySet) -> String {
    let any = set.name == "shadow";
    let mut counts = TraversalCounts::default();
    let (mut hits, mut digest) = (0u64, 0u64);
    for ray in &set.rays {
        hits += u64::from(if any {
            tree.any_hit_counted(ray, &mut counts)
        } else {
            let hit = tree.closest_hit_counted(ray, &mut counts);
            digest = mix(digest, hit.as_ref());
            hit.is_some()
        });
    }
    let mut best = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = processor_seconds();
        for ray in &set.rays {
            if any {
                black_box(tree.any_hit(ray));
            } else {
                black_box(tree.closest_hit(ray));
            }
        }
        best = best.min(processor_seconds() - start);
    }
    let per_ray = |count: u64| count as f64 / set.rays.len() as f64;
    format!(
        "{:8} {:6.2} Mrays/s, {:.2} nodes, {:.2} leaves, {:.2} triangles a ray, {hits} hits, digest {digest:016x}",
        set.name,
        set.rays.len() as f64 / best / 1e6,
        per_ray(counts.nodes),
        per_ray(counts.leaves),
        per_ray(counts.triangles),
    )
}

/// `digest` with every bit of `hit` in it (FNV-1a): equal where two programs find the same.
fn mix(digest: u64, hit: Option<&Hit>) -> u64 {
    let words = hit.map_or([0; 4], |hit| {
        [
            hit.t.to_bits(),
            hit.u.to_bits(),
            hit.v.to_bits(),
            hit.triangle,
        ]
    });
    words.into_iter().fold(digest, |digest, word| {
        (digest ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Processor time of this thread on Linux; wall time elsewhere.
fn processor_seconds() -> f64 {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    let wall = START.get_or_init(Instant::now).elapsed().as_secs_f64();
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next()?.parse::<f64>().ok())
        .map_or(wall, |nanoseconds| 1e-9 * nanoseconds)
}

type Geometry = (Vec<Vec3>, Vec<[u32; 3]>);

/// Vertices and triangles; anything else is passed over.
fn read_obj(text: &str) -> Result<Geometry, Box<dyn std::error::Error>> {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            ["v", x, y, z, ..] => positions.push(Vec3::new(x.parse()?, y.parse()?, z.parse()?)),
            ["f", corners @ ..] => {
                let index = |corner: &&str| -> Result<u32, std::num::ParseIntError> {
                    Ok(corner.split('/').next().unwrap_or("").parse::<u32>()? - 1)
                };
                let corners: Vec<u32> = corners.iter().map(index).collect::<Result<_, _>>()?;
                indices
                    .extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
            }
            _ => {}
        }
    }
    Ok((positions, indices))
}

fn read_sets(prefix: &str) -> Result<Vec<RaySet>, Box<dyn std::error::Error>> {
    let read = |name| -> Result<RaySet, Box<dyn std::error::Error>> {
        let bytes = std::fs::read(format!("{prefix}_{name}.ray"))?;
        let data = bytes.strip_prefix(b"RAY1").ok_or("not a RAY1 file")?;
        let rays = data[4..].chunks_exact(32).map(ray_of).collect();
        Ok(RaySet { name, rays })
    };
    ["primary", "shadow", "diffuse", "random"]
        .into_iter()
        .map(read)
        .collect()
}

fn ray_of(bytes: &[u8]) -> Ray {
    let mut x = [0f32; 8];
    for (x, b) in x.iter_mut().zip(bytes.chunks_exact(4)) {
        *x = f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    }
    Ray {
        origin: Vec3::new(x[0], x[1], x[2]),
        direction: Vec3::new(x[4], x[5], x[6]),
        t_min: x[3],
        t_max: x[7],
    }
}

/// `2 * side²` triangles over the unit square.
fn terrain(side: u32) -> Geometry {
    let grid = (0..=side).flat_map(|i| (0..=side).map(move |j| (i, j)));
    let position = |(i, j): (u32, u32)| {
        let (x, y) = (i as f32 / side as f32, j as f32 / side as f32);
        Vec3::new(x, y, 0.05 * (40.0 * x).sin() * (30.0 * y).cos())
    };
    let cells = (0..side).flat_map(|i| (0..side).map(move |j| i * (side + 1) + j));
    let cut = |a: u32| {
        let b = a + side + 1;
        [[a, b, a + 1], [b, b + 1, a + 1]]
    };
    (grid.map(position).collect(), cells.flat_map(cut).collect())
}

fn random_rays(count: usize) -> RaySet {
    let mut state = 1u64;
    let mut next = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut point = move || Vec3::new(next(), next(), 0.4 * next() - 0.2);
    let rays = (0..count).map(|_| {
        let (origin, target) = (point(), point());
        Ray::new(origin, target - origin)
    });
    RaySet {
        name: "random",
        rays: rays.collect(),
    }
}
