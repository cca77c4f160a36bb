//! Smooth and rough borders of clear bodies, and thin panes, in the coordinates of a shading frame.
//!
//! What is carried along a ray is basic radiance, L/n², which a border changes by what it
//! reflects alone.

use std::f32::consts::PI;

use super::border::Border;
use super::fresnel::{fresnel_dielectric, reflect, refract};
use super::iridescence::Film;
use super::microfacet::Ggx;
use crate::color::Rgb;
use crate::math::{Vec2, Vec3};

/// A clear border.
#[derive(Clone, Copy, Debug)]
pub struct Glass {
    /// Colour of what is let through.
    pub tint: Rgb,
    /// Reflectance at normal incidence and at grazing incidence (`KHR_materials_specular`).
    pub f0: Rgb,
    /// See `f0`.
    pub f90: f32,
    /// Index of the inside over that of the outside.
    pub index: f32,
    /// Half the difference of the index between red and blue (`KHR_materials_dispersion`).
    pub spread: f32,
    /// Whether it is a pane, which light crosses without a bend.
    pub is_thin: bool,
    /// A film upon it, which is seen from outside.
    pub film: Option<Film>,
}

/// A direction that glass sends a path to, before it is known what comes from there.
pub struct GlassSample {
    /// The direction.
    pub wi: Vec3,
    /// Its weight where the border is smooth; the density is of no area then.
    pub weight: Rgb,
}

impl Glass {
    /// Whether light is let through without a bend, whatever the roughness.
    pub fn is_invisible(&self) -> bool {
        self.index == 1.0 && self.spread == 0.0 && !self.is_thin
    }

    fn is_dispersive(&self) -> bool {
        self.spread > 0.0 && !self.is_thin
    }

    /// Index of the side beyond over that of the viewer's, per channel.
    fn etas(&self, is_inside: bool) -> [f32; 3] {
        let spread = if self.is_dispersive() {
            self.spread
        } else {
            0.0
        };
        [-spread, 0.0, spread].map(|offset| {
            let index = if spread > 0.0 {
                (self.index + offset).max(1.0)
            } else {
                self.index
            };
            if is_inside { 1.0 / index } else { index }
        })
    }

    /// Share that is reflected, for a cosine with the facet.
    fn fresnel(&self, cos: f32, etas: [f32; 3]) -> Rgb {
        let plain = |eta: f32, f0: f32| {
            let exact = fresnel_dielectric(cos.min(1.0), eta);
            let normal = fresnel_dielectric(1.0, eta);
            // From 0 at normal incidence to 1 at grazing incidence, where f90 is reached.
            let white = if normal < 1.0 {
                (exact - normal) / (1.0 - normal)
            } else {
                0.0
            };
            if exact == 1.0 && eta < 1.0 {
                1.0
            } else {
                f0 + (self.f90 - f0) * white
            }
        };
        let [er, eg, eb] = etas;
        let all = Rgb::new(
            plain(er, self.f0.r),
            plain(eg, self.f0.g),
            plain(eb, self.f0.b),
        );
        match &self.film {
            Some(film) if eg >= 1.0 => film.over(self.f0, all, cos),
            _ => all,
        }
    }

    /// Probability of following what is reflected.
    fn reflection(&self, fresnel: Rgb) -> f32 {
        let through = ((Rgb::WHITE - fresnel) * self.tint).max_channel();
        let reflected = fresnel.max_channel();
        if reflected + through > 0.0 {
            reflected / (reflected + through)
        } else {
            1.0
        }
    }

    /// Mean share that is reflected at `cos`, for the choice among lobes.
    pub fn reflectance(&self, cos: f32, is_inside: bool) -> Rgb {
        self.fresnel(cos, self.etas(is_inside))
    }

    /// Value for light that is reflected, `wi` above the surface.
    pub fn reflected(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, is_inside: bool) -> Rgb {
        let half = (wo + wi).normalize_or(Vec3::Z);
        let fresnel = self.fresnel(wo.dot(half), self.etas(is_inside));
        fresnel * (ggx.distribution(half) * ggx.visibility(wo, wi))
    }

    /// Value for light that is let through, `wi` below the surface
    /// (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces").
    pub fn transmitted(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, is_inside: bool) -> Rgb {
        let etas = self.etas(is_inside);
        if self.is_thin {
            // The reflected lobe, folded to the other side.
            let wi = wi * Vec3::new(1.0, 1.0, -1.0);
            let half = (wo + wi).normalize_or(Vec3::Z);
            let through = Rgb::WHITE - self.fresnel(wo.dot(half), etas);
            return self.tint * through * (ggx.distribution(half) * ggx.visibility(wo, wi));
        }
        let channel = |eta: f32| {
            let Some((half, cos_o, cos_i)) = facet(wo, wi, eta) else {
                return Rgb::BLACK;
            };
            let bend = cos_i + cos_o / eta;
            let lobe = ggx.distribution(half) * ggx.visibility(wo, wi) * 4.0 * cos_o * cos_i.abs();
            (Rgb::WHITE - self.fresnel(cos_o, etas)) * (lobe / (bend * bend))
        };
        if !self.is_dispersive() {
            return self.tint * channel(etas[0]);
        }
        let [r, g, b] = etas.map(channel);
        self.tint * Rgb::new(r.r, g.g, b.b)
    }

    /// A rough border of a body from the viewer's side and from the other, per channel.
    fn borders(&self, ggx: &Ggx, is_inside: bool) -> [(Border, Border); 3] {
        let [r, g, b] = self.etas(is_inside);
        let side = |eta: f32, f0: f32| {
            // A film may reflect less, and then less is lost.
            let has_film = self.film.is_some() && eta >= 1.0;
            Border {
                alpha: ggx.alpha,
                eta,
                f0: if has_film { 0.0 } else { f0 },
                f90: self.f90,
            }
        };
        [(r, self.f0.r), (g, self.f0.g), (b, self.f0.b)]
            .map(|(eta, f0)| (side(eta, f0), side(1.0 / eta, f0)))
    }

    /// Value for light that crossed several facets of a rough border of a body.
    ///
    /// It leaves to both sides in proportion to what each misses, which adds up to what is lost
    /// and is the same both ways: the lobe of Kulla and Conty (2017, "Revisiting Physically Based
    /// Shading at Imageworks") for both hemispheres at once, each by the square of its index.
    pub fn between_facets(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, is_inside: bool) -> Rgb {
        if !self.is_lossy() {
            return Rgb::BLACK;
        }
        let channel = |(near, far): &(Border, Border)| {
            let squared = near.eta * near.eta;
            let all = PI * (near.mean_lost() + squared * far.mean_lost());
            let met = if wi.z > 0.0 {
                near.lost(wi.z)
            } else {
                squared * far.lost(-wi.z)
            };
            near.lost(wo.z) * met / all
        };
        let value = self.per_channel(&self.borders(ggx, is_inside), channel);
        if wi.z > 0.0 { value } else { value * self.tint }
    }

    /// What [`Glass::between_facets`] sends to a viewer from both sides: from the viewer's, and from the other.
    pub fn lost(&self, ggx: &Ggx, cos: f32, is_inside: bool) -> (f32, f32) {
        if !self.is_lossy() {
            return (0.0, 0.0);
        }
        let [_, (near, far), _] = self.borders(ggx, is_inside);
        let (here, there) = (near.mean_lost(), near.eta * near.eta * far.mean_lost());
        let lost = near.lost(cos) / (here + there);
        (lost * here, lost * there * self.tint.max_channel())
    }

    /// Whether it is the border of a body that mirrors not everything.
    fn is_lossy(&self) -> bool {
        !self.is_thin && self.index > 0.0 && self.index.is_finite()
    }

    /// The same value thrice where the channels do not differ.
    fn per_channel<T>(&self, parts: &[T; 3], value: impl Fn(&T) -> f32) -> Rgb {
        let [r, g, b] = parts;
        let is_grey = self.f0.r == self.f0.g && self.f0.g == self.f0.b;
        if is_grey && !self.is_dispersive() {
            return Rgb::splat(value(g));
        }
        Rgb::new(value(r), value(g), value(b))
    }

    /// Density of [`Glass::sample`] of a rough border.
    pub fn pdf(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, is_inside: bool) -> f32 {
        let etas = self.etas(is_inside);
        if wi.z > 0.0 || self.is_thin {
            let above = Vec3::new(wi.x, wi.y, wi.z.abs());
            let half = (wo + above).normalize_or(Vec3::Z);
            let cos = wo.dot(half);
            let reflection = self.reflection(self.fresnel(cos, etas));
            let choice = if wi.z > 0.0 {
                reflection
            } else {
                1.0 - reflection
            };
            return choice * ggx.pdf(wo, half) / (4.0 * cos);
        }
        let channel = |eta: f32| {
            let Some((half, cos_o, cos_i)) = facet(wo, wi, eta) else {
                return 0.0;
            };
            let bend = cos_i + cos_o / eta;
            let choice = 1.0 - self.reflection(self.fresnel(cos_o, etas));
            choice * ggx.pdf(wo, half) * cos_i.abs() / (bend * bend)
        };
        if self.is_dispersive() {
            etas.map(channel).into_iter().sum::<f32>() / 3.0
        } else {
            channel(etas[0])
        }
    }

    /// A direction, for `choice` and `u` in `[0, 1)`; of a smooth border where `ggx` is `None`.
    /// Light that is split into its colours takes the way of one of them, chosen evenly.
    pub fn sample(
        &self,
        ggx: Option<&Ggx>,
        wo: Vec3,
        is_inside: bool,
        choice: f32,
        u: Vec2,
    ) -> Option<GlassSample> {
        let etas = self.etas(is_inside);
        let half = ggx.map_or(Vec3::Z, |ggx| ggx.sample(wo, u));
        let fresnel = self.fresnel(wo.dot(half), etas);
        let reflection = self.reflection(fresnel);
        let mirrored = reflect(wo, half);
        if choice < reflection {
            let weight = fresnel / reflection;
            return (mirrored.z > 0.0).then_some(GlassSample {
                wi: mirrored,
                weight,
            });
        }
        let mut through = (Rgb::WHITE - fresnel) * self.tint / (1.0 - reflection);
        let wi = if self.is_thin {
            mirrored * Vec3::new(1.0, 1.0, -1.0)
        } else if self.is_dispersive() {
            let rest = (choice - reflection) / (1.0 - reflection);
            let channel = ((3.0 * rest) as usize).min(2);
            let mut one = [0.0; 3];
            one[channel] = 3.0;
            through *= Rgb::from(one);
            refract(wo, half, etas[channel])?
        } else {
            refract(wo, half, etas[0])?
        };
        (wi.z < 0.0).then_some(GlassSample {
            wi,
            weight: through,
        })
    }
}

/// The normal of the facet that bends `wo` to `wi`, and its cosines with both: that with `wo` is
/// above 0, that with `wi` below. `None` where there is none.
fn facet(wo: Vec3, wi: Vec3, eta: f32) -> Option<(Vec3, f32, f32)> {
    let along = wo + wi * eta;
    let half = along.try_normalize()?;
    let half = if half.z < 0.0 { -half } else { half };
    let (cos_o, cos_i) = (wo.dot(half), wi.dot(half));
    (cos_o > 0.0 && cos_i < 0.0).then_some((half, cos_o, cos_i))
}
