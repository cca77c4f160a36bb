//! Rays that are traced together.

use std::path::PathBuf;

use serde::Serialize;

use crate::math::Ray;

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Query {
    /// The nearest hit.
    #[default]
    Closest,
    /// Whether anything is in the way.
    Any,
}

impl Query {
    /// As on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Closest => "closest",
            Self::Any => "any",
        }
    }
}

/// Rays that are traced together, in order.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// What kind of rays they are.
    pub name: String,
    /// Where they were read; `None` where they were made.
    pub file: Option<PathBuf>,
    /// What is asked of them.
    pub query: Query,
    /// The rays, in the coordinates of the triangles.
    pub rays: Vec<Ray>,
}
