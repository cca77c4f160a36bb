//! The options of `render`.

use std::path::PathBuf;

use clap::Args;
use halfshade::bvh::Builder;
use halfshade::film::Rect;
use halfshade::import::{Pose, SceneOptions};
use halfshade::integrate::Aov;
use halfshade::math::UVec2;
use halfshade::sampling::{Pattern, Target};
use halfshade::scene::{
    IntegratorKind, Keep, MAX_DEPTH, MAX_LIGHT_SAMPLES, MAX_SAMPLES, Needs, Settings, ToneMap,
};

use super::arguments::{self, Exposure, Frames, SampleId};
use super::console::Console;
use super::layers::{GUIDES, LayerKind};
use super::load::ask_for_size;
use super::names::{self, one_of};
use super::targets;

const EXAMPLES: &str = "\
Examples:
  halfshade render scenes/house.toml
      makes house.png
  halfshade render bunny.obj --size 640x480 --samples 16 -o bunny.png -o bunny.exr
      a model by itself gets a camera and lights, which are printed
  halfshade render scenes/house.toml --error 0.02
      as many samples as it takes, where they are needed
  halfshade render scenes/house.toml --time 10
      the best picture that ten seconds give
  halfshade render bunny.obj --orbit 36 --transparent --exposure auto -o bunny.png
      36 pictures from all around, bunny.0001.png and so on, of the bunny alone
  halfshade render walk.glb --frames 0..23 -o walk.png
      a second: walk.0000.png to walk.0023.png
  halfshade render scenes/house.toml --set light.0.angle=0 --crop 100,50,64,64 -o part.exr
      a hard shadow of the sun

Ctrl-C ends the render and saves what there is, with exit status 1.";

/// Render a scene to PNG and EXR files
#[derive(Args, Clone, Debug)]
#[command(after_help = EXAMPLES)]
pub struct RenderOptions {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub sequence: SequenceOptions,
    #[command(flatten)]
    pub picture: PictureOptions,
    #[command(flatten)]
    pub sampling: SamplingOptions,
    #[command(flatten)]
    pub limits: LimitOptions,
    #[command(flatten)]
    pub work: WorkOptions,
    #[command(flatten)]
    pub output: OutputOptions,
    #[command(flatten)]
    pub console: Console,
}

/// What is read.
#[derive(Args, Clone, Debug)]
pub struct SceneArguments {
    /// A scene file (.toml), or a model by itself (.gltf, .glb, .obj)
    pub scene: PathBuf,
    #[command(flatten)]
    pub reading: ReadingOptions,
}

/// How it is read.
#[derive(Args, Clone, Debug)]
pub struct ReadingOptions {
    /// Change a key of the scene file, like light.0.angle=0; may be given again
    #[arg(long, value_name = "PATH=VALUE", value_parser = arguments::assignment)]
    pub set: Vec<(String, String)>,
    /// A picture of the surroundings (.exr, .hdr), in place of the scene's; in path it is light
    #[arg(long, value_name = "FILE")]
    pub environment: Option<PathBuf>,
    /// Show the materials of this variant, in models that have several
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
    /// Refuse files that require an extension that is not known
    #[arg(long)]
    pub strict: bool,
    /// Show animated models at this time after their start [default: at rest]
    #[arg(long, value_name = "SECONDS", group = "moment", value_parser = arguments::seconds)]
    pub time_code: Option<f64>,
    /// Which animation, by its name or its number in the file, counted from 0 [default: the first]
    #[arg(long, value_name = "NAME", requires = "moment")]
    pub animation: Option<String>,
}

/// Many pictures of animated models.
#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "Sequence")]
pub struct SequenceOptions {
    /// Render these frames, first to last, to numbered files like name.0001.png; frame 0 is the start
    #[arg(long, value_name = "A..B", group = "moment", conflicts_with = "replay", value_parser = arguments::frames)]
    pub frames: Option<Frames>,
    /// Frames per second
    #[arg(long, value_name = "N", default_value_t = 24.0, requires = "frames", value_parser = arguments::positive)]
    pub fps: f64,
}

/// Whether anything is left out.
#[derive(Args, Clone, Copy, Debug)]
pub struct KeepOptions {
    /// Leave nothing out that the picture does not need: it is the same, bit for bit
    #[arg(long)]
    keep_all: bool,
}

impl KeepOptions {
    /// What is kept though nothing reads it.
    pub fn keep(self) -> Keep {
        if self.keep_all {
            Keep::EVERYTHING
        } else {
            Keep::NOTHING
        }
    }
}

/// What is seen.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Picture")]
pub struct PictureOptions {
    /// Pixels across and down [default: the scene's, or 1280x720]
    #[arg(long, value_name = "WxH", value_parser = arguments::size)]
    pub size: Option<UVec2>,
    /// Render only this part: upper left pixel, columns, rows [default: all]
    #[arg(long, value_name = "X,Y,W,H", value_parser = arguments::crop)]
    pub crop: Option<Rect>,
    /// Which of the scene's cameras [default: the scene's choice, or the first]
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// Go around the scene once in this many pictures, which are numbered like name.0001.png
    #[arg(long, value_name = "N", conflicts_with_all = ["replay", "time"], value_parser = clap::value_parser!(u32).range(1..=9999))]
    pub orbit: Option<u32>,
    /// The background is seen by nothing but mirrors and glass, and pictures have an opacity [default: what the scene says]
    #[arg(long)]
    pub transparent: bool,
    /// What is computed [default: the scene's, or path for a glTF file by itself, or whitted]
    #[arg(long, value_name = "KIND", value_parser = one_of(IntegratorKind::ALL, IntegratorKind::name))]
    pub integrator: Option<IntegratorKind>,
    /// Scattering events of a path; 1 is direct light only [default: the scene's, or 64
    /// in path and 8 in whitted]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_DEPTH)))]
    pub max_depth: Option<u32>,
    /// Dim light that was scattered more than once to this radiance (path); what that takes away is said
    #[arg(long, value_name = "L", value_parser = arguments::positive)]
    pub clamp: Option<f64>,
    /// Start shadow rays on the triangles of smooth surfaces, though facets show where light ends
    #[arg(long)]
    pub no_shadow_terminator: bool,
}

/// How it is sampled.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Sampling")]
pub struct SamplingOptions {
    /// Camera samples per pixel; under a limit the most on average [default: the scene's, or 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SAMPLES)))]
    pub samples: Option<u32>,
    /// Their layout [default: the scene's, or sobol]
    #[arg(long, value_parser = one_of(Pattern::ALL, Pattern::name))]
    pub pattern: Option<Pattern>,
    /// What part of its pixel they land in [default: the scene's, or rectangle]
    #[arg(long, value_parser = one_of(Target::ALL, Target::name))]
    pub target: Option<Target>,
    /// Shadow rays per light and shading point [default: what each light says, or 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_LIGHT_SAMPLES)))]
    pub light_samples: Option<u32>,
    /// Other seeds give other random numbers [default: the scene's, or 0]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

/// When it ends, and where the samples go.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Limits")]
pub struct LimitOptions {
    /// Stop so that the picture is saved this many seconds after the start, as good as it is then
    #[arg(long, value_name = "SECONDS", value_parser = arguments::positive)]
    pub time: Option<f64>,
    /// Stop when the estimated relative RMSE, the square root of relMSE, is no larger; that is the estimate, not
    /// the upper end of its interval
    #[arg(long, value_name = "R", value_parser = arguments::positive)]
    pub error: Option<f64>,
    /// Samples go where the error is [default: with --time or --error]
    #[arg(long, conflicts_with = "no_adaptive")]
    pub adaptive: bool,
    /// Every pixel gets the same number of samples [default: without --time and --error]
    #[arg(long)]
    pub no_adaptive: bool,
}

impl LimitOptions {
    /// Whether something else than a number of samples ends the render.
    pub fn are_open(&self) -> bool {
        self.time.is_some() || self.error.is_some()
    }

    /// Whether samples go where the error is.
    pub fn is_adaptive(&self) -> bool {
        self.adaptive || (self.are_open() && !self.no_adaptive)
    }
}

/// How the work is done; the picture does not depend on it.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Work")]
pub struct WorkOptions {
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub threads: Option<u16>,
    /// How the tree over the triangles is built; none tests every triangle
    #[arg(long, value_name = "BUILDER", default_value_t, value_parser = names::builder())]
    pub bvh: Builder,
    #[command(flatten)]
    pub keep: KeepOptions,
    /// Refuse to build a tree that would take more memory than this, like 500M or 4G [default: no limit]
    #[arg(long, value_name = "BYTES", value_parser = arguments::bytes)]
    pub max_memory: Option<u64>,
    /// Send rays out of closed meshes through their edges and vertices, and report those that meet nothing
    #[arg(long)]
    pub check_leaks: bool,
    /// Trace one sample of one pixel (column, row, index), print its rays in world coordinates and write no files
    #[arg(long, value_name = "X,Y,I", value_parser = arguments::sample_id)]
    pub replay: Option<SampleId>,
}

/// What is written.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Output")]
pub struct OutputOptions {
    /// A .png or .exr file; may be given again [default: the scene's name with .png, in this folder]
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Stops of exposure; auto brings the middle of the picture, of a sequence the first, to middle grey, and says the number (PNG) [default: 0]
    #[arg(long, value_name = "EV|auto", allow_negative_numbers = true, value_parser = arguments::exposure)]
    pub exposure: Option<Exposure>,
    /// What happens to what is too bright; none clips it (PNG) [default: none]
    #[arg(long, value_parser = one_of(ToneMap::ALL, ToneMap::name))]
    pub tone_map: Option<ToneMap>,
    /// 16 bits a channel (PNG)
    #[arg(long)]
    pub png16: bool,
    /// Take the noise out of the picture with Open Image Denoise, if its library is there; layers keep theirs
    #[arg(long)]
    pub denoise: bool,
    /// Layers beside the picture, with commas between them (EXR)
    #[arg(long, value_delimiter = ',', value_parser = one_of(LayerKind::ALL, LayerKind::name))]
    pub layers: Vec<LayerKind>,
    /// Write what was done, how long it took and a digest of the pixels, as JSON
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
}

impl SceneArguments {
    /// How the scene is imported.
    pub fn import_options(&self) -> SceneOptions {
        self.reading.import_options()
    }
}

impl ReadingOptions {
    /// How the scene is imported.
    pub fn import_options(&self) -> SceneOptions {
        let mut overrides = self.set.clone();
        if let Some(file) = &self.environment {
            // In a scene file paths are relative to its folder.
            let file = std::path::absolute(file).unwrap_or_else(|_| file.clone());
            let value = toml::Value::String(file.to_string_lossy().into_owned());
            let key = "background.environment".to_owned();
            overrides.push((key, value.to_string()));
        }
        SceneOptions {
            is_strict: self.strict,
            variant: self.variant.clone(),
            overrides,
            pose: self.time_code.map(|seconds| Pose {
                seconds,
                animation: self.animation.clone(),
            }),
            ..SceneOptions::default()
        }
    }
}

impl RenderOptions {
    /// How the scene is imported.
    pub fn import_options(&self) -> SceneOptions {
        let mut options = self.scene.import_options();
        options.camera = self.picture.camera.clone();
        if let Some(size) = self.picture.size {
            ask_for_size(&mut options, size);
        }
        options.keep = self.work.keep.keep();
        let aovs = self.output.layers.iter().filter_map(|layer| layer.aov());
        let guides = self.output.denoise.then_some(GUIDES.map(Aov::View));
        let aovs = aovs.chain(guides.into_iter().flatten());
        options.layers = aovs.fold(Needs::default(), |all, aov| all.and(aov.needs()));
        // Not later, with other settings: what neither picture nor layers read is left out at once.
        if let Some(integrator) = self.picture.integrator {
            let kind = format!("{:?}", integrator.name());
            options.overrides.push(("integrator.kind".to_owned(), kind));
        }
        options
    }

    /// The options of one frame of the sequence.
    pub fn of_frame(&self, frame: u32) -> Self {
        let mut options = self.clone();
        options.scene.reading.time_code = Some(f64::from(frame) / self.sequence.fps);
        if options.output.output.is_empty() {
            let name = targets::default_output(&self.scene.scene);
            options.output.output.push(name);
        }
        let outputs = options.output.output.iter_mut();
        for path in outputs.chain(&mut options.output.stats) {
            *path = targets::numbered(path, frame);
        }
        options
    }

    /// Puts what the options say above what the scene says.
    pub fn apply(&self, settings: &mut Settings) {
        fn put<T: Copy>(option: Option<T>, setting: &mut T) {
            if let Some(value) = option {
                *setting = value;
            }
        }
        put(self.picture.integrator, &mut settings.integrator);
        settings.max_depth = self.picture.max_depth.or(settings.max_depth);
        settings.clamp = (self.picture.clamp.map(|c| c as f32)).or(settings.clamp);
        put(self.sampling.samples, &mut settings.sampling.samples);
        put(self.sampling.pattern, &mut settings.sampling.pattern);
        put(self.sampling.target, &mut settings.sampling.target);
        put(self.sampling.seed, &mut settings.sampling.seed);
        settings.shadow_terminator &= !self.picture.no_shadow_terminator;
        settings.transparent |= self.picture.transparent;
        let light_samples = self.sampling.light_samples;
        settings.light_samples = light_samples.or(settings.light_samples);
    }
}
