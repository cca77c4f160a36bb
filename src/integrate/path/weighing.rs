//! How much what one technique finds counts for, where another might have found it.

/// How what two techniques find is weighed. The mean is the same with all, the noise is not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weighing {
    /// By the power heuristic.
    #[default]
    Power,
    /// Lights are found by looking at them alone, but for those that only scattering finds.
    LightsOnly,
    /// Lights that have a size are found by scattering alone.
    ScatteringOnly,
}

impl Weighing {
    /// The weight of what was found with density `own` by looking at a light (`is_look`) or by scattering,
    /// while the other technique finds it with density `other`.
    pub(super) fn weight(self, is_look: bool, own: f64, other: f64) -> f32 {
        if other == 0.0 {
            return 1.0;
        }
        match self {
            Self::Power => power(own, other),
            Self::LightsOnly => f32::from(u8::from(is_look)),
            Self::ScatteringOnly => f32::from(u8::from(!is_look)),
        }
    }
}

/// The weight of the technique of density `a` against that of density `b` (Veach and Guibas's power
/// heuristic).
fn power(a: f64, b: f64) -> f32 {
    let ratio = b / a;
    (1.0 / (1.0 + ratio * ratio)) as f32
}
