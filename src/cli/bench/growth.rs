//! What `bench bvh --scaling` measured, as charts, tables, CSV and fitted growth.

use halfshade::bench::{Generated, RayReport, Spread, Timing, TreeReport};
use halfshade::report::plot::{Chart, Guide, Line, Marker, Point, Series, Style};
use halfshade::report::power_law::PowerLaw;
use serde::Serialize;

use crate::cli::table::{Table, number};

/// The unit of what falls, and not grows, with the number of triangles.
const RATE: &str = "million rays a second";

/// Something that is measured: one chart, one column.
struct Quantity {
    name: String,
    unit: &'static str,
    value: Box<dyn Fn(&TreeReport) -> Spread>,
}

/// Build time and bytes, then the rate of every ray set.
fn quantities(reports: &[TreeReport]) -> Vec<Quantity> {
    let mut quantities = vec![
        Quantity {
            name: "build time".to_owned(),
            unit: "seconds",
            value: Box::new(build_time),
        },
        Quantity {
            name: "memory".to_owned(),
            unit: "bytes",
            value: Box::new(|report| Spread::of([report.bytes as f64])),
        },
    ];
    let sets = reports.first().map_or(&[][..], |report| &report.rays);
    quantities.extend(sets.iter().enumerate().map(|(set, rays)| Quantity {
        name: format!("{} rays", rays.name),
        unit: RATE,
        value: Box::new(move |report| rate(&report.rays[set])),
    }));
    quantities
}

/// Of one thread as if it had a processor to itself. Several do not share the work evenly, and
/// only the wall tells how long they take.
fn build_time(report: &TreeReport) -> Spread {
    match report.threads {
        1 => report.build.undisturbed(1),
        _ => report.build.wall,
    }
}

/// Millions of rays in a second, as if every thread had a processor to itself.
fn rate(rays: &RayReport) -> Spread {
    let seconds = rays.time.undisturbed(rays.threads);
    let rate = |seconds: f64| rays.count as f64 / seconds / 1e6;
    Spread {
        median: rate(seconds.median),
        min: rate(seconds.max),
        max: rate(seconds.min),
    }
}

/// One mesh kind with one builder, by size.
fn curves(reports: &[TreeReport]) -> Vec<(&str, &'static str, Vec<&TreeReport>)> {
    let mut curves: Vec<(&str, &'static str, Vec<&TreeReport>)> = Vec::new();
    for report in reports {
        let (mesh, builder) = (report.mesh.as_str(), report.builder);
        match curves.iter_mut().find(|c| (c.0, c.1) == (mesh, builder)) {
            Some((.., curve)) => curve.push(report),
            None => curves.push((mesh, builder, vec![report])),
        }
    }
    curves
}

/// A chart for every quantity.
pub fn charts(reports: &[TreeReport]) -> Vec<Chart> {
    let charts = quantities(reports).into_iter().zip('a'..);
    charts
        .map(|(q, letter)| chart(reports, &q, letter))
        .collect()
}

fn chart(reports: &[TreeReport], quantity: &Quantity, letter: char) -> Chart {
    let mut builders: Vec<&str> = Vec::new();
    let mut series = Vec::new();
    for (mesh, builder, curve) in curves(reports) {
        if !builders.contains(&builder) {
            builders.push(builder);
        }
        let is_first_kind = mesh == Generated::ALL[0].name();
        let point = |report: &&TreeReport| {
            let value = (quantity.value)(report);
            Point {
                x: report.triangles as f64,
                y: value.median,
                range: Some((value.min, value.max)),
            }
        };
        series.push(Series {
            name: format!("{builder}, {mesh}"),
            style: Style {
                color: builders.iter().position(|b| *b == builder).unwrap_or(0),
                marker: if is_first_kind {
                    Marker::Disk
                } else {
                    Marker::Ring
                },
                line: if is_first_kind {
                    Line::Solid
                } else {
                    Line::Dashed
                },
            },
            points: curve.iter().map(point).collect(),
        });
    }
    // A little below everything.
    let per_triangle = |r: &TreeReport| (quantity.value)(r).min / r.triangles as f64;
    let least = reports.iter().map(per_triangle).reduce(f64::min);
    Chart {
        title: format!("({letter}) {}", quantity.name),
        x: "triangles".to_owned(),
        y: quantity.unit.to_owned(),
        series,
        guides: least
            .filter(|_| quantity.unit != RATE)
            .map(|least| Guide {
                name: "linear".to_owned(),
                slope: 1.0,
                through: (1.0, 0.6 * least),
            })
            .into_iter()
            .collect(),
    }
}

/// How one quantity grows, for one kind of mesh and one builder.
#[derive(Serialize)]
pub struct Growth {
    quantity: String,
    mesh: String,
    builder: &'static str,
    exponent: f64,
    standard_error: f64,
}

/// Of every quantity, kind of mesh and builder; none where there are too few sizes to fit.
pub fn growths(reports: &[TreeReport]) -> Vec<Growth> {
    let mut growths = Vec::new();
    for quantity in quantities(reports) {
        for (mesh, builder, curve) in curves(reports) {
            let points: Vec<(f64, f64)> = curve
                .iter()
                .map(|report| (report.triangles as f64, (quantity.value)(report).median))
                .collect();
            if let Some(fit) = PowerLaw::fit(&points) {
                growths.push(Growth {
                    quantity: quantity.name.clone(),
                    mesh: mesh.to_owned(),
                    builder,
                    exponent: fit.exponent,
                    standard_error: fit.standard_error,
                });
            }
        }
    }
    growths
}

/// The exponents.
pub fn growth_table(growth: &[Growth]) -> Table {
    let mut table = Table::new(&["quantity", "mesh", "builder", "exponent", "standard error"]);
    for growth in growth {
        table.row(vec![
            growth.quantity.clone(),
            growth.mesh.clone(),
            growth.builder.to_owned(),
            format!("{:.3}", growth.exponent),
            format!("{:.3}", growth.standard_error),
        ]);
    }
    table
}

/// The medians.
pub fn table(reports: &[TreeReport]) -> Table {
    let sets = reports.first().map_or(&[][..], |report| &report.rays);
    let rates_of = sets.iter().map(|set| format!("{} Mrays/s", set.name));
    let mut head: Vec<String> = ["mesh", "triangles", "builder", "threads", "build s"]
        .into_iter()
        .chain(["bytes/triangle", "SAH cost"])
        .map(str::to_owned)
        .collect();
    head.extend(rates_of);
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let mut table = Table::new(&head);
    for report in reports {
        let mut row = vec![
            report.mesh.clone(),
            report.triangles.to_string(),
            report.builder.to_owned(),
            report.threads.to_string(),
            number(build_time(report).median),
            number(report.bytes_per_triangle),
            number(report.sah_cost),
        ];
        row.extend(report.rays.iter().map(|rays| number(rate(rays).median)));
        table.row(row);
    }
    table
}

/// Every number, for other programs; columns for what is not known are empty.
pub fn csv(reports: &[TreeReport]) -> String {
    let mut head = "mesh,triangles,builder,width,threads".to_owned() + &time_columns("build");
    head += ",bytes,bytes_per_triangle,sah_cost,nodes,leaves,depth";
    for set in reports.first().map_or(&[][..], |report| &report.rays) {
        let name = &set.name;
        head += &format!(",{name}_rays{}", time_columns(name));
        head += &format!(",{name}_nodes_per_ray,{name}_leaves_per_ray");
    }
    let rows = reports.iter().map(csv_row);
    std::iter::once(head)
        .chain(rows)
        .map(|line| line + "\n")
        .collect()
}

fn csv_row(report: &TreeReport) -> String {
    let r = report;
    let mut row = format!("{},{},{}", r.mesh, r.triangles, r.builder);
    row += &format!(",{},{}", r.width, r.threads);
    row += &time_values(&r.build);
    row += &format!(",{},{},{}", r.bytes, r.bytes_per_triangle, r.sah_cost);
    row += &format!(",{},{},{}", r.nodes, r.leaves, r.depth);
    for rays in &r.rays {
        row += &format!(",{}{}", rays.count, time_values(&rays.time));
        row += &format!(",{},{}", rays.nodes_per_ray, rays.leaves_per_ray);
    }
    row
}

fn time_columns(name: &str) -> String {
    ["seconds", "cpu_seconds"]
        .map(|clock| format!(",{name}_{clock},{name}_{clock}_min,{name}_{clock}_max"))
        .concat()
}

fn time_values(time: &Timing) -> String {
    [Some(time.wall), time.processor]
        .map(|spread| match spread {
            Some(Spread { median, min, max }) => format!(",{median},{min},{max}"),
            None => ",,,".to_owned(),
        })
        .concat()
}
