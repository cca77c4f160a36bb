//! How much a group of lights may bring to a point, without a single angle.

use std::f64::consts::PI;

use super::{LightBounds, Receiver};
use crate::math::{DVec3, Vec3};

/// [`LightBounds`] in the form that is asked at every step of a walk.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Of the sphere around them.
    center: DVec3,
    radius_squared: f64,
    axis: Vec3,
    /// Of the largest angle between the axis and a normal.
    cos_normals: f64,
    sin_normals: f64,
    /// Of the angle from its own normal to which a light shines.
    cos_emission: f64,
    is_two_sided: bool,
    intensity: f64,
}

/// Cosines that are off by less count as equal: what is at the edge of a cone is not left out.
const ROUNDING: f64 = 4e-6;

/// Light that is left where the bounds say that there is hardly any.
const LEAST_COSINE: f64 = 1e-3;

impl Group {
    /// The same bounds.
    pub fn of(bounds: &LightBounds) -> Self {
        let (min, max) = (bounds.bounds.min.as_dvec3(), bounds.bounds.max.as_dvec3());
        let normals = f64::from(bounds.normals_radians).min(PI);
        Self {
            center: 0.5 * (min + max),
            radius_squared: 0.25 * (max - min).length_squared(),
            axis: bounds.axis.get(),
            cos_normals: normals.cos(),
            sin_normals: normals.sin().max(0.0),
            cos_emission: f64::from(bounds.emission_radians).min(PI).cos(),
            is_two_sided: bounds.is_two_sided,
            intensity: bounds.intensity,
        }
    }

    /// About the most irradiance that they may bring to `receiver`, in arbitrary units; 0 only where
    /// they bring none (equation 3 of the paper).
    pub fn importance(&self, receiver: &Receiver) -> f64 {
        let to_light = self.center - receiver.point.as_dvec3();
        let squared = to_light.length_squared();
        // Nearer than the radius, the mean distance of the lights no longer falls; and they may be
        // in any direction.
        if squared <= self.radius_squared {
            // At the very place of a light, not beyond all bounds, which have no shares.
            return (self.intensity / self.radius_squared.max(f64::MIN_POSITIVE)).min(1e300);
        }
        let way = to_light / squared.sqrt();
        // Half the angle under which the sphere is seen.
        let sin_squared = self.radius_squared / squared;
        let spread = Angle {
            cos: (1.0 - sin_squared).sqrt(),
            sin: sin_squared.sqrt(),
        };
        let cos_axis = -way.dot(self.axis.as_dvec3());
        let cos_axis = if self.is_two_sided {
            cos_axis.abs()
        } else {
            cos_axis
        };
        let normals = Angle {
            cos: self.cos_normals,
            sin: self.sin_normals,
        };
        let off_axis = Angle::of_cos(cos_axis).less(normals).less(spread).cos;
        if off_axis < self.cos_emission - ROUNDING {
            return 0.0;
        }
        let received = match receiver.normal {
            None => 1.0,
            Some(normal) => {
                let cos = normal.as_dvec3().dot(way);
                Angle::of_cos(cos).less(spread).cos
            }
        };
        if received < -ROUNDING {
            return 0.0;
        }
        self.intensity * off_axis.max(LEAST_COSINE) * received.max(LEAST_COSINE) / squared
    }
}

/// An angle from 0 to π.
#[derive(Clone, Copy)]
struct Angle {
    cos: f64,
    sin: f64,
}

impl Angle {
    fn of_cos(cos: f64) -> Self {
        let cos = cos.clamp(-1.0, 1.0);
        Self {
            cos,
            sin: (1.0 - cos * cos).sqrt(),
        }
    }

    /// The difference, or 0 where `other` is larger.
    fn less(self, other: Self) -> Self {
        if self.cos >= other.cos {
            return Self { cos: 1.0, sin: 0.0 };
        }
        Self {
            cos: self.cos * other.cos + self.sin * other.sin,
            sin: self.sin * other.cos - self.cos * other.sin,
        }
    }
}
