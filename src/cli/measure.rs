//! `info --measure`: how much time is saved by what is left out.
//!
//! The scene is imported, prepared and rendered small, in turns without anything that it does not
//! need and with one kind of it.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use halfshade::bench::{Elapsed, Spread, Stopwatch};
use halfshade::bvh::Builder;
use halfshade::film::Rect;
use halfshade::import::{ImportError, SceneOptions, import};
use halfshade::math::UVec2;
use halfshade::prepare::prepare_keeping;
use halfshade::render::{Job, render};
use halfshade::scene::{Keep, LeftOut, Omission};

/// Turns; the median counts.
const TURNS: usize = 5;
/// Pixels of the picture, at most.
const MOST_PIXELS: u32 = 16_384;
/// Its camera samples per pixel.
const SAMPLES: u32 = 4;

/// Fills in the seconds of `left_out`. What was left out for several reasons shares the seconds of
/// its kind by bytes.
///
/// # Errors
/// Where the scene at `path` cannot be imported any more.
pub fn measure(
    path: &Path,
    options: &SceneOptions,
    left_out: &mut [LeftOut],
) -> Result<(), ImportError> {
    for kind in Omission::ALL {
        let entries = || left_out.iter().filter(|entry| entry.kind == kind);
        let count = entries().count();
        let bytes: u64 = entries().map(|entry| entry.saved_bytes).sum();
        if count == 0 {
            continue;
        }
        let seconds = saving(path, options, kind)?;
        for entry in left_out.iter_mut().filter(|entry| entry.kind == kind) {
            let share = match bytes {
                0 => 1.0 / count as f64,
                bytes => entry.saved_bytes as f64 / bytes as f64,
            };
            entry.saved_seconds = Some(share * seconds);
        }
    }
    Ok(())
}

/// Seconds that leaving `kind` out saves: the median over turns that are taken in pairs.
fn saving(path: &Path, options: &SceneOptions, kind: Omission) -> Result<f64, ImportError> {
    let mut differences = Vec::with_capacity(TURNS);
    for _ in 0..TURNS {
        let without = cost(path, options, Keep::NOTHING)?;
        let with = cost(path, options, Keep::only(kind))?;
        differences.push(with - without);
    }
    Ok(Spread::of(differences).median)
}

/// Processor seconds, or where the system does not tell those of the clock, of everything from
/// the file to a small picture.
fn cost(path: &Path, options: &SceneOptions, keep: Keep) -> Result<f64, ImportError> {
    let options = SceneOptions {
        keep,
        ..options.clone()
    };
    let watch = Stopwatch::start();
    let mut imported = import(path, &options)?;
    imported.settings.size = small(imported.settings.size);
    imported.settings.sampling.samples = SAMPLES;
    let prepared = prepare_keeping(&imported.scene, Builder::default(), keep);
    if let Some(camera) = imported.scene.cameras.first() {
        let job = Job {
            scene: &prepared.scene,
            camera: prepared.scene.camera(camera),
            settings: &imported.settings,
            crop: Rect::full(imported.settings.size),
            layers: Vec::new(),
        };
        render(&job, &AtomicBool::new(false), &|_| {});
    }
    let Elapsed { wall, processor } = watch.read();
    Ok(processor.unwrap_or(wall))
}

/// The largest size of nearly the same shape with few enough pixels.
fn small(size: UVec2) -> UVec2 {
    let pixels = f64::from(size.x) * f64::from(size.y);
    let scale = (f64::from(MOST_PIXELS) / pixels).sqrt().min(1.0);
    let side = |length: u32| ((f64::from(length) * scale) as u32).max(1);
    UVec2::new(side(size.x), side(size.y))
}
