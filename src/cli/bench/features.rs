//! `halfshade bench features`: what supersampling, soft shadows and the tree cost and bring.

use std::fmt::{self, Display};
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

use clap::Args;
use halfshade::bench::{FeatureCell, FeaturePlan, FeatureReport, bench_features};
use halfshade::import::Imported;
use halfshade::math::UVec2;
use halfshade::scene::{MAX_LIGHT_SAMPLES, MAX_SAMPLES, Settings};
use serde::Serialize;

use crate::cli::Failure;
use crate::cli::arguments;
use crate::cli::console::{Console, print, printable};
use crate::cli::load::{ask_for_size, camera, load_scene};
use crate::cli::options::SceneArguments;
use crate::cli::table::{Table, number};

const COMMAND: &str = "bench features";

const EXAMPLES: &str = "\
Examples:
  halfshade bench features scenes/house.toml --size 320x180
  halfshade bench features bunny.obj --light-samples 16 --seconds 60 --json

A picture that would take longer than --seconds is rendered with fewer samples, and then fewer
pixels, all over it. Its time is scaled up from that, and marked with ~.";

/// Render a scene with and without its features: supersampling, soft shadows, a tree, threads
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct FeatureOptions {
    #[command(flatten)]
    scene: SceneArguments,
    /// Pixels across and down [default: the scene's, or 1280x720]
    #[arg(long, value_name = "WxH", value_parser = arguments::size)]
    size: Option<UVec2>,
    /// Camera samples per pixel, where there is supersampling [default: the scene's, or 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    samples: Option<u32>,
    /// Shadow rays per light and shading point [default: what each light says, or 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_LIGHT_SAMPLES)))]
    light_samples: Option<u32>,
    /// The larger number of threads; the smaller is 1 [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Option<u16>,
    /// Times that every picture is rendered
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    repeats: u16,
    /// Seconds that all repeats of one picture may take, about
    #[arg(long, value_name = "S", default_value_t = 30.0, value_parser = seconds)]
    seconds: f64,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    console: Console,
}

fn seconds(text: &str) -> Result<f64, String> {
    let seconds: Option<f64> = text.trim().parse().ok();
    seconds
        .filter(|&s| s > 0.0 && s <= 1e6)
        .ok_or_else(|| "not a number of seconds above 0 and up to 1000000".to_owned())
}

/// Does what the options say.
pub fn run(options: &FeatureOptions) -> Result<(), Failure> {
    let Imported {
        scene, settings, ..
    } = load(options)?;
    let camera = camera(&scene, &options.scene.scene)?;
    let plan = FeaturePlan {
        repeats: usize::from(options.repeats),
        limit: options.seconds,
        threads: options.threads.map_or_else(
            || available_parallelism().map_or(1, NonZeroUsize::get),
            usize::from,
        ),
    };
    let report = bench_features(&scene, &settings, camera, &plan)?;
    let shown = Shown {
        scene: options.scene.scene.display().to_string(),
        triangles: scene.triangle_count(),
        size: settings.size.to_array(),
        report: &report,
    };
    if options.json {
        print(serde_json::to_string_pretty(&shown).map_err(Failure::job)?)
    } else {
        print(printable(&shown))
    }
}

/// The scene, with settings that follow the options.
fn load(options: &FeatureOptions) -> Result<Imported, Failure> {
    let mut import_options = options.scene.import_options();
    if let Some(size) = options.size {
        ask_for_size(&mut import_options, size);
    }
    let path = &options.scene.scene;
    let mut imported = load_scene(COMMAND, path, &import_options, options.console)?;
    let Settings {
        sampling,
        light_samples,
        ..
    } = &mut imported.settings;
    sampling.samples = options.samples.unwrap_or(sampling.samples);
    *light_samples = options.light_samples.or(*light_samples);
    Ok(imported)
}

/// What scripts may rely on; more keys may come to stand beside these.
#[derive(Serialize)]
struct Shown<'a> {
    scene: String,
    triangles: u64,
    /// Pixels across and down.
    size: [u32; 2],
    #[serde(flatten)]
    report: &'a FeatureReport,
}

impl Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        let (scene, triangles) = (&self.scene, self.triangles);
        let FeatureReport {
            sampling,
            bvh,
            always_soft_lights,
        } = self.report;
        writeln!(f, "{scene}, {triangles} triangles, {width}x{height} pixels")?;
        writeln!(f, "\n{}", sampling_table(sampling))?;
        write!(f, "\n{}", bvh_table(bvh))?;
        let cells = || sampling.iter().chain(bvh);
        if cells().any(is_scaled_up) {
            let least = cells().map(|c| c.measured_share).fold(1.0, f64::min);
            write!(
                f,
                "\n\n~ scaled up from a part of the samples, all over the picture: \
                 {} at least",
                percent(least)
            )?;
        }
        if *always_soft_lights > 0 {
            write!(
                f,
                "\n\nlights with an area of their own, which are never hard: {always_soft_lights}"
            )?;
        }
        Ok(())
    }
}

fn is_scaled_up(cell: &FeatureCell) -> bool {
    cell.measured_share < 1.0
}

fn percent(share: f64) -> String {
    format!("{} %", number(100.0 * share))
}

fn sampling_table(cells: &[FeatureCell]) -> Table {
    let mut table = Table::new(&[
        "shadows", "samples", "threads", "s", "min", "max", "cpu s", "relative", "rays", "Mrays/s",
    ]);
    for cell in cells {
        let shadows = if cell.soft_shadows { "soft" } else { "hard" };
        let mut row = vec![shadows.to_owned(), cell.samples.to_string()];
        row.extend(times(cell, number(cell.ratio)));
        table.row(row);
    }
    table
}

fn bvh_table(cells: &[FeatureCell]) -> Table {
    let mut table = Table::new(&[
        "tree",
        "threads",
        "s",
        "min",
        "max",
        "cpu s",
        "speedup",
        "rays",
        "Mrays/s",
        "prepare s",
    ]);
    for cell in cells {
        let mut row = vec![cell.builder.to_owned()];
        row.extend(times(cell, number(1.0 / cell.ratio)));
        row.push(number(cell.prepare_seconds));
        table.row(row);
    }
    table
}

/// From the number of threads to the rate.
fn times(cell: &FeatureCell, ratio: String) -> Vec<String> {
    let mark = if is_scaled_up(cell) { "~" } else { "" };
    let marked = |text: String| format!("{mark}{text}");
    vec![
        cell.threads.to_string(),
        marked(number(cell.seconds)),
        marked(number(cell.time.wall.min)),
        marked(number(cell.time.wall.max)),
        cell.time
            .processor
            .map_or_else(|| "-".to_owned(), |spread| marked(number(spread.median))),
        marked(ratio),
        marked(cell.rays.to_string()),
        number(cell.mrays_per_second),
    ]
}
