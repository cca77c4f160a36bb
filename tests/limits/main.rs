//! What a render says about its own error, when it stops, and where its samples go.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;

mod adaptive;
mod calibration;
mod stopping;
mod subject;
