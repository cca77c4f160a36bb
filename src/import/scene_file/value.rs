//! One value of a scene file: its type and its range.

use super::document::{Kind, Node, Source};
use super::nearest::suggestion;
use crate::color::{Rgb, srgb8_to_linear};
use crate::import::ImportError;
use crate::math::DVec3;

/// A value and the key that it belongs to.
#[derive(Clone, Copy, Debug)]
pub struct Value<'a> {
    /// The file.
    pub source: &'a Source,
    /// Its key.
    pub name: &'static str,
    /// The value.
    pub node: &'a Node,
}

/// What numbers a key takes.
#[derive(Clone, Copy, Debug)]
pub struct Domain {
    /// In words that follow "must be".
    pub words: &'static str,
    /// Whether a finite number belongs to it.
    pub contains: fn(f64) -> bool,
}

/// Every finite number.
pub const ANY: Domain = Domain {
    words: "a finite number",
    contains: |_| true,
};

/// 0 and more.
pub const NON_NEGATIVE: Domain = Domain {
    words: "a number that is at least 0",
    contains: |v| v >= 0.0,
};

/// More than 0, also after rounding to single precision.
pub const POSITIVE: Domain = Domain {
    words: "a number above 0",
    contains: |v| v as f32 > 0.0,
};

/// Shares.
pub const SHARE: Domain = Domain {
    words: "a number from 0 to 1",
    contains: |v| (0.0..=1.0).contains(&v),
};

impl<'a> Value<'a> {
    /// An error about this value.
    pub fn invalid(&self, what: impl Into<String>) -> ImportError {
        self.source.invalid(&self.node.place, what)
    }

    /// An error: the value is not what it must be.
    fn must_be(&self, what: &str) -> ImportError {
        let is = self.node.kind.words();
        self.invalid(format!("{} must be {what}, not {is}", self.name))
    }

    /// A number of `domain`.
    pub fn number(&self, domain: Domain) -> Result<f64, ImportError> {
        let number = match self.node.kind {
            Kind::Float(float) => float,
            Kind::Integer(integer) => integer as f64,
            _ => return Err(self.must_be(domain.words)),
        };
        if number.is_finite() && (domain.contains)(number) {
            Ok(number)
        } else {
            Err(self.must_be(domain.words))
        }
    }

    /// A number of `domain` that single precision can hold.
    pub fn single(&self, domain: Domain) -> Result<f32, ImportError> {
        let number = self.number(domain)? as f32;
        if number.is_finite() {
            Ok(number)
        } else {
            Err(self.must_be("a number below 3.4e38"))
        }
    }

    /// A whole number from `min` to `max`.
    pub fn integer(&self, min: u64, max: u64) -> Result<u64, ImportError> {
        let fits = |integer: i128| {
            u64::try_from(integer)
                .ok()
                .filter(|v| (min..=max).contains(v))
        };
        match self.node.kind {
            Kind::Integer(integer) => fits(integer),
            _ => None,
        }
        .ok_or_else(|| self.must_be(&format!("a whole number from {min} to {max}")))
    }

    /// As [`Value::integer`], where `max` fits.
    pub fn integer_u32(&self, min: u32, max: u32) -> Result<u32, ImportError> {
        self.integer(min.into(), max.into()).map(|v| v as u32)
    }

    /// True or false.
    pub fn boolean(&self) -> Result<bool, ImportError> {
        match self.node.kind {
            Kind::Boolean(boolean) => Ok(boolean),
            _ => Err(self.must_be("true or false")),
        }
    }

    /// Text.
    pub fn string(&self) -> Result<&'a str, ImportError> {
        match &self.node.kind {
            Kind::String(text) => Ok(text),
            _ => Err(self.must_be("text in quotes")),
        }
    }

    /// One of several things, which are called what `name` says.
    pub fn one_of<T: Copy>(
        &self,
        choices: &[T],
        name: impl Fn(T) -> &'static str,
    ) -> Result<T, ImportError> {
        let text = self.string()?;
        let choice = choices.iter().find(|&&choice| name(choice) == text);
        choice.copied().ok_or_else(|| {
            let names: Vec<_> = choices.iter().map(|&choice| name(choice)).collect();
            self.unknown(text, &names)
        })
    }

    /// An error: the value is `text`, and that is none of `known`.
    pub fn unknown(&self, text: &str, known: &[&str]) -> ImportError {
        let name = self.name;
        self.invalid(format!(
            "unknown {name} \"{text}\"; {}",
            suggestion(text, known)
        ))
    }

    /// The elements of a list of `N`, each read by `read`.
    pub fn array<const N: usize, T: Copy + Default>(
        &self,
        what: &str,
        read: impl Fn(Value<'a>) -> Result<T, ImportError>,
    ) -> Result<[T; N], ImportError> {
        let nodes = match &self.node.kind {
            Kind::Array(nodes) if nodes.len() == N => nodes,
            _ => return Err(self.must_be(what)),
        };
        let mut array = [T::default(); N];
        for (element, node) in array.iter_mut().zip(nodes) {
            *element = read(Value { node, ..*self })?;
        }
        Ok(array)
    }

    /// Three numbers.
    pub fn vector(&self) -> Result<DVec3, ImportError> {
        self.array("a list of 3 numbers", |v| v.number(ANY))
            .map(DVec3::from_array)
    }

    /// Three numbers that are not all 0, scaled to length 1.
    pub fn direction(&self) -> Result<DVec3, ImportError> {
        let vector = self.vector()?;
        normalize(vector).ok_or_else(|| {
            let name = self.name;
            self.invalid(format!("{name} is a direction and must not be zero"))
        })
    }

    /// A colour: three linear numbers of `domain`, or an sRGB string `"#rrggbb"` or `"#rgb"`.
    pub fn color(&self, domain: Domain) -> Result<Rgb, ImportError> {
        const WHAT: &str = "[red, green, blue] or \"#rrggbb\"";
        if let Kind::String(text) = &self.node.kind {
            return hex_color(text).ok_or_else(|| self.must_be(WHAT));
        }
        self.array(WHAT, |v| v.single(domain))
            .map(|channels: [f32; 3]| Rgb::from(channels))
    }
}

/// `v` at length 1, whatever its size; `None` where it is zero or not finite.
pub fn normalize(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    // Division by the largest component first keeps squares from under- and overflowing.
    (largest > 0.0 && v.is_finite()).then(|| (v / largest).normalize())
}

/// The linear colour of `#rrggbb` or `#rgb`.
fn hex_color(text: &str) -> Option<Rgb> {
    let digits = text.strip_prefix('#')?.as_bytes();
    let digit = |i: usize| (digits[i] as char).to_digit(16).map(|d| d as u8);
    let level = |channel: usize| match digits.len() {
        3 => Some(17 * digit(channel)?),
        6 => Some(16 * digit(2 * channel)? + digit(2 * channel + 1)?),
        _ => None,
    };
    let channel = |i| level(i).map(srgb8_to_linear);
    Some(Rgb::new(channel(0)?, channel(1)?, channel(2)?))
}
