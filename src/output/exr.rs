//! OpenEXR: what was computed, to be measured.
//!
//! Files are of one part, in scan lines, with ZIP compression of 16 lines a block and dotted layer names
//! (`R`, `albedo.R`, `depth.Z`): what every reader understands. Every channel is in single
//! precision. Half floats would take half the space, but end at 65504, and their 11 bits are
//! a relative error of 5e-4, which is more than the errors that these files are compared for.

#[cfg(feature = "exr")]
use std::io::BufWriter;
use std::io::{self, Read, Seek, Write};
use std::path::Path;

#[cfg(feature = "exr")]
use ::exr::meta::attribute::{AttributeValue, Chromaticities, IntegerBounds, Text};
#[cfg(feature = "exr")]
use ::exr::meta::header::{ImageAttributes, LayerAttributes};
#[cfg(feature = "exr")]
use ::exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, LineOrder, Vec2,
    WritableImage,
};

#[cfg(feature = "exr")]
use super::header::sort_attributes;
use super::{OutputError, write_whole};
use crate::color::Rgb;
use crate::math::{UVec2, Vec3};

/// Name of the attribute that holds the metadata.
pub const METADATA_ATTRIBUTE: &str = "halfshade";

/// Where the pixels of a file lie in the whole picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Size of the whole picture: the display window.
    pub picture: UVec2,
    /// The upper left pixel of the part that the file holds: where the data window begins.
    pub corner: UVec2,
    /// Size of that part.
    pub size: UVec2,
}

impl Window {
    /// All of a picture.
    pub fn whole(size: UVec2) -> Self {
        Self {
            picture: size,
            corner: UVec2::ZERO,
            size,
        }
    }
}

/// One layer: values of one kind for every pixel, row by row from the top.
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    /// Stands before the channels' names, with a dot; the picture itself has none.
    pub name: &'a str,
    /// The values.
    pub values: Values<'a>,
}

/// The values of a [`Layer`].
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// Channels `R`, `G`, `B`: linear, Rec. 709.
    Colors(&'a [Rgb]),
    /// Channels `X`, `Y`, `Z`.
    Vectors(&'a [Vec3]),
    /// One channel: `Z` for depths, `Y` for other numbers.
    Numbers {
        /// Its name.
        channel: &'static str,
        /// One number a pixel.
        values: &'a [f32],
    },
}

/// Writes an EXR file with `layers`; `metadata` are keys and values about the whole picture,
/// kept as lines of text in the header's attribute [`METADATA_ATTRIBUTE`]. A key with a slash is an attribute by
/// itself, as Cryptomatte wants it.
///
/// # Errors
/// Where the file cannot be written.
pub fn write(
    path: &Path,
    window: Window,
    layers: &[Layer],
    metadata: &[(&str, String)],
) -> Result<(), OutputError> {
    write_whole(path, |file| {
        encode(file.get_mut(), window, layers, metadata)
    })
}

/// The bytes of an EXR file, to an empty `file`; the same bytes for the same arguments. As in [`write()`].
///
/// # Errors
/// Where `file` fails, or the window or a name is not possible in an EXR file.
#[cfg(feature = "exr")]
pub fn encode(
    mut file: impl Read + Write + Seek,
    window: Window,
    layers: &[Layer],
    metadata: &[(&str, String)],
) -> io::Result<()> {
    let pixels = window.size.x as usize * window.size.y as usize;
    let channels: Vec<_> = layers
        .iter()
        .flat_map(channels)
        .collect::<io::Result<_>>()?;
    debug_assert!(channels.iter().all(|c| c.sample_data.len() == pixels));
    let part = ::exr::image::Layer::new(
        dimensions(window.size),
        LayerAttributes {
            layer_position: position(window.corner)?,
            software_name: Text::new_or_none(concat!("halfshade ", env!("CARGO_PKG_VERSION"))),
            ..LayerAttributes::default()
        },
        Encoding {
            compression: Compression::ZIP16,
            blocks: ::exr::image::Blocks::ScanLines,
            line_order: LineOrder::Increasing,
        },
        AnyChannels::sort(channels.into()),
    );
    let image = Image::new(image_attributes(window, metadata)?, part);
    let mut writer = BufWriter::new(&mut file);
    // The encoder's own threads: none of them where the caller works on one.
    let written = if rayon::current_num_threads() == 1 {
        image.write().non_parallel().to_buffered(&mut writer)
    } else {
        image.write().to_buffered(&mut writer)
    };
    written.map_err(io_error)?;
    writer.flush()?;
    drop(writer);
    sort_attributes(&mut file)
}

/// As above, of a build that cannot.
#[cfg(not(feature = "exr"))]
pub fn encode(
    _: impl Read + Write + Seek,
    _: Window,
    _: &[Layer],
    _: &[(&str, String)],
) -> io::Result<()> {
    Err(super::not_built(super::ImageFormat::Exr))
}

#[cfg(feature = "exr")]
fn channels<'a>(layer: &Layer<'a>) -> Vec<io::Result<AnyChannel<FlatSamples>>> {
    let channel = |suffix: &str, samples: Vec<f32>| {
        let name = if layer.name.is_empty() {
            suffix.to_owned()
        } else {
            format!("{}.{suffix}", layer.name)
        };
        Ok(AnyChannel::new(text(&name)?, FlatSamples::F32(samples)))
    };
    match layer.values {
        Values::Colors(colors) => vec![
            channel("R", colors.iter().map(|c| c.r).collect()),
            channel("G", colors.iter().map(|c| c.g).collect()),
            channel("B", colors.iter().map(|c| c.b).collect()),
        ],
        Values::Vectors(vectors) => vec![
            channel("X", vectors.iter().map(|v| v.x).collect()),
            channel("Y", vectors.iter().map(|v| v.y).collect()),
            channel("Z", vectors.iter().map(|v| v.z).collect()),
        ],
        Values::Numbers {
            channel: name,
            values,
        } => vec![channel(name, values.to_vec())],
    }
}

#[cfg(feature = "exr")]
fn image_attributes(window: Window, metadata: &[(&str, String)]) -> io::Result<ImageAttributes> {
    let mut attributes =
        ImageAttributes::new(IntegerBounds::new(Vec2(0, 0), dimensions(window.picture)));
    attributes.chromaticities = Some(Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });
    let (others, lines): (Vec<_>, Vec<_>) = metadata.iter().partition(|(key, _)| key.contains('/'));
    let lines: String = lines
        .iter()
        .map(|(key, value)| format!("{key} = {value}\n"))
        .collect();
    let lines = (!lines.is_empty()).then_some((METADATA_ATTRIBUTE, &lines));
    let others = others.iter().map(|(key, value)| (*key, value));
    for (name, value) in others.chain(lines) {
        let value = AttributeValue::Text(text(value)?);
        attributes.other.insert(text(name)?, value);
    }
    Ok(attributes)
}

/// EXR's text is of one byte a character; what does not fit becomes `?`.
#[cfg(feature = "exr")]
fn text(string: &str) -> io::Result<Text> {
    let latin: String = string
        .chars()
        .map(|c| if u32::from(c) < 256 { c } else { '?' })
        .collect();
    Text::new_or_none(latin).ok_or_else(|| io::Error::other("a name does not fit into an EXR file"))
}

#[cfg(feature = "exr")]
fn dimensions(size: UVec2) -> Vec2<usize> {
    Vec2(size.x as usize, size.y as usize)
}

#[cfg(feature = "exr")]
fn position(corner: UVec2) -> io::Result<Vec2<i32>> {
    let coordinate = |c: u32| i32::try_from(c).map_err(io::Error::other);
    Ok(Vec2(coordinate(corner.x)?, coordinate(corner.y)?))
}

#[cfg(feature = "exr")]
fn io_error(error: ::exr::error::Error) -> io::Error {
    match error {
        ::exr::error::Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    }
}
