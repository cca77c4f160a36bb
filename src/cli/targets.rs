//! The files that `render` writes: checked before the work, written after it.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use halfshade::color::Rgb;
use halfshade::math::UVec2;
use halfshade::output::exr::{self, Layer, Values, Window};
use halfshade::output::png::{self, PngBits, PngOptions};
use halfshade::output::{ImageFormat, OutputError, check_writable};

use super::Failure;
use super::arguments::Exposure;
use super::layers::{LayerKind, LayerValues};
use super::options::{OutputOptions, RenderOptions};

/// Size of the picture that tells how long writing takes.
const REHEARSAL: UVec2 = UVec2::new(128, 64);
/// What making a file takes beside its pixels.
const SECONDS_PER_FILE: f64 = 0.01;

/// The files that a render writes.
pub struct Targets {
    images: Vec<(PathBuf, ImageFormat)>,
    png: PngOptions,
}

impl Targets {
    /// What the options ask for; every file can be written as far as one can tell.
    pub fn of(options: &RenderOptions) -> Result<Self, Failure> {
        let output = &options.output;
        let images = images(options).map_err(usage)?;
        check_combination(output, &images).map_err(usage)?;
        check_stats_name(output.stats.as_deref()).map_err(usage)?;
        let outputs = images.iter().map(|(path, _)| path).chain(&output.stats);
        check_distinct(&[&options.scene.scene], "the scene", outputs).map_err(usage)?;
        for path in images.iter().map(|(path, _)| path).chain(&output.stats) {
            check_writable(path)?;
        }
        let png = PngOptions {
            bits: if output.png16 {
                PngBits::Sixteen
            } else {
                PngBits::Eight
            },
            exposure_ev: match output.exposure {
                Some(Exposure::Stops(stops)) => stops,
                // Not known before the picture is there.
                None | Some(Exposure::Automatic) => 0.0,
            },
            tone_map: output.tone_map.unwrap_or_default(),
        };
        Ok(Self { images, png })
    }

    /// The same with another exposure.
    pub fn exposed(&self, stops: f32) -> Self {
        Self {
            images: self.images.clone(),
            png: PngOptions {
                exposure_ev: stops,
                ..self.png
            },
        }
    }

    /// The files of one picture of a sequence.
    pub fn of_number(&self, number: u32) -> Self {
        let images = self.images.iter();
        Self {
            images: images
                .map(|(path, format)| (numbered(path, number), *format))
                .collect(),
            png: self.png,
        }
    }

    /// Their names.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.images.iter().map(|(path, _)| path.as_path())
    }

    /// About how many seconds it will take to write a picture of `pixels` pixels: measured on a small
    /// one of noise, which no format can shorten.
    pub fn writing_seconds(&self, pixels: u64, layers: &[LayerKind]) -> f64 {
        let picture = rehearsal();
        let start = Instant::now();
        for (_, format) in &self.images {
            // What fails here fails again, and is told of, when the files are written.
            let _ = match format {
                ImageFormat::Png => png::encode(io::sink(), REHEARSAL, &picture, None, self.png),
                ImageFormat::Exr => {
                    let values = || Values::Colors(&picture);
                    let count = layers.iter().map(|kind| kind.width()).sum::<usize>() + 1;
                    let names: Vec<String> = (0..count).map(|i| i.to_string()).collect();
                    let layers: Vec<_> = names
                        .iter()
                        .map(|name| Layer {
                            name,
                            values: values(),
                        })
                        .collect();
                    let file = io::Cursor::new(Vec::new());
                    exr::encode(file, Window::whole(REHEARSAL), &layers, &[])
                }
            };
        }
        let share = pixels as f64 / f64::from(REHEARSAL.x * REHEARSAL.y);
        start.elapsed().as_secs_f64() * share + SECONDS_PER_FILE * self.images.len() as f64
    }

    /// Writes all of them, even where one fails; the first error is returned.
    pub fn write(
        &self,
        window: Window,
        values: &LayerValues,
        metadata: &[(&str, String)],
    ) -> Result<(), OutputError> {
        let attributes = values.attributes();
        let attributes = attributes.iter().map(|(k, v)| (k.as_str(), v.clone()));
        let metadata: Vec<_> = metadata.iter().cloned().chain(attributes).collect();
        let write = |(path, format): &(PathBuf, ImageFormat)| match format {
            ImageFormat::Png => {
                let (picture, alpha) = (values.picture(), values.alpha());
                png::write(path, window.size, picture, alpha, self.png)
            }
            ImageFormat::Exr => exr::write(path, window, &values.layers(), &metadata),
        };
        let results: Vec<_> = self.images.iter().map(write).collect();
        results.into_iter().collect()
    }
}

/// Noise in the range of a picture.
fn rehearsal() -> Vec<Rgb> {
    let mut state = 1_u32;
    let mut next = || {
        // Numerical Recipes' linear congruential generator.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let pixels = (0..REHEARSAL.x * REHEARSAL.y).map(|_| Rgb::new(next(), next(), next()));
    pixels.collect()
}

fn usage(message: String) -> Failure {
    Failure::usage("render", message)
}

/// The pictures that are asked for, each with the format that its name says.
fn images(options: &RenderOptions) -> Result<Vec<(PathBuf, ImageFormat)>, String> {
    let mut paths = options.output.output.clone();
    if paths.is_empty() {
        paths.push(default_output(&options.scene.scene));
    }
    let mut images: Vec<(PathBuf, ImageFormat)> = Vec::new();
    for path in paths {
        let name = path.display();
        let format = ImageFormat::of_path(&path)
            .ok_or_else(|| format!("{name}: pictures are written as .png or .exr"))?;
        if let Some(feature) = format.needed_feature() {
            return Err(format!(
                "{name}: this build cannot write it: it lacks the feature \"{feature}\""
            ));
        }
        images.push((path, format));
    }
    Ok(images)
}

/// A model or a picture that is given to `--stats` by mistake would be overwritten.
fn check_stats_name(stats: Option<&Path>) -> Result<(), String> {
    match stats {
        Some(path)
            if path
                .extension()
                .is_none_or(|e| !e.eq_ignore_ascii_case("json")) =>
        {
            Err(format!("{}: stats are written as .json", path.display()))
        }
        _ => Ok(()),
    }
}

/// No output may replace an input, which is called `what`, or another output, under whatever name.
pub fn check_distinct<'a>(
    inputs: &[&Path],
    what: &str,
    outputs: impl Iterator<Item = &'a PathBuf>,
) -> Result<(), String> {
    let inputs: Vec<PathBuf> = inputs.iter().map(|path| resolved(path)).collect();
    let mut known: Vec<PathBuf> = Vec::new();
    for path in outputs {
        let (name, path) = (path.display(), resolved(path));
        if inputs.contains(&path) {
            return Err(format!("{name}: is {what}, and would be overwritten"));
        }
        if known.contains(&path) {
            return Err(format!("{name}: given twice"));
        }
        known.push(path);
    }
    Ok(())
}

/// The one name of a file, which need not be there yet.
fn resolved(path: &Path) -> PathBuf {
    let in_folder = || {
        let folder = match path.parent()? {
            folder if folder.as_os_str().is_empty() => Path::new("."),
            folder => folder,
        };
        Some(folder.canonicalize().ok()?.join(path.file_name()?))
    };
    let there = path.canonicalize().ok();
    there.or_else(in_folder).unwrap_or_else(|| path.to_owned())
}

/// Options that no file could follow are mistakes.
fn check_combination(
    output: &OutputOptions,
    images: &[(PathBuf, ImageFormat)],
) -> Result<(), String> {
    let layers = &output.layers;
    if (1..layers.len()).any(|i| layers[..i].contains(&layers[i])) {
        return Err("--layers names a layer twice".to_owned());
    }
    for (is_given, option, format, extension) in [
        (!layers.is_empty(), "--layers", ImageFormat::Exr, ".exr"),
        (
            output.exposure.is_some(),
            "--exposure",
            ImageFormat::Png,
            ".png",
        ),
        (
            output.tone_map.is_some(),
            "--tone-map",
            ImageFormat::Png,
            ".png",
        ),
        (output.png16, "--png16", ImageFormat::Png, ".png"),
    ] {
        if is_given && !images.iter().any(|(_, other)| *other == format) {
            return Err(format!(
                "{option} needs a file that ends in {extension} among the outputs"
            ));
        }
    }
    Ok(())
}

/// The scene's name with `.png`, in the current folder.
pub fn default_output(scene: &Path) -> PathBuf {
    let name = scene.file_stem().unwrap_or(scene.as_os_str());
    let mut name = name.to_owned();
    name.push(".png");
    PathBuf::from(name)
}

/// The file of one picture of a sequence: its number stands before the ending.
pub fn numbered(path: &Path, number: u32) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!(".{number:04}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}
