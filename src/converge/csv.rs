//! `curve.csv`: one line a point. What is not known stays empty.

use super::point::Point;

/// The names of the columns.
const COLUMNS: [&str; 28] = [
    "method",
    "pattern",
    "target",
    "adaptive",
    "asked_samples",
    "samples",
    "light_samples",
    "repeats",
    "first_seed",
    "seconds",
    "seconds_min",
    "seconds_max",
    "cpu_seconds",
    "busy_seconds",
    "camera_rays",
    "shadow_rays",
    "secondary_rays",
    "rmse",
    "relmse",
    "standard_error",
    "measured_rmse",
    "measured_relmse",
    "floor_relmse",
    "variance",
    "bias_squared",
    "flip",
    "estimated_relmse",
    "coverage",
];

/// The points as lines under the names of the columns, which stand in [`Point`] as well.
pub fn csv(points: &[Point]) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for point in points {
        text += &(cells(point).join(",") + "\n");
    }
    text
}

fn cells(p: &Point) -> [String; 28] {
    let known = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    [
        p.method.clone(),
        p.pattern.to_owned(),
        p.target.to_owned(),
        p.adaptive.to_string(),
        p.asked_samples.to_string(),
        p.samples.to_string(),
        p.light_samples.map_or_else(String::new, |n| n.to_string()),
        p.repeats.to_string(),
        p.first_seed.to_string(),
        p.seconds.to_string(),
        p.time.wall.min.to_string(),
        p.time.wall.max.to_string(),
        known(p.cpu_seconds),
        p.busy_seconds.to_string(),
        p.rays.camera.to_string(),
        p.rays.shadow.to_string(),
        p.rays.secondary.to_string(),
        known(p.rmse),
        known(p.relmse),
        known(p.standard_error),
        p.measured_rmse.to_string(),
        p.measured_relmse.to_string(),
        p.floor_relmse.to_string(),
        known(p.variance),
        known(p.bias_squared),
        known(p.flip),
        known(p.estimated_relmse),
        known(p.coverage),
    ]
}
