//! The picture that others are measured against, kept in files beside the digest of its scene.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::digest::of_debug;
use super::floor::Floors;
use crate::color::Rgb;
use crate::film::Film;
use crate::output::exr::{self, Layer, Values, Window};
use crate::output::{OutputError, write_whole};
use crate::report::metrics::{Pair, PairError, flip};
use crate::report::{Picture, read_picture};
use crate::sampling::Target;

/// A picture of high quality that knows its own noise.
#[derive(Clone, Debug)]
pub struct Reference {
    /// What it was made of.
    pub about: About,
    /// Its value.
    pub picture: Picture,
    /// Half the difference of its two halves by channel: the square is the variance of the value,
    /// the value with it added and subtracted is each half.
    pub noise: Picture,
    /// Its squared errors.
    pub floors: Floors,
    /// What FLIP finds between it and the truth, about: half of what it finds between its halves.
    pub flip_floor: f64,
}

/// What a reference was made of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// Name of the part of a pixel that its samples fill: another part is another picture.
    pub target: String,
    /// Of the scene and the settings.
    pub digest: String,
    /// Camera samples of a pixel.
    pub samples: u32,
    /// Its seed; no picture that is measured against it has the same.
    pub seed: u64,
}

/// The file that says what the pictures are.
#[derive(Serialize, Deserialize)]
struct Note {
    #[serde(flatten)]
    about: About,
    /// Of the pixels of both files.
    pixels: String,
}

impl Reference {
    /// From a film whose pixels have both halves.
    ///
    /// # Errors
    /// Where it has no pixel.
    pub fn of(about: About, film: &Film) -> Result<Self, PairError> {
        let noise = film.pixels.iter().map(|pixel| {
            let [a, b] = pixel.halves().map(|half| half.mean());
            Rgb::from([0, 1, 2].map(|c| (0.5 * (a[c] - b[c])) as f32))
        });
        let noise = Picture {
            size: film.size(),
            pixels: noise.collect(),
        };
        Self::new(about, Picture::from(film), noise)
    }

    fn new(about: About, picture: Picture, noise: Picture) -> Result<Self, PairError> {
        let half = |side: f32| {
            let both = picture.pixels.iter().zip(&noise.pixels);
            Picture {
                size: picture.size,
                pixels: both.map(|(&value, &noise)| value + noise * side).collect(),
            }
        };
        let halves = Pair::new(&half(1.0), &half(-1.0))?;
        Ok(Self {
            floors: Floors::of(&picture, &noise),
            flip_floor: 0.5 * flip(&halves).mean(),
            about,
            picture,
            noise,
        })
    }

    /// Where the value of a reference for `target` lies in `folder`.
    pub fn path(folder: &Path, target: Target) -> PathBuf {
        file(folder, target.name(), ".exr")
    }

    /// Writes it to `folder`.
    ///
    /// # Errors
    /// Where a file cannot be written.
    pub fn save(&self, folder: &Path) -> Result<(), OutputError> {
        let target = self.about.target.as_str();
        let metadata = [
            ("samples", self.about.samples.to_string()),
            ("seed", self.about.seed.to_string()),
            ("scene_digest", self.about.digest.clone()),
        ];
        for (picture, end) in [(&self.picture, ".exr"), (&self.noise, "-noise.exr")] {
            let layer = Layer {
                name: "",
                values: Values::Colors(&picture.pixels),
            };
            let window = Window::whole(picture.size);
            exr::write(&file(folder, target, end), window, &[layer], &metadata)?;
        }
        let note = Note {
            about: self.about.clone(),
            pixels: of_debug(&(&self.picture, &self.noise)),
        };
        write_whole(&file(folder, target, ".json"), |file| {
            serde_json::to_writer_pretty(&mut *file, &note)?;
            file.write_all(b"\n")
        })
    }

    /// The one that was saved in `folder`, if it is as `about` says and nobody has touched it.
    pub fn load(folder: &Path, about: &About) -> Option<Self> {
        let target = about.target.as_str();
        let note = fs::read_to_string(file(folder, target, ".json")).ok()?;
        let note: Note = serde_json::from_str(&note).ok()?;
        if note.about != *about {
            return None;
        }
        let read = |end: &str| {
            let opened = read_picture(&file(folder, target, end)).ok()?;
            Some(opened.picture)
        };
        let (picture, noise) = (read(".exr")?, read("-noise.exr")?);
        if of_debug(&(&picture, &noise)) != note.pixels {
            return None;
        }
        Self::new(note.about, picture, noise).ok()
    }
}

fn file(folder: &Path, target: &str, end: &str) -> PathBuf {
    folder.join(format!("reference-{target}{end}"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::math::UVec2;

    #[test]
    fn a_reference_comes_back_unless_something_else_is_wanted() {
        let size = UVec2::new(3, 2);
        let about = About {
            target: "circle".to_owned(),
            digest: "0".to_owned(),
            samples: 64,
            seed: 0,
        };
        let picture = Picture::from_fn(size, |x, y| Rgb::new(x as f32, y as f32, 1e-9));
        let noise = Picture::from_fn(size, |x, _| Rgb::splat(-0.1 * x as f32));
        let reference = Reference::new(about.clone(), picture, noise).unwrap();
        let folder = tempfile::tempdir().unwrap();
        assert!(Reference::load(folder.path(), &about).is_none());
        reference.save(folder.path()).unwrap();
        let loaded = Reference::load(folder.path(), &about).unwrap();
        assert_eq!(loaded.picture, reference.picture);
        assert_eq!(loaded.floors, reference.floors);
        let other = About {
            seed: 1,
            ..about.clone()
        };
        assert!(Reference::load(folder.path(), &other).is_none());
        // A file that somebody else wrote under its name.
        let path = Reference::path(folder.path(), Target::Circle);
        fs::copy(folder.path().join("reference-circle-noise.exr"), path).unwrap();
        assert!(Reference::load(folder.path(), &about).is_none());
    }
}
