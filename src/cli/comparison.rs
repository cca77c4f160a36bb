//! What `compare` says about two pictures, for people and as JSON.

use std::fmt::{self, Display};

use halfshade::color::Rgb;
use halfshade::math::UVec2;
use halfshade::report::metrics::{Figures, Metric, NonFinite, WorstPixel};
use serde::Serialize;

/// What is said about two pictures.
pub struct Report {
    /// Name of the picture that is measured.
    pub a: String,
    /// Name of its reference.
    pub b: String,
    /// Pixels across and down.
    pub size: UVec2,
    /// The figures.
    pub figures: Figures,
    /// Pixels that are not finite in each picture.
    pub non_finite: [NonFinite; 2],
    /// The worst pixels.
    pub worst: Vec<WorstPixel>,
}

impl Report {
    /// Title, value and meaning of every figure but that of pixels that are not finite.
    pub fn rows(&self) -> impl Iterator<Item = [String; 3]> {
        let metrics = Metric::ALL.iter().filter(|&&m| m != Metric::NonFinite);
        metrics.map(|metric| {
            let value = metric.of(&self.figures);
            let value = value.map_or("none (too small)".to_owned(), figure);
            [metric.title().to_owned(), value, metric.about().to_owned()]
        })
    }

    /// What is to be said about pixels that are not finite.
    pub fn non_finite_text(&self) -> String {
        let [a, b] = self.non_finite;
        let first = |name: &str, found: NonFinite| match found.first {
            Some(pixel) => format!("; the first in {name} at {},{}", pixel.x, pixel.y),
            None => String::new(),
        };
        let note = if a.count + b.count > 0 {
            "; left out of all figures"
        } else {
            ""
        };
        format!(
            "{} pixels in A, {} in B{}{}{note}",
            a.count,
            b.count,
            first("A", a),
            first("B", b)
        )
    }
}

/// A figure with as many digits as anybody reads.
fn figure(value: f64) -> String {
    match value.abs() {
        _ if value.is_infinite() => "infinite (equal)".to_owned(),
        0.0 => "0".to_owned(),
        1e-3..1e5 => {
            let digits = (4 - value.abs().log10().floor() as i32).max(0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.4e}"),
    }
}

/// A colour with as many digits as anybody reads.
pub fn color_text(color: Rgb) -> String {
    let channels = color.channels().map(|c| figure(f64::from(c)));
    channels.join(" ")
}

impl Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "A {}, {}x{} pixels", self.a, self.size.x, self.size.y)?;
        writeln!(f, "B {} (reference)", self.b)?;
        for [title, value, about] in self.rows() {
            writeln!(f, "  {title:<10} {value:<16} {about}")?;
        }
        let title = Metric::NonFinite.title();
        writeln!(f, "  {title:<10} {}", self.non_finite_text())?;
        for worst in &self.worst {
            let UVec2 { x, y } = worst.pixel;
            writeln!(
                f,
                "  {:<10} {:<16} at {x},{y}: A {}, B {}",
                "worst",
                figure(worst.relative_error),
                color_text(worst.test),
                color_text(worst.reference)
            )?;
        }
        Ok(())
    }
}

/// What scripts may rely on; more keys may come to stand beside these.
#[derive(Serialize)]
pub struct Json<'a> {
    a: &'a str,
    b: &'a str,
    size: [u32; 2],
    #[serde(flatten)]
    figures: &'a Figures,
    /// In each picture; `null` where there is none.
    first_non_finite: [Option<[u32; 2]>; 2],
    worst: Vec<JsonPixel>,
}

#[derive(Serialize)]
struct JsonPixel {
    pixel: [u32; 2],
    relative_error: f64,
    a: [f32; 3],
    b: [f32; 3],
}

impl<'a> Json<'a> {
    /// The report as JSON has it.
    pub fn of(report: &'a Report) -> Self {
        let pixel = |worst: &WorstPixel| JsonPixel {
            pixel: worst.pixel.to_array(),
            relative_error: worst.relative_error,
            a: worst.test.channels(),
            b: worst.reference.channels(),
        };
        Self {
            a: &report.a,
            b: &report.b,
            size: report.size.to_array(),
            figures: &report.figures,
            first_non_finite: report.non_finite.map(|found| found.first.map(UVec2::into)),
            worst: report.worst.iter().map(pixel).collect(),
        }
    }
}
