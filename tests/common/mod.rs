//! What several tests share.
#![allow(dead_code)] // each test file uses its own part of it

pub mod build;
pub mod chi_square;
pub mod floor;
