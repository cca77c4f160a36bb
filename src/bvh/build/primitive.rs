//! What builders sort: boxes.

use glam::{Vec3A, Vec4};

use crate::bvh::triangle::has_area;
use crate::math::{Aabb, Vec3};
use rayon::prelude::*;

/// The box of a triangle or instance and its index, in 32 bytes that load as two vectors.
///
/// The index is in the fourth components: its low 23 bits as the fraction of a number in
/// `[1, 2)` beside the lower corner, the others beside the upper one. (Plain bits could be
/// subnormal or NaN, which slows vector arithmetic or loses them.)
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Primitive {
    lower: Vec4,
    upper: Vec4,
}

const FRACTION_BITS: u32 = 23;
const ONE: u32 = 0x3f80_0000;

impl Primitive {
    /// Number `index`, in the box from `lower` to `upper`.
    pub fn new(lower: Vec3, upper: Vec3, index: u32) -> Self {
        let part = |bits: u32| f32::from_bits(ONE | bits);
        let fraction = index & ((1 << FRACTION_BITS) - 1);
        Self {
            lower: lower.extend(part(fraction)),
            upper: upper.extend(part(index >> FRACTION_BITS)),
        }
    }

    /// Index of what is in the box.
    pub fn index(&self) -> u32 {
        let part = |x: f32| x.to_bits() & !ONE;
        part(self.upper.w) << FRACTION_BITS | part(self.lower.w)
    }

    /// Lower corner.
    #[inline(always)]
    pub fn lower(&self) -> Vec3A {
        Vec3A::from_vec4(self.lower)
    }

    /// Upper corner.
    #[inline(always)]
    pub fn upper(&self) -> Vec3A {
        Vec3A::from_vec4(self.upper)
    }

    /// Middle of the box: what decides on which side of a split it goes.
    #[inline(always)]
    pub fn centroid(&self) -> Vec3A {
        0.5 * self.lower() + 0.5 * self.upper()
    }
}

/// Corner positions of a triangle.
pub(super) fn corners(positions: &[Vec3], triangle: [u32; 3]) -> [Vec3; 3] {
    triangle.map(|i| positions[i as usize])
}

/// The primitives of all triangles that can be hit: those with an area and finite corners.
pub(super) fn primitives(positions: &[Vec3], indices: &[[u32; 3]]) -> Vec<Primitive> {
    indices
        .par_iter()
        .enumerate()
        .filter_map(|(i, &triangle)| {
            let corners = corners(positions, triangle);
            let usable =
                corners.iter().all(|p| p.is_finite()) && has_area(&corners.map(|p| p.to_array()));
            let [a, b, c] = corners;
            usable.then(|| Primitive::new(a.min(b).min(c), a.max(b).max(c), i as u32))
        })
        .collect()
}

/// A box for vector arithmetic.
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
    pub fn add_primitive(&mut self, primitive: &Primitive) {
        self.min = self.min.min(primitive.lower());
        self.max = self.max.max(primitive.upper());
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Half the surface, in f64 so that no finite box overflows; 0 where empty.
    pub fn half_area(&self) -> f64 {
        let e = (self.max.as_dvec3() - self.min.as_dvec3()).max(glam::DVec3::ZERO);
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    /// As the type of everyone else.
    pub fn to_aabb(self) -> Aabb {
        Aabb {
            min: self.min.into(),
            max: self.max.into(),
        }
    }
}

/// A range of primitives on its way to becoming a node or a leaf.
#[derive(Debug)]
pub(super) struct Part<'a> {
    pub primitives: &'a mut [Primitive],
    /// Around the primitives.
    pub bounds: Bounds,
    /// Around their centroids.
    pub centroids: Bounds,
}

/// Ranges longer than this are scanned by several threads; what they compute (minima, maxima
/// and counts) does not depend on how the range is cut.
pub(super) const PARALLEL_SCAN: usize = 1 << 16;

impl<'a> Part<'a> {
    /// Scans `primitives`.
    pub fn new(primitives: &'a mut [Primitive]) -> Self {
        let (bounds, centroids) = scan(primitives);
        Self {
            primitives,
            bounds,
            centroids,
        }
    }
}

fn scan(primitives: &[Primitive]) -> (Bounds, Bounds) {
    let empty = (Bounds::EMPTY, Bounds::EMPTY);
    let scan_chunk = |chunk: &[Primitive]| {
        chunk.iter().fold(empty, |(mut bounds, mut centroids), p| {
            bounds.add_primitive(p);
            centroids.add_point(p.centroid());
            (bounds, centroids)
        })
    };
    if primitives.len() <= PARALLEL_SCAN {
        return scan_chunk(primitives);
    }
    primitives
        .par_chunks(PARALLEL_SCAN / 4)
        .map(scan_chunk)
        .reduce(
            || empty,
            |(mut bounds, mut centroids), (b, c)| {
                bounds.add(&b);
                centroids.add(&c);
                (bounds, centroids)
            },
        )
}
