//! Trees of several builders over one mesh, and rays through them, all in turns.

use std::hint::black_box;
use std::path::PathBuf;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use serde::Serialize;

use crate::bvh::{Builder, Bvh, TraversalCounts};
use crate::math::Ray;

use super::{Elapsed, Query, RaySet, Stopwatch, Timing, Triangles};

/// Rays that a thread takes at a time.
const CHUNK: usize = 4096;

/// Trees are built until so many triangles have been in them, but not too often.
const SMALL_BUILDS: usize = 1_000_000;
const MOST_SMALL_BUILDS: usize = 30;

/// What is compared, and how often it is measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Each builds a tree.
    pub builders: Vec<Builder>,
    /// Each number of threads builds and traces.
    pub threads: Vec<usize>,
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
    /// Threads that built and traced.
    pub threads: usize,
    /// Wall time of the build.
    pub build_seconds: f64,
    /// The least of the repeats.
    pub build_seconds_min: f64,
    /// The greatest of the repeats.
    pub build_seconds_max: f64,
    /// Processor time of the build, all threads; `None` where the system does not say.
    pub build_cpu_seconds: Option<f64>,
    /// The least of the repeats.
    pub build_cpu_seconds_min: Option<f64>,
    /// The greatest of the repeats.
    pub build_cpu_seconds_max: Option<f64>,
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
    /// Wall time, median.
    pub seconds: f64,
    /// The least of the repeats.
    pub seconds_min: f64,
    /// The greatest of the repeats.
    pub seconds_max: f64,
    /// Processor time of all threads, median; `None` where the system does not say.
    pub cpu_seconds: Option<f64>,
    /// The least of the repeats.
    pub cpu_seconds_min: Option<f64>,
    /// The greatest of the repeats.
    pub cpu_seconds_max: Option<f64>,
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

/// Builds and traces everything of `plan` over `triangles`; a report for each builder and number
/// of threads.
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
    let (trees, build_times) = build_all(triangles, plan, &pools);
    let surveys: Vec<Vec<Survey>> = trees
        .iter()
        .map(|tree| sets.iter().map(|set| Survey::of(tree, set)).collect())
        .collect();
    let trace_times = trace_all(&trees, sets, plan, &pools);

    let mut reports = Vec::new();
    for (b, tree) in trees.iter().enumerate() {
        for (t, &threads) in plan.threads.iter().enumerate() {
            let builder = plan.builders[b];
            let timing = Timing::of(&build_times[b][t]);
            let mut report = tree_report(mesh, triangles, builder, threads, tree, timing);
            report.rays = (0..sets.len())
                .map(|s| ray_report(&sets[s], threads, &surveys[b][s], &trace_times[b][t][s]))
                .collect();
            reports.push(report);
        }
    }
    Ok(reports)
}

/// By builder, number of threads and repeat.
type BuildTimes = Vec<Vec<Vec<Elapsed>>>;

fn build_all(triangles: &Triangles, plan: &Plan, pools: &[ThreadPool]) -> (Vec<Bvh>, BuildTimes) {
    let mut trees: Vec<Option<Bvh>> = plan.builders.iter().map(|_| None).collect();
    let mut times = vec![vec![Vec::new(); pools.len()]; plan.builders.len()];
    // Trees of few triangles are built in less time than threads take to wake.
    let for_small = (SMALL_BUILDS / triangles.indices.len().max(1)).min(MOST_SMALL_BUILDS);
    for _ in 0..plan.repeats.max(1).max(for_small) {
        for (t, pool) in pools.iter().enumerate() {
            for (b, &builder) in plan.builders.iter().enumerate() {
                // Not two at a time of the same builder.
                trees[b] = None;
                let stopwatch = Stopwatch::start();
                let tree =
                    pool.install(|| Bvh::build(&triangles.positions, &triangles.indices, builder));
                times[b][t].push(stopwatch.read());
                trees[b] = Some(tree);
            }
        }
    }
    (trees.into_iter().flatten().collect(), times)
}

/// By builder, number of threads, ray set and repeat.
type TraceTimes = Vec<Vec<Vec<Vec<Elapsed>>>>;

fn trace_all(trees: &[Bvh], sets: &[RaySet], plan: &Plan, pools: &[ThreadPool]) -> TraceTimes {
    let mut times = vec![vec![vec![Vec::new(); sets.len()]; pools.len()]; trees.len()];
    for _ in 0..plan.repeats.max(1) {
        for (s, set) in sets.iter().enumerate() {
            for (t, pool) in pools.iter().enumerate() {
                for (b, tree) in trees.iter().enumerate() {
                    times[b][t][s].push(pool.install(|| trace(tree, set)));
                }
            }
        }
    }
    times
}

/// Traces all rays of `set` on the current thread pool.
fn trace(tree: &Bvh, set: &RaySet) -> Elapsed {
    let stopwatch = Stopwatch::start();
    set.rays.par_chunks(CHUNK).for_each(|rays| match set.query {
        Query::Closest => rays.iter().for_each(|ray| {
            black_box(tree.closest_hit(ray));
        }),
        Query::Any => rays.iter().for_each(|ray| {
            black_box(tree.any_hit(ray));
        }),
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

fn tree_report(
    mesh: &str,
    triangles: &Triangles,
    builder: Builder,
    threads: usize,
    tree: &Bvh,
    build: Timing,
) -> TreeReport {
    let stats = tree.stats();
    let bytes = tree.memory_bytes();
    TreeReport {
        mesh: mesh.to_owned(),
        triangles: triangles.indices.len(),
        builder: builder.name(),
        threads,
        build_seconds: build.wall.median,
        build_seconds_min: build.wall.min,
        build_seconds_max: build.wall.max,
        build_cpu_seconds: build.processor.map(|spread| spread.median),
        build_cpu_seconds_min: build.processor.map(|spread| spread.min),
        build_cpu_seconds_max: build.processor.map(|spread| spread.max),
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
    let Timing { wall, processor } = Timing::of(repeats);
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
        seconds: wall.median,
        seconds_min: wall.min,
        seconds_max: wall.max,
        cpu_seconds: processor.map(|spread| spread.median),
        cpu_seconds_min: processor.map(|spread| spread.min),
        cpu_seconds_max: processor.map(|spread| spread.max),
        mrays_per_second: rate(wall.median),
        mrays_per_cpu_second: processor.map(|spread| rate(spread.median / threads as f64)),
        nodes_per_ray: per_ray(survey.counts.nodes),
        leaves_per_ray: per_ray(survey.counts.leaves),
        triangles_per_ray: per_ray(survey.counts.triangles),
        hits: survey.hits,
        digest: format!("{:016x}", survey.digest),
    }
}
