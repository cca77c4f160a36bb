//! Halfshade renders imported triangle meshes with soft shadows, and says how wrong it is.
//!
//! Modules stand in the order in which data flows; each uses only those above it
//! (`tests/architecture.rs` holds it to that).

#![warn(missing_docs)]

pub mod math;

pub mod color;

pub mod sampling;

pub mod texture;

pub mod camera;

pub mod interaction;

pub mod light;

pub mod material;

pub mod scene;

pub mod import;

pub mod bvh;

pub mod prepare;

pub mod film;

pub mod integrate;

pub mod render;

pub mod output;
