//! Images that materials name, each read once, and decoded here only where a material cannot be
//! understood without its pixels.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::super::search::find;
use super::map::Map;
use crate::import::budget::Budget;
use crate::import::undecoded::{Source, Undecoded, placeholder};
use crate::import::{WarningCode, Warnings, files, images};
use crate::math::{Affine2, Vec2};
use crate::texture::{Filter, Image, ImageId, Pixels, Texture, TextureId, TextureRef, Wrap};

/// The textures of a scene, as materials ask for them.
pub struct Textures {
    /// Images that could be read, in the order of their first use.
    pub images: Vec<Image>,
    /// Their uses with different wrapping.
    pub textures: Vec<Texture>,
    /// Those of the images that are not decoded yet, in their order.
    pub undecoded: Vec<Undecoded>,
    /// By file, whatever name it goes by; `None` for those that could not be read.
    read: HashMap<PathBuf, Option<ImageId>>,
    /// For the pixels of those that are decoded here.
    budget: Budget,
}

impl Default for Textures {
    /// None yet.
    fn default() -> Self {
        Self {
            images: Vec::new(),
            textures: Vec::new(),
            undecoded: Vec::new(),
            read: HashMap::new(),
            budget: Budget::for_pixels(0),
        }
    }
}

impl Textures {
    /// The texture of `map`, whose file is looked for in `folders`. `None`, with a warning, where it is missing
    /// or no image: the material is then shown without it.
    pub fn get(
        &mut self,
        map: &Map,
        folders: &[&Path],
        warnings: &mut Warnings,
    ) -> Option<TextureRef> {
        let Some(path) = find(&map.file, folders) else {
            let message = format!(
                "texture {:?} was not found; its material goes without",
                map.file
            );
            warnings.add(WarningCode::MissingFile, message);
            return None;
        };
        for option in &map.ignored {
            let message = format!("option {option} of texture {:?} is not shown", map.file);
            warnings.add(WarningCode::Approximated, message);
        }
        let image = self.image(&path, warnings)?;
        Some(TextureRef {
            transform: transform(map),
            ..TextureRef::new(self.texture(image, map.is_clamped))
        })
    }

    fn image(&mut self, path: &Path, warnings: &mut Warnings) -> Option<ImageId> {
        let key = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if let Some(&known) = self.read.get(&key) {
            return known;
        }
        let id = match encoded(path) {
            Ok(bytes) => {
                let image = ImageId(self.images.len() as u32);
                self.images.push(placeholder(path.display().to_string()));
                self.undecoded.push(Undecoded {
                    image,
                    source: Source::Bytes(bytes),
                    model: 0,
                });
                Some(image)
            }
            Err(message) => {
                warnings.add(WarningCode::BadImage, message);
                None
            }
        };
        self.read.insert(key, id);
        id
    }

    fn texture(&mut self, image: ImageId, is_clamped: bool) -> TextureId {
        let wrap = [if is_clamped {
            Wrap::ClampToEdge
        } else {
            Wrap::Repeat
        }; 2];
        let known = self
            .textures
            .iter()
            .position(|t| t.image == image && t.wrap == wrap);
        let index = known.unwrap_or_else(|| {
            self.textures.push(Texture {
                image,
                wrap,
                filter: Filter::Linear,
            });
            self.textures.len() - 1
        });
        TextureId(index as u32)
    }

    /// Whether the image behind `texture`, which is decoded for it, is `so`; not where it
    /// cannot be decoded, of which there is a warning when all others are.
    pub fn is(&mut self, texture: &TextureRef, so: impl Fn(&Image) -> bool) -> bool {
        let id = self.textures[texture.texture.0 as usize].image;
        let image = &mut self.images[id.0 as usize];
        if let Ok(place) = self.undecoded.binary_search_by_key(&id.0, |u| u.image.0)
            && let Source::Bytes(bytes) = &self.undecoded[place].source
            && let Ok(decoded) = images::decode_within(bytes, &image.name, &self.budget)
        {
            *image = decoded;
            self.undecoded.remove(place);
        }
        so(image)
    }
}

/// The bytes of a file that begins as an image does.
fn encoded(path: &Path) -> Result<Vec<u8>, String> {
    let name = path.display().to_string();
    let bytes = files::read(path).map_err(|error| format!("{name}: {error}"))?;
    images::decoded_bytes(&bytes, &name)?;
    Ok(bytes)
}

/// `-s` and `-o` for texture coordinates whose v grows downwards: with v' = 1 − v,
/// s v + o becomes s v' + (1 − s − o).
fn transform(map: &Map) -> Affine2 {
    let scale = Vec2::from_array(map.scale);
    let offset = Vec2::new(map.offset[0], 1.0 - map.scale[1] - map.offset[1]);
    Affine2::from_scale_angle_translation(scale, 0.0, offset)
}

/// Whether any pixel is less than opaque.
pub fn has_alpha(image: &Image) -> bool {
    match &image.pixels {
        Pixels::Rgba8(pixels) => pixels.iter().any(|p| p[3] < 255),
        Pixels::Rgba32F(pixels) => pixels.iter().any(|p| p[3] < 1.0),
    }
}

/// Whether an image holds the colours of a tangent-space normal map, by the mean of its pixels: much more blue than
/// red and green, and those near the middle. Heights are grey.
pub fn looks_like_normals(image: &Image) -> bool {
    let mean = match &image.pixels {
        Pixels::Rgba8(pixels) => mean(pixels.iter().map(|p| p.map(|c| f64::from(c) / 255.0))),
        Pixels::Rgba32F(pixels) => mean(pixels.iter().map(|p| p.map(f64::from))),
    };
    let is_middle = |c: f64| (0.4..0.6).contains(&c);
    is_middle(mean[0]) && is_middle(mean[1]) && mean[2] > 0.75
}

fn mean(pixels: impl ExactSizeIterator<Item = [f64; 4]>) -> [f64; 4] {
    let count = pixels.len() as f64;
    let sum = pixels.fold([0.0; 4], |sum, p| std::array::from_fn(|i| sum[i] + p[i]));
    sum.map(|s| s / count)
}
