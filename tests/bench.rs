//! `halfshade bench` and the library behind it: files, counts and names. No time is asserted.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use halfshade::bench::{Plan, Query, Triangles, measure, own_rays, read_rays, write_rays};
use halfshade::bvh::{Builder, Bvh};
use halfshade::import::{SceneOptions, import};
use halfshade::math::{Ray, Vec3};
use serde_json::Value;
use tempfile::TempDir;

/// A pyramid on a floor; two quadrilaterals and four triangles.
const OBJ: &str = "\
v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 4 0
v -3 0 -3\nv 3 0 -3\nv 3 0 3\nv -3 0 3
f 9 8 7 6\nf 1 2 3 4\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1
";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.obj"), OBJ).unwrap();
    folder
}

fn bench(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_halfshade"))
        .arg("bench")
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn bench_json(folder: &Path, arguments: &[&str]) -> Value {
    let output = bench(folder, arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {error}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn triangles(folder: &Path) -> Triangles {
    let imported = import(&folder.join("scene.obj"), &SceneOptions::default()).unwrap();
    Triangles::of_scene(&imported.scene).unwrap()
}

fn some_rays() -> Vec<Ray> {
    let ray = |i: u16| Ray {
        origin: Vec3::new(0.013 * f32::from(i) - 2.6, 2.0, 0.1),
        direction: Vec3::new(0.1, -1.0, 0.02),
        t_min: 0.25,
        t_max: if i % 3 == 0 { 0.6 } else { f32::INFINITY },
    };
    (0..400).map(ray).collect()
}

#[test]
fn json_has_the_promised_keys() {
    let folder = folder();
    let few = ["--resolution", "16", "--repeats", "2", "--json"];
    let arguments = [&["bvh", "scene.obj", "--threads", "1,2"], &few[..]].concat();
    let reports = bench_json(folder.path(), &arguments);
    let reports = reports.as_array().unwrap();
    let trees = Builder::ALL.len() - 1;
    assert_eq!(reports.len(), 2 * trees);
    for report in reports {
        assert_eq!(report["mesh"], "scene.obj");
        assert_eq!(report["triangles"], 8);
        assert!(report["builder"].is_string() && report["builder"] != "none");
        assert!(report["build_seconds"].as_f64().unwrap() > 0.0);
        assert!(report["bytes"].as_u64().unwrap() > 8 * 36);
        let rays = report["rays"].as_array().unwrap();
        assert_eq!(rays.len(), 4);
        for (set, name) in rays.iter().zip(["primary", "shadow", "diffuse", "random"]) {
            assert_eq!(set["name"], name);
            assert!(set["file"].is_null());
            assert_eq!(
                set["kind"],
                if name == "shadow" { "any" } else { "closest" }
            );
            assert_eq!(set["threads"], report["threads"]);
            let rate = set["mrays_per_second"].as_f64().unwrap();
            let seconds = set["seconds"].as_f64().unwrap();
            let count = set["count"].as_f64().unwrap();
            assert!((rate * seconds * 1e6 / count - 1.0).abs() < 1e-9);
        }
        // Not every primary ray meets the pyramid or its floor, and every one that does goes on.
        let hits = rays[0]["hits"].as_u64().unwrap();
        assert!(0 < hits && hits < 256);
        assert_eq!(rays[1]["count"].as_u64(), Some(hits));
        assert_eq!(rays[2]["count"].as_u64(), Some(hits));
        assert_eq!(rays[3]["count"].as_u64(), Some(256));
    }
}

#[test]
fn a_table_names_every_builder_and_ray_set() {
    let folder = folder();
    let output = bench(
        folder.path(),
        &["bvh", "scene.obj", "--resolution", "8", "--repeats", "1"],
    );
    let text = String::from_utf8(output.stdout).unwrap();
    for word in [
        "scene.obj, 8 triangles",
        "median",
        "balanced",
        "shadow",
        "SAH cost",
    ] {
        assert!(text.contains(word), "{word} is not in\n{text}");
    }
}

#[test]
fn all_builders_find_the_same() {
    let folder = folder();
    let triangles = triangles(folder.path());
    let sets = own_rays(&triangles, 32).unwrap();
    let plan = Plan {
        builders: Builder::ALL.to_vec(),
        threads: vec![1, 3],
        repeats: 1,
    };
    let reports = measure("scene", &triangles, &sets, &plan).unwrap();
    assert_eq!(reports.len(), 2 * Builder::ALL.len());
    for report in &reports {
        for (set, expected) in report.rays.iter().zip(&reports[0].rays) {
            assert_eq!((set.hits, &set.digest), (expected.hits, &expected.digest));
        }
    }
    // Every other hit would change the digest: a ray set that is one ray shorter has another one.
    let mut shorter = sets[0].clone();
    let is_hit = |ray: &Ray| {
        Bvh::build(&triangles.positions, &triangles.indices, Builder::None).any_hit(ray)
    };
    let last_hit = shorter.rays.iter().rposition(is_hit).unwrap();
    shorter.rays.remove(last_hit);
    let other = measure("scene", &triangles, &[shorter], &plan).unwrap();
    assert_ne!(other[0].rays[0].digest, reports[0].rays[0].digest);
}

#[test]
fn own_rays_start_where_they_should() {
    let folder = folder();
    let triangles = triangles(folder.path());
    let tree = Bvh::build(&triangles.positions, &triangles.indices, Builder::Balanced);
    let [primary, shadow, diffuse, random] = own_rays(&triangles, 32).unwrap();
    assert_eq!(primary.rays.len(), 32 * 32);
    assert_eq!(random.rays.len(), 32 * 32);
    assert_eq!(shadow.query, Query::Any);
    // Nothing starts below the floor, and what starts on it goes up.
    for ray in shadow.rays.iter().chain(&diffuse.rays) {
        assert!(ray.origin.y >= 0.0, "{ray:?}");
        assert!(ray.origin.y > 1e-4 || ray.direction.y > 0.0, "{ray:?}");
    }
    let bounds = tree.bounds();
    for ray in &random.rays {
        let inside = ray.origin.cmpge(bounds.min) & ray.origin.cmple(bounds.max);
        assert!(inside.all() && (ray.direction.length() - 1.0).abs() < 1e-5);
    }
    // The floor is larger than the pyramid's shadow on it.
    let blocked = shadow.rays.iter().filter(|ray| tree.any_hit(ray)).count();
    assert!(0 < blocked && 2 * blocked < shadow.rays.len(), "{blocked}");
    assert!(own_rays(&Triangles::default(), 32).is_none());
}

#[test]
fn ray_files_keep_every_bit() {
    let folder = folder();
    let path = folder.path().join("a.ray");
    let mut rays = some_rays();
    rays[1].direction = Vec3::new(-0.0, f32::MIN_POSITIVE / 4.0, f32::MAX);
    write_rays(&path, &rays).unwrap();
    assert_eq!(fs::metadata(&path).unwrap().len(), 8 + 32 * 400);
    let bits = |rays: &[Ray]| -> Vec<u32> {
        let numbers = |r: &Ray| {
            let ([a, b, c], [d, e, f]) = (r.origin.to_array(), r.direction.to_array());
            [a, b, c, r.t_min, d, e, f, r.t_max].map(f32::to_bits)
        };
        rays.iter().flat_map(numbers).collect()
    };
    assert_eq!(bits(&read_rays(&path).unwrap()), bits(&rays));
}

#[test]
fn dumped_hits_are_those_of_closest_hit() {
    let folder = folder();
    let path = folder.path();
    let rays = some_rays();
    write_rays(&path.join("a.ray"), &rays).unwrap();
    let triangles = triangles(path);
    let tree = Bvh::build(&triangles.positions, &triangles.indices, Builder::None);
    for (argument, builder) in [("a.ray", "median"), ("a.ray:any", "balanced")] {
        let arguments = [
            &[
                "bvh",
                "scene.obj",
                "--rays",
                argument,
                "--dump-hits",
                "hits",
            ][..],
            &["--builder", builder, "--repeats", "1", "--json"],
        ];
        let reports = bench_json(path, &arguments.concat());
        let set = &reports[0]["rays"][0];
        assert_eq!(
            (&set["file"], &set["count"]),
            (&"a.ray".into(), &400.into())
        );
        let bytes = fs::read(path.join("hits")).unwrap();
        assert_eq!(bytes.len(), 8 * rays.len());
        let mut hits = 0;
        for (record, ray) in bytes.chunks_exact(8).zip(&rays) {
            let triangle = u32::from_le_bytes(record[..4].try_into().unwrap());
            let t = f32::from_le_bytes(record[4..].try_into().unwrap());
            let expected = tree.closest_hit(ray);
            assert_eq!(triangle != u32::MAX, expected.is_some());
            match expected {
                None => assert_eq!(t, ray.t_max),
                Some(hit) if argument == "a.ray" => {
                    assert_eq!((triangle, t), (hit.triangle, hit.t));
                }
                // Any of those in the way.
                Some(hit) => assert!(triangle < 8 && hit.t <= t && t < ray.t_max),
            }
            hits += u64::from(expected.is_some());
        }
        assert!(0 < hits && hits < 400);
        assert_eq!(set["hits"].as_u64(), Some(hits));
    }
}

#[test]
fn saved_rays_can_be_read_again() {
    let folder = folder();
    let path = folder.path();
    let few = ["--resolution", "8", "--repeats", "1", "--json"];
    let own = [&["bvh", "scene.obj", "--save-rays", "own"], &few[..]].concat();
    let own = bench_json(path, &own);
    let read = ["bvh", "scene.obj", "--repeats", "1", "--json", "--rays"];
    let read = [
        &read[..],
        &["own_primary.ray", "--rays", "own_shadow.ray:any"],
    ]
    .concat();
    let read = bench_json(path, &read);
    for set in 0..2 {
        let digest = |report: &Value| report[0]["rays"][set]["digest"].clone();
        assert_eq!(digest(&own), digest(&read));
    }
    assert_eq!(read[0]["rays"][1]["name"], "own_shadow");
}

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
    assert!(csv.lines().all(|line| columns(line) == 14 + 4 * 7), "{csv}");
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

/// Two soft lights, of which one can be hard, and few pixels.
fn soft_scene(folder: &Path) {
    let scene = "\
[film]\nsize = [24, 16]\n[sampling]\nsamples = 4\n[[model]]\nfile = \"scene.obj\"
[[light]]\nkind = \"point\"\nposition = [2.0, 5.0, 3.0]\nintensity = [90.0, 90.0, 90.0]\nradius = 0.5\nsamples = 9
[[light]]\nkind = \"disk\"\nposition = [-2.0, 5.0, 3.0]\nnormal = [0.0, -1.0, 0.0]\nradius = 0.5\nradiance = [9.0, 9.0, 9.0]\n";
    fs::write(folder.join("soft.toml"), scene).unwrap();
}

#[test]
fn features_are_measured_with_and_without() {
    let folder = folder();
    soft_scene(folder.path());
    let arguments = [
        &["features", "soft.toml", "--json", "--threads", "2"][..],
        &["--repeats", "1", "--seconds", "1000"],
    ];
    let report = bench_json(folder.path(), &arguments.concat());
    assert_eq!(report["triangles"], 8);
    assert_eq!(report["always_soft_lights"], 1);
    let sampling = report["sampling"].as_array().unwrap();
    let told: Vec<_> = sampling
        .iter()
        .map(|cell| (cell["samples"].as_u64(), cell["soft_shadows"].as_bool()))
        .collect();
    let expected = [(1, false), (1, true), (4, false), (4, true)];
    assert_eq!(told, expected.map(|(n, is_soft)| (Some(n), Some(is_soft))));
    let rays: Vec<u64> = sampling
        .iter()
        .map(|c| c["rays"].as_u64().unwrap())
        .collect();
    // Four camera samples cost four times the rays, up to the noise of what they hit; nine shadow
    // rays and one cost more than one and one.
    for (one, four) in [(rays[0], rays[2]), (rays[1], rays[3])] {
        let ratio = four as f64 / one as f64;
        assert!((3.6..4.4).contains(&ratio), "{ratio}");
    }
    let camera = 24 * 16;
    assert!(rays[1] - camera > 4 * (rays[0] - camera), "{rays:?}");

    let bvh = report["bvh"].as_array().unwrap();
    assert_eq!(bvh.len(), 2 * Builder::ALL.len());
    assert_eq!(
        (&bvh[0]["builder"], &bvh[0]["ratio"]),
        (&"none".into(), &1.0.into())
    );
    for cell in bvh {
        assert_eq!(cell["rays"].as_u64(), Some(rays[3]), "{cell}");
        assert_eq!(cell["measured_share"], 1.0);
        let seconds = cell["seconds"].as_f64().unwrap();
        let rate = cell["mrays_per_second"].as_f64().unwrap();
        assert!((seconds * rate * 1e6 / rays[3] as f64 - 1.0).abs() < 1e-9);
    }
}

#[test]
fn what_takes_too_long_is_scaled_up_and_marked() {
    let folder = folder();
    soft_scene(folder.path());
    let limited = ["--seconds", "1e-9", "--repeats", "1", "--threads", "1"];
    let arguments = [&["features", "soft.toml", "--json"], &limited[..]].concat();
    let report = bench_json(folder.path(), &arguments);
    let cell = &report["sampling"][3];
    let share = cell["measured_share"].as_f64().unwrap();
    assert!(0.02 < share && share < 0.1, "{share}");
    // 24 × 16 pixels with 4 camera samples and at most 10 shadow rays each.
    let rays = cell["rays"].as_u64().unwrap();
    assert!((1536..=1536 * 11).contains(&rays), "{rays}");
    let arguments = [&["features", "soft.toml"], &limited[..]].concat();
    let output = bench(folder.path(), &arguments);
    let text = String::from_utf8(output.stdout).unwrap();
    for part in [
        "soft.toml, 8 triangles, 24x16 pixels",
        "~ scaled up",
        "never hard: 1",
    ] {
        assert!(text.contains(part), "{text}");
    }
}

#[test]
fn what_is_wrong_is_named() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("empty.obj"), "v 0 0 0\n").unwrap();
    fs::write(path.join("other.ray"), "RAY2....").unwrap();
    fs::write(path.join("short.ray"), b"RAY1\x02\0\0\0....").unwrap();
    let scene = |more: &[&'static str]| [&["bvh", "scene.obj"], more].concat();
    for (arguments, status, expected) in [
        (vec![], 2, "Usage"),
        (vec!["bvh"], 2, "MESH"),
        (scene(&["--builder", "best"]), 2, "balanced"),
        (scene(&["--threads", "0"]), 2, "1.."),
        (scene(&["--repeats", "0"]), 2, "1.."),
        (scene(&["--dump-hits", "x"]), 2, "--rays"),
        (
            vec!["bvh", "a", "b", "--rays", "r", "--dump-hits", "x"],
            2,
            "one mesh",
        ),
        (vec!["bvh", "a", "b", "--save-rays", "x"], 2, "one mesh"),
        (scene(&["--scaling"]), 2, "--scaling"),
        (scene(&["-o", "x.svg"]), 2, "--scaling"),
        (scene(&["--max-triangles", "9"]), 2, "--scaling"),
        (vec!["bvh", "--scaling", "--threads", "1,2"], 2, "threads"),
        (vec!["bvh", "--scaling", "--builder", "none"], 2, "trees"),
        (vec!["bvh", "--scaling", "-o", "no/x.svg"], 1, "no/x.svg"),
        (vec!["features", "missing.obj"], 1, "missing.obj"),
        (
            vec!["features", "scene.obj", "--seconds", "0"],
            2,
            "seconds",
        ),
        (vec!["bvh", "missing.obj"], 1, "missing.obj"),
        (vec!["bvh", "empty.obj"], 1, "empty.obj: holds nothing"),
        (scene(&["--rays", "missing.ray"]), 1, "missing.ray"),
        (scene(&["--rays", "other.ray"]), 1, "not a ray file"),
        (
            scene(&["--rays", "short.ray:any"]),
            1,
            "announces 2 rays of 32 bytes, but 4 bytes follow",
        ),
        (
            scene(&["--rays", "other.ray", "--dump-hits", "no/x"]),
            1,
            "does not exist",
        ),
    ] {
        let output = bench(path, &arguments);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {text}");
        assert!(text.contains(expected), "{arguments:?}: {text}");
    }
}
