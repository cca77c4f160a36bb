//! `index.html`: the study as one self-contained page.

use super::study::Study;
use super::views::View;
use crate::report::page::document;

/// The page. `views` belong to the points of `study`; `plot` is `curve.svg`.
pub fn page(study: &Study, views: &[View], plot: &str) -> String {
    let _ = views;
    document(&study.scene, plot)
}
