//! `halfshade render`: scene to picture.

use std::env;
use std::f32::consts::TAU;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use halfshade::camera::Camera;
use halfshade::film::{ErrorEstimate, Film, Rect, StoppedBy};
use halfshade::import::Imported;
use halfshade::math::{DVec3, UVec2};
use halfshade::output::automatic_exposure;
use halfshade::output::denoise::{Denoiser, LIBRARY_VARIABLE};
use halfshade::output::exr::Window;
use halfshade::prepare::{Prepared, PreparedScene, prepare_keeping};
use halfshade::render::stability::Stability;
use halfshade::render::{Event, Job, Limits, Significant, render_within, replay};
use halfshade::scene::{LeftOut, Placed, Scene, Settings};

use super::Failure;
use super::arguments::{Exposure, SampleId};
use super::console::{Console, print};
use super::interrupt::Interrupt;
use super::layers::{Kept, LayerValues};
use super::left_out::LeftOutLine;
use super::limits::limits;
use super::load::{camera, load_scene};
use super::memory;
use super::metadata::metadata;
use super::options::RenderOptions;
use super::progress::RenderProgress;
use super::stats::{Done, Seconds, Stats, StepClock};
use super::targets::{Targets, numbered};

/// Rays of `--check-leaks`.
const LEAK_RAYS: u64 = 200_000;

/// Does what the options say.
pub fn run(options: &RenderOptions) -> Result<(), Failure> {
    let interrupt = Interrupt::listen();
    let mut stops = None;
    let Some(frames) = &options.sequence.frames else {
        return run_one(options, &mut stops, &interrupt);
    };
    for frame in frames.all() {
        interrupt.rendering_is_ahead();
        run_one(&options.of_frame(frame), &mut stops, &interrupt)?;
        if interrupt.is_requested().load(Ordering::SeqCst) {
            return Err(Failure::Interrupted);
        }
    }
    Ok(())
}

fn run_one(
    options: &RenderOptions,
    automatic_stops: &mut Option<f32>,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    // All that can be wrong before the work begins.
    let targets = match options.work.replay {
        None => Some(Targets::of(options)?),
        Some(_) => None,
    };
    let threads = options.work.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    pool.install(|| run_on_pool(options, targets.as_ref(), automatic_stops, interrupt))
}

fn run_on_pool(
    options: &RenderOptions,
    targets: Option<&Targets>,
    automatic_stops: &mut Option<f32>,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let mut clock = StepClock::start();
    let mut seconds = Seconds::default();

    let denoiser = denoiser(options)?;
    let mut imported = load(options)?;
    let crop = crop(options, &imported.settings)?;
    let deadline = deadline(options, targets, crop, &clock);
    let limits = limits(options, &mut imported.settings, deadline)?;
    let settings = &imported.settings;
    let camera = camera(&imported.scene, &options.scene.scene)?;
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
    let kept = Kept::of(&options.output, settings, &imported.scene)?;
    let mut work = Work {
        options,
        interrupt,
        imported: &imported,
        prepared: &scene,
        left_out: [imported.left_out.as_slice(), &left_out].concat(),
        crop,
        limits,
        kept,
        denoiser,
        automatic_stops,
        clock,
        seconds,
    };
    let Some(targets) = targets else {
        return replay_one(options, &work.limits, &work.job(camera));
    };
    let Some(count) = options.picture.orbit else {
        return work.picture(camera, targets, None);
    };
    for number in 1..=count {
        interrupt.rendering_is_ahead();
        let camera = orbiting(camera, &imported.scene, (number - 1) as f32 / count as f32);
        work.picture(&camera, &targets.of_number(number), Some(number))?;
        work.begin_again();
    }
    Ok(())
}

/// What all pictures of a scene have in common, and the time that the next one takes.
struct Work<'a> {
    options: &'a RenderOptions,
    interrupt: &'a Interrupt,
    imported: &'a Imported,
    prepared: &'a PreparedScene<'a>,
    left_out: Vec<LeftOut>,
    crop: Rect,
    limits: Limits,
    kept: Kept,
    denoiser: Option<Denoiser>,
    /// What the first picture asked for.
    automatic_stops: &'a mut Option<f32>,
    clock: StepClock,
    seconds: Seconds,
}

impl Work<'_> {
    fn job(&self, camera: &Placed<Camera>) -> Job<'_> {
        Job {
            scene: self.prepared,
            camera: self.prepared.camera(camera),
            settings: &self.imported.settings,
            crop: self.crop,
            layers: self.kept.aovs.clone(),
        }
    }

    /// Renders the picture of `camera`, and writes it to `targets`; `number` is its place in a sequence.
    fn picture(
        &mut self,
        camera: &Placed<Camera>,
        targets: &Targets,
        number: Option<u32>,
    ) -> Result<(), Failure> {
        let (options, imported) = (self.options, self.imported);
        let (settings, console) = (&imported.settings, options.console);
        let job = self.job(camera);
        for entry in &self.left_out {
            console.detail(format_args!("left out: {}", LeftOutLine(entry)));
        }
        memory::check(&job, &options.output.layers)?;
        let film = watched(&job, &self.limits, self.interrupt, console);
        self.seconds.render = self.clock.step();
        let layers = &options.output.layers;
        let mut values = LayerValues::of_film(&film, &self.kept, layers, &imported.scene);
        let error = film.error();
        let mut metadata = metadata(options, settings, &film, error.as_ref());
        if let Some(denoiser) = &self.denoiser {
            let version = values.denoise(denoiser, &film, &self.kept)?;
            metadata.push(("denoised", format!("Open Image Denoise {version}")));
        }
        let window = Window {
            picture: settings.size,
            corner: UVec2::new(self.crop.x, self.crop.y),
            size: self.crop.size(),
        };
        match options.output.exposure {
            Some(Exposure::Automatic) => {
                // The first picture's for all: a sequence must not flicker.
                let stops = *self.automatic_stops.get_or_insert_with(|| {
                    let stops = automatic_exposure(values.picture());
                    console.say(format_args!("note: --exposure {stops} shows the same"));
                    stops
                });
                let targets = targets.exposed(stops);
                targets.write(window, &values, &metadata)?;
            }
            _ => targets.write(window, &values, &metadata)?,
        }
        self.seconds.output = self.clock.step();
        self.seconds.total = self.clock.total();
        let stability = stability(options, self.prepared, &film);
        let done = Done {
            film: &film,
            pixels: values.picture(),
            triangles: imported.scene.triangle_count(),
            seed: settings.sampling.seed,
            seconds: self.seconds,
            error,
            left_out: &self.left_out,
            stability: &stability,
        };
        finish(options, targets, number, &done)
    }

    /// Lets the next picture's time begin.
    fn begin_again(&mut self) {
        self.clock = StepClock::start();
        self.seconds = Seconds::default();
    }
}

/// Open Image Denoise, where it is asked for.
fn denoiser(options: &RenderOptions) -> Result<Option<Denoiser>, Failure> {
    if !options.output.denoise {
        return Ok(None);
    }
    let place = env::var_os(LIBRARY_VARIABLE).map(PathBuf::from);
    let found = Denoiser::find(place.as_deref());
    found.map(Some).map_err(Failure::job)
}

/// `camera` after a share of the way around the middle of `scene`.
fn orbiting(camera: &Placed<Camera>, scene: &Scene, share: f32) -> Placed<Camera> {
    let middle = scene
        .bounds()
        .map_or(DVec3::ZERO, |(min, max)| 0.5 * (min + max));
    let center = (middle - camera.origin).as_vec3();
    Placed {
        item: camera.item.turned(center, share * TAU),
        ..camera.clone()
    }
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
    let path = &options.scene.scene;
    let mut imported = load_scene("render", path, &options.import_options(), options.console)?;
    announce_defaults(options.console, &imported);
    options.apply(&mut imported.settings);
    Ok(imported)
}

/// What was added to a scene that lacked it.
fn announce_defaults(console: Console, imported: &Imported) {
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

fn replay_one(options: &RenderOptions, limits: &Limits, job: &Job) -> Result<(), Failure> {
    let Some(SampleId { pixel, index }) = options.work.replay else {
        return Ok(());
    };
    let size = job.settings.size;
    // Where samples go where the error is, a pixel may have any number of them.
    let samples = match limits.is_open() || limits.is_adaptive {
        true => 1 << 31,
        false => job.settings.sampling.samples_per_pixel(),
    };
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
    say_clamped(console, job.settings, &film);
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

/// What the render says about its own numbers.
fn stability(options: &RenderOptions, scene: &PreparedScene, film: &Film) -> Stability {
    let leaks = options.work.check_leaks.then(|| scene.leaks(LEAK_RAYS));
    Stability::of(scene, film, leaks, command(options).as_deref())
}

/// The command that was given, as a shell reads it.
/// With `--frames` that of the frame alone; `None` with `--orbit`, whose pictures have none.
fn command(options: &RenderOptions) -> Option<String> {
    if options.picture.orbit.is_some() {
        return None;
    }
    let mut arguments: Vec<_> = env::args_os().skip(1).collect();
    if options.sequence.frames.is_some() {
        for option in ["--frames", "--fps"] {
            without(&mut arguments, option);
        }
        let time = options.scene.reading.time_code.unwrap_or(0.0);
        arguments.extend(["--time-code".into(), time.to_string().into()]);
    }
    let quoted = arguments.iter().map(|argument| {
        let argument = argument.to_string_lossy();
        let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+@%".contains(c);
        if !argument.is_empty() && argument.chars().all(is_plain) {
            argument.into_owned()
        } else {
            format!("'{}'", argument.replace('\'', "'\\''"))
        }
    });
    let words: Vec<String> = std::iter::once("halfshade".to_owned())
        .chain(quoted)
        .collect();
    Some(words.join(" "))
}

/// Takes `option` and its value out of `arguments`.
fn without(arguments: &mut Vec<OsString>, option: &str) {
    let joined = format!("{option}=");
    if let Some(at) = arguments.iter().position(|argument| argument == option) {
        arguments.drain(at..(at + 2).min(arguments.len()));
    }
    arguments.retain(|argument| !argument.to_string_lossy().starts_with(&joined));
}

fn say_clamped(console: Console, settings: &Settings, film: &Film) {
    if let Some(clamp) = settings.clamp {
        let percent = 100.0 * film.clamped_share();
        console.say(format_args!(
            "note: the clamp at {clamp} took {} % of the light",
            Significant(percent)
        ));
    }
}

/// Writes the stats and says what was done.
fn finish(
    options: &RenderOptions,
    targets: &Targets,
    number: Option<u32>,
    done: &Done,
) -> Result<(), Failure> {
    let console = options.console;
    if let Some(path) = &options.output.stats {
        let path = number.map_or_else(|| path.clone(), |number| numbered(path, number));
        Stats::of(done).write(&path)?;
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
    say_stability(console, done.stability);
    match done.film.stopped_by {
        StoppedBy::Interrupt => Err(Failure::Interrupted),
        _ => Ok(()),
    }
}

/// The verdict, and what led to it.
fn say_stability(console: Console, stability: &Stability) {
    for line in stability.details() {
        console.detail(line);
    }
    console.say(&stability.verdict);
    if let Some(replay) = &stability.dropped.replay {
        console.say(format_args!("the first dropped sample: {replay}"));
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
