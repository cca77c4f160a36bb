//! Pictures read from files.

use std::fs;
use std::path::{Path, PathBuf};

use exr::prelude::{
    AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    Vec2, WritableImage, f16,
};
use halfshade::color::{Rgb, srgb_to_linear, srgb8_to_linear};
use halfshade::import::SizeError;
use halfshade::math::UVec2;
use halfshade::output::exr::{self as exr_file, Layer as OurLayer, Values, Window};
use halfshade::output::png::{self as png_file, PngBits, PngOptions};
use halfshade::report::{Picture, ReadProblem, read_picture};
use tempfile::TempDir;

use super::picture;

const SIZE: UVec2 = UVec2::new(7, 5);

fn folder() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("picture");
    (folder, path)
}

fn read(path: &Path) -> Picture {
    read_picture(path).unwrap().picture
}

fn problem(path: &Path) -> ReadProblem {
    read_picture(path).unwrap_err().problem
}

/// Writes channels of 7 x 5 pixels.
fn write_channels(path: &Path, channels: Vec<(&str, FlatSamples)>) {
    let channels = channels
        .into_iter()
        .map(|(name, samples)| AnyChannel::new(name, samples));
    let layer = Layer::new(
        Vec2(7, 5),
        LayerAttributes::default(),
        Encoding::FAST_LOSSLESS,
        AnyChannels::sort(channels.collect()),
    );
    Image::from_layer(layer).write().to_file(path).unwrap();
}

fn numbers(offset: f32) -> Vec<f32> {
    (0..35).map(|i| offset + i as f32).collect()
}

#[test]
fn exr_comes_back_bit_for_bit_and_other_layers_are_left_out() {
    let (_folder, path) = folder();
    let original = picture(SIZE, |x, y, c| {
        (x as f32 - 3.0) * 1e30f32.powf(y as f32 / 4.0) + c as f32
    });
    let albedo = vec![Rgb::WHITE; 35];
    let layer = |name, values| OurLayer { name, values };
    let layers = [
        layer("", Values::Colors(&original.pixels)),
        layer("albedo", Values::Colors(&albedo)),
    ];
    // A crop is as large as what it holds.
    let window = Window {
        picture: UVec2::new(20, 20),
        corner: UVec2::new(4, 6),
        size: SIZE,
    };
    exr_file::write(&path, window, &layers, &[]).unwrap();
    let opened = read_picture(&path).unwrap();
    assert_eq!(opened.picture, original);
    assert!(!opened.has_other_primaries);
}

#[test]
fn exr_of_half_floats_and_of_greys_is_read() {
    let (_folder, path) = folder();
    let halves =
        |offset| FlatSamples::F16(numbers(offset).into_iter().map(f16::from_f32).collect());
    write_channels(
        &path,
        vec![
            ("R", halves(0.0)),
            ("G", halves(100.0)),
            ("B", halves(0.5)),
            ("A", halves(9.0)),
        ],
    );
    assert_eq!(read(&path).pixels[34], Rgb::new(34.0, 134.0, 34.5));
    write_channels(&path, vec![("Y", FlatSamples::F32(numbers(0.25)))]);
    assert_eq!(read(&path).pixels[8], Rgb::splat(8.25));
    write_channels(&path, vec![("depth.Z", FlatSamples::F32(numbers(0.0)))]);
    assert!(matches!(problem(&path), ReadProblem::NoColors));
}

#[test]
fn other_primaries_are_told() {
    let (_folder, path) = folder();
    let channels =
        ["B", "G", "R"].map(|name| AnyChannel::new(name, FlatSamples::F32(numbers(0.0))));
    let layer = Layer::new(
        Vec2(7, 5),
        LayerAttributes::default(),
        Encoding::UNCOMPRESSED,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut image = Image::from_layer(layer);
    // ACES AP0.
    image.attributes.chromaticities = Some(exr::meta::attribute::Chromaticities {
        red: Vec2(0.7347, 0.2653),
        green: Vec2(0.0, 1.0),
        blue: Vec2(0.0001, -0.077),
        white: Vec2(0.32168, 0.33767),
    });
    image.write().to_file(&path).unwrap();
    assert!(read_picture(&path).unwrap().has_other_primaries);
}

#[test]
fn png_is_decoded_from_srgb() {
    let (_folder, path) = folder();
    let original = picture(SIZE, |x, y, c| (x * 5 + y * 7 + c) as f32 / 70.0);
    for (bits, tolerance) in [
        (PngBits::Eight, 0.5 / 255.0),
        (PngBits::Sixteen, 0.5 / 65535.0),
    ] {
        let options = PngOptions {
            bits,
            ..PngOptions::default()
        };
        png_file::write(&path, SIZE, &original.pixels, None, options).unwrap();
        let back = read(&path);
        assert_eq!(back.size, SIZE);
        for (a, b) in back.pixels.iter().zip(&original.pixels) {
            // A level is at most 2.3 times wider in linear values than encoded.
            let off = a
                .channels()
                .into_iter()
                .zip(b.channels())
                .map(|(a, b)| (a - b).abs());
            assert!(
                off.fold(0.0, f32::max) <= 2.3 * tolerance,
                "{a:?} for {b:?}"
            );
        }
    }
}

#[test]
fn png_of_any_kind_is_read_exactly() {
    let (_folder, path) = folder();
    let png = image::ImageFormat::Png;
    image::GrayImage::from_pixel(2, 1, image::Luma([77]))
        .save_with_format(&path, png)
        .unwrap();
    assert_eq!(read(&path).pixels, [Rgb::splat(srgb8_to_linear(77)); 2]);
    let see_through = image::Rgba([10, 20, 30, 0]);
    image::RgbaImage::from_pixel(1, 1, see_through)
        .save_with_format(&path, png)
        .unwrap();
    assert_eq!(
        read(&path).pixels,
        [Rgb::from([10, 20, 30].map(srgb8_to_linear))]
    );
    let deep = image::Luma([40_000u16]);
    let deep = image::ImageBuffer::from_pixel(1, 1, deep);
    image::DynamicImage::ImageLuma16(deep)
        .save_with_format(&path, png)
        .unwrap();
    assert_eq!(
        read(&path).pixels,
        [Rgb::splat(srgb_to_linear(40_000.0 / 65535.0))]
    );
}

#[test]
fn what_is_no_picture_is_an_error_that_names_the_file() {
    let (folder, path) = folder();
    let missing = read_picture(&path).unwrap_err();
    assert!(matches!(missing.problem, ReadProblem::Io(_)));
    assert!(
        missing.to_string().contains("picture: could not be read: "),
        "{missing}"
    );
    assert!(matches!(problem(folder.path()), ReadProblem::Io(_)));
    for text in ["", "abc", "GIF89a and more"] {
        fs::write(&path, text).unwrap();
        assert!(matches!(problem(&path), ReadProblem::OtherFormat), "{text}");
    }
}

#[test]
fn damaged_files_are_errors() {
    let (_folder, path) = folder();
    let original = picture(SIZE, |x, y, c| (x * y + c) as f32 / 40.0);
    png_file::write(&path, SIZE, &original.pixels, None, PngOptions::default()).unwrap();
    let png = fs::read(&path).unwrap();
    let layer = OurLayer {
        name: "",
        values: Values::Colors(&original.pixels),
    };
    exr_file::write(&path, Window::whole(SIZE), &[layer], &[]).unwrap();
    let exr = fs::read(&path).unwrap();
    for bytes in [png, exr] {
        for length in (0..bytes.len() * 3 / 4).step_by(7) {
            fs::write(&path, &bytes[..length]).unwrap();
            assert!(
                read_picture(&path).is_err(),
                "{length} of {} bytes",
                bytes.len()
            );
        }
        for at in (0..bytes.len()).step_by(3) {
            let mut broken = bytes.clone();
            broken[at] ^= 0xa5;
            fs::write(&path, &broken).unwrap();
            // Pixels may be read that are wrong, but nothing else may happen.
            let _ = read_picture(&path);
        }
    }
}

#[test]
fn a_small_file_cannot_claim_more_pixels_than_a_picture_has() {
    let (_folder, path) = folder();
    png_file::write(
        &path,
        UVec2::ONE,
        &[Rgb::WHITE],
        None,
        PngOptions::default(),
    )
    .unwrap();
    let mut bytes = fs::read(&path).unwrap();
    bytes[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let mut checksum = crc32(&bytes[12..29]).to_be_bytes();
    bytes[29..33].swap_with_slice(&mut checksum);
    fs::write(&path, bytes).unwrap();
    let error = problem(&path);
    assert!(
        matches!(
            error,
            ReadProblem::Size(SizeError::TooLarge {
                width: 65536,
                height: 65536
            })
        ),
        "{error}"
    );
    assert_eq!(
        error.to_string(),
        "has 65536 × 65536 pixels, which are more than 268435456"
    );
}

/// Found by fuzzing: 541 bytes took 3 GB, and 819 bytes 2 GB.
#[test]
fn a_file_cannot_claim_more_pixels_than_its_bytes_can_hold() {
    let seeds = concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/seeds/exr");
    for name in ["many-pixels", "many-channels", "many-channels-dwaa"] {
        let error = problem(&Path::new(seeds).join(name));
        assert!(
            matches!(error, ReadProblem::Size(SizeError::TooShort { .. })),
            "{name}: {error}"
        );
        let message = error.to_string();
        assert!(message.starts_with("says that it has "), "{message}");
        assert!(
            message.contains(" pixels, which do not fit into its "),
            "{message}"
        );
    }
}

/// The longest runs there are: nothing is refused that a file of its size can be.
#[test]
fn a_picture_of_one_colour_is_read_however_large() {
    let (_folder, path) = folder();
    let black = || FlatSamples::F32(vec![0.0; 2_000_000]);
    let channels = ["R", "G", "B"].map(|name| AnyChannel::new(name, black()));
    let layer = Layer::new(
        Vec2(2000, 1000),
        LayerAttributes::default(),
        Encoding {
            compression: Compression::PXR24,
            ..Encoding::FAST_LOSSLESS
        },
        AnyChannels::sort(channels.into_iter().collect()),
    );
    Image::from_layer(layer).write().to_file(&path).unwrap();
    let picture = read(&path);
    assert_eq!(picture.size, UVec2::new(2000, 1000));
    assert!(picture.pixels.iter().all(|pixel| pixel.is_black()));
}

/// CRC-32 of PNG (ISO 15948, annex D), bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc: u32, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| {
            (c >> 1) ^ (0xedb8_8320 * (c & 1))
        })
    })
}
