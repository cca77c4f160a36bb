//! The ray-triangle test that decides what a hit is.
//!
//! It is the watertight test of Woop, Benthin and Wald 2013 ("Watertight Ray/Triangle
//! Intersection") carried out in f64 from the f32 corners: the triangle is moved so that the
//! ray starts at the origin and sheared so that it runs along one axis; signs of three 2D edge
//! functions then tell whether the ray passes inside. Two triangles that share an edge compute
//! the same edge function up to its sign, so a ray cannot slip between them. Everything faster
//! in the tracing core only has to let through what this test accepts, or to know for certain that it does.
//!
//! What runs for each triangle is `#[inline(always)]` and free of `array::map`, which the
//! compiler leaves as a call (with its copies) inside of functions of another instruction set.

use crate::math::{larger, lesser};

/// Relative tolerance of [`ExactRay::confirms`]: `t` is rounded to `f32`, which moves the
/// point by at most half of this, and the f64 arithmetic by much less.
const POINT_TOLERANCE: f64 = f32::EPSILON as f64;

/// Areas below so many times their error bound are recomputed without cancellation.
const CANCELLED: f64 = (1u64 << 27) as f64;

/// Parameter and barycentric weights of a hit, each rounded once from f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    pub t: f32,
    pub u: f32,
    pub v: f32,
}

/// One number each for the corners a, b and c, or for the three axes; the fourth fills up a
/// vector of the processor and means nothing.
type Four = [f64; 4];

/// The f64 constants of a ray, with coordinates in the order (second, third, main axis).
pub(super) struct ExactRay {
    origin: [f64; 3],
    direction: [f64; 3],
    shear: [f64; 2],
}

impl ExactRay {
    /// `origin` and `direction` in the caster's order of axes; the last component of
    /// `direction` is the largest and not zero.
    #[inline(always)]
    pub fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        let direction = widen(direction);
        Self {
            origin: widen(origin),
            direction,
            shear: [direction[0] / direction[2], direction[1] / direction[2]],
        }
    }

    /// Where the line of the ray crosses the triangle, whatever the sign of `t`.
    ///
    /// `corners` are in the caster's order of axes. Edges and corners belong to the triangle.
    /// `None` also where the triangle has no area as seen along the ray, beyond rounding.
    #[inline(always)]
    pub fn cross(&self, corners: &[[f32; 3]; 3]) -> Option<Crossing> {
        let [x, y, z] = self.sheared(corners);
        let [reach, error] = reach_and_edge_error(x, y, z);
        let mut weights = edge_functions(x, y);
        let mut area = sum(weights);
        if area.abs() < CANCELLED * error {
            weights = edge_functions_compensated(x, y);
            area = sum(weights);
        }
        // Written so that a NaN is a miss.
        let turn = area.signum();
        let least = lesser(
            lesser(turn * weights[0], turn * weights[1]),
            turn * weights[2],
        );
        if !(area.abs() > error && least >= -error) {
            return None;
        }
        if least < 0.0 {
            weights = clamped(weights, turn);
            area = sum(weights);
        }
        let mut depth = sum(mul(weights, z));
        if depth.abs() <= 8.0 * f64::EPSILON * reach * area.abs() {
            depth = 0.0; // the ray starts in the plane, as far as can be told
        }
        let crossing = self.crossing(weights, area, depth);
        self.confirms(corners, crossing.t).then_some(crossing)
    }

    /// What [`Self::cross`] finds where it is certain to find something, far from all that it looks out for: see
    /// [`Certain`](super::filter::Certain).
    #[inline(always)]
    pub fn cross_certain(&self, corners: &[[f32; 3]; 3]) -> Crossing {
        let [x, y, z] = self.sheared(corners);
        let weights = edge_functions(x, y);
        let crossing = self.crossing(weights, sum(weights), sum(mul(weights, z)));
        debug_assert_eq!(self.cross(corners), Some(crossing));
        crossing
    }

    /// Of the three corners, moved so that the ray starts at the origin and sheared so that it runs along the last axis,
    /// the first, the second and the third coordinates.
    #[inline(always)]
    fn sheared(&self, corners: &[[f32; 3]; 3]) -> [Four; 3] {
        let z = self.beyond_origin(corners, 2);
        let x = sub(self.beyond_origin(corners, 0), scale(z, self.shear[0]));
        let y = sub(self.beyond_origin(corners, 1), scale(z, self.shear[1]));
        [x, y, z]
    }

    /// Of the sums that make it up, each rounded once.
    #[inline(always)]
    fn crossing(&self, weights: Four, area: f64, depth: f64) -> Crossing {
        let numerators = [depth, weights[1], weights[2], 0.0];
        let [t, u, v, _] = divide(numerators, [area * self.direction[2], area, area, 1.0]);
        Crossing {
            t: t as f32,
            u: u as f32,
            v: v as f32,
        }
    }

    /// Coordinate `axis` of the corners, less that of the ray's origin.
    #[inline(always)]
    fn beyond_origin(&self, corners: &[[f32; 3]; 3], axis: usize) -> Four {
        let [a, b, c] = corners;
        let o = self.origin[axis];
        let widened = [
            f64::from(a[axis]),
            f64::from(b[axis]),
            f64::from(c[axis]),
            0.0,
        ];
        sub(widened, [o; 4])
    }

    /// Whether the point at `t` is in the triangle's box, up to the rounding of `t`.
    ///
    /// True of every ordinary hit. It fails only where the origin is closer to the plane than
    /// f64 can tell from the far ends of the triangle; demanding it makes the box culling of
    /// [`Caster`](super::caster::Caster) exact by construction, for it bounds every hit by the
    /// box of its triangle.
    #[inline(always)]
    fn confirms(&self, corners: &[[f32; 3]; 3], t: f32) -> bool {
        let [a, b, c] = corners;
        let mut inside = true;
        for k in 0..3 {
            let way = f64::from(t) * self.direction[k];
            let point = self.origin[k] + way;
            let slack = POINT_TOLERANCE * (self.origin[k].abs() + way.abs());
            let low = f64::from(lesser(a[k], lesser(b[k], c[k])));
            let high = f64::from(larger(a[k], larger(b[k], c[k])));
            // Not `&&`: one branch for all.
            inside &= (low - slack <= point) & (point <= high + slack);
        }
        inside
    }
}

/// Corners of `W` triangles: by corner, by axis, by triangle.
pub(super) type Corners<const W: usize> = [[[f32; W]; 3]; 3];

/// [`ExactRay::cross`] for `W` rays at once, each with the same result, bit for bit.
pub(super) struct ExactRays<'a, const W: usize> {
    /// As in [`ExactRay::new`], by axis and by ray.
    pub origin: [&'a [f32; W]; 3],
    /// See `origin`.
    pub direction: [&'a [f32; W]; 3],
}

/// Crossings of `W` rays.
pub(super) struct Crossings<const W: usize> {
    pub t: [f32; W],
    pub u: [f32; W],
    pub v: [f32; W],
    /// A bit for each ray that crosses; 0, as `is_delicate`, where they are certain to and are not asked.
    pub is_hit: u32,
    /// A bit for each ray that needs [`ExactRay::cross`]: too close to an edge, or a triangle seen edge-on.
    pub is_delicate: u32,
}

impl<const W: usize> Crossings<W> {
    /// Of ray `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Crossing {
        Crossing {
            t: self.t[i],
            u: self.u[i],
            v: self.v[i],
        }
    }
}

impl<const W: usize> ExactRays<'_, W> {
    /// Where each ray crosses the triangle with its corners. Those that are `CERTAIN` to do so are not asked, as in
    /// [`ExactRay::cross_certain`].
    #[inline(always)]
    pub fn cross<const CERTAIN: bool>(&self, corners: &Corners<W>) -> Crossings<W> {
        let (mut t, mut u, mut v) = ([0.0; W], [0.0; W], [0.0; W]);
        let (mut hit, mut delicate) = ([0u32; W], [0u32; W]);
        // One straight run of arithmetic without a branch or a call, which compiles to vectors. It is what
        // `ExactRay` does, in the same order.
        for i in 0..W {
            let [a, b, c] = [
                [corners[0][0][i], corners[0][1][i], corners[0][2][i]],
                [corners[1][0][i], corners[1][1][i], corners[1][2][i]],
                [corners[2][0][i], corners[2][1][i], corners[2][2][i]],
            ];
            let (ox, oy, oz) = (
                f64::from(self.origin[0][i]),
                f64::from(self.origin[1][i]),
                f64::from(self.origin[2][i]),
            );
            let (dx, dy, dz) = (
                f64::from(self.direction[0][i]),
                f64::from(self.direction[1][i]),
                f64::from(self.direction[2][i]),
            );
            let (shear_x, shear_y) = (dx / dz, dy / dz);
            let (az, bz, cz) = (
                f64::from(a[2]) - oz,
                f64::from(b[2]) - oz,
                f64::from(c[2]) - oz,
            );
            let (ax, bx, cx) = (
                (f64::from(a[0]) - ox) - az * shear_x,
                (f64::from(b[0]) - ox) - bz * shear_x,
                (f64::from(c[0]) - ox) - cz * shear_x,
            );
            let (ay, by, cy) = (
                (f64::from(a[1]) - oy) - az * shear_y,
                (f64::from(b[1]) - oy) - bz * shear_y,
                (f64::from(c[1]) - oy) - cz * shear_y,
            );
            let r = larger(
                larger(larger(ax.abs(), bx.abs()), cx.abs()),
                larger(larger(ay.abs(), by.abs()), cy.abs()),
            );
            let z = larger(larger(az.abs(), bz.abs()), cz.abs());
            let error = 8.0 * f64::EPSILON * r * (r + z);
            let (wa, wb, wc) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
            let area = wa + wb + wc;
            let turn = if area < 0.0 { -1.0 } else { 1.0 };
            let least = lesser(lesser(turn * wa, turn * wb), turn * wc);
            let is_clear = area.abs() >= CANCELLED * error;
            let is_inside = least >= 0.0;
            let is_near_edge = least >= -error;
            let mut depth = wa * az + wb * bz + wc * cz;
            if !CERTAIN && depth.abs() <= 8.0 * f64::EPSILON * z * area.abs() {
                depth = 0.0;
            }
            let crossing = (depth / (area * dz)) as f32;
            t[i] = crossing;
            u[i] = (wb / area) as f32;
            v[i] = (wc / area) as f32;
            if CERTAIN {
                continue;
            }
            let mut is_confirmed = true;
            for (o, d, k) in [(ox, dx, 0), (oy, dy, 1), (oz, dz, 2)] {
                let way = f64::from(crossing) * d;
                let point = o + way;
                let slack = POINT_TOLERANCE * (o.abs() + way.abs());
                let low = f64::from(lesser(a[k], lesser(b[k], c[k])));
                let high = f64::from(larger(a[k], larger(b[k], c[k])));
                is_confirmed &= (low - slack <= point) & (point <= high + slack);
            }
            hit[i] = u32::from(is_clear & is_inside & is_confirmed);
            delicate[i] = u32::from(!is_clear | (is_near_edge & !is_inside));
        }
        let (mut is_hit, mut is_delicate) = (0, 0);
        for i in 0..W {
            is_hit |= hit[i] << i;
            is_delicate |= delicate[i] << i;
        }
        Crossings {
            t,
            u,
            v,
            is_hit,
            is_delicate,
        }
    }
}

#[inline(always)]
fn sub(a: Four, b: Four) -> Four {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

#[inline(always)]
fn mul(a: Four, b: Four) -> Four {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
}

#[inline(always)]
fn divide(a: Four, b: Four) -> Four {
    [a[0] / b[0], a[1] / b[1], a[2] / b[2], a[3] / b[3]]
}

#[inline(always)]
fn scale(a: Four, factor: f64) -> Four {
    mul(a, [factor; 4])
}

/// Of the three.
#[inline(always)]
fn sum(a: Four) -> f64 {
    a[0] + a[1] + a[2]
}

/// Weights whose sign is not `turn` become zero: those of a ray just outside of an edge.
#[cold]
fn clamped(weights: Four, turn: f64) -> Four {
    weights.map(|w| if turn * w > 0.0 { w } else { 0.0 })
}

#[inline(always)]
fn widen(v: [f32; 3]) -> [f64; 3] {
    [f64::from(v[0]), f64::from(v[1]), f64::from(v[2])]
}

/// The largest main coordinate Z, and a bound, with room, of what rounding does to an edge
/// function of sheared corners: with R the largest sheared coordinate, shearing moves a corner
/// by up to 2^-52 (R + Z), and the products lose 2^-52 R².
///
/// Edges reach out by so much. It closes the gaps of exactly collinear corners (T-junctions),
/// where the argument of shared edges does not hold.
#[inline(always)]
fn reach_and_edge_error(x: Four, y: Four, z: Four) -> [f64; 2] {
    let largest = |v: Four| larger(larger(v[0].abs(), v[1].abs()), v[2].abs());
    let (r, z) = (larger(largest(x), largest(y)), largest(z));
    [z, 8.0 * f64::EPSILON * r * (r + z)]
}

/// What of (c, a, b) and what of (b, c, a) make up the edge functions opposite to a, b and c.
#[inline(always)]
fn ends_of_edges(v: Four) -> [Four; 2] {
    [[v[2], v[0], v[1], 0.0], [v[1], v[2], v[0], 0.0]]
}

/// Twice the signed areas opposite to the corners a, b, c.
#[inline(always)]
fn edge_functions(x: Four, y: Four) -> Four {
    let ([px, qx], [py, qy]) = (ends_of_edges(x), ends_of_edges(y));
    sub(mul(px, qy), mul(py, qx))
}

/// The same with the rounding error of each product, for slivers (aspect ratios beyond 2^23)
/// and triangles seen edge-on.
#[cold]
fn edge_functions_compensated(x: Four, y: Four) -> Four {
    let ([px, qx], [py, qy]) = (ends_of_edges(x), ends_of_edges(y));
    let edge = |k: usize| {
        let (a, a_error) = two_product(px[k], qy[k]);
        let (b, b_error) = two_product(py[k], qx[k]);
        (a - b) + (a_error - b_error)
    };
    [edge(0), edge(1), edge(2), 0.0]
}

/// The product and its rounding error, exactly (Dekker 1971, "A Floating-Point Technique for
/// Extending the Available Precision"); without a fused operation, so that all machines agree.
fn two_product(x: f64, y: f64) -> (f64, f64) {
    let product = x * y;
    let (x_high, x_low) = halves(x);
    let (y_high, y_low) = halves(y);
    let error = x_low * y_low - (((product - x_high * y_high) - x_low * y_high) - x_high * y_low);
    (product, error)
}

/// Splits into two numbers of at most 26 bits.
fn halves(x: f64) -> (f64, f64) {
    let scaled = x * 134_217_729.0; // 2^27 + 1
    let high = scaled - (scaled - x);
    (high, x - high)
}

/// Whether three corners span any area at all; those that do not are never hit.
///
/// Exact while the corners' exponents differ by less than 29.
pub(super) fn has_area(corners: &[[f32; 3]; 3]) -> bool {
    let [a, b, c] = corners.map(|p| p.map(f64::from));
    let e = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let f = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    (0..3).any(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let (x, x_error) = two_product(e[i], f[j]);
        let (y, y_error) = two_product(e[j], f[i]);
        x != y || x_error != y_error
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_product_is_exact() {
        let x = 1.0 + f64::EPSILON;
        let (p, e) = two_product(x, x);
        assert_eq!(p, 1.0 + 2.0 * f64::EPSILON);
        assert_eq!(e, f64::EPSILON * f64::EPSILON);
    }

    #[test]
    fn corners_on_a_line_have_no_area() {
        let p = |x: f32| [x, 3.0 * x, 7.0 * x];
        assert!(!has_area(&[p(1.0), p(2.0), p(5.0)]));
        assert!(!has_area(&[p(1.0), p(1.0), [4.0, 0.1, 0.2]]));
        assert!(has_area(&[p(1.0), p(2.0), [5.0, 15.0, 35.000_004]]));
    }
}
