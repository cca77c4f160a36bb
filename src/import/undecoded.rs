//! Images that models name, and that are decoded last: when it is known which of them are read.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::PathBuf;

use rayon::prelude::*;

use super::budget::Budget;
use super::{Problem, WarningCode, Warnings, files, images};
use crate::scene::Scene;
use crate::texture::{Image, ImageId, Pixels};

/// An image of a scene that has no pixels yet.
#[derive(Debug)]
pub struct Undecoded {
    /// Its place in the scene.
    pub image: ImageId,
    /// Where its file is, or that file's bytes.
    pub source: Source,
    /// Which model named it: the images of one share a budget.
    pub model: usize,
}

/// Where the bytes of an image are.
#[derive(Debug)]
pub enum Source {
    /// In a file of their own.
    File(PathBuf),
    /// Here; they were part of another file.
    Bytes(Vec<u8>),
}

impl Source {
    /// The bytes; a file is read.
    fn bytes(&self) -> Result<Cow<'_, [u8]>, Problem> {
        match self {
            Self::File(path) => Ok(Cow::Owned(files::read(path)?)),
            Self::Bytes(bytes) => Ok(Cow::Borrowed(bytes)),
        }
    }

    /// Bytes of its pixels, from its header alone; `None` where that cannot be read.
    pub fn decoded_bytes(&self, name: &str) -> Option<u64> {
        images::decoded_bytes(&self.bytes().ok()?, name).ok()
    }
}

/// What stands in for an image that was not decoded.
pub fn placeholder(name: String) -> Image {
    Image {
        name,
        width: 1,
        height: 1,
        pixels: Pixels::Rgba8(Vec::new()),
    }
}

type Fault = (WarningCode, String);

/// Decodes `undecoded` into `scene`. One that cannot be read or decoded is a warning: its textures
/// are taken away, and materials go without them.
pub fn decode(scene: &mut Scene, undecoded: &[Undecoded], warnings: &mut Warnings) {
    let name = |entry: &Undecoded| scene.images[entry.image.0 as usize].name.clone();
    let names: Vec<String> = undecoded.iter().map(name).collect();
    let encoded: Vec<_> = (undecoded.par_iter().zip(&names))
        .map(|(entry, name)| {
            entry
                .source
                .bytes()
                .map_err(|problem| fault(name, &problem))
        })
        .collect();
    let encoded = within_budget(undecoded, &names, encoded);
    let decoded: Vec<Result<Image, Fault>> = (encoded.into_par_iter().zip(&names))
        .map(|(bytes, name)| {
            images::decode(&bytes?, name).map_err(|what| (WarningCode::BadImage, what))
        })
        .collect();
    let mut is_missing = vec![false; scene.images.len()];
    for (entry, image) in undecoded.iter().zip(decoded) {
        let index = entry.image.0 as usize;
        match image {
            Ok(image) => scene.images[index] = image,
            Err((code, what)) => {
                warnings.add(code, format!("{what}; it is left out"));
                is_missing[index] = true;
            }
        }
    }
    if is_missing.contains(&true) {
        remove_images(scene, &is_missing);
    }
}

fn fault(name: &str, problem: &Problem) -> Fault {
    let code = match problem {
        Problem::Io(_) => WarningCode::MissingFile,
        _ => WarningCode::BadImage,
    };
    (code, format!("{name}: {problem}"))
}

/// The bytes of an image file, or why there are none.
type Encoded<'a> = Result<Cow<'a, [u8]>, Fault>;

/// Keeps those images whose pixels, added up in order, are in proportion to their model's files.
fn within_budget<'a>(
    undecoded: &[Undecoded],
    names: &[String],
    encoded: Vec<Encoded<'a>>,
) -> Vec<Encoded<'a>> {
    let mut budgets = BTreeMap::new();
    for (entry, bytes) in undecoded.iter().zip(&encoded) {
        let budget: &mut Budget = budgets
            .entry(entry.model)
            .or_insert_with(|| Budget::for_pixels(0));
        budget.add_file(bytes.as_ref().map_or(0, |bytes| bytes.len() as u64));
    }
    let check = |entry: &Undecoded, name: &String, bytes: Encoded<'a>| {
        let bytes = bytes?;
        images::decoded_bytes(&bytes, name)
            .and_then(|needed| {
                let taken = budgets[&entry.model].take(needed);
                taken.map_err(|problem| format!("{name}: {problem}"))
            })
            .map_err(|what| (WarningCode::BadImage, what))?;
        Ok(bytes)
    };
    undecoded
        .iter()
        .zip(names)
        .zip(encoded)
        .map(|((entry, name), bytes)| check(entry, name, bytes))
        .collect()
}

/// Takes images and their textures out of `scene`, and the textures out of its materials.
fn remove_images(scene: &mut Scene, is_missing: &[bool]) {
    let image_ids = renumbered(is_missing.iter().map(|missing| !missing));
    let texture_ids = renumbered(
        scene
            .textures
            .iter()
            .map(|texture| !is_missing[texture.image.0 as usize]),
    );
    let mut index = 0..;
    scene
        .images
        .retain(|_| index.next().is_some_and(|i: usize| !is_missing[i]));
    scene.textures.retain_mut(|texture| {
        let id = image_ids[texture.image.0 as usize];
        id.is_some_and(|id| {
            texture.image.0 = id;
            true
        })
    });
    for material in &mut scene.materials {
        material.retain_textures(|_, texture| {
            let id = texture_ids[texture.texture.0 as usize];
            id.is_some_and(|id| {
                texture.texture.0 = id;
                true
            })
        });
    }
}

/// The new number of each that stays.
fn renumbered(stays: impl Iterator<Item = bool>) -> Vec<Option<u32>> {
    let mut next = 0..;
    stays
        .map(|stays| if stays { next.next() } else { None })
        .collect()
}
