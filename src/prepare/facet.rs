//! Where on its triangle a hit is, and which way the surface faces there.
//!
//! Straight arithmetic without a branch: it runs for single hits and for rows of them.

use crate::interaction::{Interaction, rounding_error};
use crate::math::{DVec3, UnitVec3, Vec3};

/// Heights of a bulge below this share of the distance of a vertex are rounding of its normal.
const LEAST_SLOPE: f64 = 1e-6;

/// A hit on a triangle in prepared coordinates.
#[derive(Clone, Copy)]
pub(super) struct Facet {
    /// The point that was hit.
    pub exact: DVec3,
    /// The triangle's normal on the side of its winding.
    pub outward: UnitVec3,
    /// Whether the viewer is on that side.
    pub is_front: bool,
    /// The triangle's normal on the viewer's side.
    pub geometric_normal: UnitVec3,
}

impl Facet {
    /// The point of weights `u` and `v` of the second and third corner, seen from `wo`; `orientation` is -1 where the
    /// winding is turned over, else 1.
    #[inline(always)]
    pub fn new(corners: &[DVec3; 3], u: f32, v: f32, wo: UnitVec3, orientation: f32) -> Self {
        let [a, b, c] = *corners;
        let (ab, ac) = (b - a, c - a);
        let outward = UnitVec3::normalize_f64(ab.cross(ac)).unwrap_or(wo);
        let outward = if orientation < 0.0 { -outward } else { outward };
        let is_front = outward.dot(*wo) >= 0.0;
        Self {
            exact: a + ab * f64::from(u) + ac * f64::from(v),
            outward,
            is_front,
            geometric_normal: if is_front { outward } else { -outward },
        }
    }

    /// What shading reads there, of a surface whose normal is `smooth`, before bumps; `height` is that of the bulge
    /// ([`bulge`]) and counts where it is above 0.
    #[inline(always)]
    pub fn interaction(&self, smooth: UnitVec3, height: f64, wo: UnitVec3) -> Interaction {
        let point = self.exact.as_vec3();
        let above = self.exact + self.geometric_normal.as_dvec3() * height;
        Interaction {
            point,
            point_error: rounding_error(point),
            smooth_point: (height > 0.0).then_some(above.as_vec3()),
            geometric_normal: self.geometric_normal,
            shading_normal: facing(smooth, self.geometric_normal, wo),
            wo,
            is_front: self.is_front,
        }
    }
}

/// How far above `point` of its triangle the surface lies that the vertex `normals` describe, on the side that is seen;
/// 0 where it does not bulge out on that side.
///
/// Each vertex gives a plane across its normal; the height is that of the planes above `point`, weighted as
/// the normals are (Hanika 2021, "Hacking the Shadow Terminator"). Unlike there only the part
/// across the triangle counts, so that nothing beside it comes to be in between.
#[inline(always)]
pub(super) fn bulge(
    facet: &Facet,
    corners: &[DVec3; 3],
    normals: &[Vec3; 3],
    weights: [f32; 3],
) -> f64 {
    let outward = facet.outward.as_dvec3();
    let side = if facet.is_front { 1.0 } else { -1.0 };
    let mut height = 0.0;
    for k in 0..3 {
        let normal = normals[k].as_dvec3();
        let (way, length) = (facet.exact - corners[k], normal.length());
        let above = -side * way.dot(normal);
        let lift = outward.dot(normal);
        let part = f64::from(weights[k]) * above * lift / (length * length);
        let counts = lift > 0.0 && above > LEAST_SLOPE * length * way.length();
        height += if counts { part } else { 0.0 };
    }
    if height < f64::INFINITY { height } else { 0.0 }
}

/// The interpolated normal, pointing outwards; that of the triangle where it has no direction.
#[inline(always)]
pub(super) fn smooth_normal(facet: &Facet, normals: &[Vec3; 3], weights: [f32; 3]) -> UnitVec3 {
    let [a, b, c] = *normals;
    let [wa, wb, wc] = weights;
    UnitVec3::normalize(a * wa + b * wb + c * wc).unwrap_or(facet.outward)
}

/// `normal` on the side of the surface that the viewer is on, and bent so far towards the viewer
/// that it faces it: shading normals may lean over the horizon, and nothing is seen from there.
#[inline(always)]
pub(super) fn facing(normal: UnitVec3, geometric: UnitVec3, wo: UnitVec3) -> UnitVec3 {
    const LEAST_COSINE: f32 = 1e-3;
    let normal = if normal.dot(*geometric) < 0.0 {
        -normal
    } else {
        normal
    };
    let cos = normal.dot(*wo);
    let bent = UnitVec3::normalize(*normal + *wo * (LEAST_COSINE - cos)).unwrap_or(geometric);
    if cos >= LEAST_COSINE { normal } else { bent }
}
