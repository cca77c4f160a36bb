//! `--time`, `--error` and `--adaptive`.

use super::*;

/// Renders a small picture, with a light that has a radius.
fn render_open(folder: &Path, arguments: &[&str]) -> Output {
    fs::write(
        folder.join("soft.toml"),
        "[[model]]\nfile = \"scene.obj\"\n[[light]]\nkind = \"point\"\nposition = [2.0, 4.0, 1.0]\n\
         intensity = [60.0, 60.0, 60.0]\nradius = 0.5\n",
    )
    .unwrap();
    let all: Vec<&str> = [&["render", "soft.toml", "--size", "40x30"], arguments].concat();
    run(folder, &all)
}

#[test]
fn an_error_is_reached_foreseen_and_told() {
    let folder = folder();
    let arguments = ["--error", "0.01", "--stats", "s.json", "--samples", "4096"];
    let output = render_open(folder.path(), &arguments);
    let text = stderr(&output);
    assert!(text.contains(" s for 0.01, at present "), "{text}");
    assert!(text.contains("estimated relative RMSE 0.00"), "{text}");
    let stats = json(&folder.path().join("s.json"));
    assert_eq!(stats["stopped_by"], "error");
    let estimate = stats["error"]["estimate"].as_f64().unwrap();
    assert!(estimate <= 0.01 && estimate > 0.005, "{estimate}");
    assert!(stats["samples"]["min"].as_u64() < stats["samples"]["max"].as_u64());
}

#[test]
fn a_time_is_kept_with_everything_in_it() {
    let folder = folder();
    let arguments = ["--time", "1", "--stats", "s.json"];
    let output = render_open(folder.path(), &arguments);
    let text = stderr(&output);
    assert!(
        text.contains(" after ") && text.contains(", at present "),
        "{text}"
    );
    let stats = json(&folder.path().join("s.json"));
    assert_eq!(stats["stopped_by"], "time");
    let total = stats["seconds"]["total"].as_f64().unwrap();
    // Generous: other tests run beside this one.
    assert!(total > 0.8 && total < 1.3, "{total}");
}

#[test]
fn uniform_is_what_a_number_of_samples_means() {
    let folder = folder();
    let spread = |arguments: &[&str]| {
        let arguments = [&["--stats", "s.json", "--samples", "16"], arguments].concat();
        render_open(folder.path(), &arguments);
        let stats = json(&folder.path().join("s.json"));
        let of = |key: &str| stats["samples"][key].as_u64().unwrap();
        (of("min"), of("max"))
    };
    assert_eq!(spread(&[]), (16, 16));
    assert_eq!(spread(&["--error", "1e-9", "--no-adaptive"]), (16, 16));
    let (min, max) = spread(&["--adaptive"]);
    assert!(min < 16 && max > 16, "{min} {max}");
}

#[test]
fn limits_that_mean_nothing_are_refused() {
    let folder = folder();
    for arguments in [
        &["--time", "0"][..],
        &["--error", "-1"],
        &["--adaptive", "--no-adaptive"],
        &["--error", "0.1", "--pattern", "grid"],
        &["--adaptive", "--pattern", "grid"],
    ] {
        let output = render_open(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}
