//! Indices of faces: from the start or from the end of a list, and perhaps to what comes later.

use super::geometry::Index;
use super::lines::shown;
use crate::import::{WarningCode, Warnings};

/// Why a word is not an index into a list.
#[derive(Debug, PartialEq, Eq)]
pub enum BadIndex {
    /// It is not a whole number.
    NotANumber,
    /// It is 0, before the first element, or beyond what any file can hold.
    OutOfRange,
}

/// The indices into one of a file's lists that cannot be judged before the file's end.
#[derive(Debug, Default)]
pub struct References {
    /// Those that are larger than all before them, with their lines. The first that a list is
    /// too short for is the first in the file: one before it would be no larger than an entry
    /// before it.
    forward: Vec<(Index, usize)>,
}

impl References {
    /// The place that `word` means on line `line`, where the list has `count` elements so far.
    ///
    /// # Errors
    /// Where it can mean none, whatever comes later.
    pub fn resolve(&mut self, word: &[u8], count: usize, line: usize) -> Result<Index, BadIndex> {
        let index = integer(word).ok_or(BadIndex::NotANumber)?;
        let place = if index < 0 {
            index.saturating_add(count as i64 + 1)
        } else {
            index
        };
        let place = u32::try_from(place).ok().and_then(Index::new);
        let place = place.ok_or(BadIndex::OutOfRange)?;
        if place.get() as usize > count && self.forward.last().is_none_or(|&(top, _)| place > top) {
            self.forward.push((place, line));
        }
        Ok(place)
    }

    /// Adds those of a later part of the file.
    pub fn append(&mut self, later: Self) {
        for (place, line) in later.forward {
            if self.forward.last().is_none_or(|&(top, _)| place > top) {
                self.forward.push((place, line));
            }
        }
    }

    /// The first index, with its line, that is past the end of a list of `count` elements.
    pub fn first_above(&self, count: usize) -> Option<(Index, usize)> {
        let is_above = |&&(index, _): &&(Index, usize)| index.get() as usize > count;
        self.forward.iter().find(is_above).copied()
    }
}

/// Indices of an attribute that corners can do without: one that is out of range costs its corner
/// the attribute, not its author the picture.
#[derive(Debug)]
pub struct Attributes {
    /// What one element is called in messages.
    what: &'static str,
    references: References,
    dropped: u64,
    first_dropped: Option<usize>,
}

impl Attributes {
    /// No indices yet into the list of `what`.
    pub fn new(what: &'static str) -> Self {
        Self {
            what,
            references: References::default(),
            dropped: 0,
            first_dropped: None,
        }
    }

    /// The place that `word` means on line `line`; `None` where it is empty or out of range.
    ///
    /// # Errors
    /// Where it is not a whole number.
    pub fn resolve(
        &mut self,
        word: &[u8],
        count: usize,
        line: usize,
    ) -> Result<Option<Index>, String> {
        if word.is_empty() {
            return Ok(None);
        }
        match self.references.resolve(word, count, line) {
            Ok(index) => Ok(Some(index)),
            Err(BadIndex::OutOfRange) => {
                self.dropped += 1;
                self.first_dropped.get_or_insert(line);
                Ok(None)
            }
            Err(problem) => Err(message(&problem, word, self.what, count)),
        }
    }

    /// Adds those of a later part of the file.
    pub fn append(&mut self, later: Self) {
        self.references.append(later.references);
        self.dropped += later.dropped;
        self.first_dropped = self.first_dropped.or(later.first_dropped);
    }

    /// Whether a list of `count` elements is long enough for all of them.
    pub fn are_within(&self, count: usize) -> bool {
        self.references.first_above(count).is_none()
    }

    /// Warns of the indices that were out of range: `late` of them showed at the end of the file,
    /// where the list had `count` elements.
    pub fn warn(&self, late: u64, count: usize, warnings: &mut Warnings) {
        let first_late = self.references.first_above(count).map(|(_, line)| line);
        let lines = [self.first_dropped, first_late];
        if let Some(line) = lines.into_iter().flatten().min() {
            let what = self.what;
            let message = format!(
                "corners of faces use a {what} that is not there (first on line {line}) and go without"
            );
            warnings.add_many(WarningCode::BadAttribute, message, self.dropped + late);
        }
    }
}

/// What is wrong with the index `word` into a list of `count` elements so far of the kind `what`.
pub fn message(problem: &BadIndex, word: &[u8], what: &str, count: usize) -> String {
    let word = shown(word);
    match problem {
        BadIndex::NotANumber => format!("face uses {what} \"{word}\", which is not a whole number"),
        BadIndex::OutOfRange if word.trim_start_matches(['+', '-', '0']).is_empty() => {
            format!("face uses {what} {word}, but they are counted from 1")
        }
        BadIndex::OutOfRange if word.starts_with('-') => {
            format!("face uses {what} {word}, but there are only {count} before it")
        }
        BadIndex::OutOfRange => format!("face uses {what} {word}, but there are only {count}"),
    }
}

/// The place at byte `*at` of `text` in a list of `count` elements, and `*at` moved behind it, where it
/// is written the usual way: `Some(None)` without a digit, `None` where [`References::resolve`] must judge.
#[inline]
pub fn usual_place(text: &[u8], at: &mut usize, count: usize) -> Option<Option<Index>> {
    /// Digits that cannot overflow.
    const MOST_DIGITS: usize = 9;
    let start = *at;
    let mut value = 0u32;
    while let Some(digit @ b'0'..=b'9') = text.get(*at) {
        value = value.wrapping_mul(10).wrapping_add(u32::from(digit - b'0'));
        *at += 1;
    }
    if *at == start {
        return Some(None);
    }
    let place = Index::new(value).filter(|place| place.get() as usize <= count);
    (*at - start <= MOST_DIGITS && place.is_some()).then_some(place)
}

/// The whole number that `word` is, held to the range of an `i64`.
fn integer(word: &[u8]) -> Option<i64> {
    let (is_negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    // Saturates: every number this large is out of range anyway.
    let magnitude = digits.iter().fold(0i64, |n, d| {
        n.saturating_mul(10).saturating_add(i64::from(d - b'0'))
    });
    Some(if is_negative { -magnitude } else { magnitude })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn indices_count_from_either_end() {
        let mut references = References::default();
        let mut resolve = |word: &str| references.resolve(word.as_bytes(), 8, 1).map(Index::get);
        assert_eq!(resolve("1"), Ok(1));
        assert_eq!(resolve("+8"), Ok(8));
        assert_eq!(resolve("-1"), Ok(8));
        assert_eq!(resolve("-8"), Ok(1));
        for word in [
            "0",
            "-0",
            "-9",
            "4294967296",
            "99999999999999999999",
            "-99999999999999999999",
        ] {
            assert_eq!(resolve(word), Err(BadIndex::OutOfRange), "{word}");
        }
        for word in ["", "-", "1.5", "x", "1e3", "--1"] {
            assert_eq!(resolve(word), Err(BadIndex::NotANumber), "{word}");
        }
    }

    #[test]
    fn the_first_index_past_the_end_is_found() {
        let mut references = References::default();
        for (line, word) in ["9", "3", "12", "11", "20"].iter().enumerate() {
            references.resolve(word.as_bytes(), 4, line).unwrap();
        }
        let first = |count| {
            references
                .first_above(count)
                .map(|(i, line)| (i.get(), line))
        };
        assert_eq!(first(8), Some((9, 0)));
        assert_eq!(first(10), Some((12, 2)));
        assert_eq!(first(12), Some((20, 4)));
        assert_eq!(first(20), None);
    }
}
