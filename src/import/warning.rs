//! What an author should know about a file that was imported all the same.

use std::collections::BTreeMap;

use serde::Serialize;

/// What kind of thing was ignored or repaired.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum WarningCode {
    /// Points or lines, which are not rendered.
    NotTriangles,
    /// A face with fewer than three corners, or a polygon without area.
    BadFace,
    /// Triangles without area.
    DegenerateTriangle,
    /// Vertices that are not finite numbers.
    NonFiniteVertex,
    /// An attribute of vertices that was dropped.
    BadAttribute,
    /// An extension that the file requires and Halfshade does not know.
    RequiredExtension,
    /// An extension that the file uses and Halfshade does not know.
    IgnoredExtension,
    /// A file that is named and not there, or cannot be read.
    MissingFile,
    /// An image that could not be decoded.
    BadImage,
    /// A material that is named and not there.
    MissingMaterial,
    /// A value that is not a number, or out of its range.
    BadValue,
    /// A statement that was not understood.
    UnknownStatement,
    /// A light that cannot shine as it is described.
    BadLight,
    /// A camera that cannot see as it is described.
    BadCamera,
    /// Something that is not shown as its author meant it.
    Approximated,
}

/// One thing that an author should know.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Warning {
    /// Its kind.
    pub code: WarningCode,
    /// What it is, where, and what will look different.
    pub message: String,
    /// How often it was met.
    pub count: u64,
}

/// Warnings, each message once, with its count, in the order of their kinds.
#[derive(Clone, Debug, Default)]
pub struct Warnings {
    counts: BTreeMap<(WarningCode, String), u64>,
}

impl Warnings {
    /// Adds one.
    pub fn add(&mut self, code: WarningCode, message: impl Into<String>) {
        self.add_many(code, message, 1);
    }

    /// Adds `count` of the same; nothing where `count` is 0.
    pub fn add_many(&mut self, code: WarningCode, message: impl Into<String>, count: u64) {
        if count > 0 {
            *self.counts.entry((code, message.into())).or_default() += count;
        }
    }

    /// Adds all of `other`.
    pub fn extend(&mut self, other: Warnings) {
        for ((code, message), count) in other.counts {
            self.add_many(code, message, count);
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Warning> + '_ {
        self.counts.iter().map(|((code, message), &count)| Warning {
            code: *code,
            message: message.clone(),
            count,
        })
    }
}
