//! Trees of several builders over one mesh, and rays through them, all in turns.

use std::hint::black_box;
use std::path::PathBuf;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use serde::Serialize;

use crate::bvh::{Builder, Bvh, TraversalCounts, Width};
use crate::math::{ROW, Ray};

use super::{Elapsed, Query, RaySet, Stopwatch, Timing, Triangles};

/// Rays that a thread takes at a time.
const CHUNK: usize = 4096;

/// Trees are built until so many triangles have been in them, but not too often.
const SMALL_BUILDS: usize = 1_000_000;
const MOST_SMALL_BUILDS: usize = 30;

/// What is compared, and how often it is measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Each builds a tree,
    pub builders: Vec<Builder>,
    /// in each of these widths that the processor can do.
    pub widths: Vec<Width>,
    /// Each number of threads builds and traces.
    pub threads: Vec<usize>,
    /// Whether neighbouring rays are traced together, as the renderer does; else one by one.
    pub together: bool,
    /// Times that everything is measured; small trees are built more often.
    pub repeats: usize,
}

/// One builder's tree, built and traced on one number of threads. Times are medians of repeats.
#[derive(Clone, Debug, Serialize)]
pub struct TreeReport {
    /// The mesh, as its owner calls it.
    pub mesh: String,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// The name of the builder.
    pub builder: &'static str,
    /// The name of the width that the tree is laid out for.
    pub width: &'static str,
    /// Threads that built and traced.
    pub threads: usize,
    /// Wall time of the build.
    pub build_seconds: f64,
    /// All that is known of the time of the build.
    pub build: Timing,
    /// Bytes of the tree, its own copies of triangles included.
    pub bytes: usize,
    /// The same for each triangle of the mesh.
    pub bytes_per_triangle: f64,
    /// Expected visits of nodes and leaves by a random line through the tree's box.
    pub sah_cost: f64,
    /// Inner nodes.
    pub nodes: usize,
    /// Blocks of triangles.
    pub leaves: usize,
    /// Levels of inner nodes.
    pub depth: usize,
    /// What rays did in it.
    pub rays: Vec<RayReport>,
}

/// One set of rays through one tree.
#[derive(Clone, Debug, Serialize)]
pub struct RayReport {
    /// What rays they are.
    pub name: String,
    /// Where they were read; `None` where they were made.
    pub file: Option<PathBuf>,
    /// What was asked of them.
    pub kind: Query,
    /// How many there are.
    pub count: usize,
    /// Threads that traced.
    pub threads: usize,
    /// Wall time.
    pub seconds: f64,
    /// All that is known of the time.
    pub time: Timing,
    /// Millions of rays in a second of wall time.
    pub mrays_per_second: f64,
    /// Millions of rays in a second in which every thread has a processor to itself: what
    /// `mrays_per_second` is where the machine does nothing else.
    pub mrays_per_cpu_second: Option<f64>,
    /// Inner nodes that a ray visits, on average.
    pub nodes_per_ray: f64,
    /// Leaves that a ray visits, on average.
    pub leaves_per_ray: f64,
    /// Triangles that come to the exact test, on average.
    pub triangles_per_ray: f64,
    /// Rays that hit something.
    pub hits: u64,
    /// Of every bit of every hit (for `any` of which rays hit): equal for all trees.
    pub digest: String,
}

/// As on the command line and in reports.
pub fn width_name(width: Width) -> &'static str {
    match width {
        Width::Portable => "portable",
        Width::Avx2 => "avx2",
        Width::Avx512 => "avx512",
    }
}

/// A way to build a tree.
type Kind = (Builder, Width);

/// Builds and traces everything of `plan` over `triangles`; a report for each builder, width and
/// number of threads.
///
/// # Errors
/// Where threads cannot be started.
pub fn measure(
    mesh: &str,
    triangles: &Triangles,
    sets: &[RaySet],
    plan: &Plan,
) -> Result<Vec<TreeReport>, ThreadPoolBuildError> {
    let pools: Vec<ThreadPool> = plan
        .threads
        .iter()
        .map(|&threads| ThreadPoolBuilder::new().num_threads(threads).build())
        .collect::<Result<_, _>>()?;
    let widths = Width::available();
    let widths = || plan.widths.iter().filter(|width| widths.contains(width));
    let kinds = plan
        .builders
        .iter()
        .flat_map(|&b| widths().map(move |&w| (b, w)));
    let kinds: Vec<Kind> = kinds.collect();
    let (trees, build_times) = build_all(triangles, plan, &kinds, &pools);
    let surveys: Vec<Vec<Survey>> = trees
        .iter()
        .map(|tree| sets.iter().map(|set| Survey::of(tree, set)).collect())
        .collect();
    let trace_times = trace_all(&trees, sets, plan, &pools);

    let mut reports = Vec::new();
    for (k, tree) in trees.iter().enumerate() {
        for (t, &threads) in plan.threads.iter().enumerate() {
            let rays =
                |s: usize| ray_report(&sets[s], threads, &surveys[k][s], &trace_times[k][t][s]);
            let build = Timing::of(&build_times[k][t]);
            reports.push(TreeReport {
                mesh: mesh.to_owned(),
                threads,
                rays: (0..sets.len()).map(rays).collect(),
                ..tree_report(triangles, kinds[k], tree, build)
            });
        }
    }
    Ok(reports)
}

/// By kind, number of threads and repeat.
type BuildTimes = Vec<Vec<Vec<Elapsed>>>;

fn build_all(
    triangles: &Triangles,
    plan: &Plan,
    kinds: &[Kind],
    pools: &[ThreadPool],
) -> (Vec<Bvh>, BuildTimes) {
    let Triangles { positions, indices } = triangles;
    let mut trees: Vec<Option<Bvh>> = kinds.iter().map(|_| None).collect();
    let mut times = vec![vec![Vec::new(); pools.len()]; kinds.len()];
    // Trees of few triangles are built in less time than threads take to wake.
    let for_small = (SMALL_BUILDS / indices.len().max(1)).min(MOST_SMALL_BUILDS);
    for _ in 0..plan.repeats.max(1).max(for_small) {
        for (t, pool) in pools.iter().enumerate() {
            for (k, &(builder, width)) in kinds.iter().enumerate() {
                // Not two at a time of the same kind.
                trees[k] = None;
                let stopwatch = Stopwatch::start();
                let tree = pool.install(|| Bvh::build_with(positions, indices, builder, width));
                times[k][t].push(stopwatch.read());
                trees[k] = tree;
            }
        }
    }
    (trees.into_iter().flatten().collect(), times)
}

/// By kind, number of threads, ray set and repeat.
type TraceTimes = Vec<Vec<Vec<Vec<Elapsed>>>>;

fn trace_all(trees: &[Bvh], sets: &[RaySet], plan: &Plan, pools: &[ThreadPool]) -> TraceTimes {
    let mut times = vec![vec![vec![Vec::new(); sets.len()]; pools.len()]; trees.len()];
    for _ in 0..plan.repeats.max(1) {
        for (s, set) in sets.iter().enumerate() {
            for (t, pool) in pools.iter().enumerate() {
                for (k, tree) in trees.iter().enumerate() {
                    times[k][t][s].push(pool.install(|| trace(tree, set, plan.together)));
                }
            }
        }
    }
    times
}

/// Traces all rays of `set` on the current thread pool.
fn trace(tree: &Bvh, set: &RaySet, together: bool) -> Elapsed {
    let stopwatch = Stopwatch::start();
    let chunks = set.rays.par_chunks(CHUNK);
    chunks.for_each(|rays| match (set.query, together) {
        (Query::Closest, false) => rays.iter().for_each(|ray| {
            black_box(tree.closest_hit(ray));
        }),
        (Query::Any, false) => rays.iter().for_each(|ray| {
            black_box(tree.any_hit(ray));
        }),
        (Query::Closest, true) => {
            for row in rays.chunks(ROW) {
                black_box(tree.closest_hits(&row.iter().collect()));
            }
        }
        (Query::Any, true) => {
            for row in rays.chunks(ROW) {
                black_box(tree.any_hits(&row.iter().collect()));
            }
        }
    });
    stopwatch.read()
}

/// What rays look at and find: the same whenever it is asked.
struct Survey {
    counts: TraversalCounts,
    hits: u64,
    digest: u64,
}

impl Survey {
    fn of(tree: &Bvh, set: &RaySet) -> Self {
        let parts: Vec<Self> = set
            .rays
            .par_chunks(CHUNK)
            .map(|rays| Self::of_chunk(tree, rays, set.query))
            .collect();
        parts.iter().fold(Self::empty(), |mut all, part| {
            all.counts.nodes += part.counts.nodes;
            all.counts.leaves += part.counts.leaves;
            all.counts.triangles += part.counts.triangles;
            all.hits += part.hits;
            all.mix([part.digest]);
            all
        })
    }

    fn of_chunk(tree: &Bvh, rays: &[Ray], query: Query) -> Self {
        let mut survey = Self::empty();
        for ray in rays {
            let is_hit = match query {
                Query::Any => tree.any_hit_counted(ray, &mut survey.counts),
                Query::Closest => {
                    let hit = tree.closest_hit_counted(ray, &mut survey.counts);
                    if let Some(hit) = hit {
                        let bits = [hit.t, hit.u, hit.v].map(f32::to_bits);
                        survey.mix(bits.into_iter().chain([hit.triangle]).map(u64::from));
                    }
                    hit.is_some()
                }
            };
            survey.mix([u64::from(is_hit)]);
            survey.hits += u64::from(is_hit);
        }
        survey
    }

    fn empty() -> Self {
        Self {
            counts: TraversalCounts::default(),
            hits: 0,
            digest: 0xcbf2_9ce4_8422_2325,
        }
    }

    /// FNV-1a, word by word.
    fn mix(&mut self, words: impl IntoIterator<Item = u64>) {
        for word in words {
            self.digest = (self.digest ^ word).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// All but the mesh's name, the number of threads and the rays.
fn tree_report(
    triangles: &Triangles,
    (builder, width): Kind,
    tree: &Bvh,
    build: Timing,
) -> TreeReport {
    let stats = tree.stats();
    let bytes = tree.memory_bytes();
    TreeReport {
        mesh: String::new(),
        triangles: triangles.indices.len(),
        builder: builder.name(),
        width: width_name(width),
        threads: 0,
        build_seconds: build.wall.median,
        build,
        bytes,
        bytes_per_triangle: bytes as f64 / triangles.indices.len().max(1) as f64,
        sah_cost: stats.sah_cost,
        nodes: stats.nodes,
        leaves: stats.leaves,
        depth: stats.depth,
        rays: Vec::new(),
    }
}

fn ray_report(set: &RaySet, threads: usize, survey: &Survey, repeats: &[Elapsed]) -> RayReport {
    let time = Timing::of(repeats);
    let count = set.rays.len();
    let rate = |seconds: f64| match seconds {
        0.0 => 0.0,
        seconds => count as f64 / seconds / 1e6,
    };
    let per_ray = |total: u64| total as f64 / count.max(1) as f64;
    RayReport {
        name: set.name.clone(),
        file: set.file.clone(),
        kind: set.query,
        count,
        threads,
        seconds: time.wall.median,
        time,
        mrays_per_second: rate(time.wall.median),
        mrays_per_cpu_second: time
            .processor
            .map(|spread| rate(spread.median / threads as f64)),
        nodes_per_ray: per_ray(survey.counts.nodes),
        leaves_per_ray: per_ray(survey.counts.leaves),
        triangles_per_ray: per_ray(survey.counts.triangles),
        hits: survey.hits,
        digest: format!("{:016x}", survey.digest),
    }
}
