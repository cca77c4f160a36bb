//! The numbers of one camera sample.

use crate::math::{UVec2, Vec2};

use super::SamplingConfig;

/// All numbers of one camera sample: a pure function of (seed, pixel, index, dimension).
///
/// It has no state: asking twice gives the same answer, and asking for less changes nothing else.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    config: SamplingConfig,
    pixel: UVec2,
    index: u32,
}

impl Sampler {
    /// Sample `index` of `config.samples_per_pixel()` of `pixel`.
    pub fn new(config: &SamplingConfig, pixel: UVec2, index: u32) -> Self {
        Self {
            config: *config,
            pixel,
            index,
        }
    }

    /// Where in its pixel the sample lands, in `[0, 1)²`.
    pub fn camera(&self) -> Vec2 {
        todo!("{:?}", (self.config, self.pixel, self.index))
    }

    /// Where on the lens it starts, in the unit disk.
    pub fn lens(&self) -> Vec2 {
        todo!()
    }

    /// Point `j` of the `count` that sample light number `light` at the path's vertex number
    /// `vertex` (1 is what the camera sees), in `[0, 1)²`. `count` is one that
    /// [`super::Pattern::cells`] gave.
    pub fn light(&self, vertex: u32, light: u32, j: u32, count: u32) -> Vec2 {
        todo!("{vertex} {light} {j} {count}")
    }
}
