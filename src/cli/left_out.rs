//! What a picture does not need, for people.

use std::fmt::{self, Display};

use halfshade::scene::LeftOut;

use super::console::Bytes;

/// One thing that was left out, in one line.
pub struct LeftOutLine<'a>(pub &'a LeftOut);

impl Display for LeftOutLine<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let LeftOut {
            kind: _,
            what,
            why,
            saved_bytes,
            saved_seconds,
        } = self.0;
        write!(f, "{what}; {why}")?;
        if *saved_bytes > 0 {
            write!(f, "; saves {}", Bytes(*saved_bytes))?;
        }
        match saved_seconds {
            Some(seconds) => write!(f, "; saves {seconds:.3} s"),
            None => Ok(()),
        }
    }
}
