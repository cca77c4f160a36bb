//! Samples of one light for a row of points.

use super::{Light, LightSample, ShadowEnd};
use crate::color::Rgb;
use crate::math::{FEW, ROW, UnitVec3, Vec2, Vec3, VectorRow};

/// [`Light::sample`] of each point of a row.
#[derive(Debug)]
pub struct LightSampleRow {
    /// See [`LightSample::wi`].
    wi: VectorRow,
    /// See [`LightSample::weight`], by channel.
    weight: VectorRow,
    /// See [`LightSample::density`].
    density: [f64; ROW],
    /// Where the shadow rays go: points, or directions.
    end: VectorRow,
    has_direction: bool,
    /// Whether there is a sample.
    is_some: [bool; ROW],
}

impl LightSampleRow {
    /// Without a sample.
    pub const NONE: Self = Self {
        wi: VectorRow::Z,
        weight: VectorRow::ZERO,
        density: [0.0; ROW],
        end: VectorRow::Z,
        has_direction: false,
        is_some: [false; ROW],
    };

    /// Whether there is a sample of point `i`.
    #[inline(always)]
    pub fn is_some(&self, i: usize) -> bool {
        self.is_some[i]
    }

    /// The sample of point `i`; means nothing where there is none.
    #[inline(always)]
    pub fn get(&self, i: usize) -> LightSample {
        let [r, g, b] = self.weight.get(i).to_array();
        let end = self.end.get(i);
        LightSample {
            wi: UnitVec3::from_normalized(self.wi.get(i)),
            weight: Rgb::new(r, g, b),
            density: self.density[i],
            shadow: if self.has_direction {
                ShadowEnd::Direction(UnitVec3::from_normalized(end))
            } else {
                ShadowEnd::Point(end)
            },
        }
    }

    /// Makes `sample` that of point `i`. All samples of a row have ends of one kind.
    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, sample: Option<LightSample>) {
        self.is_some[i] = sample.is_some();
        let sample = sample.unwrap_or(LightSample {
            wi: UnitVec3::Z,
            weight: Rgb::BLACK,
            density: 0.0,
            shadow: ShadowEnd::Point(Vec3::Z),
        });
        self.wi.set(i, *sample.wi);
        self.weight.set(i, Vec3::from(sample.weight.channels()));
        self.density[i] = sample.density;
        let end = match sample.shadow {
            ShadowEnd::Point(end) => end,
            ShadowEnd::Direction(direction) => *direction,
        };
        self.end.set(i, end);
    }
}

impl Light {
    /// One sample of the light, as seen from each of the first `count` of `points`, for `u` in `[0, 1)²`: the same
    /// bits as [`Light::sample`] gives. What `samples` holds beyond `count` means nothing.
    pub fn sample_row(
        &self,
        points: &VectorRow,
        u: &[Vec2; ROW],
        count: usize,
        samples: &mut LightSampleRow,
    ) {
        if let Light::Disk(light) = self
            && count >= FEW
        {
            *samples = light.sample_row(points, u);
            return;
        }
        samples.has_direction = matches!(self, Light::Distant(_));
        for (i, u) in u[..count].iter().enumerate() {
            samples.set(i, self.sample(points.get(i), *u));
        }
    }
}
