//! The numerical cases: extreme scenes with answers that are known beforehand.
//!
//! Geometry at every scale and place ([`geometry`]) and light of every size ([`light`]), each case a
//! pure function from the [`Effort`] to its [`Check`]s: what was tried, what was measured, what
//! bound it must keep. The scenes ([`scenes`], [`floor`], [`meshes`]), closed forms ([`closed_form`]) and the
//! tracer in double precision ([`mod@reference`]) serve the tests as well. A scene of anyone's own is
//! held against itself in [`invariance`].

mod check;
pub mod closed_form;
pub mod floor;
pub mod geometry;
pub mod invariance;
pub mod light;
pub mod meshes;
mod page;
pub mod reference;
pub mod scattering;
pub mod scenes;
pub mod still_life;

pub use check::{Check, Curve, Report, Status, Sweep};
pub use page::page;

/// How much is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// All cases within a minute on two cores.
    Short,
    /// More rays, seeds and scales.
    Full {
        /// Rays at edges and vertices of closed meshes (G1).
        rays: u64,
    },
}

impl Effort {
    /// One of two values.
    pub fn pick<T>(self, short: T, full: T) -> T {
        match self {
            Self::Short => short,
            Self::Full { .. } => full,
        }
    }
}

/// A case: extreme input with a known answer.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// A letter (G: geometry, L: light) and a number.
    pub id: &'static str,
    /// What it is about.
    pub name: &'static str,
    /// Tries it.
    run: fn(Effort) -> Vec<Check>,
}

impl Case {
    const fn new(id: &'static str, name: &'static str, run: fn(Effort) -> Vec<Check>) -> Self {
        Self { id, name, run }
    }

    /// Tries it. The same effort gives the same report, but for what is measured in seconds (G3).
    pub fn run(&self, effort: Effort) -> Report {
        Report {
            id: self.id.to_owned(),
            case: self.name.to_owned(),
            checks: (self.run)(effort),
        }
    }
}

/// All cases, in the order of their numbers.
pub fn cases() -> impl Iterator<Item = &'static Case> {
    geometry::CASES.iter().chain(light::CASES)
}
