//! How the samples of one pixel are laid out.

use super::cells::Cells;

/// How the samples of one pixel, or of one light, are laid out in the unit square.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pattern {
    /// Centres of m × n cells: free of noise, but aliases in regular stripes.
    Grid,
    /// One random point in each of m × n cells (Cook 1986, "Stochastic Sampling in Computer Graphics").
    Jittered,
    /// Independent points: the baseline that the others are measured against.
    Random,
    /// Owen-scrambled Sobol points (Burley 2020, "Practical Hash-based Owen Scrambling").
    #[default]
    Sobol,
}

/// What part of its pixel a camera sample may land in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Target {
    /// The whole square.
    #[default]
    Rectangle,
    /// The inscribed disk.
    Circle,
}

/// How the samples of a picture are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SamplingConfig {
    /// Camera samples per pixel that were asked for.
    pub samples: u32,
    /// Their layout.
    pub pattern: Pattern,
    /// Where in the pixel they land.
    pub target: Target,
    /// Other seeds give other random numbers.
    pub seed: u64,
}

impl Default for SamplingConfig {
    fn default() -> Self {
        Self {
            samples: 64,
            pattern: Pattern::Sobol,
            target: Target::Rectangle,
            seed: 0,
        }
    }
}

impl Pattern {
    /// All of them.
    pub const ALL: &[Self] = &[Self::Grid, Self::Jittered, Self::Random, Self::Sobol];

    /// As in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::Jittered => "jittered",
            Self::Random => "random",
            Self::Sobol => "sobol",
        }
    }

    /// The number of samples that are taken where `count` are asked for: grid and jittered
    /// round up to m × n cells that are nearly square (⌊√count⌋ rows and as many columns as it
    /// takes: 81 gives 9 × 9, 10 gives 4 × 3), the others take what is asked for. At least 1.
    pub fn cells(self, count: u32) -> u32 {
        match self {
            Self::Grid | Self::Jittered => Cells::at_least(count).count(),
            Self::Random | Self::Sobol => count.max(1),
        }
    }

    /// How many sets a pixel's camera samples are dealt to in turn, each randomised on its own:
    /// the difference between two tells the error of their mean, whatever the pattern
    /// (Owen 1995, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences"). A grid is one: its
    /// error is no chance, and two grids would be the same.
    pub fn sets(self) -> u32 {
        match self {
            Self::Grid => 1,
            Self::Jittered | Self::Random | Self::Sobol => 2,
        }
    }
}

impl Target {
    /// All of them.
    pub const ALL: &[Self] = &[Self::Rectangle, Self::Circle];

    /// As in scene files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rectangle => "rectangle",
            Self::Circle => "circle",
        }
    }
}

impl SamplingConfig {
    /// Camera samples that each pixel really takes, at least 1: what is asked for, or as many as
    /// fill the cells of each set ([`Pattern::sets`]). 81 jittered samples become two sets of 7 × 6.
    pub fn samples_per_pixel(&self) -> u32 {
        match self.pattern {
            Pattern::Jittered if self.samples > 1 => {
                self.samples_per_set().saturating_mul(self.pattern.sets())
            }
            Pattern::Grid | Pattern::Jittered => self.samples_per_set(),
            Pattern::Random | Pattern::Sobol => self.samples.max(1),
        }
    }

    /// Camera samples of the largest set of a pixel.
    pub fn samples_per_set(&self) -> u32 {
        self.pattern
            .cells(self.samples.div_ceil(self.pattern.sets()))
    }
}
