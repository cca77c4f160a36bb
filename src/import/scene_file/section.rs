//! A table of a scene file, all keys of which are known.

use super::document::{Entry, Kind, Node, Place, Source};
use super::nearest::suggestion;
use super::value::Value;
use crate::import::ImportError;

/// A table, after its keys were checked.
#[derive(Clone, Debug)]
pub struct Section<'a> {
    /// The file.
    pub source: &'a Source,
    /// How it is called in messages, such as `[[light]]`.
    pub heading: String,
    place: &'a Place,
    entries: &'a [Entry],
    known: &'a [&'a str],
}

impl<'a> Section<'a> {
    /// The table `node`, which may have the keys `known`.
    ///
    /// # Errors
    /// Where it is not a table, or has another key.
    pub fn new(
        source: &'a Source,
        node: &'a Node,
        heading: impl Into<String>,
        known: &'a [&'a str],
    ) -> Result<Self, ImportError> {
        let heading = heading.into();
        let entries = entries(source, node, &heading)?;
        for entry in entries {
            if !known.contains(&entry.key.as_str()) {
                let place = if heading.is_empty() { "" } else { " in " };
                let message = format!(
                    "unknown key \"{}\"{place}{heading}; {}",
                    entry.key,
                    suggestion(&entry.key, known)
                );
                return Err(source.invalid(&entry.place, message));
            }
        }
        Ok(Self {
            source,
            heading,
            place: &node.place,
            entries,
            known,
        })
    }

    /// The value of `key`, read by `read`; `None` where it is left out.
    ///
    /// # Errors
    /// Those of `read`.
    pub fn get<T>(
        &self,
        key: &'static str,
        read: impl FnOnce(Value<'a>) -> Result<T, ImportError>,
    ) -> Result<Option<T>, ImportError> {
        self.value(key).map(read).transpose()
    }

    /// The value of `key`, read by `read`.
    ///
    /// # Errors
    /// Where it is left out, and those of `read`.
    pub fn require<T>(
        &self,
        key: &'static str,
        read: impl FnOnce(Value<'a>) -> Result<T, ImportError>,
    ) -> Result<T, ImportError> {
        self.get(key, read)?
            .ok_or_else(|| self.invalid(format!("{} needs \"{key}\"", self.heading)))
    }

    /// The value of `key` as it stands; `None` where it is left out.
    pub fn value(&self, key: &'static str) -> Option<Value<'a>> {
        debug_assert!(self.known.contains(&key), "{key} is not checked for");
        find(self.entries, key).map(|entry| Value {
            source: self.source,
            name: key,
            node: &entry.node,
        })
    }

    /// The tables of the list `key`; none where it is left out.
    ///
    /// # Errors
    /// Where it is not a list.
    pub fn list(&self, key: &'static str) -> Result<&'a [Node], ImportError> {
        match self.value(key).map(|value| value.node) {
            None => Ok(&[]),
            Some(Node {
                kind: Kind::Array(nodes),
                ..
            }) => Ok(nodes),
            Some(node) => Err(self.source.invalid(
                &node.place,
                format!("there may be several of {key}: write [[{key}]]"),
            )),
        }
    }

    /// An error about the whole table.
    pub fn invalid(&self, what: impl Into<String>) -> ImportError {
        self.source.invalid(self.place, what)
    }
}

/// The string `key` of the table `node`, read before it is known which other keys there may be.
///
/// # Errors
/// Where `node` is not a table, or the value is not a string.
pub fn string_of<'a>(
    source: &'a Source,
    node: &'a Node,
    heading: &str,
    key: &'static str,
) -> Result<Option<Value<'a>>, ImportError> {
    let entries = entries(source, node, heading)?;
    let Some(entry) = find(entries, key) else {
        return Ok(None);
    };
    let value = Value {
        source,
        name: key,
        node: &entry.node,
    };
    value.string()?;
    Ok(Some(value))
}

fn entries<'a>(source: &Source, node: &'a Node, heading: &str) -> Result<&'a [Entry], ImportError> {
    match &node.kind {
        Kind::Table(entries) => Ok(entries),
        other => Err(source.invalid(
            &node.place,
            format!("{heading} must be a table, not {}", other.words()),
        )),
    }
}

fn find<'a>(entries: &'a [Entry], key: &str) -> Option<&'a Entry> {
    entries.iter().find(|entry| entry.key == key)
}
