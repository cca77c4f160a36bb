//! `cargo bench --bench obj -- [FILE…]`: how long OBJ files take to import, and `tobj` to read, in turn.
//!
//! Without a file it makes two of two million triangles: one with positions alone, one with texture coordinates
//! and normals. `RAYON_NUM_THREADS` sets how many threads there are; `tobj` uses one.

#![allow(clippy::unwrap_used)]

use std::fmt::Write as _;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;

use halfshade::import::{ImportOptions, import_model};

const ROUNDS: usize = 5;

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let mut files: Vec<PathBuf> = std::env::args_os()
        .skip(1)
        .filter(|a| a != "--bench")
        .map(PathBuf::from)
        .collect();
    if files.is_empty() {
        files = ["bare.obj", "complete.obj"]
            .map(|name| folder.path().join(name))
            .into();
        std::fs::write(&files[0], terrain(1000, false)).unwrap();
        std::fs::write(&files[1], terrain(1000, true)).unwrap();
    }
    println!(
        "seconds, median of {ROUNDS}; {} threads",
        rayon::current_num_threads()
    );
    for file in files {
        let bytes = std::fs::metadata(&file).unwrap().len();
        let mut seconds = [Vec::new(), Vec::new()];
        for _ in 0..ROUNDS {
            seconds[0].push(timed(|| {
                import_model(&file, ImportOptions::default()).unwrap()
            }));
            seconds[1].push(timed(|| tobj_reads(&file)));
        }
        let [ours, theirs] = seconds.map(median);
        println!(
            "{}: {} MB, import {ours:.3}, tobj {theirs:.3}, {:.2} times as fast",
            file.display(),
            bytes / 1_000_000,
            theirs / ours
        );
    }
}

/// A surface over a grid of `side` by `side` squares, of two triangles each.
fn terrain(side: usize, has_attributes: bool) -> String {
    let mut text = String::new();
    let height = |x: usize, z: usize| {
        let (x, z) = (x as f64, z as f64);
        8.0 * (0.031 * x).sin() * (0.027 * z).cos() + 0.7 * (0.37 * x + 0.21 * z).sin()
    };
    let points = || (0..=side).flat_map(|z| (0..=side).map(move |x| (x, z)));
    for (x, z) in points() {
        let y = height(x, z);
        writeln!(text, "v {:.6} {y:.6} {:.6}", 0.1 * x as f64, 0.1 * z as f64).unwrap();
    }
    if has_attributes {
        for (x, z) in points() {
            let [u, v] = [x, z].map(|i| i as f64 / side as f64);
            writeln!(text, "vt {u:.6} {v:.6}").unwrap();
        }
        for (x, z) in points() {
            let slope = [height(x + 1, z), height(x, z + 1)].map(|h| (height(x, z) - h) / 0.1);
            let length = (slope[0] * slope[0] + slope[1] * slope[1] + 1.0).sqrt();
            let [nx, ny, nz] = [slope[0], 1.0, slope[1]].map(|n| n / length);
            writeln!(text, "vn {nx:.4} {ny:.4} {nz:.4}").unwrap();
        }
    }
    for z in 0..side {
        for x in 0..side {
            let a = z * (side + 1) + x + 1;
            let [b, c, d] = [a + 1, a + side + 1, a + side + 2];
            for [a, b, c] in [[a, c, b], [b, c, d]] {
                if has_attributes {
                    writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}").unwrap();
                } else {
                    writeln!(text, "f {a} {b} {c}").unwrap();
                }
            }
        }
    }
    text
}

fn tobj_reads(path: &Path) -> Vec<tobj::Model> {
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ..tobj::LoadOptions::default()
    };
    tobj::load_obj(path, &options).unwrap().0
}

/// Seconds that `work` takes; its result is dropped outside.
fn timed<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    let result = black_box(work());
    let seconds = start.elapsed().as_secs_f64();
    drop(result);
    seconds
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
