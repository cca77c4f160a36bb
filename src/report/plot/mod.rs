//! Log-log charts as SVG.
//!
//! Series with names and styles go in, one chart or several in a grid under one legend; the text of
//! an SVG file comes out, fit for print: white, with colours that people with any kind of colour
//! vision can tell apart (Okabe and Ito 2008, "Color Universal Design"), and markers and dashes
//! beside the colours.

mod axis;
mod draw;

use thiserror::Error;

/// A chart with logarithmic axes. What is not positive and finite is not drawn.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// What stands above it.
    pub title: String,
    /// The name of the horizontal axis, with its unit.
    pub x: String,
    /// The name of the vertical axis, with its unit.
    pub y: String,
    /// What is shown.
    pub series: Vec<Series>,
    /// Lines to compare slopes with.
    pub guides: Vec<Guide>,
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// As in the legend, where a name stands once: series of one name have one style.
    pub name: String,
    /// How it is drawn.
    pub style: Style,
    /// In the order in which they are joined.
    pub points: Vec<Point>,
}

/// A measured point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Horizontal.
    pub x: f64,
    /// Vertical.
    pub y: f64,
    /// Least and greatest `y`; `None` where it is not known.
    pub range: Option<(f64, f64)>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// Number of a colour; there are seven, and they repeat.
    pub color: usize,
    /// What stands at each point.
    pub marker: Marker,
    /// What joins the points.
    pub line: Line,
}

/// What stands at each point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marker {
    /// A full circle.
    #[default]
    Disk,
    /// An empty circle.
    Ring,
    /// A full triangle.
    Triangle,
    /// Two strokes.
    Cross,
}

/// What joins the points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Line {
    /// One stroke.
    #[default]
    Solid,
    /// Many.
    Dashed,
    /// Nothing.
    None,
}

/// A straight line of known slope.
#[derive(Clone, Debug)]
pub struct Guide {
    /// What stands beside it.
    pub name: String,
    /// Decades up for each decade to the right.
    pub slope: f64,
    /// A point that it goes through.
    pub through: (f64, f64),
}

/// Why there is no plot.
#[derive(Debug, Error)]
#[error("the plot could not be drawn: {0}")]
pub struct PlotError(String);

/// The text of an SVG file that shows `charts`, row by row, `columns` in each row, each
/// `size` pixels wide and high.
///
/// # Errors
/// Where a chart is too small for what stands around it.
pub fn svg(charts: &[Chart], columns: usize, size: [u32; 2]) -> Result<String, PlotError> {
    draw::svg(charts, columns, size).map_err(|error| PlotError(error.to_string()))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn chart() -> Chart {
        let point = |x: f64, y: f64| Point { x, y, range: None };
        Chart {
            title: "build <time>".to_owned(),
            x: "triangles".to_owned(),
            y: "s".to_owned(),
            series: vec![Series {
                name: "balanced".to_owned(),
                style: Style::default(),
                points: vec![
                    point(1e3, 0.5),
                    point(1e4, 5.0),
                    point(1e5, f64::NAN),
                    point(1e6, 0.0),
                    point(1e7, 50.0),
                ],
            }],
            guides: vec![Guide {
                name: "linear".to_owned(),
                slope: 1.0,
                through: (1e3, 1.0),
            }],
        }
    }

    /// The places of the full circles, without the one of the legend, which comes first.
    fn disks(svg: &str) -> Vec<(f64, f64)> {
        let number = |line: &str, name: &str| -> f64 {
            let (_, rest) = line.split_once(&format!("{name}=\"")).unwrap();
            rest.split('"').next().unwrap().parse().unwrap()
        };
        let circles = svg.lines().filter(|line| line.contains("<circle"));
        let places = circles.map(|line| (number(line, "cx"), number(line, "cy")));
        places.skip(1).collect()
    }

    #[test]
    fn equal_factors_are_equal_distances() {
        let svg = svg(&[chart()], 1, [400, 300]).unwrap();
        let disks = disks(&svg);
        assert_eq!(disks.len(), 3, "{svg}");
        let [(x0, y0), (x1, y1), (x2, y2)] = [disks[0], disks[1], disks[2]];
        assert!(((x2 - x0) / (x1 - x0) - 4.0).abs() < 0.01);
        assert!(((y2 - y0) / (y1 - y0) - 2.0).abs() < 0.01);
        assert!(x1 > x0 && y1 < y0);
    }

    #[test]
    fn names_stand_in_it_and_are_escaped() {
        let svg = svg(&[chart(), chart()], 2, [400, 300]).unwrap();
        for (name, times) in [
            ("build &lt;time&gt;", 2),
            ("triangles", 2),
            ("balanced", 1),
            ("linear", 2),
            ("10⁵", 2),
        ] {
            assert_eq!(svg.matches(name).count(), times, "{name} in\n{svg}");
        }
        assert!(svg.starts_with("<svg width=\"800\""), "{}", &svg[..80]);
    }

    #[test]
    fn nothing_to_show_is_no_error() {
        assert!(svg(&[], 1, [400, 300]).is_ok());
        assert!(svg(&[Chart::default()], 3, [400, 300]).is_ok());
    }
}
