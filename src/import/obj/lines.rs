//! Bytes to logical lines and words, without a copy where a line is not continued.

use std::borrow::Cow;

use memchr::memchr;

/// The statements of an OBJ or MTL file, with the numbers of the lines that they start on.
///
/// Lines end with LF, CRLF, or, in a file without any LF, CR. A backslash at the end of a line
/// that is not a comment joins it with the next. A byte-order mark is skipped.
#[derive(Clone)]
pub struct Lines<'a> {
    rest: &'a [u8],
    separator: u8,
    number: usize,
    /// Whether a `#` may be among them.
    may_have_comments: bool,
}

/// One logical line.
pub struct Line<'a> {
    /// Number of its first physical line, counted from 1.
    pub number: usize,
    /// What it says, with its comment.
    pub text: Cow<'a, [u8]>,
    may_have_comment: bool,
}

impl Line<'_> {
    /// The words before the first `#`: for statements that hold numbers.
    pub fn words(&self) -> Words<'_> {
        let comment = if self.may_have_comment {
            memchr(b'#', &self.text)
        } else {
            None
        };
        Words(&self.text[..comment.unwrap_or(self.text.len())])
    }
}

/// What is wrong with a file, and on which line.
#[derive(Debug, PartialEq, Eq)]
pub struct LineError {
    /// Counted from 1; `None` where it is the file as a whole.
    pub line: Option<usize>,
    /// What is wrong.
    pub what: String,
}

impl<'a> Lines<'a> {
    /// The lines of a whole file.
    pub fn new(bytes: &'a [u8]) -> Self {
        let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let separator = if rest.contains(&b'\n') { b'\n' } else { b'\r' };
        Self {
            rest,
            separator,
            number: 0,
            may_have_comments: true,
        }
    }

    /// The same lines in parts of `size` bytes, from 1, or a little more: each ends with a statement. Every part
    /// counts its lines from 1.
    pub fn split(self, size: usize) -> Vec<Self> {
        let mut parts = Vec::with_capacity(self.rest.len() / size + 1);
        let mut rest = self.rest;
        while rest.len() > size {
            let (part, others) = rest.split_at(self.end_of_statement(rest, size));
            parts.push(Self { rest: part, ..self });
            rest = others;
        }
        parts.push(Self { rest, ..self });
        parts
    }

    /// Behind the first line of `text` that ends at byte `from` or later and is not continued.
    fn end_of_statement(&self, text: &[u8], mut from: usize) -> usize {
        while let Some(length) = memchr(self.separator, &text[from..]) {
            let line = &text[..from + length];
            let line = line.strip_suffix(b"\r").unwrap_or(line);
            from += length + 1;
            if line.last() != Some(&b'\\') {
                return from;
            }
        }
        text.len()
    }

    /// The same lines behind `lines` others. Looks for comments in all of them at once, which is faster than
    /// in each.
    pub fn behind(self, lines: usize) -> Self {
        Self {
            number: self.number + lines,
            may_have_comments: memchr(b'#', self.rest).is_some(),
            ..self
        }
    }

    /// How many physical lines there were so far.
    pub fn count_so_far(&self) -> usize {
        self.number
    }

    fn next_physical(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let (line, rest) = match memchr(self.separator, self.rest) {
            Some(end) => (&self.rest[..end], &self.rest[end + 1..]),
            None => (self.rest, &self.rest[self.rest.len()..]),
        };
        self.rest = rest;
        Some(line.strip_suffix(b"\r").unwrap_or(line))
    }

    /// Joins `first`, which ends with a backslash, with the lines that continue it.
    fn continued(&mut self, first: &'a [u8]) -> Vec<u8> {
        let mut text = first.to_vec();
        while text.last() == Some(&b'\\') {
            text.pop();
            text.push(b' ');
            match self.next_physical() {
                Some(next) => text.extend_from_slice(next),
                None => break,
            }
        }
        text
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let line = self.next_physical()?;
        let number = self.number;
        let is_comment = || line.trim_ascii_start().starts_with(b"#");
        let text = if line.last() == Some(&b'\\') && !is_comment() {
            Cow::Owned(self.continued(line))
        } else {
            Cow::Borrowed(line)
        };
        Some(Line {
            number,
            text,
            may_have_comment: self.may_have_comments,
        })
    }
}

/// The words of a text: what stands between blanks.
#[derive(Clone)]
pub struct Words<'a>(&'a [u8]);

impl<'a> Words<'a> {
    /// The words before the first `#` that starts a word: for statements that hold names, in
    /// which a `#` may stand.
    pub fn of_names(text: &'a [u8]) -> Self {
        let starts_comment =
            |&i: &usize| text[i] == b'#' && (i == 0 || text[i - 1].is_ascii_whitespace());
        let end = (0..text.len()).find(starts_comment);
        Self(&text[..end.unwrap_or(text.len())])
    }

    /// The next word as a number; the word itself where it is none.
    pub fn number(&mut self) -> Option<Result<f64, &'a [u8]>> {
        let value = self.take_with(short_decimal);
        value
            .map(Ok)
            .or_else(|| self.next().map(|word| number(word).ok_or(word)))
    }

    /// The value that `read` finds at the start of the next word, where it says that it took all bytes of it.
    pub fn take_with<T>(&mut self, read: impl FnOnce(&'a [u8]) -> Option<(T, usize)>) -> Option<T> {
        self.0 = self.0.trim_ascii_start();
        let (value, length) = read(self.0).filter(|&(_, length)| self.ends_at(length))?;
        self.0 = &self.0[length..];
        Some(value)
    }

    /// How many words are left.
    pub fn count_left(&self) -> usize {
        /// The loop over so many bytes becomes vector instructions.
        const WIDTH: usize = 64;
        // Without branches, for the same reason.
        let is_blank = |b: u8| (b == b' ') | (b.wrapping_sub(b'\t') < 5) & (b != 0x0b);
        let mut count = 0;
        let mut before = b' ';
        for chunk in self.0.chunks(WIDTH) {
            let mut bytes = [b' '; WIDTH + 1];
            bytes[0] = before;
            bytes[1..=chunk.len()].copy_from_slice(chunk);
            let starts = (0..WIDTH).map(|i| u8::from(is_blank(bytes[i]) & !is_blank(bytes[i + 1])));
            count += usize::from(starts.sum::<u8>());
            before = bytes[WIDTH];
        }
        count
    }

    /// Whether a word can end before byte `place`.
    fn ends_at(&self, place: usize) -> bool {
        self.0.get(place).is_none_or(u8::is_ascii_whitespace)
    }

    /// Everything that is left, as one name that may have blanks inside.
    pub fn rest(&self) -> &'a [u8] {
        self.0.trim_ascii()
    }
}

impl<'a> Iterator for Words<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.0.iter().position(|b| !b.is_ascii_whitespace())?;
        let text = &self.0[start..];
        let end = text.iter().position(u8::is_ascii_whitespace);
        let (word, rest) = text.split_at(end.unwrap_or(text.len()));
        self.0 = rest;
        Some(word)
    }
}

/// The number that `word` is; `None` where it is none.
pub fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The number at the start of `text`, and its bytes, where it is one of few digits without an
/// exponent; [`number`] reads the others. It is rounded correctly: its digits and the power of ten are doubles
/// without rounding, so that the division rounds once (Clinger 1990, "How to Read Floating Point Numbers Accurately").
fn short_decimal(text: &[u8]) -> Option<(f64, usize)> {
    /// Below 2^53.
    const MOST_DIGITS: usize = 15;
    const POWERS: [f64; MOST_DIGITS + 1] = [
        1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
    ];
    let is_negative = text.first() == Some(&b'-');
    let mut at = usize::from(is_negative);
    let mut digits = 0u64;
    let mut take_digits = |at: &mut usize| {
        let start = *at;
        while let Some(digit @ b'0'..=b'9') = text.get(*at) {
            digits = digits
                .wrapping_mul(10)
                .wrapping_add(u64::from(digit - b'0'));
            *at += 1;
        }
        *at - start
    };
    let mut count = take_digits(&mut at);
    let mut decimals = 0;
    if text.get(at) == Some(&b'.') {
        at += 1;
        decimals = take_digits(&mut at);
        count += decimals;
    }
    if count == 0 || count > MOST_DIGITS {
        return None;
    }
    let magnitude = digits as f64 / POWERS[decimals];
    let value = if is_negative { -magnitude } else { magnitude };
    Some((value, at))
}

/// `word` for a message: readable and short, whatever its bytes are.
pub fn shown(word: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&word[..word.len().min(4 * LONGEST)]);
    let mut shown: String = text.escape_debug().take(LONGEST).collect();
    if text.escape_debug().nth(LONGEST).is_some() {
        shown.push('…');
    }
    shown
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn logical(bytes: &[u8]) -> Vec<(usize, String)> {
        Lines::new(bytes)
            .map(|l| (l.number, String::from_utf8_lossy(&l.text).into_owned()))
            .collect()
    }

    #[test]
    fn lines_end_in_every_customary_way() {
        let expected = vec![(1, "a".to_owned()), (2, String::new()), (3, "b".to_owned())];
        for text in ["a\n\nb", "a\r\n\r\nb\r\n", "a\r\rb\r", "\u{feff}a\n\nb\n"] {
            assert_eq!(logical(text.as_bytes()), expected, "{text:?}");
        }
    }

    #[test]
    fn a_backslash_joins_lines_but_not_comments() {
        assert_eq!(
            logical(b"f 1 2 \\\r\n 3\\\n4\n# c:\\\nv 0 0 0\\"),
            [
                (1, "f 1 2   3 4".to_owned()),
                (4, "# c:\\".to_owned()),
                (5, "v 0 0 0 ".to_owned())
            ]
        );
    }

    #[test]
    fn a_comment_may_stand_behind_a_statement() {
        let line = Lines::new(b"\t1 2#x 3").next();
        let words = line.map(|line| line.words().map(<[u8]>::to_vec).collect());
        assert_eq!(words, Some(vec![b"1".to_vec(), b"2".to_vec()]));
        assert_eq!(Words::of_names(b" My Mat#1  # red ").rest(), b"My Mat#1");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn numbers_are_those_of_the_standard_library(
            word in "[-+]?[0-9]{0,12}(\\.[0-9]{0,12})?(e-?[0-9]{1,3})?|-?(inf|nan|NaN|infinity)|[-+.e0-9x]{0,4}",
            blank in "[ \t]{0,2}",
        ) {
            let text = format!("{blank}{word} 1");
            let mut words = Words(text.as_bytes());
            let expected: Result<f64, _> = word.parse();
            if !word.is_empty() {
                let ours = words.number();
                prop_assert_eq!(
                    ours.and_then(Result::ok).map(f64::to_bits),
                    expected.ok().map(f64::to_bits)
                );
            }
            prop_assert_eq!(words.number(), Some(Ok(1.0)));
        }

        #[test]
        fn words_are_counted(text in "[ a\t\x0b\x0c]{0,200}") {
            let words = Words(text.as_bytes());
            prop_assert_eq!(words.count_left(), words.count());
        }
    }
}
