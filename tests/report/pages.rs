//! Error maps with their bars, and pages.

use halfshade::color::Rgb;
use halfshade::math::UVec2;
use halfshade::report::color_map::color;
use halfshade::report::error_map::{NON_FINITE, colored, with_bar};
use halfshade::report::metrics::ErrorValues;
use halfshade::report::page::{Shown, color_bar, document, error_figure, slider, table};
use halfshade::report::scale::Scale;

use super::constant;

fn errors(size: UVec2) -> ErrorValues {
    let last = (size.x * size.y - 1).max(1) as f32;
    let mut values: Vec<Option<f32>> = (0..size.x * size.y)
        .map(|i| Some(i as f32 / last))
        .collect();
    values[0] = None;
    ErrorValues { size, values }
}

#[test]
fn a_map_shows_errors_in_colours_and_what_is_not_finite_in_none_of_them() {
    let errors = errors(UVec2::new(40, 30));
    let map = colored(&errors, Scale::Unit);
    assert_eq!(map.pixels[0], NON_FINITE);
    assert_eq!(map.pixels[1199], color(1.0));
    assert!((0..256).all(|i| color(i as f32 / 255.0) != NON_FINITE));
    let log = colored(&errors, Scale::Decades { low: -2, high: 0 });
    assert_eq!(log.pixels[12], color(0.0003));
}

#[test]
fn a_bar_stands_below_the_map_whatever_its_width() {
    for (x, y) in [(1, 1), (40, 30), (201, 3), (1500, 7)] {
        let errors = errors(UVec2::new(x, y));
        let picture = with_bar(&errors, Scale::Unit);
        let (width, height) = (picture.size.x, picture.size.y);
        assert!(
            width >= x.max(200) && height > y + 20,
            "{x}x{y}: {width}x{height}"
        );
        assert_eq!(picture.pixels.len(), (width * height) as usize);
        let left = (width - x) / 2;
        let map = colored(&errors, Scale::Unit);
        for row in 0..y {
            let start = (row * width + left) as usize;
            let shown = &picture.pixels[start..start + x as usize];
            assert_eq!(
                shown,
                &map.pixels[(row * x) as usize..((row + 1) * x) as usize]
            );
        }
        // One row of the strip runs through all colours, from left to right.
        let rows = picture.pixels[(y * width) as usize..].chunks(width as usize);
        let bar = rows.clone().find(|row| row.contains(&color(0.5))).unwrap();
        let lit: Vec<f32> = bar.iter().map(|c| c.luminance()).collect();
        let start = bar.iter().position(|&c| c == color(0.0)).unwrap();
        let end = bar.iter().rposition(|&c| c == color(1.0)).unwrap();
        assert!(lit[start..=end].is_sorted());
        // Numbers below it.
        let white = rows.flatten().filter(|&&c| c == Rgb::WHITE).count();
        assert!(white > 60, "{white} white pixels");
    }
}

#[test]
fn a_page_needs_nothing_but_itself() {
    let picture = constant(UVec2::new(16, 9), Rgb::splat(0.5));
    let [left, right] = ["a", "b"].map(|name| Shown::new(name, &picture).unwrap());
    let errors = errors(picture.size);
    let body = [
        slider(&left, &right),
        error_figure("FLIP", &errors, Scale::Unit).unwrap(),
        table(&["", "n"], &[vec!["row".into(), "1".into()]]),
    ];
    let page = document("title", &body.concat());
    assert!(!page.contains("http") && !page.contains("<link") && !page.contains(" id="));
    assert_eq!(
        page.matches("src=\"").count(),
        page.matches("src=\"data:").count()
    );
    assert_eq!(page.matches("<img").count(), 3);
    assert!(page.contains("type=\"range\"") && page.contains("@media print"));
    for tag in [
        "div",
        "figure",
        "figcaption",
        "label",
        "table",
        "tr",
        "svg",
        "main",
        "script",
    ] {
        let opened =
            page.matches(&format!("<{tag}>")).count() + page.matches(&format!("<{tag} ")).count();
        assert!(opened > 0, "{tag}");
        assert_eq!(opened, page.matches(&format!("</{tag}>")).count(), "{tag}");
    }
}

#[test]
fn names_cannot_break_a_page() {
    let picture = constant(UVec2::new(2, 2), Rgb::WHITE);
    let name = "<script>\"&</title>";
    let shown = Shown::new(name, &picture).unwrap();
    let figure = error_figure(name, &errors(picture.size), Scale::Unit).unwrap();
    let table = table(&[name], &[vec![name.into(), name.into()]]);
    let page = document(name, &[slider(&shown, &shown), figure, table].concat());
    assert_eq!(page.matches("<script>").count(), 1);
    assert_eq!(page.matches("</title>").count(), 1);
    assert!(page.contains("alt=\"&lt;script&gt;&quot;&amp;&lt;/title&gt;\""));
}

#[test]
fn a_bar_has_its_numbers() {
    let bar = color_bar(Scale::Decades { low: -4, high: 0 });
    for label in ["1e-4", "1e-3", "1e-2", "1e-1", "1"] {
        assert!(bar.contains(&format!(">{label}</text>")), "{label}: {bar}");
    }
}
