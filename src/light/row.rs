//! Rows of points that look at one light, and rows of rays that may meet it.

use super::{DiskLight, Light, LightSample, ShadowEnd};
use crate::color::Rgb;
use crate::math::{
    FEW, ROW, RayRow, Row, RowJob, UnitVec3, Vec2, Vec3, VectorRow, first_places, places,
    those_where, widely,
};

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
    /// One sample of the light as seen from each of `points` with a bit in `of`, for `u` in `[0, 1)²`: the same
    /// bits as [`Light::sample`] gives. What `samples` holds of others means nothing.
    pub fn sample_row(
        &self,
        points: &VectorRow,
        u: &[Vec2; ROW],
        of: u64,
        samples: &mut LightSampleRow,
    ) {
        match self {
            Light::Disk(light) if of.count_ones() as usize >= FEW => {
                *samples = light.sample_row(points, u);
            }
            _ => {
                // What another light left may be ends of another kind.
                *samples = LightSampleRow::NONE;
                samples.has_direction = matches!(self, Light::Distant(_));
                for i in places(of) {
                    samples.set(i, self.sample(points.get(i), u[i]));
                }
            }
        }
    }

    /// A bit for each of `rays` that meets the light ([`Light::met`]) before it `ends`.
    pub fn is_met_by(&self, rays: &RayRow, ends: &Row) -> u64 {
        let all = first_places(rays.count());
        match self {
            Light::Disk(light) if rays.count() >= FEW => {
                those_where(&widely(Meet { light, rays, ends })) & all
            }
            _ => {
                let meets = |&i: &usize| {
                    let met = self.met(&rays.get(i));
                    met.is_some_and(|(t, _)| is_between(t, ends[i]))
                };
                places(all).filter(meets).fold(0, |all, i| all | 1 << i)
            }
        }
    }
}

#[inline(always)]
fn is_between(t: f32, end: f32) -> bool {
    (t > 0.0) & (t < end)
}

struct Meet<'a> {
    light: &'a DiskLight,
    rays: &'a RayRow,
    ends: &'a Row,
}

impl RowJob for Meet<'_> {
    type Output = [bool; ROW];

    #[inline(always)]
    fn call(self) -> [bool; ROW] {
        let mut all = [false; ROW];
        for (i, is_met) in all.iter_mut().enumerate() {
            let met = self.light.met(&self.rays.get(i));
            *is_met = met.is_some_and(|(t, _)| is_between(t, self.ends[i]));
        }
        all
    }
}
