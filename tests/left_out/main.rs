//! What a scene does not need is left out, is said to be, and changes no bit of the picture.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod document;
mod equality;
mod plan;
#[path = "../common/project.rs"]
mod project;

use std::path::Path;

use halfshade::import::{SceneOptions, import};
use halfshade::integrate::{Aov, ViewKind};
use halfshade::scene::{Keep, LeftOut, Needs};

/// What is rendered of a scene.
struct Ask<'a> {
    integrator: &'a str,
    layers: &'a [ViewKind],
}

/// The bits of a picture and its layers.
#[derive(Debug, PartialEq)]
struct Bits {
    picture: Vec<[u32; 3]>,
    layers: Vec<Vec<[u32; 3]>>,
}

/// A small picture of the scene at `path`, and what was left out of it.
fn picture(path: &Path, ask: &Ask, keep: Keep) -> (Bits, Vec<LeftOut>) {
    let integrator = format!("{:?}", ask.integrator);
    let overrides = [
        ("film.size", "[40, 30]"),
        ("sampling.samples", "2"),
        ("integrator.kind", &integrator),
    ];
    let views = ask.layers.iter();
    let options = SceneOptions {
        overrides: overrides.map(|(k, v)| (k.into(), v.into())).into(),
        layers: views.fold(Needs::default(), |all, view| all.and(view.needs())),
        keep,
        ..SceneOptions::default()
    };
    let mut imported = import(path, &options).unwrap_or_else(|error| panic!("{error}"));
    imported.settings.light_samples = Some(1);
    let layers = ask.layers.iter().map(|&view| Aov::View(view)).collect();
    let (film, left_out) = project::film_keeping(&imported, layers, keep);
    let bits = |values: &[f32; 3]| values.map(f32::to_bits);
    let bits = Bits {
        picture: film.means().iter().map(|c| bits(&c.channels())).collect(),
        layers: (film.layers.iter())
            .map(|layer| layer.iter().map(bits).collect())
            .collect(),
    };
    (bits, left_out)
}
