//! `map_` statements: options and a file name.

use super::super::lines::{Words, number};

/// The use of an image by one property of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The file, as written.
    pub file: String,
    /// `-o`: added to the texture coordinates, after scaling. v grows upwards.
    pub offset: [f32; 2],
    /// `-s`: multiplies the texture coordinates.
    pub scale: [f32; 2],
    /// `-clamp on`: the image is not repeated.
    pub is_clamped: bool,
    /// `-bm`: multiplies heights.
    pub bump_multiplier: f32,
    /// `-imfchan`: the channel that a scalar is read from; `None` where the file leaves it open.
    pub channel: Option<Channel>,
    /// Options that are not shown.
    pub ignored: Vec<String>,
}

/// A channel of an image, as `-imfchan` names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// `r`.
    Red,
    /// `g`.
    Green,
    /// `b`.
    Blue,
    /// `m`, the matte.
    Alpha,
    /// `l`.
    Luminance,
}

impl Map {
    /// What stands behind the keyword; `None` where there is no file name.
    pub fn parse(text: &[u8]) -> Option<Self> {
        let mut map = Self {
            file: String::new(),
            offset: [0.0; 2],
            scale: [1.0; 2],
            is_clamped: false,
            bump_multiplier: 1.0,
            channel: None,
            ignored: Vec::new(),
        };
        let mut words = Words::of_names(text);
        loop {
            let mut ahead = words.clone();
            match ahead.next() {
                Some(option)
                    if option.len() > 1 && option[0] == b'-' && option[1].is_ascii_alphabetic() =>
                {
                    if !map.option(&option[1..], &mut ahead) {
                        break;
                    }
                    words = ahead;
                }
                _ => break,
            }
        }
        map.file = String::from_utf8_lossy(words.rest()).into_owned();
        (!map.file.is_empty()).then_some(map)
    }

    /// Takes in one option with its arguments; `false` where it is none.
    fn option(&mut self, option: &[u8], words: &mut Words<'_>) -> bool {
        match option.to_ascii_lowercase().as_slice() {
            b"o" => fill(&mut self.offset, &numbers(words, 3)),
            b"s" => fill(&mut self.scale, &numbers(words, 3)),
            b"clamp" => self.is_clamped = words.next() == Some(b"on"),
            b"bm" => fill(
                std::slice::from_mut(&mut self.bump_multiplier),
                &numbers(words, 1),
            ),
            b"imfchan" => self.channel = words.next().and_then(channel),
            b"mm" => {
                if numbers(words, 2) != [0.0, 1.0] {
                    self.ignored.push("-mm".to_owned());
                }
            }
            b"t" => {
                numbers(words, 3);
                self.ignored.push("-t".to_owned());
            }
            b"boost" | b"texres" => {
                numbers(words, 1);
            }
            b"blendu" | b"blendv" | b"cc" | b"type" => {
                words.next();
            }
            _ => return false,
        }
        true
    }
}

/// Up to `most` numbers; leaves the last word, which is the file, even where it is a number.
fn numbers(words: &mut Words<'_>, most: usize) -> Vec<f32> {
    let mut values = Vec::new();
    while values.len() < most && words.clone().nth(1).is_some() {
        let mut ahead = words.clone();
        match ahead.next().and_then(number) {
            Some(value) => values.push(value as f32),
            None => break,
        }
        *words = ahead;
    }
    values
}

fn fill(target: &mut [f32], values: &[f32]) {
    for (slot, &value) in target.iter_mut().zip(values) {
        if value.is_finite() {
            *slot = value;
        }
    }
}

fn channel(name: &[u8]) -> Option<Channel> {
    match name {
        b"r" => Some(Channel::Red),
        b"g" => Some(Channel::Green),
        b"b" => Some(Channel::Blue),
        b"m" => Some(Channel::Alpha),
        b"l" => Some(Channel::Luminance),
        _ => None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Map {
        Map::parse(text.as_bytes()).unwrap()
    }

    #[test]
    fn options_may_have_one_to_three_numbers() {
        let map =
            parse(" -s 2 -o 0.5 0.25 -clamp on -bm 0.2 -imfchan m -mm 0 1  my wood.png # oak");
        assert_eq!(map.file, "my wood.png");
        assert_eq!((map.scale, map.offset), ([2.0, 1.0], [0.5, 0.25]));
        assert!(map.is_clamped);
        assert_eq!(
            (map.bump_multiplier, map.channel),
            (0.2, Some(Channel::Alpha))
        );
        assert!(map.ignored.is_empty());
        assert_eq!(parse("-s 1 2 3 4.png").scale, [1.0, 2.0]);
    }

    #[test]
    fn a_name_may_look_like_a_number_or_an_option() {
        assert_eq!(parse("-s 1 2 3").file, "3");
        assert_eq!(parse("-unknown.png").file, "-unknown.png");
        assert_eq!(parse("-o 1 2 3 7").file, "7");
        assert_eq!(Map::parse(b" -clamp on "), None);
        assert_eq!(Map::parse(b""), None);
    }

    #[test]
    fn what_is_not_shown_is_kept_for_a_word_about_it() {
        assert_eq!(parse("-mm 0.1 2 -t 1 1 1 a.png").ignored, ["-mm", "-t"]);
    }
}
