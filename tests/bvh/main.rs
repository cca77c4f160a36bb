//! The tracing core against independent answers: cases G1-G3, G10, G12 and G13 of the
//! project's list of extreme scenes, and equality among builders, widths and thread counts.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod agreement;
mod builders;
mod degenerate;
mod instances;
mod meshes;
mod reference;
