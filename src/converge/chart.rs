//! `curve.svg`: relative RMSE against time.

use super::study::{Study, pareto_front};
use crate::report::plot::{self, Chart, Guide, Line, Marker, PlotError, Point, Series, Style};

/// What guides compare slopes with: independent samples; jittered ones at an edge; what a smooth
/// picture gives to scrambled nets.
pub const GUIDES: [(&str, f64); 3] = [("−1/2", -0.5), ("−3/4", -0.75), ("−1", -1.0)];

/// Pixels.
const SIZE: [u32; 2] = [1000, 640];

/// The text of an SVG file with every curve, the floor, guides and the Pareto front.
///
/// # Errors
/// See [`plot::svg`].
pub fn svg(study: &Study) -> Result<String, PlotError> {
    plot::svg(&[chart(study)], 1, SIZE)
}

fn chart(study: &Study) -> Chart {
    let [width, height] = study.size;
    let mut series = vec![front(study)];
    series.extend(curves(study));
    series.extend(floor(study, &series));
    Chart {
        title: format!("{}, {width}×{height} pixels", study.scene),
        x: "seconds for a picture (processor time by thread)".to_owned(),
        y: "relative RMSE, √relMSE".to_owned(),
        guides: guides(&series),
        series,
    }
}

/// What a series looks like; repeats after 28.
fn style(number: usize) -> Style {
    let markers = [Marker::Disk, Marker::Triangle, Marker::Ring, Marker::Cross];
    Style {
        color: number % 6,
        marker: markers[(number / 6) % markers.len()],
        line: Line::Solid,
    }
}

fn curves(study: &Study) -> Vec<Series> {
    let own = study.curves().into_iter().map(|(method, points)| {
        let points = points
            .iter()
            .map(|p| (p.busy_seconds, p.relmse, p.standard_error));
        (method, points.collect::<Vec<_>>())
    });
    let others = study.others().into_iter().map(|(method, points)| {
        let points = points.iter().map(|p| (p.seconds, p.relmse, None));
        (method, points.collect())
    });
    let all = own.chain(others).enumerate();
    all.map(|(i, (method, points))| Series {
        name: method.to_owned(),
        style: style(i),
        points: points.into_iter().filter_map(point).collect(),
    })
    .collect()
}

/// A point whose error is known, within twice its standard error.
fn point((x, relmse, error): (f64, Option<f64>, Option<f64>)) -> Option<Point> {
    let relmse = relmse?;
    let end = |side: f64| (relmse + 2.0 * side * error.unwrap_or(0.0)).max(0.0).sqrt();
    Some(Point {
        x,
        y: relmse.sqrt(),
        range: error.map(|_| (end(-1.0), end(1.0))),
    })
}

fn front(study: &Study) -> Series {
    let points = pareto_front(study);
    Series {
        name: "Pareto front".to_owned(),
        style: Style {
            color: 6,
            marker: Marker::Ring,
            line: Line::Dashed,
        },
        points: points
            .into_iter()
            .filter_map(|(x, y)| point((x, Some(y), None)))
            .collect(),
    }
}

/// From one end of the times to the other.
fn floor(study: &Study, series: &[Series]) -> Option<Series> {
    let floors = study.references.iter().map(|r| r.floors.relmse.bound);
    let floor = floors.fold(0.0, f64::max).sqrt();
    let times = || series.iter().flat_map(|s| &s.points).map(|p| p.x);
    let ends = [
        times().fold(f64::INFINITY, f64::min),
        times().fold(0.0, f64::max),
    ];
    (floor > 0.0 && floor.is_finite()).then(|| Series {
        name: "noise floor of the reference".to_owned(),
        style: Style {
            color: 6,
            marker: Marker::Cross,
            line: Line::Solid,
        },
        points: ends
            .map(|x| Point {
                x,
                y: floor,
                range: None,
            })
            .into(),
    })
}

/// Through the first point of the front, where there is one.
fn guides(series: &[Series]) -> Vec<Guide> {
    let Some(first) = series.first().and_then(|front| front.points.first()) else {
        return Vec::new();
    };
    let guide = |(name, slope): (&str, f64)| Guide {
        name: name.to_owned(),
        slope,
        through: (first.x, first.y),
    };
    GUIDES.map(guide).into()
}
