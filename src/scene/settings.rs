//! How a scene wants to be rendered.

use serde::{Deserialize, Serialize};

use crate::color::Rgb;
use crate::math::UVec2;
use crate::sampling::SamplingConfig;

/// What rays bring back that leave the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Background {
    /// Radiance, W/(m² sr).
    pub radiance: Rgb,
    /// Irradiance / π that every matte surface receives from everywhere (`whitted`).
    pub ambient: Rgb,
}

/// How light is followed, or what else is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// Local shading, shadows, perfect mirrors and refraction
    /// (Whitted 1980, "An Improved Illumination Model for Shaded Display").
    #[default]
    Whitted,
    /// Shading normals, mapped from `[-1, 1]` to `[0, 1]`.
    Normal,
    /// Distance along the ray, in metres.
    Depth,
    /// Diffuse reflectance or base colour.
    Albedo,
}

/// From linear radiance to a picture on a screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ToneMap {
    /// Clip at 1.
    #[default]
    None,
    /// The ACES filmic curve (Narkowicz 2015's fit).
    Aces,
    /// AgX (Sobotka 2022).
    Agx,
    /// Khronos PBR Neutral.
    PbrNeutral,
}

/// How a scene wants to be rendered; options of the command line go above it.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Pixels across and down.
    pub size: UVec2,
    /// Camera samples.
    pub sampling: SamplingConfig,
    /// What is computed.
    pub integrator: IntegratorKind,
    /// Scattering events of a path: 1 is direct light only.
    pub max_depth: u32,
    /// Shadow rays per shading point, in place of what each light says.
    pub light_samples: Option<u32>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: UVec2::new(1280, 720),
            sampling: SamplingConfig::default(),
            integrator: IntegratorKind::Whitted,
            max_depth: 8,
            light_samples: None,
        }
    }
}
