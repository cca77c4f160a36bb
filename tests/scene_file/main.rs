//! Scene files: what they mean, what their mistakes say, and what scenes get that lack a camera or
//! lights.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod defaults;
mod files;
mod hostile;
mod meaning;
mod mistakes;
mod models;
mod overrides;

/// What the fuzz targets do with hostile files.
#[path = "../../fuzz/src/lib.rs"]
mod targets;
