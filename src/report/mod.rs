//! What measurements say: how far two pictures are apart, fits, plots, pages.
//!
//! [`metrics`] takes [`Picture`]s in memory, so that films and files are measured alike. What
//! comes out is numbers, pictures ([`error_map`]) and text ([`page`]); nothing here prints, and
//! only [`read_picture`] touches a file.

pub mod color_map;
mod digits;
pub mod error_map;
pub mod metrics;
pub mod page;
mod picture;
pub mod plot;
pub mod power_law;
mod read;
pub mod scale;

pub use picture::Picture;
pub use read::{Opened, ReadError, ReadProblem, read_picture};
