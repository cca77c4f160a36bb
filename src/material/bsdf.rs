//! Scattering at one point of a surface.

use std::f32::consts::PI;

use crate::color::Rgb;
use crate::math::{UnitVec3, Vec3};

use super::fresnel::{fresnel_dielectric, reflect, schlick_weight};

/// Scattering at one point of a surface, of either kind of material.
///
/// Directions point away from the surface and are on the side of `normal`; the cosine is never
/// included.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    /// Reflectance of the Lambertian lobe.
    pub diffuse: Rgb,
    /// The lobe around the mirror direction.
    pub glossy: Glossy,
    /// Perfect mirror and what is let through.
    pub specular: Specular,
}

/// A lobe around the mirror direction.
#[derive(Clone, Copy, Debug)]
pub enum Glossy {
    /// None.
    None,
    /// Phong's cosine lobe, normalised by (n+2)/(2π) so that it never makes energy
    /// (Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model for Physically Based Rendering").
    Phong {
        /// Its reflectance.
        reflectance: Rgb,
        /// Its exponent n, at least 0.
        exponent: f32,
    },
    /// GGX microfacets
    /// (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces").
    Ggx {
        /// Reflectance at normal incidence.
        f0: Rgb,
        /// Reflectance at grazing incidence.
        f90: f32,
        /// Roughness α, above 0.
        alpha: f32,
        /// Reflectance at normal and at grazing incidence of the dielectric alone: what it
        /// reflects does not reach the diffuse layer below.
        dielectric: [f32; 2],
        /// What of `f0` and `f90` is not that of glass, whose reflection goes with what it
        /// transmits.
        opaque: (Rgb, f32),
        /// What of `f0` and `f90` no mirror ray follows.
        unmirrored: (Rgb, f32),
    },
}

/// Perfect mirror and what is let through.
#[derive(Clone, Copy, Debug)]
pub struct Specular {
    /// Share that is mirrored at every angle.
    pub reflect: Rgb,
    /// Share that is added to `reflect` at grazing incidence, by Schlick's weight.
    pub reflect_grazing: Rgb,
    /// Share that enters the border, split into mirrored and refracted by Fresnel's equations.
    pub transmit: Rgb,
    /// Index of the inside over the index of the outside.
    pub index_of_refraction: f32,
    /// Whether the surface is a thin wall, which light crosses without a bend.
    pub is_thin: bool,
}

impl Specular {
    /// Neither mirror nor glass.
    pub const NONE: Self = Self {
        reflect: Rgb::BLACK,
        reflect_grazing: Rgb::BLACK,
        transmit: Rgb::BLACK,
        index_of_refraction: 1.0,
        is_thin: true,
    };

    /// The shares that are mirrored and let through at `cos_o`, for `eta` as in
    /// [`fresnel_dielectric`].
    pub fn split(&self, cos_o: f32, eta: f32) -> (Rgb, Rgb) {
        let mirrored = self.reflect + self.reflect_grazing * schlick_weight(cos_o);
        if self.transmit.is_black() {
            return (mirrored, Rgb::BLACK);
        }
        let (reflected, through) = self.glass(cos_o, eta);
        (mirrored + reflected, through)
    }

    /// The part of [`Specular::split`] that is glass.
    pub fn glass(&self, cos_o: f32, eta: f32) -> (Rgb, Rgb) {
        let reflected = fresnel_dielectric(cos_o, eta);
        (self.transmit * reflected, self.transmit * (1.0 - reflected))
    }

    /// Whether light that is let through keeps its direction.
    pub fn is_straight(&self) -> bool {
        self.is_thin || self.index_of_refraction == 1.0
    }
}

/// A surface that gives back no light.
pub const BLACK: Bsdf = Bsdf {
    diffuse: Rgb::BLACK,
    glossy: Glossy::None,
    specular: Specular::NONE,
};

impl Bsdf {
    /// Value for light that comes from `wi` and leaves to `wo`, 1/sr.
    pub fn eval(&self, normal: UnitVec3, wo: UnitVec3, wi: UnitVec3) -> Rgb {
        let diffuse = self.diffuse * (1.0 / PI);
        match self.glossy {
            Glossy::None => diffuse,
            Glossy::Phong {
                reflectance,
                exponent,
            } => diffuse + reflectance * phong_lobe(*normal, *wo, *wi, exponent),
            Glossy::Ggx {
                f0,
                f90,
                alpha,
                dielectric,
                ..
            } => {
                let Some(half) = UnitVec3::normalize(*wo + *wi) else {
                    return Rgb::BLACK;
                };
                // In and out through the coat, each at its own angle: appendix B of the glTF
                // specification takes both at the half vector, and makes energy at grazing views.
                let through =
                    entering(dielectric, normal.dot(*wo)) * entering(dielectric, normal.dot(*wi));
                let reflected = schlick(f0, f90, wo.dot(*half));
                diffuse * through + reflected * ggx(normal, wo, wi, half, alpha)
            }
        }
    }

    /// Without what mirror rays see of lights that have a surface, which would count twice.
    pub fn without_mirrored(mut self) -> Self {
        if let Glossy::Ggx {
            f0,
            f90,
            unmirrored,
            ..
        } = &mut self.glossy
        {
            (*f0, *f90) = *unmirrored;
        }
        self
    }

    /// Share of uniform ambient light that is scattered to `wo`; what rays of their own bring
    /// from mirrors and glass is left out. Phong's lobe, whose author gave it lights alone to show,
    /// takes none.
    pub fn ambient(&self, cos_o: f32) -> Rgb {
        match self.glossy {
            Glossy::None | Glossy::Phong { .. } => self.diffuse,
            Glossy::Ggx {
                dielectric,
                unmirrored: (f0, f90),
                ..
            } => {
                let through = entering(dielectric, cos_o) * mean_entering(dielectric);
                self.diffuse * through + schlick(f0, f90, cos_o)
            }
        }
    }
}

/// Schlick's approximation of Fresnel's equations, between `f0` and `f90`.
pub fn schlick(f0: Rgb, f90: f32, cos: f32) -> Rgb {
    f0.lerp(Rgb::splat(f90), schlick_weight(cos))
}

/// Share that passes a dielectric of reflectance `f0` and `f90` to the layer below.
pub fn entering([f0, f90]: [f32; 2], cos: f32) -> f32 {
    1.0 - (f0 + (f90 - f0) * schlick_weight(cos))
}

/// Mean of [`entering`] over the hemisphere, weighted by the cosine: that of Schlick's weight is
/// 1/21.
fn mean_entering([f0, f90]: [f32; 2]) -> f32 {
    1.0 - (f0 + (f90 - f0) / 21.0)
}

/// Phong's lobe of reflectance 1, 1/sr.
pub fn phong_lobe(normal: Vec3, wo: Vec3, wi: Vec3, exponent: f32) -> f32 {
    // 1 - cos, without the cancellation that would decide the value at large exponents.
    let deviation = 0.5 * (reflect(wi, normal) - wo).length_squared();
    if deviation >= 1.0 {
        return 0.0;
    }
    (exponent + 2.0) / (2.0 * PI) * (exponent * (-deviation).ln_1p()).exp()
}

/// Distribution times visibility: the lobe without its Fresnel factor.
fn ggx(normal: UnitVec3, wo: UnitVec3, wi: UnitVec3, half: UnitVec3, alpha: f32) -> f32 {
    let (cos_o, cos_i) = (normal.dot(*wo), normal.dot(*wi));
    if cos_o <= 0.0 || cos_i <= 0.0 {
        return 0.0;
    }
    let a2 = alpha * alpha;
    let cos_h = normal.dot(*half);
    // sin² from the cross product: 1 - cos² has no digits left near the peak.
    let sin2_h = normal.cross(*half).length_squared();
    let spread = sin2_h + a2 * cos_h * cos_h;
    let distribution = a2 / (PI * spread * spread);
    // Height-correlated masking and shadowing over 4 cos_o cos_i
    // (Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs").
    let lambda_o = cos_i * (a2 + (1.0 - a2) * cos_o * cos_o).sqrt();
    let lambda_i = cos_o * (a2 + (1.0 - a2) * cos_i * cos_i).sqrt();
    distribution * 0.5 / (lambda_o + lambda_i)
}
