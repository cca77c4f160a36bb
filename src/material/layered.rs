//! The layers of a glTF material at one point: coat, sheen, and below them metal, glass, or matte
//! under a dielectric, in the coordinates of a shading frame.
//!
//! Layers let through what they do not send back themselves, at the less favourable of both
//! directions, so that nothing is made and both directions give the same value. Light that meets
//! two facets of a rough surface or more is added by its table (Kulla and Conty 2017, "Revisiting
//! Physically Based Shading at Imageworks").

use std::f32::consts::{PI, TAU};

use super::albedo;
use super::coat::{CoatLayer, coat_fresnel};
use super::facets::Facets;
use super::fresnel::{reflect, schlick, schlick_weight};
use super::glass::Glass;
use super::iridescence::Film;
use super::microfacet::Ggx;
use super::sheen::SheenLayer;
use crate::color::Rgb;
use crate::math::{Vec2, Vec3};
use crate::sampling::square_to_hemisphere;

/// More than tabulated albedos were found to be too low; that much of what they leave is left out.
const TABLE_ERROR: f32 = 1e-3;

/// GGX lobes of this α or below are perfect mirrors to a path: no light could be found in them.
pub const MIRROR_ALPHA: f32 = 1e-4;

/// What is left of lobes that rays of their own show already.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    /// Of facets of metal and of opaque dielectrics.
    pub facets: f32,
    /// Of the reflection of glass.
    pub glass: f32,
    /// Of the coat.
    pub coat: f32,
}

impl Kept {
    /// Everything.
    pub const ALL: Self = Self {
        facets: 1.0,
        glass: 1.0,
        coat: 1.0,
    };
}

/// All layers at one point.
#[derive(Clone, Copy, Debug)]
pub struct Layered {
    /// Reflectance of the matte base, without the dielectric above it.
    pub diffuse: Rgb,
    /// Share that the matte base lets through, as matte.
    pub translucent: Rgb,
    /// The opaque dielectric above it.
    pub dielectric: Facets,
    /// Metal.
    pub metal: Facets,
    /// Share of the surface that is glass, in `[0, 1]`, and what kind.
    pub glass: (f32, Glass),
    /// Roughness of all of these.
    pub ggx: Ggx,
    /// A film on all of these.
    pub film: Option<Film>,
    /// Fibres above them.
    pub sheen: Option<SheenLayer>,
    /// The coat over all.
    pub coat: Option<CoatLayer>,
    /// What is left of them; everything, but for techniques that follow mirror rays.
    pub kept: Kept,
    /// What is left where mirror rays are followed.
    pub unmirrored: Kept,
}

/// Two directions in a shading frame; `wo` is above.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// Towards the viewer.
    pub wo: Vec3,
    /// Where light comes from.
    pub wi: Vec3,
    /// Normal of the coat.
    pub coat_normal: Vec3,
    /// Whether the viewer is inside of a body of glass.
    pub is_inside: bool,
}

/// A direction that was drawn.
pub enum Drawn {
    /// By a lobe that has area.
    Area(Vec3),
    /// By a perfect mirror or by smooth glass, with its weight.
    Specular(Vec3, Rgb),
}

/// Probabilities with which lobes are chosen, in this order: coat, sheen, facets, glass, matte,
/// matte on the far side.
type Shares = [f32; 6];

impl Layered {
    /// What white facets send to a viewer, as [`albedo::ggx`] says it.
    fn albedo(&self, cos: f32) -> Vec2 {
        if self.is_mirror() {
            let white = schlick_weight(cos);
            return Vec2::new(1.0 - white, white);
        }
        self.of_least_loss(|alpha| albedo::ggx(cos, alpha))
    }

    /// Mean of [`Layered::albedo`] over the hemisphere.
    fn mean_albedo(&self) -> Vec2 {
        if self.is_mirror() {
            return Vec2::new(20.0, 1.0) / 21.0;
        }
        self.of_least_loss(albedo::ggx_mean)
    }

    /// Tables are those of round highlights: of both roughnesses of long ones the one counts
    /// that loses less, so that what is added for the loss is never too much.
    fn of_least_loss(&self, table: impl Fn(f32) -> Vec2) -> Vec2 {
        let Vec2 { x, y } = self.ggx.alpha;
        let along = table(x);
        if x == y {
            return along;
        }
        let across = table(y);
        if along.element_sum() > across.element_sum() {
            along
        } else {
            across
        }
    }

    /// Whether the base is a perfect mirror.
    fn is_mirror(&self) -> bool {
        self.ggx.alpha.max_element() <= MIRROR_ALPHA
    }

    /// The coat, as far as a viewer on this side sees it.
    fn coat(&self, pair: &Pair) -> Option<CoatLayer> {
        self.coat.filter(|_| !pair.is_inside)
    }

    fn sheen(&self, pair: &Pair) -> Option<SheenLayer> {
        self.sheen.filter(|_| !pair.is_inside)
    }

    /// Share that passes coat and sheen on the way to `wo` from `wi`.
    fn below_layers(&self, pair: &Pair) -> (f32, f32) {
        let at = |w: Vec3| {
            let coat = self.coat(pair).map_or(0.0, |coat| {
                coat.share * coat.albedo(w.dot(pair.coat_normal).abs())
            });
            let sheen = self.sheen(pair).map_or(0.0, |s| s.share(w.z.abs()));
            (1.0 - coat, 1.0 - sheen)
        };
        let (o, i) = (at(pair.wo), at(pair.wi));
        (o.0.min(i.0), o.1.min(i.1))
    }

    /// Value for light from either side, 1/sr: lobes that have area, and with `has_mirrors`
    /// perfect mirrors too, as very narrow ones. Rough glass lets light through to paths alone.
    pub fn value(&self, pair: &Pair, has_mirrors: bool) -> Rgb {
        let Pair { wo, wi, .. } = *pair;
        if wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        let (under_coat, under_sheen) = self.below_layers(pair);
        if wi.z <= 0.0 {
            return self.through(pair, has_mirrors) * (under_coat * under_sheen);
        }
        let coat = self
            .coat(pair)
            .map_or(0.0, |coat| coat.value(pair, has_mirrors) * self.kept.coat);
        let sheen = self.sheen(pair).map_or(Rgb::BLACK, |s| s.value(wo, wi));
        let base = self.facets(wo, wi, has_mirrors)
            + self.matte(wo.z, wi.z)
            + self.glass_reflection(pair, has_mirrors);
        Rgb::splat(coat) + (sheen + base * under_sheen) * under_coat
    }

    /// Reflection of opaque facets.
    fn facets(&self, wo: Vec3, wi: Vec3, has_mirrors: bool) -> Rgb {
        if self.is_mirror() && !has_mirrors {
            return Rgb::BLACK;
        }
        let half = (wo + wi).normalize_or(Vec3::Z);
        let fresnel = self.reflectance(wo.dot(half));
        let once = fresnel * (self.ggx.distribution(half) * self.ggx.visibility(wo, wi));
        let again = self.returned() * self.between_facets(wo.z, wi.z);
        (once + again) * self.kept.facets
    }

    /// Share that opaque facets reflect, at a cosine with them.
    fn reflectance(&self, cos: f32) -> Rgb {
        [&self.dielectric, &self.metal]
            .into_iter()
            .filter(|facets| facets.share > 0.0)
            .map(|facets| facets.fresnel(self.film.as_ref(), cos) * facets.share)
            .sum()
    }

    fn returned(&self) -> Rgb {
        let mean = self.mean_albedo();
        let white = mean.x + mean.y;
        [&self.dielectric, &self.metal]
            .into_iter()
            .map(|facets| facets.returned(white) * facets.share)
            .sum()
    }

    /// The lobe of light that met several white facets.
    fn between_facets(&self, cos_o: f32, cos_i: f32) -> f32 {
        let mean = self.mean_albedo();
        let mean = 1.0 - mean.x - mean.y;
        if mean < 1e-6 {
            return 0.0;
        }
        lost(self.albedo(cos_o)) * lost(self.albedo(cos_i)) / (PI * mean)
    }

    /// The matte base, of reflectance 1, through the dielectric above it.
    fn matte_lobe(&self, cos_o: f32, cos_i: f32) -> f32 {
        let (shown, mean) = self.shown_below();
        if mean < 1e-6 {
            return 0.0;
        }
        shown(cos_o) * shown(cos_i) / (PI * mean)
    }

    /// Share that reaches the matte base, by cosine, and its mean.
    fn shown_below(&self) -> (impl Fn(f32) -> f32, f32) {
        let facets = &self.dielectric;
        let mean = self.mean_albedo();
        let returned = facets.returned(mean.x + mean.y).max_channel();
        let shown = move |cos: f32| {
            let hidden = facets.hidden(self.albedo(cos), returned);
            (1.0 - hidden * (1.0 + TABLE_ERROR)).max(0.0)
        };
        (shown, 1.0 - facets.hidden(mean, returned))
    }

    fn matte(&self, cos_o: f32, cos_i: f32) -> Rgb {
        if self.diffuse.is_black() {
            return Rgb::BLACK;
        }
        self.diffuse * self.matte_lobe(cos_o, cos_i)
    }

    fn glass_reflection(&self, pair: &Pair, has_mirrors: bool) -> Rgb {
        let (share, glass) = &self.glass;
        let is_hidden = glass.is_invisible() || self.is_mirror() && !has_mirrors;
        if *share * self.kept.glass == 0.0 || is_hidden {
            return Rgb::BLACK;
        }
        let once = glass.reflected(&self.ggx, pair.wo, pair.wi, pair.is_inside);
        let again = match has_mirrors {
            true => Rgb::BLACK,
            false => self.between_borders(pair, glass.reflectance(0.5, false)),
        };
        (once + again) * (share * self.kept.glass)
    }

    /// What leaves rough glass after several facets, on one side: of a pane, `part` of it.
    fn between_borders(&self, pair: &Pair, part: Rgb) -> Rgb {
        let (_, glass) = &self.glass;
        match glass.is_thin {
            true => part * self.between_facets(pair.wo.z.abs(), pair.wi.z.abs()),
            false => glass.between_facets(&self.ggx, pair.wo, pair.wi, pair.is_inside),
        }
    }

    /// Value for light from the far side, below coat and sheen.
    fn through(&self, pair: &Pair, has_mirrors: bool) -> Rgb {
        let Pair {
            wo, wi, is_inside, ..
        } = *pair;
        if wi.z >= 0.0 {
            return Rgb::BLACK;
        }
        let matte = match self.translucent.is_black() {
            true => Rgb::BLACK,
            false => self.translucent * self.matte_lobe(wo.z, -wi.z),
        };
        let (share, glass) = &self.glass;
        if *share == 0.0 || has_mirrors || self.is_mirror() || glass.is_invisible() {
            return matte;
        }
        let once = glass.transmitted(&self.ggx, wo, wi, is_inside);
        let part = Rgb::WHITE - glass.reflectance(0.5, false);
        let again = self.between_borders(pair, part * glass.tint);
        matte + (once + again) * *share
    }

    /// Density of [`Layered::draw`] for lobes that have area.
    pub fn pdf(&self, pair: &Pair) -> f32 {
        let Pair {
            wo, wi, is_inside, ..
        } = *pair;
        let Some(shares) = self.shares(pair) else {
            return 0.0;
        };
        let [coat, sheen, facets, glass, matte, far] = shares;
        let mut density = 0.0;
        if wi.z > 0.0 {
            density += matte * wi.z / PI + sheen / TAU;
            if let Some(layer) = self.coat(pair).filter(|_| coat > 0.0) {
                density += coat * layer.pdf(pair);
            }
            if facets > 0.0 && !self.is_mirror() {
                let half = (wo + wi).normalize_or(Vec3::Z);
                density += facets * self.ggx.pdf(wo, half) / (4.0 * wo.dot(half));
            }
        } else {
            density += far * -wi.z / PI;
        }
        let is_rough = !self.is_mirror() && !self.glass.1.is_invisible();
        if glass > 0.0 && is_rough && wi.z != 0.0 {
            density += glass * self.glass.1.pdf(&self.ggx, wo, wi, is_inside);
        }
        density
    }

    /// Draws a direction for independent numbers in `[0, 1)`; `pair.wi` is not read.
    pub fn draw(&self, pair: &Pair, u_lobe: f32, u: Vec2) -> Option<Drawn> {
        let Pair {
            wo, coat_normal, ..
        } = *pair;
        let shares = self.shares(pair)?;
        let mut rest = u_lobe;
        // Rounding may leave a rest: it goes to the last lobe that there is.
        let last = shares.iter().rposition(|&share| share > 0.0)?;
        let mut lobe = 0;
        while lobe < last && rest >= shares[lobe] {
            rest -= shares[lobe];
            lobe += 1;
        }
        let share = shares[lobe];
        // The same number again, for a choice within the lobe.
        let choice = (rest / share).clamp(0.0, crate::math::ONE_MINUS_EPSILON);
        let weighed = |wi: Vec3, weight: Rgb| {
            let (coat, sheen) = self.below_layers(&Pair { wi, ..*pair });
            Some(Drawn::Specular(wi, weight * (coat * sheen / share)))
        };
        match lobe {
            0 => {
                let coat = self.coat(pair)?;
                let (wi, cos) = coat.draw(wo, coat_normal, u)?;
                // The coat's own normal may send light below the horizon of what is under it.
                if wi.z <= 0.0 {
                    return None;
                }
                if coat.alpha > MIRROR_ALPHA {
                    return Some(Drawn::Area(wi));
                }
                let weight = Rgb::splat(coat.share * coat_fresnel(cos));
                Some(Drawn::Specular(wi, weight / share))
            }
            1 => {
                let (sin, cos) = (TAU * u.y).sin_cos();
                let ring = (1.0 - u.x * u.x).max(0.0).sqrt();
                Some(Drawn::Area(Vec3::new(ring * cos, ring * sin, u.x)))
            }
            2 if self.is_mirror() => weighed(reflect(wo, Vec3::Z), self.reflectance(wo.z)),
            2 => {
                let wi = reflect(wo, self.ggx.sample(wo, u));
                (wi.z > 0.0).then_some(Drawn::Area(wi))
            }
            3 => {
                let (part, glass) = &self.glass;
                if glass.is_invisible() {
                    return weighed(-wo, glass.tint * *part);
                }
                let ggx = (!self.is_mirror()).then_some(&self.ggx);
                let drawn = glass.sample(ggx, wo, pair.is_inside, choice, u)?;
                match ggx {
                    Some(_) => Some(Drawn::Area(drawn.wi)),
                    None => weighed(drawn.wi, drawn.weight * *part),
                }
            }
            _ => {
                let wi = square_to_hemisphere(u);
                let z = if lobe == 4 { wi.z } else { -wi.z };
                Some(Drawn::Area(Vec3 { z, ..wi }))
            }
        }
    }

    /// Share that glass lets through without a bend; `pair.wi` is the way on.
    pub fn straight(&self, pair: &Pair) -> Rgb {
        let (share, glass) = &self.glass;
        let (coat, sheen) = self.below_layers(pair);
        let through = if *share == 0.0 || pair.wo.z <= 0.0 {
            Rgb::BLACK
        } else if glass.is_invisible() {
            glass.tint
        } else if glass.is_thin && self.is_mirror() {
            (Rgb::WHITE - glass.reflectance(pair.wo.z, false)) * glass.tint
        } else {
            Rgb::BLACK
        };
        through * (share * coat * sheen)
    }

    /// In proportion to what each lobe sends to `wo`, about; `None` where that is nothing.
    fn shares(&self, pair: &Pair) -> Option<Shares> {
        let cos = pair.wo.z;
        if cos <= 0.0 {
            return None;
        }
        let coat_cos = pair.wo.dot(pair.coat_normal);
        let coat = self.coat(pair).filter(|_| coat_cos > 0.0);
        let coat = coat.map_or(0.0, |coat| coat.share * coat.albedo(coat_cos));
        let sheen = self.sheen(pair).map_or(0.0, |s| s.share(cos));
        let facets = self.reflectance(cos).max_channel();
        let (glass_share, glass) = &self.glass;
        let table = self.albedo(cos);
        let lost = lost(table);
        let shown = self.shown_below().0(cos);
        let again = self.returned().max_channel() * lost;
        let is_rough = *glass_share > 0.0 && !self.is_mirror() && !glass.is_invisible();
        let (near, far) = match is_rough {
            true if glass.is_thin => (0.5 * lost, lost),
            true => glass.lost(&self.ggx, cos, pair.is_inside),
            false => (0.0, 0.0),
        };
        let glass = match *glass_share > 0.0 {
            true => {
                let fresnel = glass.reflectance(cos, pair.is_inside);
                let through = (Rgb::WHITE - fresnel) * glass.tint;
                *glass_share * (fresnel + through).max_channel()
            }
            false => 0.0,
        };
        let below = (1.0 - coat) * (1.0 - sheen);
        let shares = [
            coat,
            sheen * (1.0 - coat),
            facets * below,
            glass * below,
            (self.diffuse.max_channel() * shown + again + near * glass_share) * below,
            (self.translucent.max_channel() * shown + far * glass_share) * below,
        ];
        let sum: f32 = shares.iter().sum();
        (sum > 0.0 && sum.is_finite()).then(|| shares.map(|share| share / sum))
    }

    /// Share of uniform ambient light that is scattered to `wo`, but for what rays of their own
    /// bring from mirrors and glass.
    pub fn ambient(&self, pair: &Pair) -> Rgb {
        let cos = pair.wo.z.max(0.0);
        let table = self.albedo(cos);
        let lost = lost(table);
        let facets =
            |part: &Facets| (part.bound * table.x + Rgb::splat(part.f90 * table.y)) * part.share;
        let all = facets(&self.dielectric) + facets(&self.metal) + self.returned() * lost;
        // The matte base gets what neither the table nor the mirror ray shows.
        let mirrored = 1.0 - self.unmirrored.facets;
        let hidden = 1.0 - self.shown_below().0(cos);
        let by_mirror = schlick(self.dielectric.bound, self.dielectric.f90, cos).max_channel();
        let shown = 1.0 - (hidden * self.unmirrored.facets + by_mirror * mirrored);
        let base =
            all * self.unmirrored.facets + (self.diffuse + self.translucent) * shown.max(0.0);
        let coat = self.coat(pair).map_or((0.0, 0.0), |coat| {
            let cos = pair.wo.dot(pair.coat_normal).max(0.0);
            let all = coat.share * coat.albedo(cos);
            let mirrored = coat.share * coat_fresnel(cos) * (1.0 - self.unmirrored.coat);
            (
                all * self.unmirrored.coat,
                all * self.unmirrored.coat + mirrored,
            )
        });
        let (color, sheen) = self.sheen(pair).map_or((Rgb::BLACK, 0.0), |s| {
            let share = s.share(cos);
            (s.color * (share / s.color.max_channel().max(1e-6)), share)
        });
        Rgb::splat(coat.0) + (color + base * (1.0 - sheen)) * (1.0 - coat.1)
    }
}

/// What white facets do not send to a viewer, and what lies between them may: less than is missing by what the
/// table may be off, so that no energy is made.
fn lost(albedo: Vec2) -> f32 {
    (1.0 - albedo.x - albedo.y - TABLE_ERROR).max(0.0)
}
