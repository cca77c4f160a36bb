//! What a ray finds.

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
    /// Orders hits at the same `t`: by instance, then by triangle.
    pub(super) fn key(&self) -> u64 {
        key(self.instance, self.triangle)
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
    /// Of no ray.
    pub const NOWHERE: Self = Self {
        t_min: 0.0,
        t_best: 0.0,
        key_best: 0,
        hit: None,
    };

    /// Everything in `t_min < t < t_max` that is not behind the origin.
    pub fn new(t_min: f32, t_max: f32) -> Self {
        Self {
            t_min: t_min.max(0.0),
            t_best: t_max,
            key_best: 0,
            hit: None,
        }
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
