//! Arguments that are made of several parts.

use std::str::FromStr;

use halfshade::film::Rect;
use halfshade::math::UVec2;
use halfshade::scene::{MAX_PIXELS, MAX_SIDE};

/// `1280x720`.
pub fn size(text: &str) -> Result<UVec2, String> {
    let wanted = || {
        format!(
            "a size is like 1280x720, with sides from 1 to {MAX_SIDE} \
             and at most {MAX_PIXELS} pixels"
        )
    };
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wanted)?;
    let side = |text: &str| {
        let side: Option<u32> = text.trim().parse().ok();
        side.filter(|side| (1..=MAX_SIDE).contains(side))
    };
    match (side(width), side(height)) {
        (Some(width), Some(height)) if u64::from(width) * u64::from(height) <= MAX_PIXELS => {
            Ok(UVec2::new(width, height))
        }
        _ => Err(wanted()),
    }
}

/// `x,y,w,h`: the upper left pixel, columns and rows.
pub fn crop(text: &str) -> Result<Rect, String> {
    let [x, y, width, height] = numbers(text, "x,y,w,h")?;
    if width == 0 || height == 0 {
        return Err("a crop has at least one pixel".to_owned());
    }
    Ok(Rect {
        x,
        y,
        width,
        height,
    })
}

/// One sample of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct SampleId {
    /// Which pixel of the whole film.
    pub pixel: UVec2,
    /// Which of its samples.
    pub index: u32,
}

/// `x,y,i`: column, row, index of the sample.
pub fn sample_id(text: &str) -> Result<SampleId, String> {
    let [x, y, index] = numbers(text, "x,y,i")?;
    Ok(SampleId {
        pixel: UVec2::new(x, y),
        index,
    })
}

fn numbers<const N: usize>(text: &str, form: &str) -> Result<[u32; N], String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|n| u32::from_str(n.trim())).collect();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| format!("not {N} whole numbers {form}"))
}

/// `PATH=VALUE`.
pub fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((path, value)) if !path.trim().is_empty() => {
            Ok((path.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("not of the form PATH=VALUE, like light.0.radius=0.5".to_owned()),
    }
}

/// A number of seconds; there are some before an animation's start, too.
pub fn seconds(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    number
        .filter(|number| number.is_finite())
        .ok_or_else(|| "not a number".to_owned())
}

/// Frames of a sequence, the first and the last of them.
#[derive(Clone, Copy, Debug)]
pub struct Frames {
    first: u32,
    last: u32,
}

impl Frames {
    /// Their numbers.
    pub fn all(self) -> impl Iterator<Item = u32> {
        self.first..=self.last
    }
}

/// `A..B`: the first and the last frame.
pub fn frames(text: &str) -> Result<Frames, String> {
    let ends = text.trim().split_once("..");
    let ends = ends.and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    match ends {
        Some((first, last)) if first <= last => Ok(Frames { first, last }),
        Some(_) => Err("the last frame comes before the first".to_owned()),
        None => Err("not two numbers like 0..47".to_owned()),
    }
}

/// A number above 0.
pub fn positive(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    number
        .filter(|number| *number > 0.0 && number.is_finite())
        .ok_or_else(|| "not a number above 0".to_owned())
}

/// A number of bytes, or of KiB, MiB or GiB: `1000`, `500M`, `4G`.
pub fn bytes(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let (number, unit) = match text.char_indices().next_back() {
        Some((end, 'K' | 'k')) => (&text[..end], 1u64 << 10),
        Some((end, 'M' | 'm')) => (&text[..end], 1 << 20),
        Some((end, 'G' | 'g')) => (&text[..end], 1 << 30),
        _ => (text, 1),
    };
    let number: Option<u64> = number.parse().ok();
    number
        .and_then(|number| number.checked_mul(unit))
        .ok_or_else(|| "not a number of bytes like 500M or 4G".to_owned())
}

/// How bright a picture is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// By so many stops brighter than it is.
    Stops(f32),
    /// So that it is neither dark nor bright.
    Automatic,
}

/// Stops of exposure, or `auto`.
pub fn exposure(text: &str) -> Result<Exposure, String> {
    if text.trim() == "auto" {
        return Ok(Exposure::Automatic);
    }
    let stops: Option<f32> = text.trim().parse().ok();
    stops
        .filter(|stops| stops.abs() <= 100.0)
        .map(Exposure::Stops)
        .ok_or_else(|| "neither auto nor a number of stops from -100 to 100".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_two_sides() {
        assert_eq!(size("1280x720"), Ok(UVec2::new(1280, 720)));
        for wrong in [
            "",
            "1280",
            "0x7",
            "7x0",
            "-1x7",
            "7x7x7",
            "axb",
            "99999x1",
            "65536x65536",
        ] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn crops_have_four_numbers_and_a_pixel() {
        let rect = Rect {
            x: 1,
            y: 2,
            width: 3,
            height: 4,
        };
        assert_eq!(crop("1, 2,3,4"), Ok(rect));
        for wrong in ["1,2,3", "1,2,3,4,5", "1,2,0,4", "-1,2,3,4", "1.5,2,3,4"] {
            assert!(crop(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn values_may_hold_equals_signs() {
        let expected = ("a.b".to_owned(), "c = d".to_owned());
        assert_eq!(assignment("a.b = c = d"), Ok(expected));
        assert!(assignment("a.b").is_err() && assignment("=1").is_err());
    }

    #[test]
    fn limits_are_above_zero() {
        assert_eq!(positive("1e-3"), Ok(1e-3));
        for wrong in ["0", "-1", "nan", "inf", "x"] {
            assert!(positive(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn bytes_have_units() {
        assert_eq!(bytes("1000"), Ok(1000));
        assert_eq!(bytes("500M"), Ok(500 << 20));
        assert_eq!(bytes(" 4g"), Ok(4 << 30));
        for wrong in ["", "G", "-1", "4.5G", "4GB", "99999999999G"] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn stops_are_finite() {
        assert_eq!(exposure("-1.5"), Ok(Exposure::Stops(-1.5)));
        assert_eq!(exposure("auto"), Ok(Exposure::Automatic));
        assert!(
            ["nan", "inf", "x"]
                .iter()
                .all(|wrong| exposure(wrong).is_err())
        );
    }
}
