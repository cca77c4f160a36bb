//! What may be kept of every sample beside its radiance.

use super::{LightPart, ViewKind};
use crate::scene::Needs;

/// An arbitrary output variable: a value of every pixel beside its radiance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    /// What a view shows of the first surface.
    View(ViewKind),
    /// The share of the pixel that is covered by anything: its alpha, `[0, 1]`.
    Coverage,
    /// The shares of the pixel that instances of the scene cover ([`crate::film::Film::objects`]).
    Objects,
    /// A part of the light, W/(m² sr).
    Light(LightPart),
}

impl Aov {
    /// What it reads of surfaces beyond what the picture does.
    pub fn needs(self) -> Needs {
        match self {
            Self::View(view) => view.needs(),
            Self::Coverage | Self::Objects | Self::Light(_) => Needs::default(),
        }
    }
}
