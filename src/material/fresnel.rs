//! Reflection and refraction at the border of two media.

use crate::color::Rgb;
use crate::math::Vec3;

/// Share of unpolarised light that a smooth dielectric border reflects (Fresnel's equations).
///
/// `cos_i` is the cosine of incidence in `[0, 1]`; `eta` the index of the side that the light
/// goes to over the index of the side it comes from. 1 at total internal reflection and where
/// `eta` is 0 or infinite, and exactly 0 where the indices are equal.
pub fn fresnel_dielectric(cos_i: f32, eta: f32) -> f32 {
    if eta == 1.0 {
        return 0.0;
    }
    if eta.is_infinite() {
        return 1.0;
    }
    let Some(cos_t) = cos_transmitted(cos_i, eta) else {
        return 1.0;
    };
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// Cosine of the refracted direction; `None` at total internal reflection.
fn cos_transmitted(cos_i: f32, eta: f32) -> Option<f32> {
    let sin2_t = (1.0 - cos_i * cos_i).max(0.0) / (eta * eta);
    // Not a number, for light along the normal into index 0, is total reflection too.
    (sin2_t < 1.0).then(|| (1.0 - sin2_t).sqrt())
}

/// The mirror direction of `wo` about `normal`; all point away from the surface.
pub fn reflect(wo: Vec3, normal: Vec3) -> Vec3 {
    2.0 * wo.dot(normal) * normal - wo
}

/// The refracted direction, on the side of `normal` that `wo` is not on.
///
/// `eta` as for [`fresnel_dielectric`]. Exactly `-wo` where the indices are equal; `None` at
/// total internal reflection.
pub fn refract(wo: Vec3, normal: Vec3, eta: f32) -> Option<Vec3> {
    if eta == 1.0 {
        return Some(-wo);
    }
    let cos_i = wo.dot(normal);
    let cos_t = cos_transmitted(cos_i, eta)?;
    Some(-wo / eta + (cos_i / eta - cos_t) * normal)
}

/// Schlick's approximation of Fresnel's equations for reflectance `f0` at normal incidence: the
/// weight of white in `f0 + (1 - f0) * weight` (Schlick 1994, "An Inexpensive BRDF Model for
/// Physically-based Rendering").
pub fn schlick_weight(cos_i: f32) -> f32 {
    (1.0 - cos_i).clamp(0.0, 1.0).powi(5)
}

/// Schlick's formula between `f0` at normal and `f90` at grazing incidence.
pub fn schlick(f0: Rgb, f90: f32, cos_i: f32) -> Rgb {
    f0.lerp(Rgb::splat(f90), schlick_weight(cos_i))
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;

    #[test]
    fn normal_incidence_has_its_closed_form() {
        for n in [1.0 + 1e-7, 1.1, 1.5, 2.4, 100.0f32] {
            let expected = ((n - 1.0) / (n + 1.0)).powi(2);
            for eta in [n, 1.0 / n] {
                let got = fresnel_dielectric(1.0, eta);
                assert!((got - expected).abs() <= 1e-6, "n {n}: {got} {expected}");
            }
        }
        assert_eq!(fresnel_dielectric(0.3, 1.0), 0.0);
    }

    #[test]
    fn total_internal_reflection_begins_at_the_critical_angle() {
        let critical = (1.0f32 / 1.5).asin();
        let eta = 1.0 / 1.5;
        assert!(fresnel_dielectric((critical - 1e-3).cos(), eta) < 1.0);
        assert_eq!(fresnel_dielectric((critical + 1e-3).cos(), eta), 1.0);
        let normal = Vec3::Z;
        let wo = Vec3::new((critical + 1e-3).sin(), 0.0, (critical + 1e-3).cos());
        assert_eq!(refract(wo, normal, eta), None);
    }

    #[test]
    fn refraction_obeys_snell() {
        for (angle, eta) in [(0.3f32, 1.5f32), (1.2, 1.33), (0.4, 0.7)] {
            let wo = Vec3::new(angle.sin(), 0.0, angle.cos());
            let wi = refract(wo, Vec3::Z, eta).expect("below the critical angle");
            assert!((wi.length() - 1.0).abs() < 1e-6);
            assert!((wi.x.abs() * eta - angle.sin()).abs() < 1e-6);
            assert!(wi.z < 0.0 && wi.x < 0.0);
        }
    }
}
