//! `bench features`: what is measured, and what is scaled up.

use std::fs;
use std::path::Path;

use halfshade::bvh::Builder;

use super::{bench, bench_json, folder};

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
