//! `bench bvh --scaling`: the files that it writes.

use std::fs;

use halfshade::bvh::Builder;

use super::{bench_json, folder};

#[test]
fn scaling_writes_a_plot_and_tables() {
    let folder = folder();
    let few = [
        "--max-triangles",
        "17000",
        "--repeats",
        "1",
        "--resolution",
        "16",
    ];
    let arguments = [
        &["bvh", "--scaling", "-o", "made", "--json", "-q"],
        &few[..],
    ]
    .concat();
    let all = bench_json(folder.path(), &arguments);
    let trees = Builder::ALL.len() - 1;
    let (sizes, kinds, quantities) = (3, 2, 6);
    let measurements = all["measurements"].as_array().unwrap();
    assert_eq!(measurements.len(), sizes * kinds * trees);
    let growth = all["growth"].as_array().unwrap();
    assert_eq!(growth.len(), quantities * kinds * trees);
    for growth in growth.iter().filter(|g| g["quantity"] == "memory") {
        let exponent = growth["exponent"].as_f64().unwrap();
        assert!((exponent - 1.0).abs() < 0.15, "{growth}");
    }
    let read = |name: &str| fs::read_to_string(folder.path().join("made").join(name)).unwrap();
    let csv = read("scaling.csv");
    let columns = |line: &str| line.split(',').count();
    assert_eq!(csv.lines().count(), 1 + measurements.len());
    assert!(csv.lines().all(|line| columns(line) == 17 + 4 * 9), "{csv}");
    let markdown = read("scaling.md");
    assert!(markdown.contains("| terrain |") && markdown.contains("| exponent |"));
    let svg = read("scaling.svg");
    for name in [
        "(a) build time",
        "(f) random rays",
        "balanced, spheres",
        "bytes",
    ] {
        assert!(svg.contains(name), "{name}");
    }
    let values = measurements.len() * quantities;
    assert!(
        svg.matches("<circle").count() > values,
        "a marker for each value"
    );
}
