//! `[film]`, `[sampling]`, `[integrator]` and `[background]`.

use std::path::{Path, PathBuf};

use super::section::Section;
use super::value::{ANY, NON_NEGATIVE, POSITIVE, Value};
use crate::color::Rgb;
use crate::import::ImportError;
use crate::math::UVec2;
use crate::sampling::{Pattern, SamplingConfig, Target};
use crate::scene::{IntegratorKind, MAX_DEPTH, MAX_PIXELS, MAX_SAMPLES, MAX_SIDE, Settings};

/// Reads `[film]`, `[sampling]` and `[integrator]` of `root`; defaults where they are left out.
pub fn read(root: &Section) -> Result<Settings, ImportError> {
    let mut settings = Settings::default();
    if let Some(value) = root.value("film") {
        let section = Section::new(root.source, value.node, "[film]", &["size", "transparent"])?;
        settings.size = section.get("size", size)?.unwrap_or(settings.size);
        settings.transparent = section
            .get("transparent", |v| v.boolean())?
            .unwrap_or(settings.transparent);
    }
    if let Some(value) = root.value("sampling") {
        settings.sampling = sampling(value)?;
    }
    if let Some(value) = root.value("integrator") {
        let keys = &["kind", "max_depth", "clamp", "shadow_terminator"];
        let section = Section::new(root.source, value.node, "[integrator]", keys)?;
        settings.integrator = section
            .get("kind", integrator)?
            .unwrap_or(settings.integrator);
        settings.max_depth = section.get("max_depth", |v| v.integer_u32(1, MAX_DEPTH))?;
        settings.clamp = section.get("clamp", |v| v.single(POSITIVE))?;
        settings.shadow_terminator = section
            .get("shadow_terminator", |v| v.boolean())?
            .unwrap_or(settings.shadow_terminator);
    }
    Ok(settings)
}

/// What `[background]` says.
#[derive(Clone, Debug, Default)]
pub struct BackgroundSection {
    /// `None` where it is left out: what that means depends on the lights.
    pub radiance: Option<Rgb>,
    /// `None` where it is left out: what that means depends on the lights.
    pub ambient: Option<Rgb>,
    /// A picture of the surroundings.
    pub environment: Option<PathBuf>,
    /// How far the picture is turned about y.
    pub rotate_radians: f64,
}

/// Reads `[background]` of `root`.
pub fn background(root: &Section) -> Result<BackgroundSection, ImportError> {
    let Some(value) = root.value("background") else {
        return Ok(BackgroundSection::default());
    };
    let keys = &["radiance", "ambient", "environment", "rotate"];
    let section = Section::new(root.source, value.node, "[background]", keys)?;
    let color = |key| section.get(key, |v| v.color(NON_NEGATIVE));
    let environment = section.get("environment", |v| v.string())?;
    if let (None, Some(rotate)) = (environment, section.value("rotate")) {
        return Err(rotate.invalid("\"rotate\" needs \"environment\" beside it"));
    }
    let folder = root.source.path.parent().unwrap_or(Path::new(""));
    Ok(BackgroundSection {
        radiance: color("radiance")?,
        ambient: color("ambient")?,
        environment: environment.map(|file| folder.join(file)),
        rotate_radians: section
            .get("rotate", |v| v.number(ANY))?
            .unwrap_or(0.0)
            .to_radians(),
    })
}

fn size(value: Value) -> Result<UVec2, ImportError> {
    let size: [u32; 2] = value.array("[width, height]", |v| v.integer_u32(1, MAX_SIDE))?;
    let pixels = u64::from(size[0]) * u64::from(size[1]);
    if pixels > MAX_PIXELS {
        return Err(value.invalid(format!(
            "size must be at most {MAX_PIXELS} pixels in all, not {pixels}"
        )));
    }
    Ok(UVec2::from_array(size))
}

fn sampling(value: Value) -> Result<SamplingConfig, ImportError> {
    let keys = &["samples", "pattern", "target", "seed"];
    let section = Section::new(value.source, value.node, "[sampling]", keys)?;
    let default = SamplingConfig::default();
    Ok(SamplingConfig {
        samples: section
            .get("samples", |v| v.integer_u32(1, MAX_SAMPLES))?
            .unwrap_or(default.samples),
        pattern: section
            .get("pattern", |v| v.one_of(Pattern::ALL, Pattern::name))?
            .unwrap_or(default.pattern),
        target: section
            .get("target", |v| v.one_of(Target::ALL, Target::name))?
            .unwrap_or(default.target),
        seed: section
            .get("seed", |v| v.integer(0, u64::MAX))?
            .unwrap_or(default.seed),
    })
}

fn integrator(value: Value) -> Result<IntegratorKind, ImportError> {
    value.one_of(IntegratorKind::ALL, IntegratorKind::name)
}
