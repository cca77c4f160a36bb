//! The README says what is so.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).unwrap()
}

/// What stands between `](` and `)`.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let ends = text.split("](").skip(1);
    ends.filter_map(|link| link.split_once(')').map(|(target, _)| target))
}

#[test]
fn what_it_links_to_is_there() {
    let text = readme();
    let local: Vec<&str> = links(&text).filter(|l| !l.contains("://")).collect();
    assert!(local.iter().any(|link| link.ends_with(".png")), "{local:?}");
    for link in local {
        assert!(root().join(link).is_file(), "{link}");
    }
}

#[test]
fn the_scenes_it_names_are_there() {
    let text = readme();
    let scenes = text.split('`').filter(|code| {
        code.starts_with("scenes/") && code.ends_with(".toml") && !code.contains(' ')
    });
    let mut count = 0;
    for scene in scenes {
        assert!(root().join(scene).is_file(), "{scene}");
        count += 1;
    }
    assert!(count > 3, "{count} scenes are named");
}

#[test]
fn it_asks_for_the_toolchain_that_cargo_asks_for() {
    let expected = format!("({} or later)", env!("CARGO_PKG_RUST_VERSION"));
    assert!(readme().contains(&expected), "no \"{expected}\"");
}
