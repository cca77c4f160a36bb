//! `halfshade bench bvh`: trees over meshes, and rays through them.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfshade::bench::{
    Plan, Query, RaySet, TreeReport, Triangles, measure, own_rays, read_rays, width_name,
    write_hits, write_rays,
};
use halfshade::bvh::{Builder, Bvh, Width};
use halfshade::import::SceneOptions;
use halfshade::output::check_writable;

use super::report;
use super::scaling::{self, ScalingOptions};
use crate::cli::Failure;
use crate::cli::console::{Console, print, printable};
use crate::cli::load::load_scene;
use crate::cli::names;

pub const COMMAND: &str = "bench bvh";

const EXAMPLES: &str = "\
Examples:
  halfshade bench bvh bunny.obj
      all builders, on rays of its own: primary, shadow, diffuse, random
  halfshade bench bvh bunny.obj scenes/house.toml --builder balanced,median --threads 1,2 --json
  halfshade bench bvh bunny.obj --width portable --save-rays bunny
  halfshade bench bvh bunny.obj --rays bunny_primary.ray --rays bunny_shadow.ray:any
  halfshade bench bvh bunny.obj --rays bunny_primary.ray --dump-hits hits.bin
  halfshade bench bvh --scaling -o scaling.svg
      makes scaling.svg, scaling.csv and scaling.md

Rates are medians of the repeats. Mrays/cpu s goes by processor time: it is Mrays/s where the
machine does nothing else.

A ray file holds the bytes RAY1, a little-endian u32 count, then per ray eight f32: origin x y z,
t_min, direction x y z, t_max. A hit file holds per ray a u32 triangle (0xffffffff: none) and an f32 t.";

/// Build trees over meshes with every builder, and trace rays through them
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct BvhOptions {
    /// Scene files (.toml) or models (.gltf, .glb, .obj)
    #[arg(required_unless_present = "scaling")]
    mesh: Vec<PathBuf>,
    /// Rays to trace, for the nearest hit or, with :any, for any; may be given again [default: rays of its own]
    #[arg(long, value_name = "FILE[:any]")]
    rays: Vec<RayFile>,
    /// Builders, with commas between them [default: all but none, which tests every triangle]
    #[arg(long, value_name = "BUILDERS", value_delimiter = ',', value_parser = names::builder())]
    builder: Vec<Builder>,
    /// Which vectors the trees are for, with commas between them [default: the widest that the processor has]
    #[arg(long, value_name = "WIDTHS", value_delimiter = ',', value_parser = width())]
    width: Vec<Width>,
    /// Numbers of threads, with commas between them
    #[arg(long, value_name = "N,…", value_delimiter = ',', default_value = "1", value_parser = clap::value_parser!(u16).range(1..=4096))]
    threads: Vec<u16>,
    /// Times that everything is measured [default: 5, or 3 with --scaling]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    repeats: Option<u16>,
    /// Trace neighbouring rays together, as a render does, and not one by one
    #[arg(long)]
    together: bool,
    /// Pixels along each side of the camera that its own rays come from [default: 1024, or 512 with --scaling]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    resolution: Option<u32>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Write what the rays hit; for one mesh and one ray file
    #[arg(long, value_name = "FILE", requires = "rays")]
    dump_hits: Option<PathBuf>,
    /// Write its own rays to PREFIX_primary.ray, _shadow, _diffuse and _random; for one mesh
    #[arg(long, value_name = "PREFIX", conflicts_with_all = ["rays", "scaling"])]
    save_rays: Option<String>,
    #[command(flatten)]
    scaling: ScalingOptions,
    #[command(flatten)]
    console: Console,
}

/// A ray file, and what is asked of its rays.
#[derive(Clone, Debug)]
struct RayFile {
    path: PathBuf,
    query: Query,
}

impl FromStr for RayFile {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (path, query) = match text.strip_suffix(":any") {
            Some(path) => (path, Query::Any),
            None => (text, Query::Closest),
        };
        let path = PathBuf::from(path);
        Ok(Self { path, query })
    }
}

/// Reads the name of a width that this processor can do, and lists them in help and errors.
fn width() -> impl TypedValueParser<Value = Width> {
    let names = Width::available().into_iter().map(width_name);
    PossibleValuesParser::new(names).try_map(|given| {
        let mut widths = Width::available().into_iter();
        widths
            .find(|&width| width_name(width) == given)
            .ok_or("not one of them")
    })
}

/// Does what the options say.
pub fn run(options: &BvhOptions) -> Result<(), Failure> {
    if options.scaling.scaling {
        let plan = plan(options, 3);
        let resolution = options.resolution.unwrap_or(512);
        return scaling::run(
            &options.scaling,
            &plan,
            resolution,
            options.json,
            options.console,
        );
    }
    check(options)?;
    let sets = options.rays.iter().map(read_set);
    let sets: Vec<RaySet> = sets.collect::<Result<_, _>>()?;
    let mut reports = Vec::new();
    for path in &options.mesh {
        let of_mesh = measure_mesh(options, path, &sets)?;
        if !options.json {
            print(printable(report::tables(&of_mesh)))?;
        }
        reports.extend(of_mesh);
    }
    if options.json {
        print(serde_json::to_string_pretty(&reports).map_err(Failure::job)?)?;
    }
    Ok(())
}

/// All that can be wrong before the work begins.
fn check(options: &BvhOptions) -> Result<(), Failure> {
    let usage = |message: &str| Err(Failure::usage(COMMAND, message));
    if options.dump_hits.is_some() && (options.mesh.len(), options.rays.len()) != (1, 1) {
        return usage("--dump-hits is for one mesh and one ray file");
    }
    if let Some(stray) = options.scaling.stray() {
        return usage(&format!("{stray} needs --scaling"));
    }
    if options.save_rays.is_some() && options.mesh.len() != 1 {
        return usage("--save-rays is for one mesh");
    }
    if let Some(path) = &options.dump_hits {
        check_writable(path)?;
    }
    Ok(())
}

fn read_set(file: &RayFile) -> Result<RaySet, Failure> {
    let stem = file.path.file_stem().unwrap_or_default();
    Ok(RaySet {
        name: stem.to_string_lossy().into_owned(),
        file: Some(file.path.clone()),
        query: file.query,
        rays: read_rays(&file.path).map_err(Failure::job)?,
    })
}

fn measure_mesh(
    options: &BvhOptions,
    path: &Path,
    given: &[RaySet],
) -> Result<Vec<TreeReport>, Failure> {
    let triangles = load(options, path)?;
    let own;
    let sets = if given.is_empty() {
        own = rays_of(options, path, &triangles)?;
        own.as_slice()
    } else {
        given
    };
    let plan = plan(options, 5);
    if let (Some(file), Some(set)) = (&options.dump_hits, sets.first()) {
        // Hits are the same with every builder.
        let tree = Bvh::build(&triangles.positions, &triangles.indices, plan.builders[0]);
        write_hits(file, &tree, set)?;
    }
    let name = path.display().to_string();
    Ok(measure(&name, &triangles, sets, &plan)?)
}

fn load(options: &BvhOptions, path: &Path) -> Result<Triangles, Failure> {
    let imported = load_scene(COMMAND, path, &SceneOptions::default(), options.console)?;
    Triangles::of_scene(&imported.scene).ok_or_else(|| {
        let name = path.display();
        Failure::job(format_args!(
            "{name}: holds more triangles than 32 bits can number"
        ))
    })
}

fn rays_of(
    options: &BvhOptions,
    path: &Path,
    triangles: &Triangles,
) -> Result<[RaySet; 4], Failure> {
    let sets = own_rays(triangles, options.resolution.unwrap_or(1024)).ok_or_else(|| {
        let name = path.display();
        Failure::job(format_args!("{name}: holds nothing that rays could hit"))
    })?;
    if let Some(prefix) = &options.save_rays {
        for set in &sets {
            let path = format!("{prefix}_{}.ray", set.name);
            write_rays(Path::new(&path), &set.rays)?;
        }
    }
    Ok(sets)
}

fn plan(options: &BvhOptions, repeats: u16) -> Plan {
    let all_trees = Builder::ALL.into_iter().filter(|b| *b != Builder::None);
    Plan {
        together: options.together,
        builders: match options.builder.as_slice() {
            [] => all_trees.collect(),
            given => given.to_vec(),
        },
        widths: match options.width.as_slice() {
            [] => Width::available()
                .into_iter()
                .next_back()
                .into_iter()
                .collect(),
            given => given.to_vec(),
        },
        threads: options.threads.iter().map(|&n| usize::from(n)).collect(),
        repeats: usize::from(options.repeats.unwrap_or(repeats)),
    }
}
