//! The builders by name.

/// How a tree is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Builder {
    /// At the median of the longest axis, at most 4 triangles a leaf: the baseline.
    Median,
    /// Clusters along the Morton curve, the surface area heuristic over and in them: built in
    /// half the time of `Balanced`, and traced nearly as fast.
    Fast,
    /// Surface area heuristic over bins: the default.
    #[default]
    Balanced,
    /// `Balanced` with spatial splits: large triangles are in several leaves. Takes several times
    /// as long to build; pays where large and small triangles are mixed, as in interiors.
    Quality,
    /// No tree: every ray meets every triangle.
    None,
}

impl Builder {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Median,
        Self::Fast,
        Self::Balanced,
        Self::Quality,
        Self::None,
    ];

    /// As in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Median => "median",
            Self::Fast => "fast",
            Self::Balanced => "balanced",
            Self::Quality => "quality",
            Self::None => "none",
        }
    }
}

impl std::fmt::Display for Builder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

impl std::str::FromStr for Builder {
    type Err = String;

    /// The error lists the names there are.
    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|builder| builder.name() == name)
            .ok_or_else(|| {
                let names = Self::ALL.map(Self::name).join(", ");
                format!("\"{name}\" is none of {names}")
            })
    }
}
