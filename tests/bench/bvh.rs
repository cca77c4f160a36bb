//! `bench bvh`: reports, rays and hits.

use std::fs;
use std::path::Path;

use halfshade::bench::{Plan, Query, Triangles, measure, own_rays, read_rays, write_rays};
use halfshade::bvh::{Builder, Bvh, Width};
use halfshade::import::{SceneOptions, import};
use halfshade::math::{Ray, Vec3};
use serde_json::Value;

use super::{bench, bench_json, folder};

fn triangles(folder: &Path) -> Triangles {
    let imported = import(&folder.join("scene.obj"), &SceneOptions::default()).unwrap();
    Triangles::of_scene(&imported.scene).unwrap()
}

fn some_rays() -> Vec<Ray> {
    let ray = |i: u16| Ray {
        origin: Vec3::new(0.013 * f32::from(i) - 2.6, 2.0, 0.1),
        direction: Vec3::new(0.1, -1.0, 0.02),
        t_min: 0.25,
        t_max: if i.is_multiple_of(3) {
            0.6
        } else {
            f32::INFINITY
        },
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
        assert_eq!(report["build_seconds"], report["build"]["wall"]["median"]);
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
fn all_builders_and_widths_find_the_same() {
    let folder = folder();
    let triangles = triangles(folder.path());
    let sets = own_rays(&triangles, 32).unwrap();
    let plan = Plan {
        together: true,
        builders: Builder::ALL.to_vec(),
        widths: Width::available(),
        threads: vec![1, 3],
        repeats: 1,
    };
    let reports = measure("scene", &triangles, &sets, &plan).unwrap();
    let trees = Builder::ALL.len() * Width::available().len();
    assert_eq!(reports.len(), 2 * trees);
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
