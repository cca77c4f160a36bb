//! `halfshade stress`: extreme scenes against their known answers.

use std::path::{Path, PathBuf};

use clap::Args;
use halfshade::import::SceneOptions;
use halfshade::math::UVec2;
use halfshade::output::write_whole;
use halfshade::stress::invariance::{examine, technique};
use halfshade::stress::{Case, Check, Effort, Report, Status, cases, page};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

use super::Failure;
use super::arguments;
use super::console::{Console, print, printable};
use super::load::{ask_for_size, camera, load_scene};
use super::table::{Table, number};

const EXAMPLES: &str = "\
Examples:
  halfshade stress
      all cases, within a minute
  halfshade stress G1 G5 L11 --full -o report
      three of them thoroughly, with report/stress.html
  halfshade stress scenes/house.toml
      a scene scaled, moved, turned, mirrored and shuffled against itself

pass: within the bound; degraded: outside of it by a known shortfall; refused: there is no right
answer; fail: wrong.
A scene is not held against another tracer in double precision, and what the numbers in its files
have lost already does not show.

Exit status: 0 done, 1 a case failed, 2 the arguments are wrong.";

/// Try extreme scenes whose answers are known beforehand
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct StressOptions {
    /// Cases, G1 to G13 (geometry) and L1 to L13 (light), or one scene (.toml, .gltf, .glb, .obj) [default: all cases]
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Pixels across and down, for a scene
    #[arg(long, value_name = "WxH", default_value = "160x120", value_parser = arguments::size)]
    size: UVec2,
    /// Camera samples per pixel, for a scene
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=1024))]
    samples: u32,
    /// More rays, seeds and scales
    #[arg(long)]
    full: bool,
    /// With --full, rays at edges and vertices of closed meshes (G1)
    #[arg(
        long,
        value_name = "N",
        requires = "full",
        default_value_t = 1_000_000_000
    )]
    rays: u64,
    /// Write a page with plots, stress.html, to this folder
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    console: Console,
}

/// Does what the options say.
pub fn run(options: &StressOptions) -> Result<(), Failure> {
    let scene = scene_path(&options.cases)?;
    let chosen = match scene {
        Some(_) => Vec::new(),
        None => chosen(&options.cases)?,
    };
    if let Some(folder) = &options.output {
        std::fs::create_dir_all(folder)
            .map_err(|error| Failure::job(format_args!("{}: {error}", folder.display())))?;
    }
    let effort = if options.full {
        Effort::Full { rays: options.rays }
    } else {
        Effort::Short
    };
    let reports = match scene {
        Some(path) => run_scene(path, options, effort)?,
        None => run_cases(&chosen, effort, options.console),
    };
    show(options, &reports)?;
    verdict(&reports)
}

/// The scene, where one is given; no case has a name like a file's.
fn scene_path(names: &[String]) -> Result<Option<&Path>, Failure> {
    let is_file = |name: &String| name.contains(['.', '/', '\\']);
    match names {
        [name] if is_file(name) => Ok(Some(Path::new(name))),
        _ => match names.iter().find(|name| is_file(name)) {
            Some(name) => Err(Failure::usage(
                "stress",
                format_args!("{name}: a scene is tried alone, without cases and other scenes"),
            )),
            None => Ok(None),
        },
    }
}

/// Holds a scene against itself, as a small picture.
fn run_scene(path: &Path, options: &StressOptions, effort: Effort) -> Result<Vec<Report>, Failure> {
    let UVec2 { x, y } = options.size;
    let mut import_options = SceneOptions::default();
    ask_for_size(&mut import_options, options.size);
    let imported = load_scene("stress", path, &import_options, options.console)?;
    let camera = camera(&imported.scene, path)?;
    let mut settings = imported.settings.clone();
    settings.sampling.samples = options.samples;
    let command = format!(
        "halfshade render {} --integrator {} --size {x}x{y} --samples {}",
        path.display(),
        technique(settings.integrator).name(),
        options.samples
    );
    Ok(examine(
        &imported.scene,
        camera,
        &settings,
        effort,
        &command,
    ))
}

/// The cases of these names; all where there are none.
fn chosen(names: &[String]) -> Result<Vec<&'static Case>, Failure> {
    if names.is_empty() {
        return Ok(cases().collect());
    }
    let find = |name: &String| {
        let mut all = cases();
        all.find(|case| case.id.eq_ignore_ascii_case(name))
            .ok_or_else(|| {
                Failure::usage(
                    "stress",
                    format_args!("there is no case {name}; there are G1 to G13 and L1 to L13"),
                )
            })
    };
    names.iter().map(find).collect()
}

/// One after another, since one of them measures time; each uses all threads.
fn run_cases(chosen: &[&Case], effort: Effort, console: Console) -> Vec<Report> {
    let bar = ProgressBar::new(chosen.len() as u64);
    if console.shows_progress() {
        bar.set_style(
            ProgressStyle::with_template("{msg} {wide_bar} {pos} of {len}, {eta} left")
                .unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        bar.set_draw_target(ProgressDrawTarget::stderr());
    } else {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    let run = |case: &&Case| {
        bar.set_message(case.id);
        let clock = std::time::Instant::now();
        let report = case.run(effort);
        bar.inc(1);
        bar.suspend(|| {
            let seconds = number(clock.elapsed().as_secs_f64());
            console.detail(format_args!("{}: {seconds} s", case.id));
        });
        report
    };
    let reports = chosen.iter().map(run).collect();
    bar.finish_and_clear();
    reports
}

/// Prints the table or JSON, and writes the page.
fn show(options: &StressOptions, reports: &[Report]) -> Result<(), Failure> {
    if options.json {
        let json: Vec<Json> = reports.iter().map(Json::of).collect();
        print(serde_json::to_string_pretty(&json).map_err(Failure::job)?)?;
    } else {
        print(printable(text(reports)))?;
    }
    let Some(folder) = &options.output else {
        return Ok(());
    };
    let html = page("halfshade stress", reports).map_err(Failure::job)?;
    let path = folder.join("stress.html");
    write_whole(&path, |file| {
        std::io::Write::write_all(file, html.as_bytes())
    })?;
    options.console.say(path.display());
    Ok(())
}

/// Fails where a case failed.
fn verdict(reports: &[Report]) -> Result<(), Failure> {
    let is_failed = |report: &&Report| report.status() == Status::Fail;
    let failed: Vec<&str> = reports
        .iter()
        .filter(is_failed)
        .map(|r| r.id.as_str())
        .collect();
    if failed.is_empty() {
        Ok(())
    } else {
        Err(Failure::job(format_args!("failed: {}", failed.join(", "))))
    }
}

/// What scripts may rely on; more keys may come to stand beside these.
#[derive(Serialize)]
struct Json<'a> {
    id: &'a str,
    case: &'a str,
    status: Status,
    /// Of the worst check.
    measured: Option<f64>,
    /// Of the worst check.
    bound: Option<f64>,
    checks: &'a [Check],
}

impl<'a> Json<'a> {
    fn of(report: &'a Report) -> Self {
        let worst = report.worst();
        Self {
            id: &report.id,
            case: &report.case,
            status: report.status(),
            measured: worst.map(|check| check.measured),
            bound: worst.map(|check| check.bound),
            checks: &report.checks,
        }
    }
}

/// Columns of the longest name of a case.
const WIDTH: usize = 9;

/// The table, with the notes below it.
fn text(reports: &[Report]) -> String {
    let mut table = Table::new(&["case", "measured", "bound", "verdict"]);
    let mut notes = String::new();
    for Report { id, checks, .. } in reports {
        for check in checks {
            table.row(vec![
                format!("{id:<WIDTH$} {}", check.tried),
                value(check.measured),
                value(check.bound),
                check.status.name().to_owned(),
            ]);
            if let Some(note) = &check.note {
                notes += &format!("\n  {id:<WIDTH$} {}: {note}", check.tried);
            }
        }
    }
    let gap = if notes.is_empty() { "" } else { "\n" };
    format!("{table}{gap}{notes}")
}

/// Counts are whole numbers.
fn value(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 {
        format!("{value}")
    } else {
        number(value)
    }
}
