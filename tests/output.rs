//! Written files, read back by other code than wrote them.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::io::Cursor;

use halfshade::color::Rgb;
use halfshade::math::{UVec2, Vec3};
use halfshade::output::ImageFormat;
use halfshade::output::exr::{self as exr_file, Layer, Values, Window};
use halfshade::output::png::{self as png_file, PngBits, PngOptions};
use halfshade::scene::ToneMap;

const SIZE: UVec2 = UVec2::new(5, 37);

fn ramp() -> Vec<Rgb> {
    (0..SIZE.x * SIZE.y)
        .map(|i| Rgb::new(i as f32 / 184.0, 1e-30 * i as f32, 1e30 - i as f32 * 1e27))
        .collect()
}

fn decoded_png(bytes: &[u8]) -> (png::Info<'static>, Vec<u8>) {
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut pixels).unwrap();
    pixels.truncate(frame.buffer_size());
    (reader.info().clone(), pixels)
}

fn encoded_png(size: UVec2, pixels: &[Rgb], options: PngOptions) -> Vec<u8> {
    let mut bytes = Vec::new();
    png_file::encode(&mut bytes, size, pixels, None, options).unwrap();
    bytes
}

#[test]
fn png_levels_follow_the_srgb_curve_and_clip() {
    // Middle grey of sRGB is 0.2140 linear at level 127.5 (IEC 61966-2-1).
    let pixels = [
        Rgb::new(0.0, 1.0, 0.214_041_14),
        Rgb::new(-3.0, 7.0, 0.003_130_8),
    ];
    let size = UVec2::new(2, 1);
    let (info, levels) = decoded_png(&encoded_png(size, &pixels, PngOptions::default()));
    assert_eq!((info.width, info.height), (2, 1));
    assert_eq!(levels[..2], [0, 255]);
    assert!((127..=128).contains(&levels[2]), "{levels:?}");
    assert_eq!(levels[3..], [0, 255, 10]);
    assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
    assert!(info.gama_chunk.is_some() && info.chrm_chunk.is_some());
}

#[test]
fn sixteen_bits_and_exposure() {
    let options = PngOptions {
        bits: PngBits::Sixteen,
        exposure_ev: -1.0,
        tone_map: ToneMap::None,
    };
    let size = UVec2::new(1, 1);
    let pixel = Rgb::new(2.0, 2.0 * 0.214_041_14, 0.0);
    let (info, bytes) = decoded_png(&encoded_png(size, &[pixel], options));
    assert_eq!(info.bit_depth, png::BitDepth::Sixteen);
    let levels: Vec<u16> = bytes
        .chunks(2)
        .map(|b| u16::from_be_bytes([b[0], b[1]]))
        .collect();
    assert_eq!((levels[0], levels[2]), (65535, 0));
    assert!(levels[1].abs_diff(32768) <= 1, "{levels:?}");
}

#[test]
fn the_tone_map_reaches_the_file() {
    let options = PngOptions {
        tone_map: ToneMap::Aces,
        ..PngOptions::default()
    };
    let (_, levels) = decoded_png(&encoded_png(UVec2::ONE, &[Rgb::WHITE], options));
    // 2.54 / 3.16 is 0.8038 linear, 0.9085 encoded.
    assert_eq!(levels, [232; 3]);
}

/// Half of a pixel covered by linear 0.5, nothing, and a bit that rounding made brighter than its share.
#[test]
fn opacity_is_straight_in_png() {
    let pixels = [Rgb::new(0.25, 0.5, 0.0), Rgb::BLACK, Rgb::splat(0.25)];
    let alpha = [0.5, 0.0, 0.2];
    for bits in [PngBits::Eight, PngBits::Sixteen] {
        let options = PngOptions {
            bits,
            ..PngOptions::default()
        };
        let mut bytes = Vec::new();
        png_file::encode(&mut bytes, UVec2::new(3, 1), &pixels, Some(&alpha), options).unwrap();
        let (info, bytes) = decoded_png(&bytes);
        assert_eq!(info.color_type, png::ColorType::Rgba);
        // The first byte of a level of 16 bits is nearly that of 8.
        let step = match bits {
            PngBits::Eight => 1,
            PngBits::Sixteen => 2,
        };
        let levels: Vec<u8> = bytes.iter().step_by(step).copied().collect();
        // sRGB of linear 0.5 is 0.7354.
        let expected = [188, 255, 0, 128, 0, 0, 0, 0, 255, 255, 255, 51];
        let is_near = |(a, b): (&u8, &u8)| a.abs_diff(*b) <= 1;
        assert!(levels.iter().zip(&expected).all(is_near), "{levels:?}");
    }
}

#[test]
fn exr_keeps_every_bit_in_named_channels_of_one_part() {
    use exr::prelude::*;
    let colors = ramp();
    let normals: Vec<Vec3> = colors.iter().map(|c| Vec3::new(c.r, -c.r, 0.5)).collect();
    let depths: Vec<f32> = colors.iter().map(|c| c.b).collect();
    let layers = [
        exr_file::Layer {
            name: "",
            values: Values::Colors(&colors),
        },
        exr_file::Layer {
            name: "normal",
            values: Values::Vectors(&normals),
        },
        exr_file::Layer {
            name: "depth",
            values: Values::Numbers {
                channel: "Z",
                values: &depths,
            },
        },
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let metadata = [
        ("seed", "7".to_owned()),
        ("cryptomatte/0123456/name", "CryptoObject".to_owned()),
        ("scene", "haus-ü-☃".to_owned()),
    ];
    exr_file::write(&path, Window::whole(SIZE), &layers, &metadata).unwrap();

    let image = read_all_flat_layers_from_file(&path).unwrap();
    assert_eq!(image.layer_data.len(), 1);
    let part = &image.layer_data[0];
    assert_eq!(part.encoding.compression, Compression::ZIP16);
    assert_eq!(part.encoding.blocks, exr::image::Blocks::ScanLines);
    let names: Vec<String> = part
        .channel_data
        .list
        .iter()
        .map(|c| c.name.to_string())
        .collect();
    // The order that the format demands.
    let expected = ["B", "G", "R", "depth.Z", "normal.X", "normal.Y", "normal.Z"];
    assert_eq!(names, expected);
    let bits = |name: &str| -> Vec<u32> {
        let channel = part.channel_data.list.iter().find(|c| c.name == *name);
        match &channel.unwrap().sample_data {
            FlatSamples::F32(values) => values.iter().map(|v| v.to_bits()).collect(),
            other => panic!("{name} is {other:?}"),
        }
    };
    let of = |value: &dyn Fn(usize) -> f32| -> Vec<u32> {
        (0..colors.len()).map(|i| value(i).to_bits()).collect()
    };
    assert_eq!(bits("R"), of(&|i| colors[i].r));
    assert_eq!(bits("G"), of(&|i| colors[i].g));
    assert_eq!(bits("B"), of(&|i| colors[i].b));
    assert_eq!(bits("normal.Y"), of(&|i| normals[i].y));
    assert_eq!(bits("depth.Z"), of(&|i| depths[i]));

    let chromaticities = image.attributes.chromaticities.unwrap();
    assert_eq!(chromaticities.red, Vec2(0.64, 0.33));
    assert_eq!(chromaticities.white, Vec2(0.3127, 0.3290));
    let key = Text::from(exr_file::METADATA_ATTRIBUTE);
    let text = part.attributes.other.get(&key);
    let AttributeValue::Text(text) = text.unwrap() else {
        panic!("{text:?} is not text");
    };
    assert_eq!(text.to_string(), "seed = 7\nscene = haus-ü-?\n");
    let key = Text::from("cryptomatte/0123456/name");
    let name = part.attributes.other.get(&key).unwrap();
    assert_eq!(*name, AttributeValue::Text(Text::from("CryptoObject")));
}

#[test]
fn a_part_of_a_picture_says_where_it_lies() {
    let window = Window {
        picture: UVec2::new(1920, 1080),
        corner: UVec2::new(100, 200),
        size: SIZE,
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let colors = ramp();
    let layer = Layer {
        name: "",
        values: Values::Colors(&colors),
    };
    exr_file::write(&path, window, &[layer], &[]).unwrap();
    let meta = exr::meta::MetaData::read_from_file(&path, true).unwrap();
    let header = &meta.headers[0];
    let display = header.shared_attributes.display_window;
    assert_eq!(display.size, exr::math::Vec2(1920, 1080));
    assert_eq!(
        header.own_attributes.layer_position,
        exr::math::Vec2(100, 200)
    );
    assert_eq!(header.layer_size, exr::math::Vec2(5, 37));
}

#[test]
fn the_same_picture_makes_the_same_bytes() {
    let size = UVec2::new(64, 300);
    let colors: Vec<Rgb> = (0..size.x * size.y)
        .map(|i| Rgb::splat(i as f32).map(|c| (c * 0.37).sin()))
        .collect();
    let metadata = [
        ("samples", "64".to_owned()),
        ("seed", "0".to_owned()),
        ("a/b", "1".to_owned()),
        ("a/c", "22".to_owned()),
        ("a/d", "333".to_owned()),
        ("e/f", "4444".to_owned()),
    ];
    let encoded = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let layer = Layer {
                name: "",
                values: Values::Colors(&colors),
            };
            let mut bytes = Cursor::new(Vec::new());
            exr_file::encode(&mut bytes, Window::whole(size), &[layer], &metadata).unwrap();
            bytes.into_inner()
        })
    };
    let first = encoded(1);
    for threads in [1, 2, 7] {
        assert!(encoded(threads) == first, "{threads} threads");
    }
}

#[test]
fn extensions_name_the_format_in_any_case() {
    let of = |name: &str| ImageFormat::of_path(name.as_ref());
    assert_eq!(of("a.PNG"), Some(ImageFormat::Png));
    assert_eq!(of("a.b/c.exr"), Some(ImageFormat::Exr));
    assert_eq!(of("a.jpg"), None);
    assert_eq!(of("png"), None);
}
