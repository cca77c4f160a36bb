//! Curves that were measured elsewhere: another renderer, another machine.
//!
//! A text file with commas between columns. Its first line names them, in any order; `method`, `seconds`
//! and `relmse` must be there, other columns are left alone. `relmse` is what `halfshade compare
//! PICTURE DIR/reference-rectangle.exr` prints, with the noise of the reference still in it, which is
//! subtracted here; a column `measured_relmse`, as `curve.csv` has, is read in its place. Lines that
//! begin with `#` are left out.

use std::path::{Path, PathBuf};
use std::{fs, io};

use serde::Serialize;
use thiserror::Error;

use super::floor::Floor;

/// A point that was measured elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OtherPoint {
    /// The curve that it belongs to.
    pub method: String,
    /// As the file says.
    pub seconds: f64,
    /// As the file says, the noise of the reference in it.
    pub measured_relmse: f64,
    /// Without that noise, as [`Self::above`] puts it; `None` before, and where it drowns in it.
    pub relmse: Option<f64>,
}

impl OtherPoint {
    /// The point with the noise of the reference taken off.
    pub fn above(self, floor: &Floor) -> Self {
        Self {
            relmse: floor.subtracted(self.measured_relmse),
            ..self
        }
    }
}

/// Why a file holds no curves.
#[derive(Debug, Error)]
#[error("{}: {problem}", path.display())]
pub struct AgainstError {
    path: PathBuf,
    problem: Problem,
}

#[derive(Debug, Error)]
enum Problem {
    #[error("could not be read: {0}")]
    Io(#[from] io::Error),
    #[error("line {line}: {what}")]
    Line { line: usize, what: String },
}

/// Reads the file at `path`.
///
/// # Errors
/// Where it cannot be read, a column is missing, or a number is not positive.
pub fn read_curves(path: &Path) -> Result<Vec<OtherPoint>, AgainstError> {
    let text = fs::read_to_string(path).map_err(Problem::Io);
    text.and_then(|text| parse(&text))
        .map_err(|problem| AgainstError {
            path: path.to_owned(),
            problem,
        })
}

fn parse(text: &str) -> Result<Vec<OtherPoint>, Problem> {
    let lines = text.trim_start_matches('\u{feff}').lines().zip(1..);
    let mut lines = lines.filter(|(line, _)| !line.trim().is_empty() && !line.starts_with('#'));
    let wrong = |line: usize, what: String| Problem::Line { line, what };
    let (head, number) = lines.next().unwrap_or_default();
    let head: Vec<&str> = head.split(',').map(str::trim).collect();
    let column = |name: &str| head.iter().position(|&column| column == name);
    let required = |name: &str| {
        column(name).ok_or_else(|| wrong(number.max(1), format!("there is no column \"{name}\"")))
    };
    let (method, seconds) = (required("method")?, required("seconds")?);
    let relmse = column("measured_relmse").map_or_else(|| required("relmse"), Ok)?;
    lines
        .map(|(text, line)| {
            let cells: Vec<&str> = text.split(',').map(str::trim).collect();
            let positive = |column: usize| {
                let cell = cells.get(column).copied().unwrap_or_default();
                let number: Option<f64> = cell.parse().ok();
                number
                    .filter(|&number| number > 0.0 && number.is_finite())
                    .ok_or_else(|| {
                        wrong(
                            line,
                            format!("{} \"{cell}\" is no number above 0", head[column]),
                        )
                    })
            };
            Ok(OtherPoint {
                method: cells.get(method).copied().unwrap_or_default().to_owned(),
                seconds: positive(seconds)?,
                measured_relmse: positive(relmse)?,
                relmse: None,
            })
        })
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const FLOOR: Floor = Floor {
        estimate: 1e-5,
        bound: 1.1e-5,
    };

    #[test]
    fn columns_are_found_by_name() {
        let text = "# elsewhere\nseconds, spp ,method,relmse\n0.5,4,other,0.00101\n\n2,16,other,0.000015\n";
        let points = parse(text).unwrap();
        let points: Vec<_> = points.into_iter().map(|p| p.above(&FLOOR)).collect();
        assert_eq!(points.len(), 2);
        assert_eq!(
            (points[0].method.as_str(), points[0].seconds),
            ("other", 0.5)
        );
        assert!((points[0].relmse.unwrap() - 1e-3).abs() < 1e-12);
        assert_eq!(points[1].relmse, None);
    }

    #[test]
    fn a_wrong_line_is_named() {
        for (text, expected) in [
            ("", "line 1: there is no column \"method\""),
            ("method,seconds\n", "line 1: there is no column \"relmse\""),
            (
                "method,seconds,relmse\na,1,0.1\na,-1,0.1",
                "line 3: seconds \"-1\"",
            ),
            ("method,seconds,relmse\na,1", "line 2: relmse \"\""),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
