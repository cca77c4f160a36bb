//! Small pictures of the project's scenes against ones that were kept: the same but for noise.
//!
//! `HALFSHADE_BLESS=1 cargo test --release --test golden` makes them anew, to be looked at and
//! committed where a picture is meant to change.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "common/project.rs"]
mod project;

use halfshade::color::Rgb;
use halfshade::film::Film;
use halfshade::output::exr::{Layer, Values, Window, write};
use halfshade::report::read_picture;
use project::{film, load, root, scenes};

/// Samples of each pixel of a kept picture; a test takes a hundredth of that, with another seed.
const KEPT_SAMPLES: u32 = 6400;

/// Pixels along the edge of the blocks whose means are compared.
const BLOCK: usize = 8;

/// Pixels of each block that are left out, those that are off the most: a lamp that few paths find
/// is in neither half of a pixel, or in one of them a hundred times too bright.
const RARE: usize = 6;

/// Standard errors by which a block's mean may be off. With 24 blocks and 3 channels a scene, one in
/// 10^7 sound pictures exceeds 6 by chance; few degrees of freedom ask for a little more.
const MOST_ERRORS: f64 = 7.0;

/// What leaving out the worst pixels may do to a block's mean, over the mean of the kept picture.
const TRIMMING: f64 = 0.01;

#[test]
fn scenes_look_as_they_did() {
    let is_blessing = std::env::var_os("HALFSHADE_BLESS").is_some();
    for path in scenes() {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let file = root().join(format!("tests/golden/{name}.exr"));
        if is_blessing {
            let film = tiny(&path, KEPT_SAMPLES, 0);
            let means = film.means();
            let layer = Layer {
                name: "",
                values: Values::Colors(&means),
            };
            write(&file, Window::whole(film.size()), &[layer], &[]).unwrap();
            continue;
        }
        let kept = read_picture(&file)
            .unwrap_or_else(|e| panic!("{e}"))
            .picture;
        let film = tiny(&path, KEPT_SAMPLES / 100, 1);
        assert_eq!(film.size(), kept.size, "{name}");
        let worst = worst_block(&film, &kept.pixels);
        assert!(
            worst.errors < MOST_ERRORS,
            "{name}: the block at {:?} is off by {:.1} standard errors",
            worst.corner,
            worst.errors
        );
    }
}

/// A test that cannot fail is none.
#[test]
fn a_little_more_light_is_noticed() {
    let path = root().join("scenes/cornell.toml");
    let kept = read_picture(&root().join("tests/golden/cornell.exr")).unwrap();
    let brighter: Vec<Rgb> = kept.picture.pixels.iter().map(|&c| c * 1.1).collect();
    let worst = worst_block(&tiny(&path, KEPT_SAMPLES / 100, 1), &brighter);
    assert!(worst.errors > MOST_ERRORS, "{:.1}", worst.errors);
}

fn tiny(path: &std::path::Path, samples: u32, seed: u64) -> Film {
    let samples = samples.to_string();
    let seed = seed.to_string();
    let mut imported = load(
        path,
        &[
            ("film.size", "[48, 32]"),
            ("sampling.samples", &samples),
            ("sampling.seed", &seed),
        ],
    );
    imported.settings.light_samples = Some(1);
    film(&imported, None)
}

struct Worst {
    corner: [usize; 2],
    errors: f64,
}

/// The block whose mean is off by the most standard errors, as the film's halves tell them.
fn worst_block(film: &Film, kept: &[Rgb]) -> Worst {
    let [width, height] = film.size().to_array().map(|n| n as usize);
    let mean = kept.iter().map(|c| f64::from(c.luminance())).sum::<f64>() / kept.len() as f64;
    let corners = (0..height)
        .step_by(BLOCK)
        .flat_map(|y| (0..width).step_by(BLOCK).map(move |x| [x, y]));
    let errors = |[x, y]: [usize; 2], channel: usize| {
        let mut pixels: Vec<(f64, f64)> = (0..BLOCK * BLOCK)
            .map(|i| (y + i / BLOCK) * width + x + i % BLOCK)
            .map(|i| {
                let pixel = &film.pixels[i];
                let off = pixel.value()[channel] - f64::from(kept[i].channels()[channel]);
                (off, pixel.squared_error()[channel])
            })
            .collect();
        pixels.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        pixels.truncate(BLOCK * BLOCK - RARE);
        let off: f64 = pixels.iter().map(|p| p.0).sum();
        let variance: f64 = pixels.iter().map(|p| p.1).sum();
        off.abs() / (variance.sqrt() + TRIMMING / MOST_ERRORS * mean * pixels.len() as f64)
    };
    corners
        .flat_map(|corner| (0..3).map(move |channel| (corner, channel)))
        .map(|(corner, channel)| Worst {
            corner,
            errors: errors(corner, channel),
        })
        .max_by(|a, b| a.errors.total_cmp(&b.errors))
        .unwrap()
}
