//! Textures and the images that they use, decoded in parallel.
//!
//! An image is decoded once however many textures use it, and not at all if none does. What
//! cannot be read or decoded is a warning: its materials go without it.

use std::borrow::Cow;
use std::path::Path;

use rayon::prelude::*;
use serde::Deserialize;

use super::buffers::Buffers;
use super::document::{Document, ImageEntry, Sampler, TextureEntry, place};
use super::extensions::{BASISU, WEBP};
use super::uri;
use crate::import::budget::Budget;
use crate::import::{Problem, WarningCode, Warnings, images};
use crate::texture::{Filter, Image, ImageId, Texture, TextureId, Wrap};

/// Textures of a document, as far as they could be read.
#[derive(Debug, Default)]
pub struct Textures {
    /// Decoded images, in file order.
    pub images: Vec<Image>,
    /// Textures, in file order.
    pub textures: Vec<Texture>,
    /// Where each texture of the document is in `textures`; `None` where it could not be read.
    pub ids: Vec<Option<TextureId>>,
}

/// `EXT_texture_webp`.
#[derive(Deserialize)]
struct WebpSource {
    source: usize,
}

impl Textures {
    /// Reads and decodes what the textures of the document at `path` use.
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
        let image_ids = textures.decode(path, document, buffers, &is_used, warnings);
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

    /// Decodes the images in use; the place of each in `self.images`.
    fn decode(
        &mut self,
        path: &Path,
        document: &Document,
        buffers: &Buffers,
        is_used: &[bool],
        warnings: &mut Warnings,
    ) -> Vec<Option<ImageId>> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let used: Vec<usize> = (0..is_used.len()).filter(|&i| is_used[i]).collect();
        let encoded: Vec<_> = (used.par_iter())
            .map(|&index| encoded_bytes(folder, document, buffers, index))
            .collect();
        let encoded = within_budget(document, &used, encoded);
        let decoded: Vec<Result<Image, (WarningCode, String)>> = (used.par_iter().zip(encoded))
            .map(|(&index, bytes)| {
                let name = image_name(index, &document.images[index]);
                images::decode(&bytes?, &name).map_err(|what| (WarningCode::BadImage, what))
            })
            .collect();
        let mut ids = vec![None; is_used.len()];
        for (index, image) in used.into_iter().zip(decoded) {
            match image {
                Ok(image) => {
                    ids[index] = Some(ImageId(self.images.len() as u32));
                    self.images.push(image);
                }
                Err((code, what)) => warnings.add(code, format!("{what}; it is left out")),
            }
        }
        ids
    }
}

type Encoded<'a> = Result<Cow<'a, [u8]>, (WarningCode, String)>;

/// Keeps those images whose pixels, added up in file order, are in proportion to their files.
fn within_budget<'a>(
    document: &Document,
    used: &[usize],
    encoded: Vec<Encoded<'a>>,
) -> Vec<Encoded<'a>> {
    let file_bytes = |bytes: &Encoded| bytes.as_ref().map_or(0, |bytes| bytes.len() as u64);
    let budget = Budget::for_pixels(encoded.iter().map(file_bytes).sum());
    let check = |(&index, bytes): (&usize, Encoded<'a>)| {
        let bytes = bytes?;
        let name = image_name(index, &document.images[index]);
        images::decoded_bytes(&bytes, &name)
            .and_then(|needed| {
                let problem = |problem: Problem| format!("{name}: {problem}");
                budget.take(needed).map_err(problem)
            })
            .map_err(|what| (WarningCode::BadImage, what))?;
        Ok(bytes)
    };
    used.iter().zip(encoded).map(check).collect()
}

fn encoded_bytes<'a>(
    folder: &Path,
    document: &Document,
    buffers: &'a Buffers,
    index: usize,
) -> Encoded<'a> {
    let image = &document.images[index];
    let bytes = match (&image.uri, image.buffer_view) {
        (Some(uri), _) => uri::read(folder, uri).map(Cow::Owned),
        (None, Some(view)) => buffers.view(document, view).map(Cow::Borrowed),
        (None, None) => Err(Problem::Invalid("has no data".into())),
    };
    bytes.map_err(|problem| {
        let code = match problem {
            Problem::Io(_) => WarningCode::MissingFile,
            _ => WarningCode::BadImage,
        };
        (code, format!("{}: {problem}", image_name(index, image)))
    })
}

fn image_name(index: usize, image: &ImageEntry) -> String {
    match &image.uri {
        Some(uri) if !uri::holds_data(uri) => uri::label(uri),
        _ => place("image", index, image.name.as_deref()),
    }
}

/// The image that a texture shows.
fn source(
    document: &Document,
    index: usize,
    texture: &TextureEntry,
    warnings: &mut Warnings,
) -> Option<usize> {
    let webp = texture.extensions.read::<WebpSource>(WEBP);
    let webp = webp.unwrap_or_else(|what| {
        warnings.add(WarningCode::BadValue, format!("texture {index}: {what}"));
        None
    });
    let source = webp.map(|webp| webp.source).or(texture.source);
    let what = match source {
        Some(image) if image < document.images.len() => return Some(image),
        Some(image) => format!("its image {image} is not there"),
        None if texture.extensions.has(BASISU) => {
            format!("its only image is KTX2 ({BASISU}), which is not supported")
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
