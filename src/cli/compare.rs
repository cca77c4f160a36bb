//! `halfshade compare`: how far a picture is from its reference.

use std::path::{Path, PathBuf};

use clap::Args;
use halfshade::output::check_writable;
use halfshade::report::metrics::{Figures, Pair, flip, hdr_flip, worst_pixels};
use halfshade::report::{Picture, read_picture};

use super::Failure;
use super::comparison::{Json, Report};
use super::console::{Console, print, printable};
use super::difference::{self, Difference, Maps};
use super::names::one_of;
use super::targets::check_distinct;
use super::threshold::Threshold;

/// Say how far a picture is from its reference, as figures, a picture or a page
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  halfshade compare quick.exr reference.exr
  halfshade compare quick.png reference.png -o difference.png -o difference.html
  halfshade compare quick.exr reference.exr --json --fail-above relmse=1e-4

PNG is decoded from sRGB; of EXR the channels R, G, B are compared. Pixels that
are not finite in one of the pictures are counted and left out of all figures.

Exit status: 0 done and within the limits, 1 a limit is passed or the job failed,
2 the arguments are wrong.")]
pub struct CompareOptions {
    /// The picture that is measured (.png, .exr)
    a: PathBuf,
    /// Its reference (.png, .exr)
    b: PathBuf,
    /// Write the difference: a .png with a colour bar, or a .html page with both pictures; may be given again
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Which difference a .png shows
    #[arg(long, default_value = Difference::Flip.name(), value_parser = one_of(Difference::ALL, Difference::name))]
    map: Difference,
    /// Fail where rmse, relmse, mae, flip, hdr_flip or non_finite is above a value; may be given again
    #[arg(long, value_name = "METRIC=VALUE", value_parser = Threshold::above)]
    fail_above: Vec<Threshold>,
    /// Fail where psnr or ssim is below a value; may be given again
    #[arg(long, value_name = "METRIC=VALUE", value_parser = Threshold::below)]
    fail_below: Vec<Threshold>,
    /// How many of the worst pixels are listed
    #[arg(long, value_name = "N", default_value_t = 3)]
    worst: usize,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Does what the options say.
pub fn run(options: &CompareOptions) -> Result<(), Failure> {
    let usage = |message: String| Failure::usage("compare", message);
    difference::check_names(&options.output).map_err(usage)?;
    let inputs = [options.a.as_path(), options.b.as_path()];
    check_distinct(&inputs, "one of the pictures", options.output.iter()).map_err(usage)?;
    options
        .output
        .iter()
        .try_for_each(|path| check_writable(path))?;

    let [a, b] = inputs.map(open);
    let (a, b) = (a?, b?);
    let pair = Pair::new(&a, &b).map_err(|error| {
        let [a, b] = inputs.map(Path::display);
        Failure::job(format_args!("{a} and {b}: {error}"))
    })?;
    let maps = Maps {
        flip: flip(&pair),
        hdr_flip: hdr_flip(&pair),
    };
    let report = Report {
        a: options.a.display().to_string(),
        b: options.b.display().to_string(),
        size: pair.size(),
        figures: Figures::with_maps(&pair, &maps.flip, &maps.hdr_flip),
        non_finite: pair.non_finite(),
        worst: worst_pixels(&pair, options.worst),
    };
    for path in &options.output {
        difference::write(path, options.map, [&a, &b], &pair, &maps, &report)?;
    }
    if options.json {
        let json = serde_json::to_string_pretty(&Json::of(&report)).map_err(Failure::job)?;
        print(json)?;
    } else {
        print(printable(&report).trim_end())?;
    }
    check_limits(options, &report.figures)
}

fn open(path: &Path) -> Result<Picture, Failure> {
    let opened = read_picture(path).map_err(Failure::job)?;
    if opened.has_other_primaries {
        Console::default().warn(format_args!(
            "{}: the primaries are not those of Rec. 709; its numbers are compared as they are",
            path.display()
        ));
    }
    Ok(opened.picture)
}

fn check_limits(options: &CompareOptions, figures: &Figures) -> Result<(), Failure> {
    let limits = options.fail_above.iter().chain(&options.fail_below);
    let failures: Vec<String> = limits.filter_map(|limit| limit.failure(figures)).collect();
    if failures.is_empty() {
        return Ok(());
    }
    let name = options.a.display();
    Err(Failure::job(format_args!(
        "{name}: {}",
        failures.join("; ")
    )))
}
