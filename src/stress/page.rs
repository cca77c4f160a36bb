//! A page with everything that the cases measured.

use crate::report::page::{document, escaped, table};
use crate::report::plot::{Chart, Guide, Marker, PlotError, Point, Series, Style, svg};

use super::{Check, Curve, Report, Sweep};

/// Size of a plot, pixels.
const PLOT: [u32; 2] = [640, 380];

/// A page that needs no network: the table of `reports`, and the sweeps of each as plots.
///
/// # Errors
/// Where a plot cannot be drawn.
pub fn page(title: &str, reports: &[Report]) -> Result<String, PlotError> {
    let rows: Vec<Vec<String>> = reports
        .iter()
        .flat_map(|report| report.checks.iter().map(|check| row(report, check)))
        .collect();
    let head = ["case", "tried", "measured", "bound", "verdict"];
    let cases: String = reports.iter().map(section).collect::<Result<_, _>>()?;
    Ok(document(
        title,
        &format!("{}\n{cases}", table(&head, &rows)),
    ))
}

fn row(report: &Report, check: &Check) -> Vec<String> {
    vec![
        report.id.clone(),
        check.tried.clone(),
        number(check.measured),
        number(check.bound),
        check.status.name().to_owned(),
    ]
}

fn number(value: f64) -> String {
    match value.abs() {
        size if size == 0.0 || (1e-2..1e6).contains(&size) => {
            let digits = if value.fract() == 0.0 { 0 } else { 3 };
            format!("{value:.digits$}")
        }
        _ => format!("{value:.2e}"),
    }
}

fn section(report: &Report) -> Result<String, PlotError> {
    let checks: String = report.checks.iter().map(figure).collect::<Result<_, _>>()?;
    Ok(format!(
        "<h2>{} {}: {}</h2>\n{checks}",
        escaped(&report.id),
        escaped(&report.case),
        report.status().name()
    ))
}

/// What was tried, with its plot where it has more than one point to show.
fn figure(check: &Check) -> Result<String, PlotError> {
    let mut text = format!(
        "<p>{}: <strong>{}</strong>, {} of {} allowed.",
        escaped(&check.tried),
        check.status.name(),
        number(check.measured),
        number(check.bound)
    );
    if let Some(note) = &check.note {
        text += &format!(" {}.", escaped(note));
    }
    text += "</p>\n";
    if let Some(sweep) = &check.sweep {
        text += &plot(sweep, check.bound)?;
    }
    Ok(text)
}

fn plot(sweep: &Sweep, bound: f64) -> Result<String, PlotError> {
    let shown = |curve: &Curve| {
        curve
            .points
            .iter()
            .filter(|p| p.0 > 0.0 && p.1 > 0.0)
            .count()
    };
    if sweep.curves.iter().map(shown).sum::<usize>() < 2 {
        let (x, y) = (escaped(sweep.x), escaped(sweep.y));
        return Ok(format!(
            "<p>Nothing to plot of <em>{y}</em> against <em>{x}</em>: 0 everywhere.</p>\n"
        ));
    }
    let series = sweep
        .curves
        .iter()
        .enumerate()
        .map(|(number, curve)| Series {
            name: if curve.name.is_empty() {
                sweep.y.to_owned()
            } else {
                curve.name.clone()
            },
            style: Style {
                color: number,
                marker: [Marker::Disk, Marker::Ring, Marker::Triangle, Marker::Cross]
                    [number / 7 % 4],
                ..Style::default()
            },
            points: curve
                .points
                .iter()
                .map(|&(x, y)| Point { x, y, range: None })
                .collect(),
        });
    let first = sweep
        .curves
        .iter()
        .flat_map(|c| &c.points)
        .find(|p| p.0 > 0.0);
    let guide = first.filter(|_| bound > 0.0).map(|&(x, _)| Guide {
        name: "bound".to_owned(),
        slope: 0.0,
        through: (x, bound),
    });
    let chart = Chart {
        title: String::new(),
        x: sweep.x.to_owned(),
        y: sweep.y.to_owned(),
        series: series.collect(),
        guides: guide.into_iter().collect(),
    };
    Ok(format!(
        "<figure>\n{}\n</figure>\n",
        svg(&[chart], 1, PLOT)?
    ))
}
