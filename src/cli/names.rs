//! What the choices of options are called.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use halfshade::bvh::Builder;
use halfshade::sampling::{Pattern, Target};
use halfshade::scene::{IntegratorKind, ToneMap};

use super::layers::LayerKind;

/// The choices of one option, each with its name.
pub type Names<T> = &'static [(&'static str, T)];

pub const PATTERNS: Names<Pattern> = &[
    ("grid", Pattern::Grid),
    ("jittered", Pattern::Jittered),
    ("random", Pattern::Random),
    ("sobol", Pattern::Sobol),
];

pub const TARGETS: Names<Target> = &[("rectangle", Target::Rectangle), ("circle", Target::Circle)];

pub const INTEGRATORS: Names<IntegratorKind> = &[
    ("whitted", IntegratorKind::Whitted),
    ("normal", IntegratorKind::Normal),
    ("depth", IntegratorKind::Depth),
    ("albedo", IntegratorKind::Albedo),
];

pub const BUILDERS: Names<Builder> = &[
    ("balanced", Builder::Balanced),
    ("median", Builder::Median),
    ("none", Builder::None),
];

pub const TONE_MAPS: Names<ToneMap> = &[
    ("none", ToneMap::None),
    ("aces", ToneMap::Aces),
    ("agx", ToneMap::Agx),
    ("pbr-neutral", ToneMap::PbrNeutral),
];

pub const LAYERS: Names<LayerKind> = &[
    ("albedo", LayerKind::Albedo),
    ("normal", LayerKind::Normal),
    ("depth", LayerKind::Depth),
    ("variance", LayerKind::Variance),
    ("samples", LayerKind::Samples),
];

/// Reads one of `names`, and lists them in help and errors.
pub fn one_of<T: Copy + Send + Sync + 'static>(
    names: Names<T>,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(names.iter().map(|(name, _)| *name)).try_map(move |given| {
        let found = names.iter().find(|(name, _)| *name == given);
        found.map(|&(_, value)| value).ok_or("not one of them")
    })
}

/// What `value` is called.
pub fn name_of<T: Copy + PartialEq>(names: Names<T>, value: T) -> &'static str {
    let found = names.iter().find(|(_, named)| *named == value);
    found.map_or("", |&(name, _)| name)
}
