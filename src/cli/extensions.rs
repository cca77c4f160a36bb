//! `halfshade info --extensions`: what becomes of each extension of glTF.

use std::fmt::{self, Display};

use halfshade::import::{ExtensionSupport, Support, extension_table};

use super::Failure;
use super::console::print;

/// Prints the table, as a page of Markdown or as JSON.
pub fn run(as_json: bool) -> Result<(), Failure> {
    let table = extension_table();
    if as_json {
        print(serde_json::to_string_pretty(&table).map_err(Failure::job)?)
    } else {
        print(Page(&table))
    }
}

/// The page that `docs/extensions.md` is.
struct Page<'a>(&'a [ExtensionSupport]);

impl Display for Page<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "# Extensions of glTF\n\n\
             What `halfshade info --extensions` prints: what is read, what is ignored, and what a\n\
             picture is like without it. Of those that are not in this table, what they add is left out.\n\n\
             | extension | adds | |\n|---|---|---|"
        )?;
        for row in self.0 {
            let (name, adds) = (row.name, row.adds);
            write!(f, "\n| {name} | {adds} | ")?;
            match (row.support, row.without) {
                (Support::Read, _) => write!(f, "read |")?,
                (Support::Harmless, _) => write!(f, "changes no picture |")?,
                (Support::NotBuilt, without) => {
                    write!(f, "not in this build: {} |", without.unwrap_or(""))?;
                }
                (Support::Ignored, without) => {
                    write!(f, "ignored: {} |", without.unwrap_or(""))?;
                }
            }
        }
        Ok(())
    }
}
