//! The files that `render` writes: checked before the work, written after it.

use std::path::{Path, PathBuf};

use halfshade::output::exr::{self, Window};
use halfshade::output::png::{self, PngBits, PngOptions};
use halfshade::output::{ImageFormat, OutputError, check_writable};

use super::Failure;
use super::layers::LayerValues;
use super::options::RenderOptions;

/// The files that a render writes.
pub struct Targets {
    images: Vec<(PathBuf, ImageFormat)>,
    png: PngOptions,
}

impl Targets {
    /// What the options ask for; every file can be written as far as one can tell.
    pub fn of(options: &RenderOptions) -> Result<Self, Failure> {
        let usage = |message: String| Err(Failure::usage("render", message));
        let output = &options.output;
        let mut paths = output.output.clone();
        if paths.is_empty() {
            paths.push(default_output(&options.scene.scene));
        }
        let mut images: Vec<(PathBuf, ImageFormat)> = Vec::new();
        for path in paths {
            let Some(format) = ImageFormat::of_path(&path) else {
                return usage(format!(
                    "{}: pictures are written as .png or .exr",
                    path.display()
                ));
            };
            if images.iter().any(|(other, _)| *other == path) {
                return usage(format!("{}: given twice", path.display()));
            }
            images.push((path, format));
        }
        let has = |format| images.iter().any(|(_, other)| *other == format);
        if !output.layers.is_empty() && !has(ImageFormat::Exr) {
            return usage("--layers needs an .exr file among the outputs".to_owned());
        }
        let png_option = [
            (output.exposure.is_some(), "--exposure"),
            (output.tone_map.is_some(), "--tone-map"),
            (output.png16, "--png16"),
        ];
        if let Some((_, name)) = png_option.iter().find(|(is_given, _)| *is_given)
            && !has(ImageFormat::Png)
        {
            return usage(format!("{name} needs a .png file among the outputs"));
        }
        for path in images.iter().map(|(path, _)| path).chain(&output.stats) {
            check_writable(path)?;
        }
        let png = PngOptions {
            bits: if output.png16 {
                PngBits::Sixteen
            } else {
                PngBits::Eight
            },
            exposure_ev: output.exposure.unwrap_or(0.0),
            tone_map: output.tone_map.unwrap_or_default(),
        };
        Ok(Self { images, png })
    }

    /// Their names.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.images.iter().map(|(path, _)| path.as_path())
    }

    /// Writes all of them; the first that fails ends it.
    pub fn write(
        &self,
        window: Window,
        values: &LayerValues,
        metadata: &[(&str, String)],
    ) -> Result<(), OutputError> {
        for (path, format) in &self.images {
            match format {
                ImageFormat::Png => png::write(path, window.size, values.picture(), self.png)?,
                ImageFormat::Exr => exr::write(path, window, &values.layers(), metadata)?,
            }
        }
        Ok(())
    }
}

/// The scene's name with `.png`, in the current folder.
fn default_output(scene: &Path) -> PathBuf {
    let name = scene.file_stem().unwrap_or(scene.as_os_str());
    let mut name = name.to_owned();
    name.push(".png");
    PathBuf::from(name)
}
