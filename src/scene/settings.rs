//! How a scene wants to be rendered.

use crate::color::Rgb;
use crate::math::UVec2;
use crate::sampling::SamplingConfig;

/// Most pixels along one side of a picture.
pub const MAX_SIDE: u32 = 1 << 16;
/// Most pixels of a picture.
pub const MAX_PIXELS: u64 = 1 << 28;
/// Most camera samples per pixel.
pub const MAX_SAMPLES: u32 = 1 << 30;
/// Most scattering events of a path: integrators recurse.
pub const MAX_DEPTH: u32 = 1024;
/// Most shadow rays per light and shading point: more than anyone can wait for.
pub const MAX_LIGHT_SAMPLES: u32 = 1 << 24;

/// What rays bring back that leave the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Background {
    /// Radiance, W/(m² sr).
    pub radiance: Rgb,
    /// Irradiance / π that every matte surface receives from everywhere (`whitted`).
    pub ambient: Rgb,
}

/// How light is followed, or what else is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntegratorKind {
    /// Local shading, shadows, perfect mirrors and refraction
    /// (Whitted 1980, "An Improved Illumination Model for Shaded Display").
    #[default]
    Whitted,
    /// All light, by whatever way it comes (Kajiya 1986, "The Rendering Equation").
    Path,
    /// Shading normals, mapped from `[-1, 1]` to `[0, 1]`.
    Normal,
    /// Distance along the ray, in metres.
    Depth,
    /// Diffuse reflectance or base colour.
    Albedo,
}

impl IntegratorKind {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Whitted,
        Self::Path,
        Self::Normal,
        Self::Depth,
        Self::Albedo,
    ];

    /// Scattering events of a path, where nobody says how many.
    ///
    /// Rays of `whitted` may split at each. Paths end by chance where they carry little; the rest,
    /// in glass that holds light by total reflection, is worth following: eight events lose 3 % of
    /// the light of a picture of a vase, and its rim is black.
    pub fn depth(self) -> u32 {
        match self {
            Self::Path => 64,
            Self::Whitted | Self::Normal | Self::Depth | Self::Albedo => 8,
        }
    }

    /// As in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whitted => "whitted",
            Self::Path => "path",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Albedo => "albedo",
        }
    }
}

/// From linear radiance to a picture on a screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

impl ToneMap {
    /// All of them.
    pub const ALL: &[Self] = &[Self::None, Self::Aces, Self::Agx, Self::PbrNeutral];

    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Aces => "aces",
            Self::Agx => "agx",
            Self::PbrNeutral => "pbr-neutral",
        }
    }
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
    /// Scattering events of a path: 1 is direct light only. `None` is what the integrator takes
    /// by itself ([`IntegratorKind::depth`]).
    pub max_depth: Option<u32>,
    /// Whether shadow rays start on the smooth surface that vertex normals describe
    /// ([`crate::interaction::LitSide`]), and not on the triangle.
    pub shadow_terminator: bool,
    /// Shadow rays per shading point, in place of what each light says.
    pub light_samples: Option<u32>,
    /// The most radiance in any channel that light brings which was scattered more than once (`path`);
    /// `None` leaves it as it is.
    pub clamp: Option<f32>,
    /// Whether the camera sees nothing where it sees the background: the picture is what is before it.
    pub transparent: bool,
}

impl Settings {
    /// Scattering events of a path.
    pub fn depth(&self) -> u32 {
        self.max_depth.unwrap_or(self.integrator.depth())
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            size: UVec2::new(1280, 720),
            sampling: SamplingConfig::default(),
            integrator: IntegratorKind::Whitted,
            max_depth: None,
            shadow_terminator: true,
            light_samples: None,
            clamp: None,
            transparent: false,
        }
    }
}
