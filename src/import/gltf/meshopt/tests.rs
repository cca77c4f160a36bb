//! Streams that the reference encoder (meshoptimizer 1.3) made, and what the reference decoder
//! makes of them.

#![allow(clippy::unwrap_used)]

use base64::prelude::{BASE64_STANDARD, Engine};
use serde::Deserialize;

use super::attributes::read_group;
use super::reader::Reader;
use super::{CompressedView, Filter};

#[derive(Deserialize)]
struct Case {
    name: String,
    view: CompressedView,
    stream: String,
    decoded: String,
}

impl Case {
    fn stream(&self) -> Vec<u8> {
        BASE64_STANDARD.decode(&self.stream).unwrap()
    }
}

fn cases() -> Vec<Case> {
    serde_json::from_str(include_str!("../../../../tests/import_gltf/meshopt.json")).unwrap()
}

/// The extension's text allows filters, but for the exponential one, to be one unit off.
#[test]
fn streams_decode_as_the_reference_decodes_them() {
    for case in cases() {
        let expected = BASE64_STANDARD.decode(&case.decoded).unwrap();
        let length = case.view.decoded_length(expected.len() as u64);
        assert_eq!(length, Some(expected.len()), "{}", case.name);
        let decoded = case.view.decode(&case.stream()).unwrap();
        assert_eq!(decoded.len(), expected.len(), "{}", case.name);
        let is_wide = case.view.byte_stride == 8;
        let largest = match case.view.filter {
            Filter::None | Filter::Exponential => {
                assert!(decoded == expected, "{}", case.name);
                continue;
            }
            _ if is_wide => {
                let pairs = decoded.as_chunks().0.iter().zip(expected.as_chunks().0);
                let distance = |(&a, &b): (&[u8; 2], &[u8; 2])| {
                    let distance = u16::from_le_bytes(a).wrapping_sub(u16::from_le_bytes(b));
                    i32::from(distance.cast_signed()).abs()
                };
                pairs.map(distance).max()
            }
            _ => {
                let pairs = decoded.iter().zip(&expected);
                let distance = |(a, b): (&u8, &u8)| i32::from(a.wrapping_sub(*b).cast_signed());
                pairs.map(|pair| distance(pair).abs()).max()
            }
        };
        assert!(largest.unwrap() <= 1, "{}: {largest:?}", case.name);
    }
}

/// The example in the extension's text.
#[test]
fn a_group_of_four_bits_is_as_the_text_says() {
    let bytes = [
        0, 0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5,
    ];
    let (_, mut reader, _) = Reader::split(&bytes, 0).unwrap();
    let mut deltas = [0; 16];
    read_group(&mut reader, 4, &mut deltas).unwrap();
    reader.finish().unwrap();
    let signed = deltas.map(|delta| i32::from((delta >> 1) ^ (delta & 1).wrapping_neg()));
    let wrapped = signed.map(|v| if v > 127 { v - 256 } else { v });
    assert_eq!(
        wrapped,
        [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]
    );
}

#[test]
fn cut_and_changed_streams_are_errors_or_other_bytes_but_never_panics() {
    for case in cases() {
        let stream = case.stream();
        for length in 0..stream.len() {
            // Tails are as long as elements, so some of a stream may look like all of it.
            if let Ok(decoded) = case.view.decode(&stream[..length]) {
                let expected = case.view.decoded_length(decoded.len() as u64);
                assert_eq!(expected, Some(decoded.len()), "{} of {length}", case.name);
            }
        }
        for place in 0..stream.len() {
            let mut changed = stream.clone();
            changed[place] ^= [0x01, 0x80, 0xff][place % 3];
            if let Ok(decoded) = case.view.decode(&changed) {
                let expected = case.view.decoded_length(decoded.len() as u64);
                assert_eq!(expected, Some(decoded.len()), "{}: {place}", case.name);
            }
        }
        let mut longer = stream.clone();
        longer.insert(1, 0);
        assert!(case.view.decode(&[]).is_err());
        assert!(
            case.view.decode(&longer).is_err() || case.view.filter != Filter::None,
            "{}",
            case.name
        );
    }
}

#[test]
fn views_that_do_not_fit_together_are_refused() {
    let length = |json: &str, view| {
        let view_entry: CompressedView = serde_json::from_str(json).unwrap();
        view_entry.decoded_length(view)
    };
    let entry = |stride: usize, count: usize, mode: &str, filter: &str| {
        format!(
            r#"{{"buffer":0,"byteLength":9,"byteStride":{stride},"count":{count},"mode":"{mode}","filter":"{filter}"}}"#
        )
    };
    assert_eq!(
        length(&entry(8, 3, "ATTRIBUTES", "QUATERNION"), 24),
        Some(24)
    );
    for (stride, count, mode, filter, view) in [
        (8, 3, "ATTRIBUTES", "NONE", 25),
        (6, 3, "ATTRIBUTES", "NONE", 18),
        (0, 3, "ATTRIBUTES", "NONE", 0),
        (260, 1, "ATTRIBUTES", "NONE", 260),
        (4, 3, "ATTRIBUTES", "QUATERNION", 12),
        (12, 3, "ATTRIBUTES", "OCTAHEDRAL", 36),
        (4, 4, "TRIANGLES", "NONE", 16),
        (1, 3, "TRIANGLES", "NONE", 3),
        (8, 3, "INDICES", "NONE", 24),
        (4, 3, "INDICES", "EXPONENTIAL", 12),
        (4, usize::MAX / 2, "INDICES", "NONE", 12),
    ] {
        let json = entry(stride, count, mode, filter);
        assert_eq!(length(&json, view), None, "{json}");
    }
}
