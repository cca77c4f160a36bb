//! `halfshade converge`: error against run time.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use halfshade::bvh::Builder;
use halfshade::converge::{
    About, Measured, Method, OtherPoint, Plan, Reference, ReferenceReport, Seconds, Study, Subject,
    csv, digest, measure, page, read_curves, svg,
};
use halfshade::import::{Imported, SceneOptions};
use halfshade::math::UVec2;
use halfshade::output::{check_writable, write_whole};
use halfshade::prepare::{Prepared, prepare};
use halfshade::report::metrics::PairError;
use halfshade::sampling::Target;
use halfshade::scene::{MAX_DEPTH, MAX_SAMPLES, Settings};

use super::Failure;
use super::arguments;
use super::console::{Console, print, printable};
use super::curve_tables::tables;
use super::load::{ask_for_size, camera, load_scene};
use super::machine::machine;
use super::names;
use super::options::SceneArguments;
use super::stats::StepClock;

const COMMAND: &str = "converge";

/// Most pixels of a picture, unless a size is asked for.
const MODEST_PIXELS: f64 = 320.0 * 180.0;
/// Samples of the reference for each of the longest curve.
const REFERENCE_FACTOR: u32 = 16;

const EXAMPLES: &str = "\
Examples:
  halfshade converge scenes/penumbra.toml -o curves
  halfshade converge scenes/house.toml -o curves --methods sobol,jittered:16,jittered:81@81
  halfshade converge scenes/house.toml -o curves --methods all --max-samples 1024 --seconds 60

A method is a pattern (grid, jittered, random, sobol), then in any order and with colons: a target
(rectangle, circle), the number of shadow rays per light and shading point (otherwise what each light says), and
adaptive. It is measured with 1, 2, 4, … camera samples, or with N alone where @N follows. The usual ones
are sobol, sobol:adaptive, jittered, random, grid and jittered:81@81, a brute force of 81 × 81 rays; all
are the 32 of every pattern, every target and 1, 4, 16, 81 shadow rays.

In DIR come to stand:
  index.html   everything on one page, which needs no network
  curve.svg    relative RMSE against time, with the slopes -1/2, -3/4, -1 and the Pareto front
  curve.csv    one line a point; what is not known is empty
  curve.json   the same, the slopes, the times to errors, the settings
  reference-TARGET.exr, with its -noise.exr and .json: kept for the next time

--against FILE.csv adds curves from elsewhere. Its first line names the columns, of which it needs
method, seconds and relmse: wall time of a picture, and what
  halfshade compare PICTURE DIR/reference-rectangle.exr
says of it. The noise of the reference is subtracted.";

/// Measure error against run time: which way to sample pays for a scene
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ConvergeOptions {
    #[command(flatten)]
    scene: SceneArguments,
    /// The folder for what comes out; it is made where it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// What is compared, with commas between them [default: the usual ones, see below]
    #[arg(long, value_name = "METHOD,…", value_parser = methods)]
    methods: Option<Methods>,
    /// Most camera samples of a curve
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES / REFERENCE_FACTOR)))]
    max_samples: u32,
    /// Pictures of each point, with different seeds
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,
    /// A curve ends before a picture that would take longer
    #[arg(long, value_name = "S", default_value_t = 10.0, value_parser = arguments::positive)]
    seconds: f64,
    /// Camera samples of the reference [default: 16 times --max-samples]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=i64::from(MAX_SAMPLES)))]
    reference_samples: Option<u32>,
    /// Curves that were measured elsewhere; may be given again
    #[arg(long, value_name = "FILE.csv")]
    against: Vec<PathBuf>,
    /// Pixels across and down [default: the scene's, made smaller to about 320x180]
    #[arg(long, value_name = "WxH", value_parser = arguments::size)]
    size: Option<UVec2>,
    /// Which of the scene's cameras [default: the scene's choice, or the first]
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Scattering events of a path; 1 is direct light only [default: the scene's, or 64
    /// in path and 8 in whitted]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_DEPTH)))]
    max_depth: Option<u32>,
    /// Seed of the reference; those of the methods come after it [default: the scene's, or 0]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// How the tree over the triangles is built
    #[arg(long, value_name = "BUILDER", default_value_t, value_parser = names::builder())]
    bvh: Builder,
    /// Print what curve.json holds
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    console: Console,
}

#[derive(Clone, Debug)]
struct Methods(Vec<Method>);

fn methods(text: &str) -> Result<Methods, String> {
    let mut methods = Vec::new();
    for name in text.split(',') {
        match name.trim() {
            "all" => methods.extend(Method::all()),
            "usual" => methods.extend(Method::usual()),
            name => methods.push(name.parse::<Method>().map_err(|error| error.to_string())?),
        }
    }
    let mut seen = Vec::new();
    methods.retain(|method| {
        let is_new = !seen.contains(method);
        seen.push(*method);
        is_new
    });
    Ok(Methods(methods))
}

/// Does what the options say.
pub fn run(options: &ConvergeOptions) -> Result<(), Failure> {
    let folder = Folder::new(&options.output)?;
    let threads = options.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    let study = pool.install(|| run_on_pool(options, &folder))?;
    options
        .console
        .say(format_args!("{}", folder.path("index.html").display()));
    if options.json {
        print(serde_json::to_string_pretty(&study).map_err(Failure::job)?)
    } else {
        print(printable(tables(&study)))
    }
}

fn run_on_pool(options: &ConvergeOptions, folder: &Folder) -> Result<Study, Failure> {
    let mut clock = StepClock::start();
    let others = against(options)?;
    let Imported {
        scene, settings, ..
    } = load(options)?;
    let placed = camera(&scene, &options.scene.scene)?;
    let mut seconds = Seconds {
        import: clock.step(),
        ..Seconds::default()
    };
    let Prepared {
        scene: prepared,
        warnings,
        left_out: _,
    } = prepare(&scene, options.bvh);
    options.console.warn_all(&warnings);
    seconds.prepare = clock.step();
    let subject = Subject {
        camera: prepared.camera(placed),
        scene: &prepared,
        settings: &settings,
    };
    let plan = plan(options, &settings);
    let digest = digest(&scene, &settings);
    clock.step();
    let references = references(options, folder, &subject, &plan, &digest)?;
    seconds.reference = clock.step();
    let name = options.scene.scene.file_name().unwrap_or_default();
    let [(_, reference), ..] = &references[..] else {
        return Err(Failure::usage(COMMAND, "there is no method"));
    };
    let floor = reference.floors.relmse;
    let mut study = Study {
        scene: name.to_string_lossy().into_owned(),
        digest,
        size: settings.size.to_array(),
        triangles: scene.triangle_count(),
        version: env!("CARGO_PKG_VERSION"),
        machine: machine(),
        settings: told_settings(options, &plan, &settings),
        seconds,
        references: references
            .iter()
            .map(|(_, r)| ReferenceReport::from(r))
            .collect(),
        points: Vec::new(),
        slopes: Vec::new(),
        time_to_error: Vec::new(),
        against: others.into_iter().map(|p| p.above(&floor)).collect(),
        left_out: Vec::new(),
    };
    let measured = measure(&subject, &references, &plan, |samples, measured| {
        let seconds = clock.step();
        options
            .console
            .say(format_args!("{samples} samples: {seconds:.1} s"));
        study.fill(measured);
        folder.write_curves(&study)
    })?;
    study.fill(&measured);
    folder.write_page(&study, &measured)?;
    Ok(study)
}

/// The scene, with settings that follow the options.
fn load(options: &ConvergeOptions) -> Result<Imported, Failure> {
    let mut import_options = SceneOptions {
        camera: options.camera.clone(),
        ..options.scene.import_options()
    };
    if let Some(size) = options.size {
        ask_for_size(&mut import_options, size);
    }
    let path = &options.scene.scene;
    let mut imported = load_scene(COMMAND, path, &import_options, options.console)?;
    let settings = &mut imported.settings;
    settings.max_depth = options.max_depth.or(settings.max_depth);
    if options.size.is_none() {
        settings.size = modest(settings.size);
    }
    Ok(imported)
}

/// The size with the same shape and a modest number of pixels.
fn modest(size: UVec2) -> UVec2 {
    let pixels = f64::from(size.x) * f64::from(size.y);
    let scale = (MODEST_PIXELS / pixels).sqrt().min(1.0);
    let side = |side: u32| (f64::from(side) * scale).round().max(1.0) as u32;
    UVec2::new(side(size.x), side(size.y))
}

fn plan(options: &ConvergeOptions, settings: &Settings) -> Plan {
    let methods = options.methods.clone();
    Plan {
        methods: methods.map_or_else(Method::usual, |methods| methods.0),
        max_samples: options.max_samples,
        repeats: options.repeats,
        seconds: options.seconds,
        seed: options.seed.unwrap_or(settings.sampling.seed),
    }
}

/// A reference for every target that a method has, from the folder or new.
fn references(
    options: &ConvergeOptions,
    folder: &Folder,
    subject: &Subject,
    plan: &Plan,
    digest: &str,
) -> Result<Vec<(Target, Reference)>, Failure> {
    let samples = options
        .reference_samples
        .unwrap_or((REFERENCE_FACTOR * options.max_samples).max(2));
    let is_wanted = |target: &&Target| plan.methods.iter().any(|m| m.target == **target);
    let wanted = Target::ALL.iter().filter(is_wanted);
    wanted
        .map(|&target| {
            let about = About {
                target: target.name().to_owned(),
                digest: digest.to_owned(),
                samples,
                seed: plan.seed,
            };
            if let Some(kept) = Reference::load(&folder.0, &about) {
                return Ok((target, kept));
            }
            options.console.say(format_args!(
                "reference: {samples} samples for each of {}x{} pixels",
                subject.settings.size.x, subject.settings.size.y
            ));
            let reference = subject.reference(about, target).map_err(Failure::job)?;
            reference.save(&folder.0)?;
            Ok((target, reference))
        })
        .collect()
}

/// All that the files hold.
fn against(options: &ConvergeOptions) -> Result<Vec<OtherPoint>, Failure> {
    let files = options.against.iter().map(|path| read_curves(path));
    let points: Result<Vec<_>, _> = files.collect();
    Ok(points.map_err(Failure::job)?.concat())
}

/// What somebody needs to do it again, names and values.
fn told_settings(
    options: &ConvergeOptions,
    plan: &Plan,
    settings: &Settings,
) -> Vec<(String, String)> {
    let methods: Vec<String> = plan.methods.iter().map(Method::to_string).collect();
    let mut told = vec![
        ("methods".to_owned(), methods.join(",")),
        ("max_samples".to_owned(), plan.max_samples.to_string()),
        ("repeats".to_owned(), plan.repeats.to_string()),
        ("seconds".to_owned(), plan.seconds.to_string()),
        ("seed".to_owned(), plan.seed.to_string()),
        ("max_depth".to_owned(), settings.depth().to_string()),
        ("bvh".to_owned(), options.bvh.name().to_owned()),
    ];
    let set = options.scene.reading.set.iter();
    told.extend(set.map(|(path, value)| ("set".to_owned(), format!("{path}={value}"))));
    told
}

impl From<PairError> for Failure {
    fn from(error: PairError) -> Self {
        Self::job(error)
    }
}

/// Where the results go.
struct Folder(PathBuf);

impl Folder {
    /// Makes it; every file can be written as far as one can tell.
    fn new(path: &Path) -> Result<Self, Failure> {
        fs::create_dir_all(path)
            .map_err(|error| Failure::job(format_args!("{}: {error}", path.display())))?;
        let folder = Self(path.to_owned());
        for name in ["index.html", "curve.svg", "curve.csv", "curve.json"] {
            check_writable(&folder.path(name))?;
        }
        Ok(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn write(&self, name: &str, text: &str) -> Result<(), Failure> {
        Ok(write_whole(&self.path(name), |file| {
            file.write_all(text.as_bytes())
        })?)
    }

    /// What a run that is ended leaves: all but the page.
    fn write_curves(&self, study: &Study) -> Result<(), Failure> {
        let json = serde_json::to_string_pretty(study).map_err(Failure::job)?;
        self.write("curve.csv", &csv(&study.points))?;
        self.write("curve.json", &(json + "\n"))?;
        self.write("curve.svg", &svg(study).map_err(Failure::job)?)
    }

    fn write_page(&self, study: &Study, measured: &Measured) -> Result<(), Failure> {
        let plot = svg(study).map_err(Failure::job)?;
        self.write("index.html", &page(study, &measured.views, &plot))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_pictures_become_smaller_in_the_same_shape() {
        assert_eq!(modest(UVec2::new(1280, 720)), UVec2::new(320, 180));
        assert_eq!(modest(UVec2::new(100, 50)), UVec2::new(100, 50));
        assert_eq!(modest(UVec2::new(65536, 1)), UVec2::new(61440, 1));
    }

    #[test]
    fn a_method_that_is_named_twice_is_measured_once() {
        let list = methods("sobol, usual,sobol").map(|methods| methods.0.len());
        assert_eq!(list, Ok(6));
        assert!(methods("sobol,").is_err());
    }
}
