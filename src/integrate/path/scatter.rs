//! Scattering by the base of every material, until all of them sample themselves.

use std::f32::consts::PI;

use crate::color::Rgb;
use crate::material::{reflect, refract};
use crate::math::{Frame, UnitVec3, Vec2};
use crate::prepare::Surface;
use crate::sampling::square_to_disk;

pub(super) struct BsdfSample {
    pub wi: UnitVec3,
    pub weight: Rgb,
    pub pdf: f32,
    pub is_specular: bool,
    pub is_transmitted: bool,
}

pub(super) trait Scatter {
    fn eval(&self, wi: UnitVec3) -> Rgb;
    fn pdf(&self, wi: UnitVec3) -> f32;
    fn sample(&self, u_lobe: f32, u: Vec2) -> Option<BsdfSample>;
    fn absorption(&self) -> Option<Rgb>;
}

fn chances(surface: &Surface) -> ([f32; 3], Rgb, Rgb) {
    let cos_o = surface
        .interaction
        .shading_normal
        .dot(*surface.interaction.wo)
        .min(1.0);
    let (mirrored, through) = surface.bsdf.specular.split(cos_o, surface.relative_index());
    let rough = surface.bsdf.without_mirrored().ambient(cos_o).max_channel();
    let all = [rough, mirrored.max_channel(), through.max_channel()];
    let sum: f32 = all.iter().sum();
    (
        all.map(|c| if sum > 0.0 { c / sum } else { 0.0 }),
        mirrored,
        through,
    )
}

impl Scatter for Surface<'_> {
    fn eval(&self, wi: UnitVec3) -> Rgb {
        let at = &self.interaction;
        if at.shading_normal.dot(*wi) <= 0.0 {
            return Rgb::BLACK;
        }
        self.bsdf
            .without_mirrored()
            .eval(at.shading_normal, at.wo, wi)
    }

    fn pdf(&self, wi: UnitVec3) -> f32 {
        chances(self).0[0] * self.interaction.shading_normal.dot(*wi).max(0.0) / PI
    }

    fn sample(&self, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let at = &self.interaction;
        let ([rough, mirror, glass], mirrored, through) = chances(self);
        if u_lobe < rough {
            let d = square_to_disk(u);
            let z = (1.0 - d.length_squared()).max(0.0).sqrt();
            let wi = UnitVec3::normalize(Frame::around(at.shading_normal).to_world(d.extend(z)))?;
            let pdf = self.pdf(wi);
            (pdf > 0.0).then(|| BsdfSample {
                wi,
                weight: self.eval(wi) * (at.shading_normal.dot(*wi) / pdf),
                pdf,
                is_specular: false,
                is_transmitted: false,
            })
        } else if u_lobe < rough + mirror {
            Some(BsdfSample {
                wi: UnitVec3::normalize(reflect(*at.wo, *at.shading_normal))?,
                weight: mirrored / mirror,
                pdf: mirror,
                is_specular: true,
                is_transmitted: false,
            })
        } else if glass > 0.0 {
            let wi = if self.bsdf.specular.is_straight() {
                -*at.wo
            } else {
                refract(*at.wo, *at.shading_normal, self.relative_index())?
            };
            Some(BsdfSample {
                wi: UnitVec3::normalize(wi)?,
                weight: through / glass,
                pdf: glass,
                is_specular: true,
                is_transmitted: true,
            })
        } else {
            None
        }
    }

    fn absorption(&self) -> Option<Rgb> {
        None
    }
}
