//! Names of objects, materials and files.

use std::collections::HashMap;

use super::lines::Words;

/// Names that have been used, each once, and the one that is in force.
///
/// A name costs nothing until a face uses it: files may select many and use few.
#[derive(Default)]
pub struct Names {
    ids: HashMap<String, u32>,
    list: Vec<String>,
    in_force: Option<Selected>,
}

enum Selected {
    Known(u32),
    New(String),
}

impl Names {
    /// Puts `name` in force. Bytes that are not UTF-8 are replaced.
    pub fn select(&mut self, name: &[u8]) {
        let name = String::from_utf8_lossy(name);
        self.in_force = Some(match self.ids.get(name.as_ref()) {
            Some(&id) => Selected::Known(id),
            None => Selected::New(name.into_owned()),
        });
    }

    /// The name in force, as an index into the list of used names; `None` before the first.
    pub fn current(&mut self) -> Option<u32> {
        let id = match self.in_force.take()? {
            Selected::Known(id) => id,
            Selected::New(name) => {
                let id = self.list.len() as u32;
                self.ids.insert(name.clone(), id);
                self.list.push(name);
                id
            }
        };
        self.in_force = Some(Selected::Known(id));
        Some(id)
    }

    /// All used names, in the order of their first use.
    pub fn into_list(self) -> Vec<String> {
        self.list
    }
}

/// What stands behind the keyword of the line `text`, as one name.
pub fn name_of(text: &[u8]) -> &[u8] {
    let mut words = Words::of_names(text);
    words.next();
    words.rest()
}

/// The file names of an `mtllib` statement. Names may have blanks inside: each ends with the word
/// that ends in `.mtl`, the last with the line.
pub fn library_names(text: &[u8]) -> Vec<String> {
    let mut names = Vec::new();
    let mut start = 0;
    for end in 1..=text.len() {
        let is_word_end = end == text.len() || text[end].is_ascii_whitespace();
        let has_ending = end >= 4 && text[end - 4..end].eq_ignore_ascii_case(b".mtl");
        if end == text.len() || (is_word_end && has_ending) {
            let name = text[start..end].trim_ascii();
            if !name.is_empty() {
                names.push(String::from_utf8_lossy(name).into_owned());
            }
            start = end;
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_name_may_have_blanks() {
        let names = |text: &str| library_names(text.as_bytes());
        assert_eq!(names("a.mtl"), ["a.mtl"]);
        assert_eq!(names("a.mtl b.MTL  c.mtl"), ["a.mtl", "b.MTL", "c.mtl"]);
        assert_eq!(names("my a.mtl my b.mtl"), ["my a.mtl", "my b.mtl"]);
        assert_eq!(
            names("a.mtl.bak b.mtl materials"),
            ["a.mtl.bak b.mtl", "materials"]
        );
        assert_eq!(names(""), [""; 0]);
    }

    #[test]
    fn only_used_names_are_kept() {
        let mut names = Names::default();
        assert_eq!(names.current(), None);
        names.select(b"a");
        names.select(b"b");
        assert_eq!(names.current(), Some(0));
        names.select(b"c");
        assert_eq!(names.current(), Some(1));
        names.select(b"b");
        assert_eq!(names.current(), Some(0));
        assert_eq!(names.into_list(), ["b", "c"]);
    }
}
