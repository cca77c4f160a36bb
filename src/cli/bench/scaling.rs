//! `halfshade bench bvh --scaling`: how trees grow with the number of triangles.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use halfshade::bench::{Generated, Plan, TreeReport, measure, own_rays};
use halfshade::bvh::Builder;
use halfshade::output::{check_writable, write_whole};
use halfshade::report::plot;
use serde::Serialize;

use super::bvh::COMMAND;
use super::growth::{Growth, charts, csv, growth_table, growths, table};
use crate::cli::Failure;
use crate::cli::console::{Console, print};

/// Triangles of the smallest mesh; each next one has four times as many.
const SMALLEST: u64 = 1_000;
const STEP: u64 = 4;
const LARGEST: u64 = 16_400_000;

/// What the numbers are.
const METHOD: &str = "Medians of repeats. Build times on one thread and all rates are by processor \
                      time: wall time on a machine that does nothing else.";

/// Growth with the number of triangles.
#[derive(Args, Debug)]
#[command(next_help_heading = "Scaling")]
pub struct ScalingOptions {
    /// In place of meshes of yours, measure terrain and spheres of 1,000 to 16 million triangles
    #[arg(long, conflicts_with_all = ["mesh", "rays"])]
    pub scaling: bool,
    /// Where the plot goes, with a .csv and a .md beside it: an .svg file, or a folder [default: scaling.svg]
    #[arg(short, long, value_name = "DIR|FILE.svg")]
    output: Option<PathBuf>,
    /// Leave out larger meshes [default: 16400000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(SMALLEST..))]
    max_triangles: Option<u64>,
}

impl ScalingOptions {
    /// The option that makes no sense without `--scaling`, where one is given.
    pub fn stray(&self) -> Option<&'static str> {
        let output = self.output.as_ref().map(|_| "--output");
        output.or(self.max_triangles.map(|_| "--max-triangles"))
    }
}

/// Does what the options say.
pub fn run(
    options: &ScalingOptions,
    plan: &Plan,
    resolution: u32,
    json: bool,
    console: Console,
) -> Result<(), Failure> {
    if plan.threads.len() > 1 || plan.widths.len() > 1 {
        return Err(Failure::usage(
            COMMAND,
            "--scaling takes one number of threads and one width",
        ));
    }
    if plan.builders.contains(&Builder::None) {
        return Err(Failure::usage(
            COMMAND,
            "--scaling is for trees: without one the large meshes would take hours",
        ));
    }
    let files = Files::of(options)?;
    let reports = measure_all(options, plan, resolution, console, &files)?;
    let growth = growths(&reports);
    if json {
        let all = Scaling {
            measurements: &reports,
            growth: &growth,
        };
        print(serde_json::to_string_pretty(&all).map_err(Failure::job)?)
    } else {
        print(format_args!(
            "{}\n\n{}\n\n{METHOD}",
            table(&reports),
            growth_table(&growth)
        ))
    }
}

#[derive(Serialize)]
struct Scaling<'a> {
    measurements: &'a [TreeReport],
    growth: &'a [Growth],
}

/// Writes the files after each size: the largest take long, and somebody may lose patience.
fn measure_all(
    options: &ScalingOptions,
    plan: &Plan,
    resolution: u32,
    console: Console,
    files: &Files,
) -> Result<Vec<TreeReport>, Failure> {
    let largest = options.max_triangles.unwrap_or(LARGEST);
    let sizes = std::iter::successors(Some(SMALLEST), |size| size.checked_mul(STEP));
    let mut reports = Vec::new();
    for size in sizes.take_while(|&size| size <= largest) {
        for kind in Generated::ALL {
            let triangles = kind.triangles(size as usize);
            console.say(format_args!(
                "{}: {} triangles",
                kind.name(),
                triangles.indices.len()
            ));
            let sets = own_rays(&triangles, resolution)
                .ok_or_else(|| Failure::job("a mesh has nothing that rays could hit"))?;
            reports.extend(measure(kind.name(), &triangles, &sets, plan)?);
        }
        files.write(&reports, &growths(&reports))?;
    }
    Ok(reports)
}

/// The three files that are written.
struct Files {
    svg: PathBuf,
    csv: PathBuf,
    markdown: PathBuf,
}

impl Files {
    /// What the options ask for; every file can be written as far as one can tell.
    fn of(options: &ScalingOptions) -> Result<Self, Failure> {
        let output = options
            .output
            .as_deref()
            .unwrap_or(Path::new("scaling.svg"));
        let is_svg = output
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("svg"));
        if !is_svg {
            fs::create_dir_all(output)
                .map_err(|error| Failure::job(format_args!("{}: {error}", output.display())))?;
        }
        let svg = if is_svg {
            output.to_owned()
        } else {
            output.join("scaling.svg")
        };
        let files = Self {
            csv: svg.with_extension("csv"),
            markdown: svg.with_extension("md"),
            svg,
        };
        for path in [&files.svg, &files.csv, &files.markdown] {
            check_writable(path)?;
        }
        Ok(files)
    }

    fn write(&self, reports: &[TreeReport], growth: &[Growth]) -> Result<(), Failure> {
        let svg = plot::svg(&charts(reports), 3, [400, 300]).map_err(Failure::job)?;
        let markdown = format!(
            "{}\nGrowth with the number of triangles n, as n^exponent, by least squares over the \
             logarithms:\n\n{}\n{}\n",
            table(reports).markdown(),
            growth_table(growth).markdown(),
            METHOD
        );
        for (path, text) in [
            (&self.svg, svg),
            (&self.csv, csv(reports)),
            (&self.markdown, markdown),
        ] {
            write_whole(path, |file| file.write_all(text.as_bytes()))?;
        }
        Ok(())
    }
}
