//! Scattering in all directions: values, densities and samples of a [`Bsdf`].
//!
//! What `whitted` shows by rays of its own, a mirror that fades in on smooth metallic-roughness
//! surfaces, is the GGX lobe itself here, so that nothing counts twice.

use std::f32::consts::PI;

use super::bsdf::{entering, phong_lobe, schlick};
use super::fresnel::{reflect, refract};
use super::microfacet::Ggx;
use super::{Bsdf, Glossy};
use crate::color::Rgb;
use crate::math::{Frame, UnitVec3, Vec2, Vec3};
use crate::sampling::square_to_disk;

/// GGX lobes of this α or below are perfect mirrors to a path: no light could be found in them.
const MIRROR_ALPHA: f32 = 1e-4;

/// How a surface is seen: what scattering needs beside the material.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Around the shading normal, on the viewer's side.
    pub frame: Frame,
    /// Towards the viewer, in the world.
    pub wo: UnitVec3,
    /// Index of refraction of the side beyond over that of the viewer's side.
    pub eta: f32,
}

/// A direction that light may have come from.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// The direction, away from the surface.
    pub wi: UnitVec3,
    /// Value × |cosine| / density, per channel; for perfect mirrors and glass, what they let
    /// by over the probability of having chosen them.
    pub weight: Rgb,
    /// Density of [`Bsdf::sample`] per solid angle, of all lobes with area together; 0 for
    /// perfect mirrors and glass, which no other technique finds.
    pub pdf: f32,
    /// Whether it came from a perfect mirror or from smooth glass.
    pub is_specular: bool,
    /// Whether `wi` is on the far side of the surface.
    pub is_transmitted: bool,
}

/// Probabilities with which [`Bsdf::sample`] chooses its lobes.
struct Shares {
    diffuse: f32,
    glossy: f32,
    mirror: f32,
    glass: f32,
}

impl Bsdf {
    /// Value for light that comes from `wi`, on either side, 1/sr: all lobes that have area. The
    /// cosine is not included.
    pub fn value(&self, view: &View, wi: UnitVec3) -> Rgb {
        let (wo, wi) = (view.frame.to_local(*view.wo), view.frame.to_local(*wi));
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        let diffuse = self.diffuse * (1.0 / PI);
        match self.glossy {
            Glossy::None => diffuse,
            Glossy::Phong {
                reflectance,
                exponent,
            } => diffuse + reflectance * phong_lobe(Vec3::Z, wo, wi, exponent),
            Glossy::Ggx {
                opaque: (f0, f90),
                alpha,
                dielectric,
                ..
            } => {
                let through = entering(dielectric, wo.z) * entering(dielectric, wi.z);
                let diffuse = diffuse * through;
                if alpha <= MIRROR_ALPHA {
                    return diffuse;
                }
                let ggx = Ggx::isotropic(alpha);
                let half = (wo + wi).normalize();
                let lobe = ggx.distribution(half) * ggx.visibility(wo, wi);
                diffuse + schlick(f0, f90, wo.dot(half)) * lobe
            }
        }
    }

    /// Density per solid angle with which [`Bsdf::sample`] chooses `wi` by a lobe that has area.
    pub fn pdf(&self, view: &View, wi: UnitVec3) -> f32 {
        let (wo, wi) = (view.frame.to_local(*view.wo), view.frame.to_local(*wi));
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let Some(shares) = self.shares(wo) else {
            return 0.0;
        };
        let glossy = match self.glossy {
            _ if shares.glossy == 0.0 => 0.0,
            Glossy::None => 0.0,
            Glossy::Phong { exponent, .. } => {
                phong_lobe(Vec3::Z, wo, wi, exponent) * (exponent + 1.0) / (exponent + 2.0)
            }
            Glossy::Ggx { alpha, .. } => {
                let half = (wo + wi).normalize();
                Ggx::isotropic(alpha).pdf(wo, half) / (4.0 * wo.dot(half))
            }
        };
        shares.diffuse * wi.z / PI + shares.glossy * glossy
    }

    /// Draws a direction for two independent numbers `u_lobe` in `[0, 1)` and `u` in its square;
    /// `None` where nothing comes from the one that was drawn.
    pub fn sample(&self, view: &View, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let wo = view.frame.to_local(*view.wo);
        let shares = self.shares(wo)?;
        let mut rest = u_lobe;
        let mut is_chosen = |share: f32| {
            rest -= share;
            rest < 0.0
        };
        if is_chosen(shares.diffuse) {
            let disk = square_to_disk(u);
            let z = (1.0 - disk.length_squared()).max(0.0).sqrt();
            return self.of_area(view, disk.extend(z));
        }
        if is_chosen(shares.glossy) {
            let wi = match self.glossy {
                Glossy::None => return None,
                Glossy::Phong { exponent, .. } => around_mirror(wo, exponent, u),
                Glossy::Ggx { alpha, .. } => reflect(wo, Ggx::isotropic(alpha).sample(wo, u)),
            };
            return self.of_area(view, wi);
        }
        let mirror = reflect(wo, Vec3::Z);
        if is_chosen(shares.mirror) {
            let weight = self.mirrored(wo.z) / shares.mirror;
            return specular(view, mirror, weight);
        }
        // Rounding may leave a rest: it goes to the last lobe that there is.
        if shares.glass == 0.0 {
            return None;
        }
        let (reflected, through) = self.specular.glass(wo.z, view.eta);
        let reflection = reflected.max_channel() / (reflected + through).max_channel();
        if is_chosen(shares.glass * reflection) {
            let weight = reflected / (shares.glass * reflection);
            return specular(view, mirror, weight);
        }
        let beyond = match self.specular.is_straight() {
            true => -wo,
            false => refract(wo, Vec3::Z, view.eta)?,
        };
        let weight = through / (shares.glass * (1.0 - reflection));
        specular(view, beyond, weight)
    }

    /// A sample of the lobes that have area.
    fn of_area(&self, view: &View, wi: Vec3) -> Option<BsdfSample> {
        let cos_i = wi.z;
        let wi = UnitVec3::normalize(view.frame.to_world(wi))?;
        let pdf = self.pdf(view, wi);
        let weight = self.value(view, wi) * (cos_i.abs() / pdf);
        let sample = BsdfSample {
            wi,
            weight,
            pdf,
            is_specular: false,
            is_transmitted: cos_i < 0.0,
        };
        (pdf > 0.0 && pdf.is_finite() && weight.is_finite() && !weight.is_black()).then_some(sample)
    }

    /// What a perfect mirror shows at `cos_o`; not what glass does.
    fn mirrored(&self, cos_o: f32) -> Rgb {
        match self.glossy {
            Glossy::Ggx {
                opaque: (f0, f90),
                alpha,
                ..
            } if alpha <= MIRROR_ALPHA => schlick(f0, f90, cos_o),
            Glossy::Ggx { .. } => Rgb::BLACK,
            Glossy::None | Glossy::Phong { .. } => self.specular.split(cos_o, 1.0).0,
        }
    }

    /// In proportion to what each lobe sends to `wo`, about; `None` where that is nothing.
    fn shares(&self, wo: Vec3) -> Option<Shares> {
        let (diffuse, glossy) = match self.glossy {
            Glossy::None => (self.diffuse, Rgb::BLACK),
            Glossy::Phong { reflectance, .. } => (self.diffuse, reflectance),
            Glossy::Ggx {
                opaque: (f0, f90),
                alpha,
                dielectric,
                ..
            } => (
                self.diffuse * entering(dielectric, wo.z),
                if alpha <= MIRROR_ALPHA {
                    Rgb::BLACK
                } else {
                    schlick(f0, f90, wo.z)
                },
            ),
        };
        let parts =
            [diffuse, glossy, self.mirrored(wo.z), self.specular.transmit].map(Rgb::max_channel);
        let sum: f32 = parts.iter().sum();
        let [diffuse, glossy, mirror, glass] = parts.map(|part| part / sum);
        (sum > 0.0 && sum.is_finite() && wo.z > 0.0).then_some(Shares {
            diffuse,
            glossy,
            mirror,
            glass,
        })
    }
}

fn specular(view: &View, wi: Vec3, weight: Rgb) -> Option<BsdfSample> {
    Some(BsdfSample {
        wi: UnitVec3::normalize(view.frame.to_world(wi))?,
        weight,
        pdf: 0.0,
        is_specular: true,
        is_transmitted: wi.z < 0.0,
    })
}

/// A direction around the mirror direction of `wo`, by the cosine with it to the `exponent`.
fn around_mirror(wo: Vec3, exponent: f32, u: Vec2) -> Vec3 {
    // 1 - cos, without the cancellation that would decide the direction at large exponents.
    let depth = -((1.0 - u.x).ln() / (exponent + 1.0)).exp_m1();
    let ring = (depth * (2.0 - depth)).max(0.0).sqrt();
    let (sin, cos) = (std::f32::consts::TAU * u.y).sin_cos();
    let mirror = UnitVec3::from_normalized(reflect(wo, Vec3::Z));
    Frame::around(mirror).to_world(Vec3::new(ring * cos, ring * sin, 1.0 - depth))
}
