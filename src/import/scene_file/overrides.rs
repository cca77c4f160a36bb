//! `--set PATH=VALUE`: changes the tree of a scene file before it is read.

use std::sync::Arc;

use super::document::{Entry, Kind, Node, Place, Source};
use crate::import::ImportError;

/// Sets the value at the dotted `path`, such as `light.0.radius`, to `value`.
///
/// Lists are indexed from 0. Tables that are missing are made; the index that is one past the
/// end of a list appends. A value that is not TOML is taken as text, so that quotes may be left out.
///
/// # Errors
/// Where `path` leads through something that is neither a table nor a list, or past the end of a
/// list. What no scene file may say is found when the tree is read.
pub fn apply(source: &Source, root: &mut Node, path: &str, value: &str) -> Result<(), ImportError> {
    let place = Place::Override(Arc::from(path));
    let keys: Vec<&str> = path.split('.').map(str::trim).collect();
    if keys.iter().any(|key| key.is_empty()) {
        return Err(source.invalid(&place, "not a path such as light.0.radius"));
    }
    let mut node = root;
    for (depth, key) in keys.iter().enumerate() {
        let missing = match keys.get(depth + 1) {
            Some(next) if next.parse::<usize>().is_ok() => Kind::Array(Vec::new()),
            _ => Kind::Table(Vec::new()),
        };
        let missing = Node {
            place: place.clone(),
            kind: missing,
        };
        node = child(node, key, missing).map_err(|problem| {
            let parent = match depth {
                0 => "a scene".to_owned(),
                _ => keys[..depth].join("."),
            };
            source.invalid(&place, format!("{parent} {problem}"))
        })?;
    }
    *node = source
        .parse_value(value.trim(), &place)
        .unwrap_or_else(|| Node {
            place: place.clone(),
            kind: Kind::String(value.to_owned()),
        });
    Ok(())
}

/// What `key` names in `parent`: `missing`, put there, where there is nothing yet.
fn child<'a>(parent: &'a mut Node, key: &str, missing: Node) -> Result<&'a mut Node, String> {
    match &mut parent.kind {
        Kind::Table(entries) => {
            let index = entries.iter().position(|entry| entry.key == key);
            let index = index.unwrap_or_else(|| {
                entries.push(Entry {
                    key: key.to_owned(),
                    place: missing.place.clone(),
                    node: missing,
                });
                entries.len() - 1
            });
            Ok(&mut entries[index].node)
        }
        Kind::Array(nodes) => {
            let length = nodes.len();
            let index: usize = key
                .parse()
                .map_err(|_| format!("is a list: \"{key}\" must be a number from 0"))?;
            if index > length {
                return Err(format!("is a list of {length}: the next is {length}"));
            }
            if index == length {
                nodes.push(missing);
            }
            Ok(&mut nodes[index])
        }
        other => Err(format!("is {}, which has no \"{key}\"", other.words())),
    }
}
