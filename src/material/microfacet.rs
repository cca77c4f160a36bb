//! GGX microfacets in the coordinates of a shading frame, where the normal is z.

use std::f32::consts::{PI, TAU};

use crate::math::{Vec2, Vec3};

/// The GGX distribution with Smith's masking and shadowing
/// (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces").
#[derive(Clone, Copy, Debug)]
pub struct Ggx {
    /// Roughness α along the frame's x and y, above 0.
    pub alpha: Vec2,
}

impl Ggx {
    /// The same roughness in every direction.
    pub fn isotropic(alpha: f32) -> Self {
        Self {
            alpha: Vec2::splat(alpha),
        }
    }

    /// Density of facets with normal `half`, per steradian and projected area.
    pub fn distribution(&self, half: Vec3) -> f32 {
        let slope = half.truncate() / self.alpha;
        let spread = slope.length_squared() + half.z * half.z;
        1.0 / (PI * self.alpha.x * self.alpha.y * spread * spread)
    }

    /// `z` of a direction plus twice what hides it: √(z² + αx² x² + αy² y²).
    fn stretched(&self, w: Vec3) -> f32 {
        (self.alpha * w.truncate()).extend(w.z).length()
    }

    /// Share of the facets that face `w` which are seen from there.
    pub fn masking(&self, w: Vec3) -> f32 {
        let z = w.z.abs();
        2.0 * z / (z + self.stretched(w))
    }

    /// Height-correlated masking and shadowing over `4 cos_o cos_i`, for directions on the same
    /// side (Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs").
    pub fn visibility(&self, wo: Vec3, wi: Vec3) -> f32 {
        0.5 / (wi.z.abs() * self.stretched(wo) + wo.z.abs() * self.stretched(wi))
    }

    /// Solid-angle density of [`Ggx::sample`] choosing `half`.
    pub fn pdf(&self, wo: Vec3, half: Vec3) -> f32 {
        // Masking over the cosine of wo.
        let seen = 2.0 / (wo.z + self.stretched(wo));
        seen * wo.dot(half).max(0.0) * self.distribution(half)
    }

    /// A facet normal in proportion to how much of it `wo`, above the surface, sees
    /// (Heitz 2018, "Sampling the GGX Distribution of Visible Normals").
    pub fn sample(&self, wo: Vec3, u: Vec2) -> Vec3 {
        // In a space where the roughness is 1, facets are a hemisphere.
        let view = (self.alpha * wo.truncate()).extend(wo.z).normalize();
        let across = view.truncate().length_squared();
        let side = if across > 0.0 {
            Vec3::new(-view.y, view.x, 0.0) / across.sqrt()
        } else {
            Vec3::X
        };
        let up = view.cross(side);
        let (sin, cos) = (TAU * u.y).sin_cos();
        let radius = u.x.sqrt();
        let x = radius * cos;
        let lean = 0.5 * (1.0 + view.z);
        let y = (1.0 - lean) * (1.0 - x * x).max(0.0).sqrt() + lean * radius * sin;
        let z = (1.0 - x * x - y * y).max(0.0).sqrt();
        let half = side * x + up * y + view * z;
        (self.alpha * half.truncate())
            .extend(half.z.max(1e-7))
            .normalize()
    }
}
