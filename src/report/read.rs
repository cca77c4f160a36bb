//! PNG and EXR files to [`Picture`]s.
//!
//! Which of the two a file is, its first bytes tell. PNG, of 8 or 16 bits a channel, is taken as
//! sRGB whatever its colour chunks say, and its opacity is left out. Of EXR the channels `R`,
//! `G`, `B` are read, or `Y` where there are none: other layers are left out, and the picture is
//! the data window, so that a crop is as large as what it holds.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use exr::meta::attribute::Chromaticities;
use exr::prelude::{
    MetaData, ReadChannels, ReadLayers, ReadSpecificChannel, Vec2, read as read_exr,
};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use thiserror::Error;

use super::Picture;
use crate::color::{Rgb, srgb_to_linear, srgb8_to_linear};
use crate::import::{SizeError, check_exr_size, check_size, read_exr_colors};
use crate::math::UVec2;
use crate::scene::MAX_PIXELS;

/// A picture from a file.
#[derive(Clone, Debug)]
pub struct Opened {
    /// The picture.
    pub picture: Picture,
    /// Whether an EXR file says that its primaries are others than those of Rec. 709; its numbers
    /// are taken as they are.
    pub has_other_primaries: bool,
}

/// Why a file could not be read as a picture.
#[derive(Debug, Error)]
#[error("{}: {problem}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    #[source]
    pub problem: ReadProblem,
}

/// What is wrong with a file that was to be read as a picture.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadProblem {
    /// The system could not read it.
    #[error("could not be read: {0}")]
    Io(#[from] io::Error),
    /// It begins like something else.
    #[error("is neither a PNG nor an EXR picture")]
    OtherFormat,
    /// It says that it has more pixels than there can be.
    #[error("{}", claim(.0))]
    Size(#[from] SizeError),
    /// An EXR file of other layers.
    #[error("has neither the channels R, G and B nor the channel Y")]
    NoColors,
    /// The decoder does not accept it.
    #[error("is damaged or not supported: {0}")]
    Invalid(String),
}

/// What a file with too many pixels says of itself.
fn claim(error: &SizeError) -> String {
    match error {
        SizeError::TooLarge { width, height } => {
            format!("has {width} × {height} pixels, which are more than {MAX_PIXELS}")
        }
        SizeError::TooShort {
            width,
            height,
            bytes,
        } => format!(
            "says that it has {width} × {height} pixels, which do not fit into its {bytes} bytes"
        ),
    }
}

/// Reads the PNG or EXR file at `path`.
///
/// # Errors
/// Where it is not there, is of another format, damaged, or has more than [`MAX_PIXELS`] pixels.
pub fn read_picture(path: &Path) -> Result<Opened, ReadError> {
    open(path).map_err(|problem| ReadError {
        path: path.to_owned(),
        problem,
    })
}

fn open(path: &Path) -> Result<Opened, ReadProblem> {
    let file = File::open(path)?;
    let bytes = file.metadata()?.len();
    let mut file = BufReader::new(file);
    let mut start = [0; 4];
    let known = match file.read_exact(&mut start) {
        Ok(()) => start,
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => [0; 4],
        Err(error) => return Err(error.into()),
    };
    file.rewind()?;
    match known {
        [0x89, b'P', b'N', b'G'] => png(file, bytes),
        [0x76, 0x2f, 0x31, 0x01] => exr(file, bytes),
        _ => Err(ReadProblem::OtherFormat),
    }
}

fn png(file: BufReader<File>, bytes: u64) -> Result<Opened, ReadProblem> {
    let invalid = |error: image::ImageError| ReadProblem::Invalid(error.to_string());
    let mut decoder = ImageReader::with_format(file, ImageFormat::Png)
        .into_decoder()
        .map_err(invalid)?;
    let (width, height) = decoder.dimensions();
    // In the longest runs of deflate, 1,032 bytes to one, of pixels of a bit.
    let most = bytes.saturating_mul(8 * 1032);
    check_size([width.into(), height.into()], most, bytes)?;
    let mut limits = Limits::default();
    // Four channels of 16 bits, and a copy.
    limits.max_alloc = Some(2 * 8 * MAX_PIXELS);
    decoder.set_limits(limits).map_err(invalid)?;
    let decoded = DynamicImage::from_decoder(decoder).map_err(invalid)?;
    let is_deep = decoded.color().bytes_per_pixel() > decoded.color().channel_count();
    let pixels = if is_deep {
        let decode = |level: u16| srgb_to_linear(f32::from(level) / 65535.0);
        let decoded = decoded.into_rgb16();
        decoded.pixels().map(|p| p.0.map(decode).into()).collect()
    } else {
        let decoded = decoded.into_rgb8();
        let pixels = decoded.pixels();
        pixels.map(|p| p.0.map(srgb8_to_linear).into()).collect()
    };
    Ok(Opened {
        picture: Picture {
            size: UVec2::new(width, height),
            pixels,
        },
        has_other_primaries: false,
    })
}

fn exr(mut file: BufReader<File>, bytes: u64) -> Result<Opened, ReadProblem> {
    let headers = MetaData::read_from_buffered(&mut file, false)
        .map_err(exr_problem)?
        .headers;
    let has = |name: &str| {
        let mut lists = headers.iter().map(|header| &header.channels.list);
        lists.any(|list| list.iter().any(|channel| channel.name.eq(name)))
    };
    check_exr_size(&headers, bytes)?;
    let has_other_primaries = headers
        .first()
        .and_then(|header| header.shared_attributes.chromaticities)
        .is_some_and(|c| !is_rec_709(&c));
    file.rewind()?;
    let picture = if ["R", "G", "B"].into_iter().all(has) {
        colors(file)?
    } else if has("Y") {
        greys(file)?
    } else {
        return Err(ReadProblem::NoColors);
    };
    Ok(Opened {
        picture,
        has_other_primaries,
    })
}

fn colors(file: BufReader<File>) -> Result<Picture, ReadProblem> {
    let ([width, height], pixels) = read_exr_colors(file).map_err(exr_problem)?;
    Ok(Picture {
        size: UVec2::new(width, height),
        pixels,
    })
}

fn greys(file: BufReader<File>) -> Result<Picture, ReadProblem> {
    let image = read_exr()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("Y")
        .collect_pixels(
            |Vec2(width, height), _| Picture {
                // Within MAX_PIXELS: the header was checked.
                size: UVec2::new(width as u32, height as u32),
                pixels: vec![Rgb::BLACK; width * height],
            },
            |picture, Vec2(x, y), (grey,): (f32,)| {
                picture.pixels[y * picture.size.x as usize + x] = Rgb::splat(grey);
            },
        )
        .first_valid_layer()
        .all_attributes()
        .from_buffered(file)
        .map_err(exr_problem)?;
    Ok(image.layer_data.channel_data.pixels)
}

fn is_rec_709(c: &Chromaticities) -> bool {
    let given = [c.red, c.green, c.blue, c.white];
    let expected = [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290)];
    let is_near = |a: f32, b: f32| (a - b).abs() < 2e-3;
    let mut both = given.iter().zip(expected);
    both.all(|(given, (x, y))| is_near(given.x(), x) && is_near(given.y(), y))
}

fn exr_problem(error: exr::error::Error) -> ReadProblem {
    match error {
        exr::error::Error::Io(error) => error.into(),
        other => ReadProblem::Invalid(other.to_string()),
    }
}
