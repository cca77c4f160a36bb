//! `halfshade render`: scene to picture.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use halfshade::camera::Camera;
use halfshade::film::{ErrorEstimate, Film, Rect, StoppedBy};
use halfshade::import::{Imported, import};
use halfshade::math::UVec2;
use halfshade::output::exr::Window;
use halfshade::prepare::{Prepared, prepare_keeping};
use halfshade::render::{self, Event, Job, Limits, Significant, render_within, replay};
use halfshade::scene::{Placed, Scene, Settings};

use super::Failure;
use super::arguments::SampleId;
use super::console::{Console, print};
use super::interrupt::Interrupt;
use super::layers::LayerValues;
use super::left_out::LeftOutLine;
use super::limits::limits;
use super::memory;
use super::metadata::metadata;
use super::options::RenderOptions;
use super::progress::RenderProgress;
use super::stats::{Done, Seconds, Stats, StepClock};
use super::targets::Targets;

/// Does what the options say.
pub fn run(options: &RenderOptions) -> Result<(), Failure> {
    let interrupt = Interrupt::listen();
    let Some(frames) = &options.sequence.frames else {
        return run_one(options, &interrupt);
    };
    for frame in frames.all() {
        interrupt.rendering_is_ahead();
        run_one(&options.of_frame(frame), &interrupt)?;
        if interrupt.is_requested().load(Ordering::SeqCst) {
            return Err(Failure::Interrupted);
        }
    }
    Ok(())
}

fn run_one(options: &RenderOptions, interrupt: &Interrupt) -> Result<(), Failure> {
    // All that can be wrong before the work begins.
    let targets = match options.work.replay {
        None => Some(Targets::of(options)?),
        Some(_) => None,
    };
    let threads = options.work.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    pool.install(|| run_on_pool(options, targets.as_ref(), interrupt))
}

fn run_on_pool(
    options: &RenderOptions,
    targets: Option<&Targets>,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let mut clock = StepClock::start();
    let mut seconds = Seconds::default();

    let mut imported = load(options)?;
    let crop = crop(options, &imported.settings)?;
    let deadline = deadline(options, targets, crop, &clock);
    let limits = limits(options, &mut imported.settings, deadline)?;
    let settings = &imported.settings;
    let camera = camera(options, &imported.scene)?;
    seconds.import = clock.step();

    let limit = options.work.max_memory;
    memory::check_build(&imported.scene, options.work.bvh, limit, options.console)?;
    let Prepared {
        scene,
        warnings,
        left_out,
    } = prepare_keeping(&imported.scene, options.work.bvh, options.work.keep.keep());
    seconds.prepare = clock.step();
    options.console.warn_all(&warnings);
    let views = options.output.layers.iter().filter_map(|kind| kind.view());
    let job = Job {
        camera: scene.camera(camera),
        scene: &scene,
        settings,
        crop,
        layers: views.collect(),
    };
    let Some(targets) = targets else {
        return replay_one(options, &job);
    };

    let mut left_out = [imported.left_out.as_slice(), &left_out].concat();
    left_out.extend(render::left_out(&job));
    for entry in &left_out {
        options
            .console
            .detail(format_args!("left out: {}", LeftOutLine(entry)));
    }

    memory::check(&job, &options.output.layers)?;
    let film = watched(&job, &limits, interrupt, options.console);
    seconds.render = clock.step();
    let values = LayerValues::of_film(&film, &options.output.layers);
    let window = Window {
        picture: settings.size,
        corner: UVec2::new(crop.x, crop.y),
        size: crop.size(),
    };
    targets.write(window, &values, &metadata(options, settings, &film))?;
    seconds.output = clock.step();
    seconds.total = clock.total();
    let done = Done {
        film: &film,
        pixels: values.picture(),
        triangles: imported.scene.triangle_count(),
        seed: settings.sampling.seed,
        seconds,
        error: film.error(),
        left_out: &left_out,
    };
    finish(options, targets, &done)
}

/// When the samples have to be there, so that the files are written in time.
fn deadline(
    options: &RenderOptions,
    targets: Option<&Targets>,
    crop: Rect,
    clock: &StepClock,
) -> Option<Instant> {
    let (seconds, targets) = (options.limits.time?, targets?);
    let writing = targets.writing_seconds(crop.area(), &options.output.layers);
    let rendering = Duration::try_from_secs_f64((seconds - writing).max(0.0)).ok()?;
    clock.begin().checked_add(rendering)
}

/// The scene, with settings that follow the options.
fn load(options: &RenderOptions) -> Result<Imported, Failure> {
    let mut imported = import(&options.scene.scene, &options.import_options())
        .map_err(|error| Failure::of_import("render", &error))?;
    announce(options.console, &imported);
    options.apply(&mut imported.settings);
    Ok(imported)
}

/// The camera that is looked through.
fn camera<'a>(options: &RenderOptions, scene: &'a Scene) -> Result<&'a Placed<Camera>, Failure> {
    scene.cameras.first().ok_or_else(|| {
        let name = options.scene.scene.display();
        Failure::job(format_args!("{name}: there is no camera to look through"))
    })
}

/// Warnings, and what was added to a scene that lacked it.
fn announce(console: Console, imported: &Imported) {
    console.warn_all(&imported.warnings);
    if let Some(defaults) = &imported.defaults {
        let added = match (defaults.cameras, defaults.lights) {
            (0, _) => "no lights: it gets these",
            (_, 0) => "no camera: it gets this",
            _ => "neither camera nor lights: it gets these",
        };
        console.say(format_args!(
            "note: the scene has {added}, to be pasted into a scene file\n\n{}",
            defaults.text
        ));
    }
}

/// The part of the film that is rendered.
fn crop(options: &RenderOptions, settings: &Settings) -> Result<Rect, Failure> {
    let size = settings.size;
    let Some(crop) = options.picture.crop else {
        return Ok(Rect::full(size));
    };
    let fits =
        |start: u32, length: u32, all: u32| u64::from(start) + u64::from(length) <= u64::from(all);
    if fits(crop.x, crop.width, size.x) && fits(crop.y, crop.height, size.y) {
        Ok(crop)
    } else {
        Err(Failure::usage(
            "render",
            format_args!(
                "--crop {},{},{},{} reaches outside the picture of {}x{} pixels",
                crop.x, crop.y, crop.width, crop.height, size.x, size.y
            ),
        ))
    }
}

fn replay_one(options: &RenderOptions, job: &Job) -> Result<(), Failure> {
    let Some(SampleId { pixel, index }) = options.work.replay else {
        return Ok(());
    };
    let size = job.settings.size;
    let samples = job.settings.sampling.samples_per_pixel();
    if pixel.x >= size.x || pixel.y >= size.y || index >= samples {
        return Err(Failure::usage(
            "render",
            format_args!(
                "--replay {},{},{index} is outside the picture of {}x{} pixels with {samples} \
                 samples each, which are counted from 0",
                pixel.x, pixel.y, size.x, size.y
            ),
        ));
    }
    print(replay(job, pixel, index).to_string().trim_end())
}

/// Renders with a progress bar, until it is done or the user has seen enough.
fn watched(job: &Job, limits: &Limits, interrupt: &Interrupt, console: Console) -> Film {
    interrupt.rendering_begins();
    announce_samples(job, limits, console);
    let progress = RenderProgress::new(console.shows_progress());
    let film = render_within(
        job,
        limits,
        interrupt.is_requested(),
        &|event| match event {
            Event::Progress(p) => progress.observe(p),
            Event::Forecast(forecast) => progress.suspend(|| console.say(forecast)),
        },
    );
    if film.stopped_by != StoppedBy::Interrupt {
        interrupt.rendering_is_complete();
    }
    progress.finish();
    say_rejected(console, &film);
    film
}

fn announce_samples(job: &Job, limits: &Limits, console: Console) {
    let asked = job.settings.sampling.samples;
    console.detail(format_args!(
        "rendering {}x{} pixels, {}{} samples each, on {} threads",
        job.crop.width,
        job.crop.height,
        if limits.is_open() { "at most " } else { "" },
        limits.samples,
        rayon::current_num_threads()
    ));
    if *limits == Limits::of(job.settings) && limits.samples != asked {
        console.say(format_args!(
            "note: {asked} samples were asked for; the pattern's cells make it {}",
            limits.samples
        ));
    }
}

fn say_rejected(console: Console, film: &Film) {
    if let Some(first) = film.first_rejected {
        console.warn(format_args!(
            "{} samples were not finite numbers and were left out; \
             --replay {},{},{} shows the first",
            film.rejected, first.pixel.x, first.pixel.y, first.index
        ));
    }
}

/// Writes the stats and says what was done.
fn finish(options: &RenderOptions, targets: &Targets, done: &Done) -> Result<(), Failure> {
    let console = options.console;
    if let Some(path) = &options.output.stats {
        Stats::of(done).write(path)?;
    }
    let rays = done.film.rays;
    console.detail(format_args!(
        "{} triangles; rays: {} camera, {} shadow, {} secondary",
        done.triangles, rays.camera, rays.shadow, rays.secondary
    ));
    let files: Vec<String> = targets.paths().map(|p| p.display().to_string()).collect();
    let size = done.film.size();
    let s = done.seconds;
    console.say(format_args!(
        "{}: {}x{} pixels, {} samples each, {:.2} s (import {:.2}, prepare {:.2}, render {:.2}, output {:.2}){}",
        files.join(", "),
        size.x,
        size.y,
        samples_text(done.film),
        s.total,
        s.import,
        s.prepare,
        s.render,
        s.output,
        done.error.map_or(String::new(), |error| error_text(&error))
    ));
    match done.film.stopped_by {
        StoppedBy::Interrupt => Err(Failure::Interrupted),
        _ => Ok(()),
    }
}

fn samples_text(film: &Film) -> String {
    match film.sample_counts() {
        (min, _, max) if min == max => min.to_string(),
        (min, mean, max) => format!("{min} to {max} (on average {mean:.1})"),
    }
}

/// Like `; estimated relative RMSE 0.0123 (0.0119 to 0.0127)`.
fn error_text(error: &ErrorEstimate) -> String {
    let [estimate, low, high] = [error.estimate, error.low, error.high].map(Significant);
    let doubt = if error.worst_share > 0.5 {
        ", most of it from 0.1 % of the pixels"
    } else {
        ""
    };
    format!("; estimated relative RMSE {estimate} ({low} to {high}{doubt})")
}
