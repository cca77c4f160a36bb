//! A TOML document as a tree in which every key and value knows where it stands.
//!
//! Text comes in; the tree goes to [`super::overrides`], which changes it, and then to
//! [`super::section`], which reads it. Places stay those of the original text.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use toml::de::{DeArray, DeTable, DeValue};

use crate::import::{ImportError, Problem, files};

/// Where a key or a value was written.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// At this byte of the text.
    Text(usize),
    /// In the override of this path.
    Override(Arc<str>),
    /// Nowhere: it stands for what was left out.
    Implied,
}

/// A value and its place.
#[derive(Clone, Debug)]
pub struct Node {
    /// Where it begins.
    pub place: Place,
    /// The value.
    pub kind: Kind,
}

/// A TOML value.
#[derive(Clone, Debug)]
pub enum Kind {
    /// Text.
    String(String),
    /// A whole number; wide enough for every `u64` and `i64`.
    Integer(i128),
    /// A number; may be infinite or NaN.
    Float(f64),
    /// A truth value.
    Boolean(bool),
    /// A date or a time, which no key takes.
    Datetime,
    /// Values in a row.
    Array(Vec<Node>),
    /// Keys and values, in the order of the text.
    Table(Vec<Entry>),
}

/// A key of a table and its value.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub place: Place,
    /// Its value.
    pub node: Node,
}

/// A file and its text: turns places into lines.
#[derive(Debug)]
pub struct Source {
    /// The file.
    pub path: PathBuf,
    text: String,
}

impl Source {
    /// The text of the scene file at `path`.
    ///
    /// # Errors
    /// Where it cannot be read, or is not UTF-8.
    pub fn read(path: &Path) -> Result<Self, ImportError> {
        let bytes = files::read(path).map_err(|error| ImportError::io(path, error))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            ImportError::invalid_at(path, line_of(valid), "not text in UTF-8")
        })?;
        Ok(Self {
            path: path.to_owned(),
            text,
        })
    }

    /// Stands for a file without text of its own.
    pub fn without_text(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            text: String::new(),
        }
    }

    /// The tree of the text; its root is a table.
    ///
    /// # Errors
    /// Where the text is not TOML.
    pub fn parse(&self) -> Result<Node, ImportError> {
        let table = DeTable::parse(&self.text).map_err(|error| {
            // Of tables too deep the parser does not say where they are; the file begins somewhere.
            let start = error.span().map_or(0, |span| span.start);
            self.invalid(&Place::Text(start), error.message())
        })?;
        let at = |offset| Place::Text(offset);
        Ok(Node {
            place: Place::Text(0),
            kind: self.table(table.get_ref(), &at)?,
        })
    }

    /// The tree of one value, every place of which is `place`.
    ///
    /// `None` where `text` is not a value of TOML.
    pub fn parse_value(&self, text: &str, place: &Place) -> Option<Node> {
        let value = DeValue::parse(text).ok()?;
        let kind = self.kind(value.get_ref(), place, &|_| place.clone()).ok()?;
        Some(Node {
            place: place.clone(),
            kind,
        })
    }

    /// An error: `what` is wrong at `place`.
    pub fn invalid(&self, place: &Place, what: impl Into<String>) -> ImportError {
        ImportError {
            path: self.path.clone(),
            place: match place {
                Place::Text(offset) => {
                    let bytes = self.text.as_bytes();
                    Some(line_of(&bytes[..*offset.min(&bytes.len())]))
                }
                Place::Override(path) => Some(format!("--set {path}")),
                Place::Implied => None,
            },
            problem: Problem::Invalid(what.into()),
        }
    }

    fn table(
        &self,
        table: &DeTable<'_>,
        place_at: &dyn Fn(usize) -> Place,
    ) -> Result<Kind, ImportError> {
        let mut spanned: Vec<_> = table.iter().collect();
        // The parser sorts by name; messages name the first mistake of the text.
        spanned.sort_by_key(|(key, _)| key.span().start);
        let mut entries = Vec::with_capacity(spanned.len());
        for (key, value) in spanned {
            let place = place_at(value.span().start);
            entries.push(Entry {
                key: key.get_ref().to_string(),
                place: place_at(key.span().start),
                node: Node {
                    kind: self.kind(value.get_ref(), &place, place_at)?,
                    place,
                },
            });
        }
        Ok(Kind::Table(entries))
    }

    fn array(
        &self,
        array: &DeArray<'_>,
        place_at: &dyn Fn(usize) -> Place,
    ) -> Result<Kind, ImportError> {
        let mut nodes = Vec::with_capacity(array.len());
        for value in array.iter() {
            let place = place_at(value.span().start);
            nodes.push(Node {
                kind: self.kind(value.get_ref(), &place, place_at)?,
                place,
            });
        }
        Ok(Kind::Array(nodes))
    }

    fn kind(
        &self,
        value: &DeValue<'_>,
        place: &Place,
        place_at: &dyn Fn(usize) -> Place,
    ) -> Result<Kind, ImportError> {
        Ok(match value {
            DeValue::String(text) => Kind::String(text.to_string()),
            DeValue::Integer(integer) => Kind::Integer(
                i128::from_str_radix(integer.as_str(), integer.radix())
                    .map_err(|_| self.invalid(place, format!("{integer} is too large")))?,
            ),
            DeValue::Float(float) => Kind::Float(
                float
                    .as_str()
                    .parse()
                    .map_err(|_| self.invalid(place, format!("{float} is not a number")))?,
            ),
            DeValue::Boolean(boolean) => Kind::Boolean(*boolean),
            DeValue::Datetime(_) => Kind::Datetime,
            DeValue::Array(array) => self.array(array, place_at)?,
            DeValue::Table(table) => self.table(table, place_at)?,
        })
    }
}

/// The line on which `before`, the start of a text, ends; counted from 1.
fn line_of(before: &[u8]) -> String {
    let newlines = before.iter().filter(|&&byte| byte == b'\n').count();
    format!("line {}", newlines + 1)
}

impl Node {
    /// A value that stands for what was left out.
    pub fn implied(kind: Kind) -> Self {
        Self {
            place: Place::Implied,
            kind,
        }
    }
}

impl Kind {
    /// What it is, for messages.
    pub fn words(&self) -> String {
        match self {
            Kind::String(text) => format!("{text:?}"),
            Kind::Integer(integer) => integer.to_string(),
            Kind::Float(float) => format!("{float:?}"),
            Kind::Boolean(boolean) => boolean.to_string(),
            Kind::Datetime => "a date or time".to_owned(),
            Kind::Array(nodes) => format!("a list of {}", nodes.len()),
            Kind::Table(_) => "a table".to_owned(),
        }
    }
}
