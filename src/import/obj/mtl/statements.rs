//! The statements of an MTL file, as they stand.

use std::collections::BTreeSet;

use super::super::lines::{Line, Lines, Words, number, shown};
use super::map::Map;
use crate::color::Rgb;
use crate::import::{WarningCode, Warnings};

/// What a `newmtl` says; `None` where it does not say it.
#[derive(Clone, Debug, Default)]
pub struct MtlMaterial {
    /// Its name; may be empty.
    pub name: String,
    /// `Kd`, linear.
    pub diffuse: Option<Rgb>,
    /// `Ks`, linear.
    pub specular: Option<Rgb>,
    /// `Ke`, radiance.
    pub emission: Option<Rgb>,
    /// `Tf`, what the material lets through.
    pub transmission: Option<Rgb>,
    /// `Ns`.
    pub exponent: Option<f32>,
    /// `Ni`.
    pub index_of_refraction: Option<f32>,
    /// `d`, or 1 − `Tr` where there is no `d`: 1 is solid.
    pub opacity: Opacity,
    /// `illum`.
    pub illumination: Option<u32>,
    /// `Pr`.
    pub roughness: Option<f32>,
    /// `Pm`.
    pub metallic: Option<f32>,
    /// Whether any of the PBR keys was there.
    pub is_physically_based: bool,
    /// Its maps.
    pub maps: Maps,
}

/// The two ways to say how solid a material is. Exporters disagree on `Tr`, so `d` counts where
/// both are there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Opacity {
    /// `d`.
    pub dissolve: Option<f32>,
    /// `Tr`.
    pub transparency: Option<f32>,
}

impl Opacity {
    /// In `[0, 1]`; 1 where the file says nothing.
    pub fn value(self) -> f32 {
        let from_transparency = self.transparency.map(|t| 1.0 - t);
        self.dissolve
            .or(from_transparency)
            .unwrap_or(1.0)
            .clamp(0.0, 1.0)
    }
}

/// The images of a material.
#[derive(Clone, Debug, Default)]
pub struct Maps {
    /// `map_Kd`.
    pub diffuse: Option<Box<Map>>,
    /// `map_Ks`.
    pub specular: Option<Box<Map>>,
    /// `map_Ke`.
    pub emission: Option<Box<Map>>,
    /// `map_Ns`.
    pub exponent: Option<Box<Map>>,
    /// `map_d`.
    pub opacity: Option<Box<Map>>,
    /// `map_Bump`, `bump`: heights.
    pub bump: Option<Box<Map>>,
    /// `norm`, `map_Kn`: normals.
    pub normal: Option<Box<Map>>,
    /// `map_Pr`.
    pub roughness: Option<Box<Map>>,
    /// `map_Pm`.
    pub metallic: Option<Box<Map>>,
}

/// Reads a whole library called `file` in messages. What is wrong in it costs no more than the
/// statement it stands in.
pub fn read(bytes: &[u8], file: &str, warnings: &mut Warnings) -> Vec<MtlMaterial> {
    let mut reader = Reader {
        file,
        materials: Vec::new(),
        warnings,
        said: BTreeSet::new(),
    };
    for line in Lines::new(bytes) {
        reader.statement(&line);
    }
    reader.materials
}

struct Reader<'a> {
    file: &'a str,
    materials: Vec<MtlMaterial>,
    warnings: &'a mut Warnings,
    /// Complaints so far.
    said: BTreeSet<String>,
}

impl Reader<'_> {
    fn statement(&mut self, line: &Line<'_>) {
        let mut names = Words::of_names(&line.text);
        let Some(keyword) = names.next() else { return };
        let key = keyword.to_ascii_lowercase();
        if key == b"newmtl" {
            self.materials.push(MtlMaterial {
                name: String::from_utf8_lossy(names.rest()).into_owned(),
                ..MtlMaterial::default()
            });
            return;
        }
        let Some(mut material) = self.materials.pop() else {
            let what = "statements before the first newmtl were left out".to_owned();
            self.complain(WarningCode::UnknownStatement, None, what);
            return;
        };
        let mut numbers = line.words();
        numbers.next();
        let taken = material
            .value(&key, &mut numbers)
            .or_else(|| material.map(&key, names.rest()));
        self.materials.push(material);
        let keyword = shown(keyword);
        match taken {
            Some(Ok(())) => {}
            Some(Err(Unfit::Bad)) => {
                let what = format!("`{keyword}` has no value that can be used");
                self.complain(WarningCode::BadValue, Some(line.number), what);
            }
            Some(Err(Unfit::NotShown)) => {
                self.complain(
                    WarningCode::Approximated,
                    None,
                    format!("`{keyword}` is not shown"),
                );
            }
            None => {
                let what = format!("`{keyword}` was not understood");
                self.complain(WarningCode::UnknownStatement, None, what);
            }
        }
    }

    /// Adds a warning; beyond a number that anyone reads, one without details.
    fn complain(&mut self, code: WarningCode, line: Option<usize>, what: String) {
        const MOST: usize = 50;
        let place = line.map_or(String::new(), |line| format!(", line {line}"));
        let mut message = format!("{}{place}: {what}", self.file);
        if self.said.len() >= MOST && !self.said.contains(&message) {
            message = format!("{}: further statements of this kind", self.file);
        }
        self.said.insert(message.clone());
        self.warnings.add(code, message);
    }
}

/// Why a statement that is known was not taken in.
enum Unfit {
    /// Its values are missing, not numbers, or out of range.
    Bad,
    /// Nothing here shows what it says.
    NotShown,
}

type Taken = Option<Result<(), Unfit>>;

impl MtlMaterial {
    /// Takes in the statement `key` if it is one of numbers; `None` where it is not.
    fn value(&mut self, key: &[u8], words: &mut Words<'_>) -> Taken {
        let taken = match key {
            b"kd" => set(&mut self.diffuse, color(words)),
            b"ks" => set(&mut self.specular, color(words)),
            b"ke" => set(&mut self.emission, color(words)),
            b"tf" => set(&mut self.transmission, color(words)),
            b"ns" => set(&mut self.exponent, scalar(words, 0.0)),
            b"ni" => set(
                &mut self.index_of_refraction,
                scalar(words, f32::MIN_POSITIVE),
            ),
            b"d" => self.dissolve(words),
            b"tr" => set(&mut self.opacity.transparency, scalar(words, 0.0)),
            b"illum" => set(&mut self.illumination, scalar(words, 0.0).map(|i| i as u32)),
            b"pr" => self.physical(words, |m| &mut m.roughness),
            b"pm" => self.physical(words, |m| &mut m.metallic),
            // Coats, sheen and anisotropy change the look where they are not 0.
            b"ps" | b"pc" | b"pcr" | b"aniso" | b"anisor" => {
                self.is_physically_based = true;
                match scalar(words, f32::NEG_INFINITY) {
                    Some(0.0) => Ok(()),
                    Some(_) if key == b"pcr" || key == b"anisor" => Ok(()),
                    Some(_) => Err(Unfit::NotShown),
                    None => Err(Unfit::Bad),
                }
            }
            // Ambient light is multiplied with the diffuse reflectance; a reflectance of its
            // own for it, and anti-aliasing of textures, have no meaning here.
            b"ka" | b"map_ka" | b"map_aat" | b"sharpness" => Ok(()),
            _ => return None,
        };
        Some(taken)
    }

    fn dissolve(&mut self, words: &mut Words<'_>) -> Result<(), Unfit> {
        let mut ahead = words.clone();
        let has_halo = ahead.next() == Some(b"-halo");
        let words = if has_halo { &mut ahead } else { words };
        set(&mut self.opacity.dissolve, scalar(words, 0.0))?;
        if has_halo {
            Err(Unfit::NotShown)
        } else {
            Ok(())
        }
    }

    fn physical(
        &mut self,
        words: &mut Words<'_>,
        field: fn(&mut Self) -> &mut Option<f32>,
    ) -> Result<(), Unfit> {
        self.is_physically_based = true;
        set(field(self), scalar(words, 0.0).map(|v| v.min(1.0)))
    }

    /// Takes in the statement `key` if it is one of images; `None` where it is not.
    fn map(&mut self, key: &[u8], text: &[u8]) -> Taken {
        let maps = &mut self.maps;
        let slot = match key {
            b"map_kd" => &mut maps.diffuse,
            b"map_ks" => &mut maps.specular,
            b"map_ke" => &mut maps.emission,
            b"map_ns" => &mut maps.exponent,
            b"map_d" => &mut maps.opacity,
            b"map_bump" | b"bump" => &mut maps.bump,
            b"norm" | b"map_kn" | b"map_norm" => &mut maps.normal,
            b"map_pr" => &mut maps.roughness,
            b"map_pm" => &mut maps.metallic,
            b"map_ps" | b"map_pc" | b"map_pcr" | b"map_tr" | b"map_rma" | b"map_orm" | b"disp"
            | b"map_disp" | b"decal" | b"refl" | b"map_refl" => return Some(Err(Unfit::NotShown)),
            _ => return None,
        };
        let is_physical = matches!(key, b"map_pr" | b"map_pm");
        let taken = set(slot, Map::parse(text).map(Box::new));
        self.is_physically_based |= is_physical && taken.is_ok();
        Some(taken)
    }
}

fn set<T>(slot: &mut Option<T>, value: Option<T>) -> Result<(), Unfit> {
    if value.is_none() {
        return Err(Unfit::Bad);
    }
    *slot = value;
    Ok(())
}

/// A finite number, brought up to `least`; `None` where there is none.
fn scalar(words: &mut Words<'_>, least: f32) -> Option<f32> {
    let value = number(words.next()?)? as f32;
    value.is_finite().then_some(value.max(least))
}

/// `r`, `r g b`, or `xyz x y z`; linear, not negative.
fn color(words: &mut Words<'_>) -> Option<Rgb> {
    let mut ahead = words.clone();
    let is_xyz = ahead.next() == Some(b"xyz");
    let words = if is_xyz { &mut ahead } else { words };
    let first = scalar(words, f32::NEG_INFINITY)?;
    let (second, third) = match words.next() {
        Some(word) => {
            let second = number(word)? as f32;
            (second, scalar(words, f32::NEG_INFINITY)?)
        }
        None => (first, first),
    };
    let color = Rgb::new(first, second, third);
    let color = if is_xyz {
        xyz_to_rgb(color.channels())
    } else {
        color
    };
    color.is_finite().then(|| color.map(|c| c.max(0.0)))
}

/// From CIE XYZ to linear Rec. 709 (IEC 61966-2-1).
fn xyz_to_rgb([x, y, z]: [f32; 3]) -> Rgb {
    Rgb::new(
        3.240_6 * x - 1.537_2 * y - 0.498_6 * z,
        -0.968_9 * x + 1.875_8 * y + 0.041_5 * z,
        0.055_7 * x - 0.204 * y + 1.057 * z,
    )
}
