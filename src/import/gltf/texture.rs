//! Textures and the images that they use.
//!
//! An image is there once however many textures use it, and not at all if none does. It is decoded
//! when it is known that something reads it ([`crate::import::undecoded`]); one without data is a
//! warning: its materials go without it.

use std::path::Path;

use serde::Deserialize;

use super::buffers::Buffers;
use super::document::{Document, ImageEntry, Sampler, TextureEntry, place};
use super::extensions::{BASISU, WEBP};
use super::uri;
use crate::import::undecoded::{Source, Undecoded, placeholder};
use crate::import::{Problem, WarningCode, Warnings};
use crate::texture::{Filter, Image, ImageId, Texture, TextureId, Wrap};

/// Textures of a document, as far as they could be read.
#[derive(Debug, Default)]
pub struct Textures {
    /// Images in use, in file order, without pixels.
    pub images: Vec<Image>,
    /// Where those are.
    pub undecoded: Vec<Undecoded>,
    /// Textures, in file order.
    pub textures: Vec<Texture>,
    /// Where each texture of the document is in `textures`; `None` where it could not be read.
    pub ids: Vec<Option<TextureId>>,
}

/// `KHR_texture_basisu`, `EXT_texture_webp`.
#[derive(Deserialize)]
struct OtherSource {
    source: usize,
}

impl Textures {
    /// Reads the textures of the document at `path`, and finds their images.
    pub fn read(
        path: &Path,
        document: &Document,
        buffers: &Buffers,
        warnings: &mut Warnings,
    ) -> Self {
        let sources: Vec<Option<usize>> = (document.textures.iter().enumerate())
            .map(|(index, texture)| source(document, index, texture, warnings))
            .collect();
        let mut is_used = vec![false; document.images.len()];
        for &image in sources.iter().flatten() {
            is_used[image] = true;
        }
        let mut textures = Self::default();
        let image_ids = textures.find_images(path, document, buffers, &is_used, warnings);
        for (index, source) in sources.into_iter().enumerate() {
            let image = source.and_then(|image| image_ids[image]);
            let id = image.map(|image| {
                let texture = texture(document, index, image, warnings);
                textures.textures.push(texture);
                TextureId(textures.textures.len() as u32 - 1)
            });
            textures.ids.push(id);
        }
        textures
    }

    /// Finds the images in use; the place of each in `self.images`.
    fn find_images(
        &mut self,
        path: &Path,
        document: &Document,
        buffers: &Buffers,
        is_used: &[bool],
        warnings: &mut Warnings,
    ) -> Vec<Option<ImageId>> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut ids = vec![None; is_used.len()];
        for index in (0..is_used.len()).filter(|&i| is_used[i]) {
            let name = image_name(index, &document.images[index]);
            match image_source(folder, document, buffers, index) {
                Ok(source) => {
                    let image = ImageId(self.images.len() as u32);
                    ids[index] = Some(image);
                    self.images.push(placeholder(name));
                    self.undecoded.push(Undecoded {
                        image,
                        source,
                        model: 0,
                    });
                }
                Err(problem) => {
                    let message = format!("{name}: {problem}; it is left out");
                    warnings.add(WarningCode::BadImage, message);
                }
            }
        }
        ids
    }
}

/// Where the bytes of image `index` are.
fn image_source(
    folder: &Path,
    document: &Document,
    buffers: &Buffers,
    index: usize,
) -> Result<Source, Problem> {
    let image = &document.images[index];
    match (&image.uri, image.buffer_view) {
        (Some(uri), _) if uri::holds_data(uri) => uri::read(folder, uri).map(Source::Bytes),
        (Some(uri), _) => uri::locate(folder, uri).map(Source::File),
        (None, Some(view)) => {
            let bytes = buffers.view(document, view)?;
            Ok(Source::Bytes(bytes.to_vec()))
        }
        (None, None) => Err(Problem::Invalid("has no data".into())),
    }
}

fn image_name(index: usize, image: &ImageEntry) -> String {
    match &image.uri {
        Some(uri) if !uri::holds_data(uri) => uri::label(uri),
        _ => place("image", index, image.name.as_deref()),
    }
}

/// The image that a texture shows: the first that is there, of its formats the newest first.
fn source(
    document: &Document,
    index: usize,
    texture: &TextureEntry,
    warnings: &mut Warnings,
) -> Option<usize> {
    let mut other = |name: &str| {
        let source = texture.extensions.read::<OtherSource>(name);
        let source = source.unwrap_or_else(|what| {
            warnings.add(WarningCode::BadValue, format!("texture {index}: {what}"));
            None
        });
        source.map(|other| other.source)
    };
    let basisu = if cfg!(feature = "ktx2") {
        other(BASISU)
    } else {
        None
    };
    let sources = [basisu, other(WEBP), texture.source];
    let count = document.images.len();
    let is_there = |&image: &usize| image < count;
    if let Some(image) = sources.into_iter().flatten().find(is_there) {
        return Some(image);
    }
    let what = match sources.into_iter().flatten().next() {
        Some(image) => format!("its image {image} is not there"),
        None if texture.extensions.has(BASISU) => {
            format!("its only image is KTX2 ({BASISU}), which this build does not support")
        }
        None => "it has no image".into(),
    };
    let message = format!("texture {index}: {what}; it is left out");
    warnings.add(WarningCode::BadImage, message);
    None
}

fn texture(document: &Document, index: usize, image: ImageId, warnings: &mut Warnings) -> Texture {
    let default = Sampler::default();
    let sampler = match document.textures[index].sampler {
        None => &default,
        Some(sampler) => document.samplers.get(sampler).unwrap_or_else(|| {
            let message = format!("texture {index}: its sampler {sampler} is not there");
            warnings.add(WarningCode::BadValue, message);
            &default
        }),
    };
    let mut wrap = |code: Option<u32>| match code {
        None | Some(10_497) => Wrap::Repeat,
        Some(33_071) => Wrap::ClampToEdge,
        Some(33_648) => Wrap::MirroredRepeat,
        Some(other) => {
            let message = format!("texture {index}: wrapping {other} is not known; it repeats");
            warnings.add(WarningCode::BadValue, message);
            Wrap::Repeat
        }
    };
    Texture {
        image,
        wrap: [wrap(sampler.wrap_s), wrap(sampler.wrap_t)],
        filter: match sampler.mag_filter {
            Some(9728) => Filter::Nearest,
            _ => Filter::Linear,
        },
    }
}
