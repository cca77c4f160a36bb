//! A box for vector arithmetic.

use glam::{DVec3, Vec3A};

use crate::math::Aabb;

/// [`Aabb`], in two vectors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub min: Vec3A,
    pub max: Vec3A,
}

impl Bounds {
    /// Of nothing.
    pub const EMPTY: Self = Self {
        min: Vec3A::INFINITY,
        max: Vec3A::NEG_INFINITY,
    };

    #[inline(always)]
    pub fn add_point(&mut self, point: Vec3A) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Around both.
    #[inline(always)]
    pub fn union(mut self, other: &Self) -> Self {
        self.add(other);
        self
    }

    /// What is in both.
    #[inline(always)]
    pub fn overlap(&self, other: &Self) -> Self {
        Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }

    /// Whether it holds no point.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Half the surface, in f64 so that no finite box overflows; 0 where empty.
    #[inline(always)]
    pub fn half_area(&self) -> f64 {
        let e = (self.max.as_dvec3() - self.min.as_dvec3()).max(DVec3::ZERO);
        e.x * (e.y + e.z) + e.y * e.z
    }

    /// As the type of everyone else.
    pub fn to_aabb(self) -> Aabb {
        Aabb {
            min: self.min.into(),
            max: self.max.into(),
        }
    }
}
