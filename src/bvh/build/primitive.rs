//! What builders sort: boxes.

use glam::{Vec3A, Vec4};
use rayon::prelude::*;

use super::bounds::Bounds;
use crate::bvh::triangle::has_area;
use crate::math::Vec3;

/// The box of a triangle or instance and its index, in 32 bytes that load as two vectors.
///
/// The index is in the fourth components: its low 23 bits as the fraction of a number in
/// `[1, 2)` beside the lower corner, the others beside the upper one. (Plain bits could be
/// subnormal or NaN, which slows vector arithmetic or loses them.)
#[derive(Clone, Copy, Debug)]
pub(super) struct Primitive {
    lower: Vec4,
    upper: Vec4,
}

const FRACTION_BITS: u32 = 23;
const ONE: u32 = 0x3f80_0000;

impl Primitive {
    /// Number `index`, in the box from `lower` to `upper`.
    #[inline(always)]
    pub fn new(lower: Vec3A, upper: Vec3A, index: u32) -> Self {
        let part = |bits: u32| f32::from_bits(ONE | bits);
        let fraction = index & ((1 << FRACTION_BITS) - 1);
        Self {
            lower: lower.extend(part(fraction)),
            upper: upper.extend(part(index >> FRACTION_BITS)),
        }
    }

    /// Index of what is in the box.
    #[inline(always)]
    pub fn index(&self) -> u32 {
        let part = |x: f32| x.to_bits() & !ONE;
        part(self.upper.w) << FRACTION_BITS | part(self.lower.w)
    }

    /// The box.
    #[inline(always)]
    pub fn bounds(&self) -> Bounds {
        Bounds {
            min: Vec3A::from_vec4(self.lower),
            max: Vec3A::from_vec4(self.upper),
        }
    }

    /// Middle of the box: what decides on which side of a split it goes.
    #[inline(always)]
    pub fn centroid(&self) -> Vec3A {
        let bounds = self.bounds();
        0.5 * bounds.min + 0.5 * bounds.max
    }

    /// Whether it stands for something that can be hit.
    fn is_usable(&self) -> bool {
        self.lower.x <= self.upper.x
    }
}

/// Corner positions of a triangle.
#[inline(always)]
pub(super) fn corners(positions: &[Vec3], [a, b, c]: [u32; 3]) -> [Vec3; 3] {
    [
        positions[a as usize],
        positions[b as usize],
        positions[c as usize],
    ]
}

/// The primitives of all triangles that can be hit: those with an area and finite corners.
pub(super) fn primitives(positions: &[Vec3], indices: &[[u32; 3]]) -> Vec<Primitive> {
    let of_triangle = |(i, &triangle): (usize, &[u32; 3])| {
        let bounds = bounds_of(corners(positions, triangle)).unwrap_or(Bounds::EMPTY);
        Primitive::new(bounds.min, bounds.max, i as u32)
    };
    // All at once into one vector, which `filter_map` could not do; few meshes have unusable ones.
    let mut primitives: Vec<_> = indices
        .par_iter()
        .enumerate()
        .with_min_len(1 << 12)
        .map(of_triangle)
        .collect();
    if !primitives.par_iter().all(Primitive::is_usable) {
        primitives.retain(Primitive::is_usable);
    }
    primitives
}

/// The box of a triangle; `None` where it can never be hit.
#[inline(always)]
fn bounds_of(corners: [Vec3; 3]) -> Option<Bounds> {
    let [p, q, r] = corners;
    let (a, b, c) = (Vec3A::from(p), Vec3A::from(q), Vec3A::from(r));
    // Rounded products differ only where the exact ones do, so most triangles pass here.
    let (e, f) = (b.as_dvec3() - a.as_dvec3(), c.as_dvec3() - a.as_dvec3());
    let is_plain = e.x * f.y != e.y * f.x || e.y * f.z != e.z * f.y || e.z * f.x != e.x * f.z;
    let is_finite = a.is_finite() && b.is_finite() && c.is_finite();
    let usable = is_finite && (is_plain || has_area(&[p.to_array(), q.to_array(), r.to_array()]));
    usable.then(|| Bounds {
        min: a.min(b).min(c),
        max: a.max(b).max(c),
    })
}
