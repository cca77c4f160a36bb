//! The files that `compare` writes: error maps and pages.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use halfshade::output::png::{self, PngOptions};
use halfshade::output::{OutputError, write_whole};
use halfshade::report::Picture;
use halfshade::report::error_map::with_bar;
use halfshade::report::metrics::{ErrorValues, Metric, Pair, relative_error};
use halfshade::report::page::{Shown, document, error_figure, slider, table};
use halfshade::report::scale::Scale;

use super::comparison::{Report, color_text};

/// What an error map shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Difference {
    /// LDR-FLIP.
    Flip,
    /// HDR-FLIP.
    HdrFlip,
    /// The root of each pixel's share of relMSE.
    Relative,
}

impl Difference {
    /// All of them.
    pub const ALL: &[Self] = &[Self::Flip, Self::HdrFlip, Self::Relative];

    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flip => "flip",
            Self::HdrFlip => "hdr-flip",
            Self::Relative => "relative",
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Flip => "FLIP",
            Self::HdrFlip => "HDR-FLIP",
            Self::Relative => "Relative error: |A − B| / √(B² + 0.01), root mean square of R, G, B",
        }
    }

    fn scale(self) -> Scale {
        match self {
            Self::Flip | Self::HdrFlip => Scale::Unit,
            Self::Relative => Scale::Decades { low: -4, high: 0 },
        }
    }

    fn errors(self, pair: &Pair, maps: &Maps) -> ErrorValues {
        match self {
            Self::Flip => maps.flip.clone(),
            Self::HdrFlip => maps.hdr_flip.clone(),
            Self::Relative => relative_error(pair),
        }
    }
}

/// Error maps that the figures are made of as well.
pub struct Maps {
    /// LDR-FLIP.
    pub flip: ErrorValues,
    /// HDR-FLIP.
    pub hdr_flip: ErrorValues,
}

/// Whether every name ends in something that can be written.
pub fn check_names(outputs: &[PathBuf]) -> Result<(), String> {
    match outputs
        .iter()
        .find(|path| !is(path, "png") && !is(path, "html"))
    {
        None => Ok(()),
        Some(path) => Err(format!(
            "{}: differences are written as .png or .html",
            path.display()
        )),
    }
}

fn is(path: &Path, extension: &str) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// Writes a map or a page, as the name of `path` says.
pub fn write(
    path: &Path,
    map: Difference,
    pictures: [&Picture; 2],
    pair: &Pair,
    maps: &Maps,
    report: &Report,
) -> Result<(), OutputError> {
    if is(path, "png") {
        let picture = with_bar(&map.errors(pair, maps), map.scale());
        png::write(
            path,
            picture.size,
            &picture.pixels,
            None,
            PngOptions::default(),
        )
    } else {
        write_whole(path, |file| {
            let page = page(pictures, pair, maps, report)?;
            file.write_all(page.as_bytes())
        })
    }
}

fn page([a, b]: [&Picture; 2], pair: &Pair, maps: &Maps, report: &Report) -> io::Result<String> {
    let left = Shown::new(&format!("A: {}", report.a), a)?;
    let right = Shown::new(&format!("B: {} (reference)", report.b), b)?;
    let figures: String = Difference::ALL
        .iter()
        .map(|map| error_figure(map.title(), &map.errors(pair, maps), map.scale()))
        .collect::<io::Result<_>>()?;
    let body = format!(
        "<p>{}×{} pixels. Both pictures are shown clipped to [0, 1], without a tone map.</p>\n\
         {}\n<h2>Figures</h2>\n{}\n<h2>Where they differ</h2>\n\
         {}<div class=\"maps\">\n{figures}</div>\n{}",
        report.size.x,
        report.size.y,
        slider(&left, &right),
        figures_table(report),
        cyan_note(report),
        worst_table(report)
    );
    Ok(document(
        &format!("{} against {}", report.a, report.b),
        &body,
    ))
}

fn cyan_note(report: &Report) -> &'static str {
    if report.figures.non_finite == [0, 0] {
        ""
    } else {
        "<p>Pixels that are not finite in one of the pictures are cyan.</p>\n"
    }
}

fn figures_table(report: &Report) -> String {
    let non_finite = vec![
        Metric::NonFinite.title().to_owned(),
        report.non_finite_text(),
        Metric::NonFinite.about().to_owned(),
    ];
    let rows: Vec<Vec<String>> = report.rows().map(Vec::from).chain([non_finite]).collect();
    table(&["", "A against B", "of"], &rows)
}

fn worst_table(report: &Report) -> String {
    if report.worst.is_empty() {
        return String::new();
    }
    let rows: Vec<Vec<String>> = report
        .worst
        .iter()
        .map(|worst| {
            vec![
                format!("{},{}", worst.pixel.x, worst.pixel.y),
                format!("{:.4}", worst.relative_error),
                color_text(worst.test),
                color_text(worst.reference),
            ]
        })
        .collect();
    let head = ["Worst pixel", "relative error", "A", "B"];
    format!("<h2>Worst pixels</h2>\n{}", table(&head, &rows))
}
