//! Scattering at one point of a surface.

use std::f32::consts::PI;

use crate::color::Rgb;
use crate::math::{Frame, UnitVec3, Vec3};

use super::fresnel::{fresnel_dielectric, schlick_weight};
use super::layered::{Layered, Pair};
use super::phong::phong_lobe;

/// Scattering at one point of a surface, of either kind of material.
///
/// Directions point away from the surface and the viewer's is on the side of the normal; the cosine is
/// never included.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    /// What scatters light in many directions.
    pub lobes: Lobes,
    /// Perfect mirror and what is let through: of [`Lobes::Phong`] a part of its own; of
    /// [`Lobes::Layered`] what a technique shows of its lobes that follows mirror rays alone.
    pub specular: Specular,
}

/// What scatters light in many directions.
#[derive(Clone, Copy, Debug)]
pub enum Lobes {
    /// Lambert's lobe and Phong's, normalised by (n+2)/(2π) so that it never makes energy
    /// (Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model for Physically Based Rendering").
    Phong {
        /// Reflectance of the Lambertian lobe.
        diffuse: Rgb,
        /// Reflectance of Phong's.
        reflectance: Rgb,
        /// Its exponent n, at least 0.
        exponent: f32,
    },
    /// glTF's layers.
    Layered(Layered),
}

/// How a surface is seen: what scattering needs beside the material.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Around the shading normal, on the viewer's side.
    pub frame: Frame,
    /// Normal of a coat, on the viewer's side.
    pub coat_normal: UnitVec3,
    /// Towards the viewer, in the world.
    pub wo: UnitVec3,
    /// Whether the viewer is inside of a body that light passes.
    pub is_inside: bool,
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
    /// A coat over all of this: its share, and how much of its reflection is a mirror's.
    pub coat: [f32; 2],
}

impl Specular {
    /// Neither mirror nor glass.
    pub const NONE: Self = Self {
        reflect: Rgb::BLACK,
        reflect_grazing: Rgb::BLACK,
        transmit: Rgb::BLACK,
        index_of_refraction: 1.0,
        is_thin: true,
        coat: [0.0; 2],
    };

    /// The shares that are mirrored and let through at `cos_o`, for `eta` as in
    /// [`fresnel_dielectric`].
    pub fn split(&self, cos_o: f32, eta: f32) -> (Rgb, Rgb) {
        let mut mirrored = self.reflect + self.reflect_grazing * schlick_weight(cos_o);
        let mut through = Rgb::BLACK;
        if !self.transmit.is_black() {
            let (reflected, refracted) = self.glass(cos_o, eta);
            mirrored += reflected;
            through = refracted;
        }
        let [share, mirror] = self.coat;
        if share > 0.0 {
            let coat = share * super::coat::coat_fresnel(cos_o);
            mirrored = mirrored * (1.0 - coat) + Rgb::splat(coat * mirror);
            through = through * (1.0 - coat);
        }
        (mirrored, through)
    }

    /// What glass mirrors and lets through.
    pub fn glass(&self, cos_o: f32, eta: f32) -> (Rgb, Rgb) {
        let reflected = fresnel_dielectric(cos_o, eta);
        (self.transmit * reflected, self.transmit * (1.0 - reflected))
    }

    /// Whether light that is let through keeps its direction.
    pub fn is_straight(&self) -> bool {
        self.is_thin || self.index_of_refraction == 1.0
    }

    /// Index of the side beyond over the index of the viewer's side.
    pub fn relative_index(&self, is_inside: bool) -> f32 {
        if is_inside && !self.is_thin {
            1.0 / self.index_of_refraction
        } else {
            self.index_of_refraction
        }
    }
}

/// A surface that gives back no light.
pub const BLACK: Bsdf = Bsdf {
    lobes: Lobes::Phong {
        diffuse: Rgb::BLACK,
        reflectance: Rgb::BLACK,
        exponent: 1.0,
    },
    specular: Specular::NONE,
};

impl View {
    /// A view of a surface without bumps, from outside.
    pub fn plain(normal: UnitVec3, wo: UnitVec3) -> Self {
        Self {
            frame: Frame::around(normal),
            coat_normal: normal,
            wo,
            is_inside: false,
        }
    }

    /// Both directions in the coordinates of the frame.
    pub(super) fn pair(&self, wi: UnitVec3) -> Pair {
        Pair {
            wo: self.frame.to_local(*self.wo),
            wi: self.frame.to_local(*wi),
            coat_normal: self.frame.to_local(*self.coat_normal),
            is_inside: self.is_inside,
        }
    }
}

impl Bsdf {
    /// Value for light that comes from `wi` and leaves to `wo`, 1/sr, of a surface without bumps;
    /// perfect mirrors of glTF's layers count as very narrow lobes.
    pub fn eval(&self, normal: UnitVec3, wo: UnitVec3, wi: UnitVec3) -> Rgb {
        self.shown(&View::plain(normal, wo), wi)
    }

    /// As [`Bsdf::value`], for a technique that follows mirror rays, and that shows lights
    /// without a surface in smooth mirrors: these count as very narrow lobes.
    pub fn shown(&self, view: &View, wi: UnitVec3) -> Rgb {
        self.lobes.value(&view.pair(wi), true)
    }

    /// Value for light that comes from `wi`, on either side, 1/sr: all lobes that have area.
    pub fn value(&self, view: &View, wi: UnitVec3) -> Rgb {
        self.lobes.value(&view.pair(wi), false)
    }

    /// The same without light from nothing: colours of MTL files often add up to more than 1, and techniques that follow
    /// light again and again, as `path` does, would meet what they make at each bounce.
    ///
    /// Highlights give way first: beside a mirror they stand for what it shows anyway. What is still too much is
    /// dimmed, channel by channel.
    pub fn conserving(mut self) -> Self {
        let specular = &mut self.specular;
        let Lobes::Phong {
            diffuse,
            reflectance,
            ..
        } = &mut self.lobes
        else {
            return self;
        };
        let others = *diffuse + specular.reflect + specular.transmit;
        if (others + *reflectance).max_channel() > 1.0 {
            let kept = others.map(|sum| 1.0 / sum.max(1.0));
            for color in [diffuse, &mut specular.reflect, &mut specular.transmit] {
                *color *= kept;
            }
            let room = others.map(|sum| (1.0 - sum).max(0.0));
            *reflectance = Rgb::new(
                reflectance.r.min(room.r),
                reflectance.g.min(room.g),
                reflectance.b.min(room.b),
            );
        }
        self
    }

    /// Reflectance of its matte base.
    pub fn diffuse(&self) -> Rgb {
        match &self.lobes {
            Lobes::Phong { diffuse, .. } => *diffuse,
            Lobes::Layered(layers) => layers.diffuse,
        }
    }

    /// [`Bsdf::value`] where that is the same for all directions above the surface.
    pub fn matte(&self) -> Option<Rgb> {
        match &self.lobes {
            Lobes::Phong {
                diffuse,
                reflectance,
                ..
            } if reflectance.is_black() => Some(lambert(*diffuse)),
            _ => None,
        }
    }

    /// Without what mirror rays see of lights that have a surface, which would count twice; `None` where
    /// there is no such thing.
    pub fn without_mirrored(&self) -> Option<Self> {
        match &self.lobes {
            Lobes::Phong { .. } => None,
            Lobes::Layered(layers) => Some(Self {
                lobes: Lobes::Layered(Layered {
                    kept: layers.unmirrored,
                    ..*layers
                }),
                ..*self
            }),
        }
    }

    /// Share of the light from behind that goes on as if nothing were there, but for its colour:
    /// what [`Bsdf::sample`] sends straight on.
    pub fn straight(&self, view: &View) -> Rgb {
        if !self.specular.is_straight() {
            return Rgb::BLACK;
        }
        let pair = view.pair(-view.wo);
        match &self.lobes {
            Lobes::Layered(layers) => layers.straight(&pair),
            Lobes::Phong { .. } => {
                let specular = self.conserving().specular;
                let eta = specular.relative_index(view.is_inside);
                specular.glass(pair.wo.z, eta).1
            }
        }
    }

    /// Whether light from the far side is scattered to the viewer.
    pub fn is_translucent(&self) -> bool {
        match &self.lobes {
            Lobes::Phong { .. } => false,
            Lobes::Layered(layers) => !layers.translucent.is_black(),
        }
    }

    /// Share of uniform ambient light that is scattered to the viewer; what rays of their own
    /// bring from mirrors and glass is left out. Phong's lobe, whose author gave it lights alone to
    /// show, takes none.
    pub fn ambient(&self, view: &View) -> Rgb {
        match &self.lobes {
            Lobes::Phong { .. } => self.diffuse(),
            Lobes::Layered(layers) => layers.ambient(&view.pair(view.wo)),
        }
    }
}

/// Lambert's lobe, 1/sr.
fn lambert(reflectance: Rgb) -> Rgb {
    reflectance * (1.0 / PI)
}

impl Lobes {
    pub(super) fn value(&self, pair: &Pair, has_mirrors: bool) -> Rgb {
        match self {
            Self::Layered(layers) => layers.value(pair, has_mirrors),
            Self::Phong { .. } if pair.wi.z <= 0.0 || pair.wo.z <= 0.0 => Rgb::BLACK,
            Self::Phong {
                diffuse,
                reflectance,
                exponent,
            } => {
                let matte = lambert(*diffuse);
                if reflectance.is_black() {
                    return matte;
                }
                matte + *reflectance * phong_lobe(Vec3::Z, pair.wo, pair.wi, *exponent)
            }
        }
    }
}
