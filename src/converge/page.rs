//! `index.html`: the study as one self-contained page.

use serde::Serialize;

use super::chart::GUIDES;
use super::choice::{Choices, choices};
use super::page_tables::{point_table, point_text, settings_table, slope_table, time_table};
use super::study::Study;
use super::views::{ERROR_SCALE, View};
use crate::report::page::{document_with, escaped, map_figure, slider};

/// What the page's script draws.
#[derive(Serialize)]
struct Data<'a> {
    series: Vec<Series<'a>>,
    floors: Metrics,
    guides: [(&'static str, f64); 3],
    views: Vec<ShownView<'a>>,
    /// By time, then by method: an index of `views`.
    choices: &'a [Vec<usize>],
}

#[derive(Serialize)]
struct Series<'a> {
    name: &'a str,
    points: Vec<Place>,
}

#[derive(Serialize)]
struct Place {
    x: Times,
    y: Metrics,
    text: String,
}

#[derive(Serialize)]
struct Times {
    busy: f64,
    wall: f64,
    samples: f64,
}

/// Errors; `None` where they are below the noise of the reference.
#[derive(Serialize)]
struct Metrics {
    relative: Option<f64>,
    rmse: Option<f64>,
    flip: Option<f64>,
}

#[derive(Serialize)]
struct ShownView<'a> {
    text: String,
    picture: &'a str,
    errors: &'a str,
}

/// The page. `views` belong to the points of `study`, in order; `plot` is `curve.svg`.
pub fn page(study: &Study, views: &[View], plot: &str) -> String {
    let choices = choices(study);
    let shown = |&point: &usize| ShownView {
        text: point_text(&study.points[point]),
        picture: &views[point].picture.source,
        errors: &views[point].errors.source,
    };
    let data = Data {
        series: series(study),
        floors: floors(study),
        guides: GUIDES,
        views: choices.points.iter().map(shown).collect(),
        choices: &choices.by_time,
    };
    // Nothing in it can fail to be JSON. A script ends at its closing tag wherever that stands.
    let json = serde_json::to_string(&data).unwrap_or_default();
    let json = json.replace('<', "\\u003c");
    let sections = [
        summary(study),
        section("Error against time", &curves(plot)),
        section("Seconds to an error", &time_table(study)),
        section("How fast the error falls", &slope_table(study)),
        section("Side by side", &side_by_side(study, views, &choices)),
        section("Every point", &point_table(study)),
        section("How it was measured", &settings_table(study)),
        format!("<script type=\"application/json\" id=\"study\">{json}</script>\n"),
    ];
    document_with(
        &format!("{}: error against run time", study.scene),
        &sections.concat(),
        include_str!("page.css"),
        include_str!("page.js"),
    )
}

fn section(title: &str, body: &str) -> String {
    format!("<h2>{title}</h2>\n{body}")
}

fn summary(study: &Study) -> String {
    let [width, height] = study.size;
    let machine = &study.machine;
    format!(
        "<p>{width}×{height} pixels, {} triangles. Halfshade {} with {} threads on {} ({}).</p>\n",
        study.triangles,
        study.version,
        machine.threads,
        escaped(&machine.processor),
        machine.system
    )
}

/// The drawing, and what the script puts in its place.
fn curves(plot: &str) -> String {
    let select = |id: &str, name: &str, choices: &[(&str, &str)]| {
        let choices: String = choices
            .iter()
            .map(|(value, text)| format!("<option value=\"{value}\">{text}</option>"))
            .collect();
        format!("<label>{name} <select id=\"{id}\">{choices}</select></label>\n")
    };
    format!(
        "<div class=\"plot still\">\n{plot}</div>\n\
         <div class=\"controls scripted\">\n{}{}</div>\n\
         <div class=\"legend scripted\" id=\"legend\"></div>\n\
         <div class=\"plot scripted\" id=\"plot\"></div>\n\
         <p class=\"details scripted\" id=\"details\" aria-live=\"polite\">Point at a place in the plot, or go there \
         with the tabulator and the arrow keys, to see what it is.</p>\n\
         <p>The guides start at the first point of the Pareto front, which is dashed: what no other point beats \
         in both time and error. The noise of the reference is subtracted from every error; what is no larger than \
         that noise is not known.</p>\n",
        select(
            "y-axis",
            "Error",
            &[
                ("relative", "relative RMSE, √relMSE"),
                ("rmse", "RMSE of linear values"),
                ("flip", "FLIP")
            ]
        ),
        select(
            "x-axis",
            "against",
            &[
                ("busy", "seconds (processor time by thread)"),
                ("wall", "seconds on the wall"),
                ("samples", "camera samples of a pixel")
            ]
        )
    )
}

fn series(study: &Study) -> Vec<Series<'_>> {
    let own = study.curves().into_iter().map(|(name, points)| Series {
        name,
        points: points
            .into_iter()
            .map(|p| Place {
                x: Times {
                    busy: p.busy_seconds,
                    wall: p.seconds,
                    samples: p.samples,
                },
                y: Metrics {
                    relative: p.relmse.map(f64::sqrt),
                    rmse: p.rmse,
                    flip: p.flip,
                },
                text: point_text(p),
            })
            .collect(),
    });
    let others = study.others().into_iter().map(|(name, points)| Series {
        name,
        points: points
            .into_iter()
            .map(|p| Place {
                x: Times {
                    busy: p.seconds,
                    wall: p.seconds,
                    samples: 0.0,
                },
                y: Metrics {
                    relative: p.relmse.map(f64::sqrt),
                    rmse: None,
                    flip: None,
                },
                text: format!("{name}, measured elsewhere: {:.3} s", p.seconds),
            })
            .collect(),
    });
    own.chain(others).collect()
}

/// Of the noisiest reference.
fn floors(study: &Study) -> Metrics {
    let most = |of: fn(&super::study::ReferenceReport) -> f64| {
        Some(study.references.iter().map(of).fold(0.0, f64::max))
    };
    Metrics {
        relative: most(|r| r.floors.relmse.bound.sqrt()),
        rmse: most(|r| r.floors.mse.bound.sqrt()),
        flip: most(|r| 2.0 * r.flip_floor),
    }
}

/// Two pictures with their error maps: the first and the last method at the longest time.
fn side_by_side(study: &Study, views: &[View], choices: &Choices) -> String {
    let Some(pair) = choices.by_time.last() else {
        return String::new();
    };
    let (Some(&first), Some(&last)) = (pair.first(), pair.last()) else {
        return String::new();
    };
    let [left, right] = [first, last].map(|view| choices.points[view]);
    let titled = |point: usize| {
        let text = point_text(&study.points[point]);
        let View { picture, errors } = &views[point];
        [picture, errors].map(|shown| {
            let mut shown = shown.clone();
            shown.label.clone_from(&text);
            shown
        })
    };
    let ([left, left_map], [right, right_map]) = (titled(left), titled(right));
    let options = |names: &mut dyn Iterator<Item = String>, selected: usize| -> String {
        let option = |(i, name): (usize, String)| {
            let mark = if i == selected { " selected" } else { "" };
            format!("<option value=\"{i}\"{mark}>{}</option>", escaped(&name))
        };
        names.enumerate().map(option).collect()
    };
    let methods = |selected| {
        let mut names = study.curves().into_iter().map(|(name, _)| name.to_owned());
        options(&mut names, selected)
    };
    let mut times = choices
        .seconds
        .iter()
        .map(|seconds| format!("{seconds:.2} s"));
    format!(
        "<div class=\"controls scripted\">\n\
         <label>left <select id=\"left-method\">{}</select></label>\n\
         <label>right <select id=\"right-method\">{}</select></label>\n\
         <label>after about <select id=\"time\">{}</select></label>\n</div>\n\
         <p>Of each method the point whose time is nearest; both pictures are shown clipped to [0, 1].</p>\n{}\
         <h3>Where they are wrong: |A − B| / √(B² + 0.01), root mean square of red, green and blue</h3>\n\
         <div class=\"maps\">\n{}{}</div>\n",
        methods(0),
        methods(pair.len() - 1),
        options(&mut times, choices.seconds.len() - 1),
        slider(&left, &right),
        map_figure(&left_map, ERROR_SCALE),
        map_figure(&right_map, ERROR_SCALE)
    )
}
