//! Boxes of parts of triangles.
//!
//! The box of a part is what a hit in that part must not be able to leave, so it is wider than
//! the part by [`MARGIN`]; see `spatial`.

use glam::Vec3A;

use super::bounds::Bounds;
use super::primitive::corners;
use crate::math::Vec3;

/// A part's box reaches out by so much of the triangle's longest extent, but not beyond the
/// triangle's own box.
const MARGIN: f32 = 1.0 / (1u32 << 19) as f32;

/// More than the few roundings of a corner of a part's box, as a share of its coordinates.
const ROUNDING: f32 = 1.0 / (1u32 << 21) as f32;

/// Triangles whose longest extent is in between can be cut without overflow or underflow.
const EXTENTS: std::ops::Range<f32> = 1e-25..1e25;

/// The corners of a triangle that is cut.
pub(super) struct Clipper {
    corners: [Vec3A; 3],
    margin: f32,
}

impl Clipper {
    /// `None` where the triangle is too large or small to be cut.
    pub fn new(positions: &[Vec3], triangle: [u32; 3]) -> Option<Self> {
        let [a, b, c] = corners(positions, triangle).map(Vec3A::from);
        let extent = (a.max(b).max(c) - a.min(b).min(c)).max_element();
        EXTENTS.contains(&extent).then_some(Self {
            corners: [a, b, c],
            margin: MARGIN * extent,
        })
    }

    /// The boxes of the parts of the triangle below and above `plane` across `axis`, as far as
    /// they are inside of `bounds`; empty ones where there is no such part.
    #[inline(always)]
    pub fn cut(&self, bounds: &Bounds, axis: usize, plane: f32) -> [Bounds; 2] {
        let mut sides = [Bounds::EMPTY; 2];
        let [a, b, c] = self.corners;
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let (x, y) = (p[axis], q[axis]);
            if x <= plane {
                sides[0].add_point(p);
            }
            if x >= plane {
                sides[1].add_point(p);
            }
            if (x < plane) != (y < plane) && x != plane && y != plane {
                let crossing = p + (plane - x) / (y - x) * (q - p);
                sides[0].add_point(crossing);
                sides[1].add_point(crossing);
            }
        }
        sides.map(|side| self.widened(side, bounds))
    }

    #[inline(always)]
    fn widened(&self, side: Bounds, within: &Bounds) -> Bounds {
        let reach = ROUNDING * side.min.abs().max(side.max.abs()) + self.margin;
        Bounds {
            min: (side.min - reach).max(within.min),
            max: (side.max + reach).min(within.max),
        }
    }
}
