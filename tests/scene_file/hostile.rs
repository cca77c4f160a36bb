//! Damaged files of every kind: whatever the bytes, nothing panics, hangs, or takes memory out of proportion.
//!
//! The files are those of `fuzz/seeds`, changed at random, and what is done with them is what the fuzz
//! targets do. Here the changes are blind and always the same; `HALFSHADE_FUZZ_SECONDS=300 cargo test
//! --release --test scene_file -- --ignored hostile` goes on with others for that time per kind.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use halfshade::stress::meshes::Random;

use super::targets;

/// A kind of file, and what is done with it.
type Target = (&'static str, fn(&[u8]));

const TARGETS: [Target; 7] = [
    ("gltf", |bytes| targets::model("gltf", bytes)),
    ("glb", |bytes| targets::model("glb", bytes)),
    ("obj", |bytes| targets::model("obj", bytes)),
    ("mtl", targets::library),
    ("scene", targets::scene),
    ("png", |bytes| targets::picture("png", bytes)),
    ("exr", |bytes| targets::picture("exr", bytes)),
];

/// Numbers at which something ends.
const NUMBERS: [&str; 16] = [
    "0",
    "-1",
    "1",
    "2",
    "3",
    "255",
    "65536",
    "4294967295",
    "4294967296",
    "1e308",
    "-1e39",
    "1e-320",
    "nan",
    "inf",
    "9223372036854775808",
    "0.1",
];

/// No file is longer than this.
const LONGEST: usize = 1 << 14;

fn seeds(kind: &str) -> Vec<Vec<u8>> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/fuzz/seeds")).join(kind);
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    paths.sort();
    assert!(!paths.is_empty(), "{kind}");
    paths
        .into_iter()
        .map(|path| fs::read(path).unwrap())
        .collect()
}

/// One of `seeds`, changed in one to six places.
fn damaged(kind: &str, seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let mut bytes = seeds[random.below(seeds.len())].clone();
    for _ in 0..=random.below(6) {
        if bytes.is_empty() {
            break;
        }
        let at = random.below(bytes.len());
        let end = (at + 1 + random.below(16)).min(bytes.len());
        match random.below(9) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff, b'\n', b'"', b'-'][random.below(8)],
            2 => drop(bytes.drain(at..end)),
            3 => {
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, copy);
            }
            4 => {
                let other = &seeds[random.below(seeds.len())];
                let from = random.below(other.len());
                bytes.truncate(at);
                bytes.extend_from_slice(&other[from..]);
            }
            5 => bytes.truncate(at),
            6 => {
                let word = (random.bits() as u32 >> random.below(32)).to_le_bytes();
                let end = (at + 4).min(bytes.len());
                bytes[at..end].copy_from_slice(&word[..end - at]);
            }
            _ => change_number(&mut bytes, at, random),
        }
    }
    bytes.truncate(LONGEST);
    // Else most of what is behind a sum or a length would never be read.
    if random.below(4) > 0 {
        match kind {
            "png" => mend_png(&mut bytes),
            "glb" => mend_glb(&mut bytes),
            _ => {}
        }
    }
    bytes
}

/// Puts another number in the place of the first one behind `at`.
fn change_number(bytes: &mut Vec<u8>, at: usize, random: &mut Random) {
    let is_part = |b: &u8| b.is_ascii_digit() || b"+-.eE".contains(b);
    let Some(start) = bytes[at..].iter().position(u8::is_ascii_digit) else {
        return;
    };
    let start = at + start;
    let length = bytes[start..].iter().take_while(|b| is_part(b)).count();
    let number = NUMBERS[random.below(NUMBERS.len())].bytes();
    bytes.splice(start..start + length, number);
}

/// Makes the sums of all chunks right.
fn mend_png(bytes: &mut [u8]) {
    let mut at = 8;
    while at + 12 <= bytes.len() {
        let length = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        let end = at + 8 + length;
        if end + 4 > bytes.len() {
            return;
        }
        let sum = crc(&bytes[at + 4..end]).to_be_bytes();
        bytes[end..end + 4].copy_from_slice(&sum);
        at = end + 4;
    }
}

/// The cyclic redundancy check of ISO 3309.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum: u32, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg())
        })
    })
}

/// Makes the length of the whole right, and that of the first chunk where only that does not fit.
fn mend_glb(bytes: &mut [u8]) {
    let total = bytes.len() as u32;
    if total < 28 {
        return;
    }
    bytes[8..12].copy_from_slice(&total.to_le_bytes());
    // The second chunk begins behind the blank-padded document.
    let second = bytes.windows(4).rposition(|w| w == b"BIN\0");
    if let Some(second) = second.filter(|&second| second >= 24) {
        let first = (second - 4 - 20) as u32;
        bytes[12..16].copy_from_slice(&first.to_le_bytes());
        let rest = total - second as u32 - 4;
        bytes[second - 4..second].copy_from_slice(&rest.to_le_bytes());
    }
}

/// Feeds damaged files of one kind to its target until `is_enough`; how many, and the time of the slowest.
fn feed(
    target: (&str, fn(&[u8])),
    seed: u64,
    mut is_enough: impl FnMut(u64) -> bool,
) -> (u64, Duration) {
    let (kind, run) = target;
    let seeds = seeds(kind);
    let mut random = Random(seed);
    seeds.iter().for_each(|seed| run(seed));
    let (mut count, mut slowest) = (0, Duration::ZERO);
    while !is_enough(count) {
        let bytes = damaged(kind, &seeds, &mut random);
        let start = Instant::now();
        if catch_unwind(AssertUnwindSafe(|| run(&bytes))).is_err() {
            let path = std::env::temp_dir().join(format!("halfshade-finding.{kind}"));
            fs::write(&path, &bytes).unwrap();
            panic!(
                "{kind}: damaged file number {count} is kept as {}",
                path.display()
            );
        }
        slowest = slowest.max(start.elapsed());
        count += 1;
    }
    (count, slowest)
}

#[test]
fn damaged_files_do_no_harm() {
    for target in TARGETS {
        let (_, slowest) = feed(target, 91, |count| count == 300);
        assert!(
            slowest < Duration::from_secs(10),
            "{}: {slowest:?}",
            target.0
        );
    }
}

#[test]
#[ignore = "as long as HALFSHADE_FUZZ_SECONDS says, for each kind"]
fn hostile_files_do_no_harm() {
    let variable = |name, default| {
        let text = std::env::var(name).ok();
        text.map_or(default, |text| text.parse().unwrap())
    };
    let seconds = Duration::from_secs(variable("HALFSHADE_FUZZ_SECONDS", 10));
    let seed = variable("HALFSHADE_FUZZ_SEED", 92);
    for target in TARGETS {
        let start = Instant::now();
        let (count, slowest) = feed(target, seed, |_| start.elapsed() > seconds);
        println!(
            "{}: {count} files in {:.0?}, the slowest in {slowest:.1?}",
            target.0,
            start.elapsed()
        );
    }
}
