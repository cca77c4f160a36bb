//! What `bench bvh` measured, as tables.

use halfshade::bench::{RayReport, Spread, TreeReport};

use crate::cli::console::Bytes;
use crate::cli::table::{Table, known, number};

/// Trees, then rays through them; all of one mesh.
pub fn tables(reports: &[TreeReport]) -> String {
    let mut text = String::new();
    if let Some(first) = reports.first() {
        text += &format!("{}, {} triangles\n\n", first.mesh, first.triangles);
    }
    text += &format!("{}\n\n{}\n", trees(reports), rays(reports));
    text
}

fn trees(reports: &[TreeReport]) -> Table {
    let mut table = Table::new(&[
        "builder",
        "width",
        "threads",
        "build s",
        "min",
        "max",
        "cpu s",
        "memory",
        "bytes/triangle",
        "SAH cost",
        "nodes",
        "leaves",
        "depth",
    ]);
    for tree in reports {
        table.row(vec![
            tree.builder.to_owned(),
            tree.width.to_owned(),
            tree.threads.to_string(),
            number(tree.build_seconds),
            number(tree.build.wall.min),
            number(tree.build.wall.max),
            known(tree.build.processor.map(|spread| spread.median)),
            Bytes(tree.bytes as u64).to_string(),
            number(tree.bytes_per_triangle),
            number(tree.sah_cost),
            tree.nodes.to_string(),
            tree.leaves.to_string(),
            tree.depth.to_string(),
        ]);
    }
    table
}

/// Set by set, so that builders stand below each other.
fn rays(reports: &[TreeReport]) -> Table {
    let mut table = Table::new(&[
        "rays",
        "asked",
        "builder",
        "width",
        "threads",
        "Mrays/cpu s",
        "min",
        "max",
        "Mrays/s",
        "nodes/ray",
        "leaves/ray",
        "triangles/ray",
        "hits",
    ]);
    let sets = reports.first().map_or(0, |report| report.rays.len());
    for set in 0..sets {
        for tree in reports {
            table.row(ray_row(tree, &tree.rays[set]));
        }
    }
    table
}

fn ray_row(tree: &TreeReport, rays: &RayReport) -> Vec<String> {
    let rate = |seconds: fn(&Spread) -> f64| {
        let processors = rays.time.processor.as_ref();
        known(processors.map(|s| rays.count as f64 * rays.threads as f64 / seconds(s) / 1e6))
    };
    vec![
        rays.name.clone(),
        rays.kind.name().to_owned(),
        tree.builder.to_owned(),
        tree.width.to_owned(),
        rays.threads.to_string(),
        known(rays.mrays_per_cpu_second),
        rate(|spread| spread.max),
        rate(|spread| spread.min),
        number(rays.mrays_per_second),
        number(rays.nodes_per_ray),
        number(rays.leaves_per_ray),
        number(rays.triangles_per_ray),
        rays.hits.to_string(),
    ]
}
