//! Cryptomatte: which things cover a pixel, by name (Friedman and Jones 2015, "Fully Automatic ID Mattes with
//! Support for Motion Blur and Transparency"; Cryptomatte Specification 1.2).
//!
//! A thing's id is the hash of its name, as a number in single precision. Every pixel holds pairs of an id and the
//! share of the pixel that it covers, the largest first, two pairs in the four channels of a layer. The
//! header holds the names, so that a matte of one of them can be drawn from the file alone.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::exr::{Layer, Values};

/// Pairs that every pixel has room for; the smallest shares are left out.
const RANKS: usize = 6;
const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

/// The layers of one kind of name.
#[derive(Clone, Debug)]
pub struct Cryptomatte {
    name: String,
    manifest: String,
    /// `CryptoObject00` and so on.
    layer_names: Vec<String>,
    /// Id and coverage of each rank, in turn.
    channels: Vec<Vec<f32>>,
}

impl Cryptomatte {
    /// Layers called `name`, like `CryptoObject`, of `pixels`: pairs of an index into `names` and the share that
    /// is covered. Things of one name are one.
    pub fn new<P>(name: &str, names: &[String], pixels: impl ExactSizeIterator<Item = P>) -> Self
    where
        P: Iterator<Item = (usize, f32)>,
    {
        let ids: Vec<u32> = names.iter().map(|name| id(name)).collect();
        let mut channels = vec![Vec::new(); 2 * RANKS];
        let mut ranks: Vec<(u32, f32)> = Vec::new();
        for pixel in pixels {
            ranks.clear();
            for (index, share) in pixel.filter(|(_, share)| *share > 0.0) {
                match ranks.iter_mut().find(|(id, _)| *id == ids[index]) {
                    Some((_, sum)) => *sum += share,
                    None => ranks.push((ids[index], share)),
                }
            }
            ranks.sort_by(|(a, x), (b, y)| y.total_cmp(x).then(a.cmp(b)));
            ranks.resize(RANKS, (0, 0.0));
            for (rank, &(id, share)) in ranks.iter().enumerate() {
                channels[2 * rank].push(f32::from_bits(id));
                channels[2 * rank + 1].push(share);
            }
        }
        Self {
            name: name.to_owned(),
            manifest: manifest(names),
            layer_names: (0..RANKS / 2).map(|i| format!("{name}{i:02}")).collect(),
            channels,
        }
    }

    /// What stands beside the picture.
    pub fn layers(&self) -> impl Iterator<Item = Layer<'_>> {
        let pairs = self.channels.iter().enumerate();
        pairs.map(|(i, values)| Layer {
            name: &self.layer_names[i / 4],
            values: Values::Numbers {
                channel: CHANNELS[i % 4],
                values,
            },
        })
    }

    /// What stands in the header.
    pub fn attributes(&self) -> [(String, String); 4] {
        let key = &format!("{:08x}", id(&self.name))[..7];
        let entry = |what: &str, value: &str| {
            let name = format!("cryptomatte/{key}/{what}");
            (name, value.to_owned())
        };
        [
            entry("conversion", "uint32_to_float32"),
            entry("hash", "MurmurHash3_32"),
            entry("manifest", &self.manifest),
            entry("name", &self.name),
        ]
    }
}

/// The bits of the number that stands for `name`: its hash, changed where it would be no normal number.
fn id(name: &str) -> u32 {
    let hash = murmur3(name.as_bytes());
    match hash >> 23 & 0xff {
        0 | 0xff => hash ^ 1 << 23,
        _ => hash,
    }
}

/// Names and their ids as JSON, in ASCII: an EXR file's text has one byte a character.
fn manifest(names: &[String]) -> String {
    let ids: BTreeMap<&str, u32> = names.iter().map(|name| (name.as_str(), id(name))).collect();
    let mut text = String::from("{");
    for (i, (name, id)) in ids.into_iter().enumerate() {
        text.push_str(if i > 0 { ",\"" } else { "\"" });
        for unit in name.encode_utf16() {
            match u8::try_from(unit) {
                Ok(c @ (b'"' | b'\\')) => text.extend(['\\', c.into()]),
                Ok(c @ b' '..=b'~') => text.push(c.into()),
                // Writing to a string does not fail.
                _ => drop(write!(text, "\\u{unit:04x}")),
            }
        }
        let _ = write!(text, "\":\"{id:08x}\"");
    }
    text.push('}');
    text
}

/// MurmurHash3 of 32 bits for little-endian machines, with the seed 0 (Appleby 2011).
fn murmur3(bytes: &[u8]) -> u32 {
    let mixed = |block: u32| {
        let block = block.wrapping_mul(0xcc9e_2d51).rotate_left(15);
        block.wrapping_mul(0x1b87_3593)
    };
    let number = |bytes: &[u8]| (bytes.iter().rev()).fold(0, |sum, &b| sum << 8 | u32::from(b));
    let blocks = bytes.chunks_exact(4);
    let tail = number(blocks.remainder());
    let hash = blocks.fold(0u32, |hash, block| {
        let hash = (hash ^ mixed(number(block))).rotate_left(13);
        hash.wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    let mut hash = hash ^ mixed(tail) ^ bytes.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published test vectors of MurmurHash3_x86_32.
    #[test]
    fn the_hash_is_murmur_s() {
        for (text, hash) in [
            ("", 0),
            ("test", 0xba6b_d213),
            ("Hello, world!", 0xc036_3e43),
            ("The quick brown fox jumps over the lazy dog", 0x2e4f_f723),
        ] {
            assert_eq!(murmur3(text.as_bytes()), hash, "{text}");
        }
    }

    #[test]
    fn ids_are_normal_numbers() {
        // The hash of nothing is 0, and becomes the smallest normal number.
        assert_eq!(id(""), 1 << 23);
        assert!((0..5000).all(|i| f32::from_bits(id(&format!("object{i}"))).is_normal()));
    }

    #[test]
    fn ranks_are_sorted_by_coverage_and_names_merged() {
        let names = ["a", "b", "a", "c"].map(String::from);
        let pixel = [(0, 0.2), (1, 0.25), (2, 0.1), (3, 0.0)];
        let pixels = [&pixel[..], &[]].map(|pixel| pixel.iter().copied());
        let matte = Cryptomatte::new("CryptoObject", &names, pixels.into_iter());
        let layers: Vec<_> = matte.layers().collect();
        assert_eq!(layers.len(), 12);
        assert_eq!(layers[0].name, "CryptoObject00");
        assert_eq!(layers[11].name, "CryptoObject02");
        let first: Vec<f32> = matte.channels[..4].iter().map(|c| c[0]).collect();
        assert_eq!(first[0].to_bits(), id("a"));
        assert!((first[1] - 0.3).abs() < 1e-7);
        assert_eq!((first[2].to_bits(), first[3]), (id("b"), 0.25));
        assert!(matte.channels.iter().all(|c| c[1] == 0.0));
        assert!(matte.channels[4..].iter().all(|c| c[0] == 0.0));
    }

    #[test]
    fn the_manifest_is_json_of_names_and_ids() {
        let names = ["Wand \"ü\"\n", "☃\\", "test"].map(String::from);
        let text = manifest(&names);
        assert!(text.is_ascii());
        let read: Result<BTreeMap<String, String>, _> = serde_json::from_str(&text);
        let read = read.unwrap_or_default();
        assert_eq!(read.len(), 3);
        for name in &names {
            assert_eq!(read[name], format!("{:08x}", id(name)));
        }
        assert_eq!(read["test"], "ba6bd213");
    }
}
