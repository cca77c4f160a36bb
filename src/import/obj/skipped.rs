//! Statements that are passed over, and counted.

use std::collections::BTreeMap;

use super::lines::shown;
use crate::import::{WarningCode, Warnings};

/// Statements of free-form geometry.
const FREE_FORM: [&str; 17] = [
    "vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",
    "sp", "end", "con", "bzp", "bsp",
];

/// How many keywords that are not known are told apart: the first by their letters, so that it does not matter
/// where in the file they stand.
const MOST_KEYWORDS: usize = 20;

/// How often something was passed over.
#[derive(Default)]
pub struct Skipped {
    /// Points of `p` statements.
    pub points: u64,
    /// `l` statements.
    pub lines: u64,
    /// Faces with fewer than three corners.
    pub small_faces: u64,
    /// Vertices with numbers that mean nothing.
    pub surplus_numbers: u64,
    statements: BTreeMap<String, u64>,
    other_statements: u64,
}

impl Skipped {
    /// Counts a statement that is not known.
    ///
    /// # Errors
    /// Where its keyword is nothing that a program writes into a file of text.
    pub fn statement(&mut self, keyword: &[u8]) -> Result<(), String> {
        let is_word = |b: &u8| b.is_ascii_alphanumeric() || b"_-.:".contains(b);
        if !keyword.iter().all(is_word) {
            return Err(format!(
                "\"{}\" is not a statement of an OBJ file",
                shown(keyword)
            ));
        }
        self.add_statements(shown(keyword), 1);
        Ok(())
    }

    fn add_statements(&mut self, keyword: String, count: u64) {
        *self.statements.entry(keyword).or_default() += count;
        if self.statements.len() > MOST_KEYWORDS
            && let Some((_, count)) = self.statements.pop_last()
        {
            self.other_statements += count;
        }
    }

    /// Adds all of `other`.
    pub fn add(&mut self, other: Self) {
        self.points += other.points;
        self.lines += other.lines;
        self.small_faces += other.small_faces;
        self.surplus_numbers += other.surplus_numbers;
        for (keyword, count) in other.statements {
            self.add_statements(keyword, count);
        }
        self.other_statements += other.other_statements;
    }

    /// Warns of all that was passed over.
    pub fn warn(self, warnings: &mut Warnings) {
        use WarningCode::{BadAttribute, BadFace, NotTriangles, UnknownStatement};
        let mut add = |code, message: &str, count| warnings.add_many(code, message, count);
        add(NotTriangles, "points are not rendered", self.points);
        add(NotTriangles, "lines are not rendered", self.lines);
        add(
            BadFace,
            "faces with fewer than three corners were left out",
            self.small_faces,
        );
        add(
            BadAttribute,
            "numbers behind a vertex that are no colour were ignored",
            self.surplus_numbers,
        );
        add(
            UnknownStatement,
            "other statements were not understood",
            self.other_statements,
        );
        for (keyword, count) in self.statements {
            if FREE_FORM.contains(&keyword.as_str()) {
                let message =
                    format!("free-form curves and surfaces (`{keyword}`) are not rendered");
                warnings.add_many(NotTriangles, message, count);
            } else {
                let message = format!("`{keyword}` was not understood");
                warnings.add_many(UnknownStatement, message, count);
            }
        }
    }
}
