//! Directions drawn from a [`Bsdf`], with their densities and weights.

use std::f32::consts::PI;

use super::bsdf::{Bsdf, Lobes, Specular, View};
use super::fresnel::{reflect, refract};
use super::layered::{Drawn, Pair};
use super::phong::{around_mirror, phong_pdf};
use crate::color::Rgb;
use crate::math::{UnitVec3, Vec2, Vec3};
use crate::sampling::square_to_hemisphere;

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

/// Probabilities with which the lobes of a Phong material are chosen.
struct Shares {
    matte: f32,
    glossy: f32,
    mirror: f32,
    glass: f32,
}

impl Bsdf {
    /// Density per solid angle with which [`Bsdf::sample`] chooses `wi` by a lobe that has area.
    pub fn pdf(&self, view: &View, wi: UnitVec3) -> f32 {
        self.pair_pdf(&view.pair(wi))
    }

    /// [`Bsdf::value`] and [`Bsdf::pdf`].
    pub fn value_and_pdf(&self, view: &View, wi: UnitVec3) -> (Rgb, f32) {
        let pair = view.pair(wi);
        (self.lobes.value(&pair, false), self.pair_pdf(&pair))
    }

    fn pair_pdf(&self, pair: &Pair) -> f32 {
        match &self.lobes {
            Lobes::Layered(layers) => layers.pdf(pair),
            Lobes::Phong { .. } if pair.wi.z <= 0.0 => 0.0,
            Lobes::Phong { exponent, .. } => {
                let Some(shares) = self.phong_shares(pair.wo) else {
                    return 0.0;
                };
                let glossy = match shares.glossy > 0.0 {
                    true => shares.glossy * phong_pdf(pair.wo, pair.wi, *exponent),
                    false => 0.0,
                };
                shares.matte * pair.wi.z / PI + glossy
            }
        }
    }

    /// Draws a direction for two independent numbers `u_lobe` in `[0, 1)` and `u` in its square;
    /// `None` where nothing comes from the one that was drawn.
    pub fn sample(&self, view: &View, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let pair = view.pair(view.wo);
        let drawn = match &self.lobes {
            Lobes::Layered(layers) => layers.draw(&pair, u_lobe, u)?,
            Lobes::Phong { exponent, .. } => {
                self.draw_phong(pair.wo, *exponent, view.is_inside, u_lobe, u)?
            }
        };
        match drawn {
            Drawn::Specular(wi, weight) => Some(BsdfSample {
                wi: UnitVec3::normalize(view.frame.to_world(wi))?,
                weight,
                pdf: 0.0,
                is_specular: true,
                is_transmitted: wi.z < 0.0,
            }),
            Drawn::Area(wi) => self.of_area(view, wi),
        }
    }

    /// A sample of the lobes that have area.
    fn of_area(&self, view: &View, wi: Vec3) -> Option<BsdfSample> {
        let cos_i = wi.z;
        let wi = UnitVec3::normalize(view.frame.to_world(wi))?;
        let (value, pdf) = self.value_and_pdf(view, wi);
        let weight = value * (cos_i.abs() / pdf);
        let is_sound = pdf > 0.0 && pdf.is_finite() && weight.is_finite();
        is_sound.then_some(BsdfSample {
            wi,
            weight,
            pdf,
            is_specular: false,
            is_transmitted: cos_i < 0.0,
        })
    }

    fn draw_phong(
        &self,
        wo: Vec3,
        exponent: f32,
        is_inside: bool,
        u_lobe: f32,
        u: Vec2,
    ) -> Option<Drawn> {
        let shares = self.phong_shares(wo)?;
        let mut rest = u_lobe;
        let mut is_chosen = |share: f32| {
            rest -= share;
            rest < 0.0
        };
        if is_chosen(shares.matte) {
            return Some(Drawn::Area(square_to_hemisphere(u)));
        }
        if is_chosen(shares.glossy) {
            let wi = around_mirror(wo, exponent, u);
            return (wi.z > 0.0).then_some(Drawn::Area(wi));
        }
        let specular = &self.specular;
        let mirror = reflect(wo, Vec3::Z);
        // Rounding may leave a rest: it goes to the last lobe that there is.
        if is_chosen(shares.mirror) || shares.glass == 0.0 {
            let weight = specular.reflect / shares.mirror;
            return (shares.mirror > 0.0).then_some(Drawn::Specular(mirror, weight));
        }
        let eta = specular.relative_index(is_inside);
        let (reflected, through) = specular.glass(wo.z, eta);
        let reflection = reflected.max_channel() / (reflected + through).max_channel();
        let share = shares.glass * reflection;
        if is_chosen(share) {
            return Some(Drawn::Specular(mirror, reflected / share));
        }
        let beyond = match specular.is_straight() {
            true => -wo,
            false => refract(wo, Vec3::Z, eta)?,
        };
        Some(Drawn::Specular(beyond, through / (shares.glass - share)))
    }

    /// In proportion to what each lobe sends to `wo`, about; `None` where that is nothing.
    fn phong_shares(&self, wo: Vec3) -> Option<Shares> {
        let Lobes::Phong {
            diffuse,
            reflectance,
            ..
        } = &self.lobes
        else {
            return None;
        };
        let Specular {
            reflect, transmit, ..
        } = &self.specular;
        let parts = [diffuse, reflectance, reflect, transmit].map(|part| part.max_channel());
        let sum: f32 = parts.iter().sum();
        let [matte, glossy, mirror, glass] = parts.map(|part| part / sum);
        (sum > 0.0 && sum.is_finite() && wo.z > 0.0).then_some(Shares {
            matte,
            glossy,
            mirror,
            glass,
        })
    }
}
