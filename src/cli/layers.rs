//! The layers of an EXR file, from a film.

use halfshade::color::Rgb;
use halfshade::film::Film;
use halfshade::integrate::ViewKind;
use halfshade::math::Vec3;
use halfshade::output::exr::{Layer, Values};

/// What stands beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayerKind {
    /// Diffuse reflectance or base colour of what is seen.
    Albedo,
    /// Its shading normal, in world axes.
    Normal,
    /// Its distance from the camera, metres.
    Depth,
    /// Variance of each pixel's mean.
    Variance,
    /// Number of each pixel's samples.
    Samples,
    /// Each pixel's part of the estimated error.
    Error,
    /// The picture from one half of each pixel's samples.
    HalfA,
    /// The picture from the other half.
    HalfB,
}

impl LayerKind {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Albedo,
        Self::Normal,
        Self::Depth,
        Self::Variance,
        Self::Samples,
        Self::Error,
        Self::HalfA,
        Self::HalfB,
    ];

    /// As on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Variance => "variance",
            Self::Samples => "samples",
            Self::Error => "error",
            Self::HalfA => "half_a",
            Self::HalfB => "half_b",
        }
    }

    /// The view that the renderer has to make for it; `None` where the film has it anyway.
    pub fn view(self) -> Option<ViewKind> {
        match self {
            Self::Albedo => Some(ViewKind::Albedo),
            Self::Normal => Some(ViewKind::Normal),
            Self::Depth => Some(ViewKind::Depth),
            Self::Variance | Self::Samples | Self::Error | Self::HalfA | Self::HalfB => None,
        }
    }
}

/// The values of all layers of a film; layers of a file borrow them.
pub struct LayerValues {
    picture: Vec<Rgb>,
    others: Vec<(LayerKind, Owned)>,
}

enum Owned {
    Colors(Vec<Rgb>),
    Vectors(Vec<Vec3>),
    Numbers(&'static str, Vec<f32>),
}

impl LayerValues {
    /// Bytes of one pixel of the picture and of each of `kinds`, at most: here, and once more as
    /// channels of a file that is written.
    pub fn pixel_bytes(kinds: &[LayerKind]) -> u64 {
        2 * (1 + kinds.len() as u64) * size_of::<Rgb>() as u64
    }

    /// The picture of `film` and `kinds`, the views of which `film` holds in the same order.
    pub fn of_film(film: &Film, kinds: &[LayerKind]) -> Self {
        let mut views = film.layers.iter();
        let others = kinds.iter().filter_map(|&kind| {
            let mut view = || views.next().map(Vec::as_slice);
            let values = match kind {
                LayerKind::Albedo => {
                    let colors = view()?.iter().map(|&c| Rgb::from(c));
                    Owned::Colors(colors.collect())
                }
                LayerKind::Normal => {
                    let normals = view()?.iter().map(|&n| Vec3::from(n));
                    Owned::Vectors(normals.collect())
                }
                LayerKind::Depth => {
                    let depths = view()?.iter().map(|d| d[0]);
                    Owned::Numbers("Z", depths.collect())
                }
                LayerKind::Variance => Owned::Colors(film.variances()),
                LayerKind::Samples => {
                    let counts = film.pixels.iter().map(|p| p.count() as f32);
                    Owned::Numbers("Y", counts.collect())
                }
                LayerKind::Error => Owned::Numbers("Y", film.errors()),
                LayerKind::HalfA => Owned::Colors(film.half(0)),
                LayerKind::HalfB => Owned::Colors(film.half(1)),
            };
            Some((kind, values))
        });
        Self {
            others: others.collect(),
            picture: film.means(),
        }
    }

    /// The picture itself.
    pub fn picture(&self) -> &[Rgb] {
        &self.picture
    }

    /// The layers of a file: the picture, without a name, and the others.
    pub fn layers(&self) -> Vec<Layer<'_>> {
        let picture = Layer {
            name: "",
            values: Values::Colors(&self.picture),
        };
        let others = self.others.iter().map(|(kind, values)| Layer {
            name: kind.name(),
            values: match values {
                Owned::Colors(values) => Values::Colors(values),
                Owned::Vectors(values) => Values::Vectors(values),
                Owned::Numbers(channel, values) => Values::Numbers { channel, values },
            },
        });
        std::iter::once(picture).chain(others).collect()
    }
}
