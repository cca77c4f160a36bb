//! What a point looks like, for the page.

use super::point::Repeats;
use crate::report::Picture;
use crate::report::error_map::colored;
use crate::report::metrics::{Pair, PairError, relative_error};
use crate::report::page::Shown;
use crate::report::scale::Scale;

/// The errors that a page tells apart.
pub const ERROR_SCALE: Scale = Scale::Decades { low: -4, high: 0 };

/// A picture and where it is wrong, as a page shows them.
#[derive(Clone, Debug)]
pub struct View {
    /// The picture.
    pub picture: Shown,
    /// Its relative error against the reference.
    pub errors: Shown,
}

impl View {
    /// Of the first picture of a point.
    pub(super) fn of(repeats: &Repeats) -> Result<Self, PairError> {
        let picture = repeats.first();
        let name = format!("{} with {} samples", repeats.method, repeats.asked_samples);
        let pair = Pair::new(picture, repeats.reference())?;
        let errors = colored(&relative_error(&pair), ERROR_SCALE);
        Ok(Self {
            picture: shown(&name, picture)?,
            errors: shown(&format!("Relative error of {name}"), &errors)?,
        })
    }
}

/// Only a picture without pixels cannot be shown.
fn shown(name: &str, picture: &Picture) -> Result<Shown, PairError> {
    Shown::new(name, picture).map_err(|_| PairError::NothingFinite)
}
