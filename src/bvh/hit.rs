//! What a ray finds.

use super::triangle::Crossing;
use crate::math::{ROW, Ray, RayRow, Row};

/// Where a ray meets a triangle.
///
/// A function of the ray and the triangle alone: no builder, tree shape or instruction set
/// changes a bit of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter: the hit is at `origin + t * direction`.
    pub t: f32,
    /// Barycentric weight of the triangle's corner 1, in `[0, 1]`.
    pub u: f32,
    /// Barycentric weight of the triangle's corner 2, in `[0, 1]`.
    pub v: f32,
    /// Index into the triangles that were given to the builder.
    pub triangle: u32,
    /// Index into the instances of a [`Forest`](super::Forest); 0 in a plain tree.
    pub instance: u32,
}

impl Hit {
    #[inline(always)]
    pub(super) fn of(crossing: Crossing, instance: u32, triangle: u32) -> Self {
        let Crossing { t, u, v } = crossing;
        Self {
            t,
            u,
            v,
            triangle,
            instance,
        }
    }

    /// Orders hits at the same `t`: by instance, then by triangle.
    pub(super) fn key(&self) -> u64 {
        key(self.instance, self.triangle)
    }
}

/// What up to [`ROW`] rays find.
#[derive(Clone, Copy, Debug)]
pub struct HitRow {
    /// See [`Hit::t`]; the end of the ray where there is no hit.
    pub t: Row,
    /// See [`Hit::u`].
    pub u: Row,
    /// See [`Hit::v`].
    pub v: Row,
    /// See [`Hit::triangle`].
    pub triangle: [u32; ROW],
    /// See [`Hit::instance`].
    pub instance: [u32; ROW],
    /// A bit for each ray that hits something.
    pub is_hit: u64,
}

impl HitRow {
    /// Nothing so far.
    pub(super) fn before(rays: &RayRow) -> Self {
        Self {
            t: rays.t_max,
            u: [0.0; ROW],
            v: [0.0; ROW],
            triangle: [0; ROW],
            instance: [0; ROW],
            is_hit: 0,
        }
    }

    /// What ray `i` finds.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Option<Hit> {
        (self.is_hit >> i & 1 != 0).then(|| Hit {
            t: self.t[i],
            u: self.u[i],
            v: self.v[i],
            triangle: self.triangle[i],
            instance: self.instance[i],
        })
    }

    /// Makes `hit` what ray `i` finds.
    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, hit: &Hit) {
        self.t[i] = hit.t;
        self.u[i] = hit.u;
        self.v[i] = hit.v;
        self.triangle[i] = hit.triangle;
        self.instance[i] = hit.instance;
        self.is_hit |= 1 << i;
    }
}

/// See [`Hit::key`].
pub(super) fn key(instance: u32, triangle: u32) -> u64 {
    u64::from(instance) << 32 | u64::from(triangle)
}

/// The part of a ray that is still looked at, and the best hit in it so far.
///
/// Hits compete by `(t, instance, triangle)`, lowest first. The open end of the ray is the
/// bound `(t_max, 0, 0)`, which no hit at `t_max` undercuts.
pub(super) struct Search {
    /// Hits must be beyond this.
    pub t_min: f32,
    /// `t` of the best hit, or the end of the ray.
    pub t_best: f32,
    key_best: u64,
    /// The best hit so far.
    pub hit: Option<Hit>,
}

impl Search {
    /// Everything in `t_min < t < t_max` that is not behind the origin.
    pub fn new(t_min: f32, t_max: f32) -> Self {
        Self {
            t_min: t_min.max(0.0),
            t_best: t_max,
            key_best: 0,
            hit: None,
        }
    }

    /// What is left of a ray's search after it found `hit`.
    pub fn beyond(ray: &Ray, hit: Option<Hit>) -> Self {
        let mut search = Self::new(ray.t_min, ray.t_max);
        if let Some(hit) = hit {
            search.keep(hit);
        }
        search
    }

    /// Whether a hit there would be better than what was found so far.
    #[inline(always)]
    pub fn is_better(&self, t: f32, key: u64) -> bool {
        t > self.t_min && (t < self.t_best || (t == self.t_best && key < self.key_best))
    }

    /// Keeps `hit` as the best.
    #[inline(always)]
    pub fn keep(&mut self, hit: Hit) {
        self.t_best = hit.t;
        self.key_best = hit.key();
        self.hit = Some(hit);
    }
}
