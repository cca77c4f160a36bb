//! All metrics of a pair together, and their names.

use serde::Serialize;

use super::{ErrorValues, Pair, flip, hdr_flip, mae, psnr, relmse, rmse, ssim};

/// The mean errors of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// See [`rmse`].
    pub rmse: f64,
    /// See [`relmse`].
    pub relmse: f64,
    /// See [`mae`].
    pub mae: f64,
    /// See [`psnr`]; dB, infinite for equal pictures, which JSON has as `null`.
    pub psnr: f64,
    /// See [`ssim`].
    pub ssim: Option<f64>,
    /// Mean of [`flip`].
    pub flip: f64,
    /// Mean of [`hdr_flip`].
    pub hdr_flip: f64,
    /// Pixels that are not finite, of the picture and of its reference.
    pub non_finite: [usize; 2],
}

impl Figures {
    /// All of them.
    pub fn of(pair: &Pair) -> Self {
        Self::with_maps(pair, &flip(pair), &hdr_flip(pair))
    }

    /// All of them, from the pixels of [`flip`] and [`hdr_flip`], which take most of the time.
    pub fn with_maps(pair: &Pair, flip: &ErrorValues, hdr_flip: &ErrorValues) -> Self {
        Self {
            rmse: rmse(pair),
            relmse: relmse(pair),
            mae: mae(pair),
            psnr: psnr(pair),
            ssim: ssim(pair),
            flip: flip.mean(),
            hdr_flip: hdr_flip.mean(),
            non_finite: pair.non_finite().map(|found| found.count),
        }
    }
}

/// One of the [`Figures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// Root mean squared error.
    Rmse,
    /// Relative mean squared error.
    RelMse,
    /// Mean absolute error.
    Mae,
    /// Peak signal-to-noise ratio.
    Psnr,
    /// Structural similarity.
    Ssim,
    /// LDR-FLIP.
    Flip,
    /// HDR-FLIP.
    HdrFlip,
    /// Pixels that are not finite, of both pictures together.
    NonFinite,
}

impl Metric {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Rmse,
        Self::RelMse,
        Self::Mae,
        Self::Psnr,
        Self::Ssim,
        Self::Flip,
        Self::HdrFlip,
        Self::NonFinite,
    ];

    /// As on the command line and in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rmse => "rmse",
            Self::RelMse => "relmse",
            Self::Mae => "mae",
            Self::Psnr => "psnr",
            Self::Ssim => "ssim",
            Self::Flip => "flip",
            Self::HdrFlip => "hdr_flip",
            Self::NonFinite => "non_finite",
        }
    }

    /// As in tables for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE",
            Self::RelMse => "relMSE",
            Self::Mae => "MAE",
            Self::Psnr => "PSNR",
            Self::Ssim => "SSIM",
            Self::Flip => "FLIP",
            Self::HdrFlip => "HDR-FLIP",
            Self::NonFinite => "non-finite",
        }
    }

    /// What it is taken of, in a few words.
    pub fn about(self) -> &'static str {
        match self {
            Self::Rmse | Self::Mae => "linear values",
            Self::RelMse => "linear values; (A − B)² / (B² + 0.01)",
            Self::Psnr => "dB; as displayed: clipped to [0, 1], sRGB",
            Self::Ssim => "as displayed; 11 × 11 Gaussian windows, mean of R, G, B",
            Self::Flip => "as displayed, at 67 pixels a degree",
            Self::HdrFlip => "over exposures of B, tone-mapped with ACES",
            Self::NonFinite => "pixels of both, left out of all means",
        }
    }

    /// Whether more of it means that the pictures are more alike.
    pub fn grows_with_likeness(self) -> bool {
        matches!(self, Self::Psnr | Self::Ssim)
    }

    /// Its value; `None` where [`Figures`] has none.
    pub fn of(self, figures: &Figures) -> Option<f64> {
        match self {
            Self::Rmse => Some(figures.rmse),
            Self::RelMse => Some(figures.relmse),
            Self::Mae => Some(figures.mae),
            Self::Psnr => Some(figures.psnr),
            Self::Ssim => figures.ssim,
            Self::Flip => Some(figures.flip),
            Self::HdrFlip => Some(figures.hdr_flip),
            Self::NonFinite => Some(figures.non_finite.iter().sum::<usize>() as f64),
        }
    }
}
