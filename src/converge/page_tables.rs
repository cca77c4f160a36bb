//! The tables of the page.

use super::point::Point;
use super::study::{Goal, Study};
use super::time_to_error::{GOALS, Reached};
use crate::report::page::table;

/// A number with three digits.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-3..1e4 => {
            let digits = (2.0 - value.abs().log10().floor()).max(0.0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.2e}"),
    }
}

fn known(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), number)
}

/// A number, or that it is below the noise of the reference.
fn above(value: Option<f64>, floor: f64) -> String {
    value.map_or_else(|| format!("< {}", number(floor)), number)
}

/// What a point is, in a few lines.
pub fn point_text(p: &Point) -> String {
    let lights = match p.light_samples {
        Some(n) => format!("{n} shadow rays to each light"),
        None => "shadow rays as each light says".to_owned(),
    };
    let rays = (p.rays.camera + p.rays.shadow + p.rays.secondary) as f64;
    let own = p.estimated_relmse.map_or_else(String::new, |estimate| {
        format!(" (by its own account {})", number(estimate))
    });
    format!(
        "{}: {:.0} camera samples, {lights}\n{} s, on the wall {} s ({} to {}), {} million rays\nrelMSE {}{own}, RMSE {}, FLIP {}",
        p.method,
        p.samples,
        number(p.busy_seconds),
        number(p.seconds),
        number(p.time.wall.min),
        number(p.time.wall.max),
        number(rays / 1e6),
        above(p.relmse, p.floor_relmse),
        p.rmse.map_or_else(|| "below the floor".to_owned(), number),
        p.flip.map_or_else(|| "below the floor".to_owned(), number),
    )
}

/// How long each method takes to each goal, and how many times as long as the fastest.
pub fn time_table(study: &Study) -> String {
    let heads = GOALS.map(|goal| format!("relMSE {goal:e}"));
    let mut head = vec!["Method"];
    head.extend(heads.iter().map(String::as_str));
    let rows: Vec<Vec<String>> = study
        .time_to_error
        .iter()
        .map(|times| {
            let goals = times.goals.iter().map(goal_text);
            std::iter::once(times.method.clone()).chain(goals).collect()
        })
        .collect();
    let left_out: String = study
        .left_out
        .iter()
        .map(|text| format!("<p>Left out: {}.</p>\n", crate::report::page::escaped(text)))
        .collect();
    format!(
        "<p>Processor time by thread, between the two points around the goal, and its ratio to that of the \
         fastest method. ≤: the first point is better already. &gt;: the curve ends before.</p>\n\
         <div class=\"wide\">\n{}</div>\n{left_out}",
        table(&head, &rows)
    )
}

fn goal_text(goal: &Goal) -> String {
    match (goal.reached, goal.ratio) {
        (Reached::About(seconds), Some(ratio)) => {
            format!("{} s (× {ratio:.1})", number(seconds))
        }
        (Reached::About(seconds), None) => format!("{} s", number(seconds)),
        (Reached::AtMost(seconds), _) => format!("≤ {} s", number(seconds)),
        (Reached::Not(seconds), _) => format!("> {} s", number(seconds)),
        (Reached::BelowTheFloor, _) => "below the floor".to_owned(),
    }
}

/// The slopes with their intervals.
pub fn slope_table(study: &Study) -> String {
    let rows: Vec<Vec<String>> = study
        .slopes
        .iter()
        .map(|slope| match slope.law {
            None => vec![slope.method.clone(), "too few known errors".to_owned()],
            Some(law) => {
                let [low, high] = law.slope_interval;
                vec![
                    slope.method.clone(),
                    format!("{:.2}", law.slope),
                    format!("{low:.2} to {high:.2}"),
                    number(law.bias_squared),
                    law.points.to_string(),
                ]
            }
        })
        .collect();
    let head = ["Method", "Slope", "95 % interval", "Bias²", "Points"];
    format!(
        "<p>error² = bias² + c·N<sup>−p</sup>, fitted over the number N of camera samples; the slope is −p/2. A bias \
         is named where the points fit worse without one than chance allows.</p>\n{}",
        table(&head, &rows)
    )
}

/// All that is known of each point.
pub fn point_table(study: &Study) -> String {
    let head = [
        "Method",
        "samples",
        "s",
        "wall s",
        "min",
        "max",
        "camera rays",
        "shadow rays",
        "secondary",
        "relMSE",
        "± s.e.",
        "variance",
        "bias²",
        "RMSE",
        "FLIP",
        "own estimate",
        "coverage",
    ];
    let rows = study.curves().into_iter().flat_map(|(_, points)| points);
    let rows: Vec<Vec<String>> = rows.map(row).collect();
    format!(
        "<p>Variance differs from seed to seed, bias does not (– where it is not told from 0). The own \
         estimate is what the render says of its relMSE without a reference; coverage is the share of the repeats \
         whose own 95 % interval holds their error.</p>\n<div class=\"wide\">\n{}</div>\n",
        table(&head, &rows)
    )
}

fn row(p: &Point) -> Vec<String> {
    let of_known = |value: Option<f64>| known(p.relmse.and(value));
    vec![
        p.method.clone(),
        format!("{:.0}", p.samples),
        number(p.busy_seconds),
        number(p.seconds),
        number(p.time.wall.min),
        number(p.time.wall.max),
        p.rays.camera.to_string(),
        p.rays.shadow.to_string(),
        p.rays.secondary.to_string(),
        above(p.relmse, p.floor_relmse),
        of_known(p.standard_error),
        of_known(p.variance),
        of_known(p.bias_squared),
        known(p.rmse),
        known(p.flip),
        known(p.estimated_relmse),
        known(p.coverage),
    ]
}

/// References, options, and what is not in the points.
pub fn settings_table(study: &Study) -> String {
    let mut rows: Vec<Vec<String>> = study
        .references
        .iter()
        .map(|r| {
            let floor = &r.floors.relmse;
            let text = format!(
                "{} samples, seed {}; its own relMSE {}, at most {}",
                r.samples,
                r.seed,
                number(floor.estimate),
                number(floor.bound)
            );
            vec![format!("reference ({})", r.target), text]
        })
        .collect();
    let seconds = [
        ("import", study.seconds.import),
        ("build", study.seconds.prepare),
        ("reference", study.seconds.reference),
    ];
    rows.extend(seconds.map(|(name, s)| vec![name.to_owned(), format!("{} s", number(s))]));
    let settings = study.settings.iter();
    rows.extend(settings.map(|(name, value)| vec![name.clone(), value.clone()]));
    rows.push(vec!["scene digest".to_owned(), study.digest.clone()]);
    table(&["", ""], &rows)
}
