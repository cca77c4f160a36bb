//! A triangle that shines, as seen from a point.

use std::f64::consts::PI;

use crate::math::{DVec3, Vec2};

/// The directions from a point in which a triangle is seen.
///
/// Sampled uniformly by solid angle (Arvo 1995, "Stratified Sampling of Spherical Triangles") where
/// the triangle looks large, and by area where it looks so small, or so nearly fills a half space, that
/// differences of angles are noise.
#[derive(Clone, Copy, Debug)]
pub struct SeenTriangle {
    /// Relative to the point.
    corners: [DVec3; 3],
    /// `(b - a) × (c - a)`: twice the area long.
    cross: DVec3,
    spherical: Option<SphericalTriangle>,
}

/// One direction in which a triangle is seen.
#[derive(Clone, Copy, Debug)]
pub struct TriangleSample {
    /// From the point to the triangle, of length 1.
    pub direction: DVec3,
    /// How far it is.
    pub distance: f64,
    /// Weights of the triangle's second and third corner, as in [`crate::bvh`]'s hits.
    pub barycentric: [f64; 2],
    /// By solid angle.
    pub density: f64,
}

impl SeenTriangle {
    /// The triangle as seen from the origin of `corners`; `None` where it has no area, or the origin
    /// is in its plane.
    pub fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let cross = (b - a).cross(c - a);
        let volume = a.dot(cross);
        (cross != DVec3::ZERO && volume != 0.0 && volume.is_finite()).then(|| Self {
            corners,
            cross,
            spherical: SphericalTriangle::new(corners),
        })
    }

    /// Whether the origin is on the side from which the corners run counter-clockwise.
    pub fn is_front(&self) -> bool {
        self.corners[0].dot(self.cross) < 0.0
    }

    /// The direction for `u` in `[0, 1)²`.
    pub fn sample(&self, u: Vec2) -> Option<TriangleSample> {
        let u = u.as_dvec2();
        let [a, b, c] = self.corners;
        let (direction, barycentric) = match &self.spherical {
            Some(spherical) => {
                let direction = spherical.sample(u.x, u.y);
                (direction, self.barycentric(direction))
            }
            None => {
                // Turk 1990, "Generating Random Points in Triangles".
                let root = u.x.sqrt();
                let barycentric = [root * (1.0 - u.y), root * u.y];
                let [v, w] = barycentric;
                let place = a * (1.0 - v - w) + b * v + c * w;
                (place.normalize(), barycentric)
            }
        };
        let [v, w] = barycentric;
        let distance = (a * (1.0 - v - w) + b * v + c * w).length();
        let density = self.density(direction);
        (density > 0.0 && direction.is_finite()).then_some(TriangleSample {
            direction,
            distance,
            barycentric,
            density,
        })
    }

    /// The density by solid angle of [`Self::sample`] in a direction in which the triangle is seen.
    pub fn density(&self, direction: DVec3) -> f64 {
        match &self.spherical {
            Some(spherical) => 1.0 / spherical.solid_angle,
            None => {
                // Distance² / (area cos): the distance is that of the plane over the cosine.
                let twice_area = self.cross.length();
                let height = (self.corners[0].dot(self.cross) / twice_area).abs();
                let cos = (direction.dot(self.cross) / twice_area).abs();
                2.0 * height * height / (cos * cos * cos * twice_area)
            }
        }
    }

    /// Weights of the second and third corner where `direction` meets the triangle.
    fn barycentric(&self, direction: DVec3) -> [f64; 2] {
        let [a, b, c] = self.corners;
        // The volumes of the tetrahedra that the direction makes with the edges, by Cramer's rule.
        let [va, vb, vc] = [
            direction.dot(b.cross(c)),
            direction.dot(c.cross(a)),
            direction.dot(a.cross(b)),
        ];
        let sum = va + vb + vc;
        let v = (vb / sum).clamp(0.0, 1.0);
        let w = (vc / sum).clamp(0.0, 1.0 - v);
        [v, w]
    }
}

/// A triangle on the sphere of directions.
#[derive(Clone, Copy, Debug)]
struct SphericalTriangle {
    a: DVec3,
    b: DVec3,
    /// Across `a`, of length 1, in the plane of `a` and the third corner.
    toward_c: DVec3,
    /// Of the angle at `a`.
    sin_alpha: f64,
    cos_alpha: f64,
    cos_c: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// Below it (a square of half a degree across), differences of angles are noise, and area does as well.
    const SMALLEST: f64 = 1e-4;
    /// Above it the corners are nearly on a great circle.
    const LARGEST: f64 = 2.0 * PI - 1e-2;

    fn new(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| corner / corner.length());
        let solid_angle = solid_angle(a, b, c);
        if !(Self::SMALLEST..Self::LARGEST).contains(&solid_angle) {
            return None;
        }
        // The angle at a, between the planes of its two edges.
        let (ab, ac) = (across(b, a)?, across(c, a)?);
        let cos_alpha = ab.dot(ac).clamp(-1.0, 1.0);
        let sin_alpha = ab.cross(ac).length();
        (sin_alpha > 1e-6).then_some(Self {
            a,
            b,
            toward_c: ac,
            sin_alpha,
            cos_alpha,
            cos_c: a.dot(b),
            solid_angle,
        })
    }

    /// Uniform by solid angle: a part of the triangle with the area `u` times the whole is cut off by
    /// a great circle through `b`, then a point on that circle is taken by its height.
    fn sample(&self, u: f64, v: f64) -> DVec3 {
        let (sin_s, cos_s) = (u * self.solid_angle).sin_cos();
        // The angle that the cut part keeps at b's opposite side: s and t of the paper.
        let s = sin_s * self.cos_alpha - cos_s * self.sin_alpha;
        let t = cos_s * self.cos_alpha + sin_s * self.sin_alpha;
        let p = t - self.cos_alpha;
        let q = s + self.sin_alpha * self.cos_c;
        let below = (q * s + p * t) * self.sin_alpha;
        let cos_b = if below == 0.0 {
            1.0
        } else {
            (((q * t - p * s) * self.cos_alpha - q) / below).clamp(-1.0, 1.0)
        };
        let sin_b = (1.0 - cos_b * cos_b).sqrt();
        // The corner that takes c's place.
        let cut = self.a * cos_b + self.toward_c * sin_b;
        let z = 1.0 - v * (1.0 - cut.dot(self.b));
        let rest = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        match across(cut, self.b) {
            Some(side) => (self.b * z + side * rest).normalize(),
            None => self.b,
        }
    }
}

/// What of `v` is across the unit vector `axis`, at length 1; `None` where nothing is.
fn across(v: DVec3, axis: DVec3) -> Option<DVec3> {
    let rest = v - axis * v.dot(axis);
    let length = rest.length();
    (length > 1e-12).then(|| rest / length)
}

/// Of the triangle between three unit vectors (Van Oosterom and Strackee 1983, "The Solid Angle of a
/// Plane Triangle").
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let volume = a.dot((b - a).cross(c - a)).abs();
    let half = volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a));
    // The arctangent of both is in [0, π], and so is half a solid angle.
    2.0 * half
}
