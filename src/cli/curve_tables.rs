//! What `converge` measured, as tables for people.

use halfshade::converge::{GOALS, Point, Reached, Slope, Study, TimeToError};

use super::table::{Table, known, number};

/// Points, slopes, times to errors.
pub fn tables(study: &Study) -> String {
    let [width, height] = study.size;
    let mut text = format!(
        "{}, {} triangles, {width}x{height} pixels\n",
        study.scene, study.triangles
    );
    for reference in &study.references {
        let floor = &reference.floors.relmse;
        text += &format!(
            "reference ({}): {} samples, its own relMSE {} (up to {}), which is subtracted\n",
            reference.target,
            reference.samples,
            number(floor.estimate),
            number(floor.bound)
        );
    }
    text += &format!(
        "\n{}\n\nError as a power of the number of samples, with the 95 % interval of the slope\n\n{}\n\n\
         Seconds to a relMSE (processor time by thread), and in those of the fastest\n\n{}",
        points(study),
        slopes(&study.slopes),
        times(&study.time_to_error)
    );
    for left_out in &study.left_out {
        text += &format!("\nleft out: {left_out}");
    }
    text
}

/// A number, or that it is below the noise of the reference.
fn above(value: Option<f64>, floor: f64) -> String {
    value.map_or_else(|| format!("< {}", number(floor)), number)
}

fn points(study: &Study) -> Table {
    let mut table = Table::new(&[
        "method",
        "samples",
        "wall s",
        "min",
        "max",
        "cpu s",
        "Mrays",
        "relMSE",
        "± s.e.",
        "bias²",
        "RMSE",
        "FLIP",
        "self-estimate",
        "coverage",
    ]);
    for (_, points) in study.curves() {
        for point in points {
            table.row(row(point));
        }
    }
    table
}

fn row(p: &Point) -> Vec<String> {
    let rays = (p.rays.camera + p.rays.shadow + p.rays.secondary) as f64;
    let of_known = |value: Option<f64>| known(p.relmse.and(value));
    vec![
        p.method.clone(),
        format!("{:.0}", p.samples),
        number(p.seconds),
        number(p.time.wall.min),
        number(p.time.wall.max),
        known(p.cpu_seconds),
        number(rays / 1e6),
        above(p.relmse, p.floor_relmse),
        of_known(p.standard_error),
        of_known(p.bias_squared),
        p.rmse.map_or_else(|| "below floor".to_owned(), number),
        p.flip.map_or_else(|| "below floor".to_owned(), number),
        known(p.estimated_relmse),
        known(p.coverage),
    ]
}

fn slopes(slopes: &[Slope]) -> Table {
    let mut table = Table::new(&["method", "slope", "low", "high", "bias²", "points"]);
    for Slope { method, law } in slopes {
        let cells = law.map_or_else(
            || vec!["too few known errors".to_owned()],
            |law| {
                let [low, high] = law.slope_interval;
                let slopes = [law.slope, low, high].map(|slope| format!("{slope:.2}"));
                let mut cells = slopes.to_vec();
                cells.extend([number(law.bias_squared), law.points.to_string()]);
                cells
            },
        );
        table.row([vec![method.clone()], cells].concat());
    }
    table
}

fn times(times: &[TimeToError]) -> Table {
    let heads = GOALS.map(|goal| format!("{goal:e}"));
    let mut head = vec!["method"];
    head.extend(heads.iter().flat_map(|head| [head.as_str(), "×"]));
    let mut table = Table::new(&head);
    for TimeToError { method, goals } in times {
        let mut cells = vec![method.clone()];
        for goal in goals {
            cells.push(reached(goal.reached));
            cells.push(
                goal.ratio
                    .map_or_else(String::new, |ratio| format!("{ratio:.1}")),
            );
        }
        table.row(cells);
    }
    table
}

fn reached(reached: Reached) -> String {
    match reached {
        Reached::About(seconds) => number(seconds),
        Reached::AtMost(seconds) => format!("≤ {}", number(seconds)),
        Reached::Not(seconds) => format!("> {}", number(seconds)),
        Reached::BelowTheFloor => "below floor".to_owned(),
    }
}
