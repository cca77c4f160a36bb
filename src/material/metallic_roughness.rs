//! glTF's metallic-roughness model.

use super::coat::CoatLayer;
use super::extension::{Anisotropy, Clearcoat, DiffuseTransmission, Iridescence, Sheen};
use super::facets::Facets;
use super::glass::Glass;
use super::iridescence::Film;
use super::layered::{Kept, Layered, MIRROR_ALPHA};
use super::microfacet::Ggx;
use super::sheen::{MIN_SHEEN_ALPHA, SheenLayer};
use super::{Bsdf, Lobes, Lookup, Specular};
use crate::color::Rgb;
use crate::math::Vec2;
use crate::texture::Encoding;
use crate::texture::{TexturedRgb, TexturedScalar};

/// The parameters of a glTF material, with those extensions that change its base layer.
#[derive(Clone, Debug)]
pub struct MetallicRoughness {
    /// Base colour; the alpha of the same texture is the material's opacity.
    pub base_color: TexturedRgb,
    /// 0 dielectric, 1 metal (blue channel).
    pub metallic: TexturedScalar,
    /// Perceptual roughness; its square is GGX's α (green channel).
    pub roughness: TexturedScalar,
    /// Share of ambient light that arrives (red channel); the factor is the strength: occlusion
    /// is `1 + strength (texture - 1)`.
    pub occlusion: TexturedScalar,
    /// `KHR_materials_ior`; 1.5 by default.
    pub index_of_refraction: f32,
    /// `KHR_materials_specular`: strength of the dielectric reflection (alpha channel).
    pub specular: TexturedScalar,
    /// `KHR_materials_specular`: its colour at normal incidence.
    pub specular_color: TexturedRgb,
    /// `KHR_materials_transmission` (red channel).
    pub transmission: TexturedScalar,
    /// `KHR_materials_volume`: thickness in the mesh's units (green channel); 0 is thin-walled.
    pub thickness: TexturedScalar,
    /// `KHR_materials_volume`: colour of white light after `attenuation_distance`.
    pub attenuation_color: Rgb,
    /// `KHR_materials_volume`, in world units; infinite for a clear medium.
    pub attenuation_distance: f32,
    /// `KHR_materials_dispersion`: 20 over the Abbe number.
    pub dispersion: f32,
    /// Whether `roughness` holds 1 - roughness (`KHR_materials_pbrSpecularGlossiness`).
    pub is_glossiness: bool,
    /// `KHR_materials_clearcoat`.
    pub clearcoat: Option<Clearcoat>,
    /// `KHR_materials_sheen`.
    pub sheen: Option<Sheen>,
    /// `KHR_materials_anisotropy`.
    pub anisotropy: Option<Anisotropy>,
    /// `KHR_materials_iridescence`.
    pub iridescence: Option<Iridescence>,
    /// `KHR_materials_diffuse_transmission`.
    pub diffuse_transmission: Option<DiffuseTransmission>,
}

impl Default for MetallicRoughness {
    /// What the glTF specification says of a material that says nothing.
    fn default() -> Self {
        Self {
            base_color: TexturedRgb::constant(Rgb::WHITE),
            metallic: TexturedScalar::constant(1.0),
            roughness: TexturedScalar::constant(1.0),
            occlusion: TexturedScalar::constant(1.0),
            index_of_refraction: 1.5,
            specular: TexturedScalar::constant(1.0),
            specular_color: TexturedRgb::constant(Rgb::WHITE),
            transmission: TexturedScalar::constant(0.0),
            thickness: TexturedScalar::constant(0.0),
            attenuation_color: Rgb::WHITE,
            attenuation_distance: f32::INFINITY,
            dispersion: 0.0,
            is_glossiness: false,
            clearcoat: None,
            sheen: None,
            anisotropy: None,
            iridescence: None,
            diffuse_transmission: None,
        }
    }
}

/// Below this roughness a `whitted` picture shows mirror images, fading in as it falls to 0.
const MIRROR_ROUGHNESS: f32 = 0.3;

/// How much of the reflection of a surface such a mirror image shows.
fn mirror_share(roughness: f32) -> f32 {
    (1.0 - roughness / MIRROR_ROUGHNESS).max(0.0).powi(2)
}

impl MetallicRoughness {
    /// How it scatters light where `lookup` is.
    ///
    /// Diffuse base under GGX, after appendix B of the glTF 2.0 specification, with the layers
    /// that extensions add. Techniques that follow mirror rays alone leave rough reflection of
    /// the surroundings to `ambient`; smooth surfaces mirror them.
    pub fn bsdf(&self, lookup: &Lookup) -> Bsdf {
        let base = lookup.rgb(&self.base_color) * lookup.vertex_rgb();
        let metallic = lookup.scalar(&self.metallic).clamp(0.0, 1.0);
        let roughness = self.roughness(lookup);
        let strength = lookup.scalar(&self.specular).clamp(0.0, 1.0);
        let ratio = (self.index_of_refraction - 1.0) / (self.index_of_refraction + 1.0);
        let dielectric_f0 = lookup.rgb(&self.specular_color) * (ratio * ratio);
        let dielectric_f0 = dielectric_f0.map(|c| c.min(1.0)) * strength;
        let film = self.film(lookup);
        let facets = |share, f0, f90| Facets {
            share,
            f0,
            f90,
            bound: film.map_or(f0, |film| film.bound(f0, f90)),
        };
        let transmission = lookup.scalar(&self.transmission).clamp(0.0, 1.0);
        let opaque = (1.0 - metallic) * (1.0 - transmission);
        let dielectric = facets(opaque, dielectric_f0, strength);
        let metal = facets(metallic, base, 1.0);
        let is_thin = self.thickness.factor == 0.0;
        let glass = Glass {
            tint: base,
            f0: dielectric_f0,
            f90: strength,
            index: self.index_of_refraction,
            spread: (self.index_of_refraction - 1.0).max(0.0) * 0.025 * self.dispersion,
            is_thin,
            film,
        };
        let (matte, translucent) = self.matte(lookup, base);
        let coat = self.coat(lookup);
        let mirror = mirror_share(roughness);
        let coat_mirror = coat.map_or(0.0, |coat| mirror_share(coat.alpha.sqrt()));
        // Glass gets its mirror image from Fresnel's equations on what it transmits.
        let f0 = dielectric.bound * opaque + metal.bound * metallic;
        let f90 = strength * opaque + metallic;
        Bsdf {
            lobes: Lobes::Layered(Layered {
                diffuse: matte * opaque,
                translucent: translucent * opaque,
                dielectric,
                metal,
                glass: ((1.0 - metallic) * transmission, glass),
                ggx: self.facets(lookup, roughness),
                film,
                sheen: self.sheen(lookup),
                coat,
                kept: Kept::ALL,
                unmirrored: Kept {
                    facets: 1.0 - mirror,
                    glass: 0.0,
                    coat: 1.0 - coat_mirror,
                },
            }),
            specular: Specular {
                reflect: f0 * mirror,
                reflect_grazing: (Rgb::splat(f90) - f0) * mirror,
                transmit: base * ((1.0 - metallic) * transmission),
                index_of_refraction: self.index_of_refraction,
                is_thin,
                coat: coat.map_or([0.0; 2], |coat| [coat.share, coat_mirror]),
            },
        }
    }

    fn roughness(&self, lookup: &Lookup) -> f32 {
        let value = lookup.scalar(&self.roughness).clamp(0.0, 1.0);
        if self.is_glossiness {
            1.0 - value
        } else {
            value
        }
    }

    /// The direction in which highlights are long, in tangent space, and how much so; `None`
    /// where they are round.
    pub fn grain(&self, lookup: &Lookup) -> Option<(Vec2, f32)> {
        let anisotropy = self.anisotropy.as_ref()?;
        let mut direction = Vec2::from_angle(anisotropy.rotation);
        let mut strength = anisotropy.strength;
        if let Some(texture) = &anisotropy.texture {
            let [r, g, b, _] = lookup.texel(texture, Encoding::Linear);
            let along = Vec2::new(2.0 * r - 1.0, 2.0 * g - 1.0);
            direction = direction.rotate(along.normalize_or(Vec2::X));
            strength *= b;
        }
        (strength > 0.0).then_some((direction, strength.min(1.0)))
    }

    fn facets(&self, lookup: &Lookup, roughness: f32) -> Ggx {
        let alpha = (roughness * roughness).max(MIRROR_ALPHA);
        let along = match self.grain(lookup) {
            Some((_, strength)) => alpha + (1.0 - alpha) * strength * strength,
            None => alpha,
        };
        Ggx {
            alpha: Vec2::new(along, alpha),
        }
    }

    fn film(&self, lookup: &Lookup) -> Option<Film> {
        let film = self.iridescence.as_ref()?;
        let strength = lookup.scalar(&film.factor).clamp(0.0, 1.0);
        let [from, to] = film.thickness;
        let at = film
            .thickness_texture
            .as_ref()
            .map_or(1.0, |texture| lookup.texel(texture, Encoding::Linear)[1]);
        let thickness = from + (to - from) * at;
        (strength > 0.0 && thickness > 0.0).then_some(Film {
            strength,
            index: film.index_of_refraction,
            thickness,
        })
    }

    fn coat(&self, lookup: &Lookup) -> Option<CoatLayer> {
        let coat = self.clearcoat.as_ref()?;
        let share = lookup.scalar(&coat.factor).clamp(0.0, 1.0);
        let roughness = lookup.scalar(&coat.roughness).clamp(0.0, 1.0);
        (share > 0.0).then_some(CoatLayer {
            share,
            alpha: (roughness * roughness).max(MIRROR_ALPHA),
        })
    }

    fn sheen(&self, lookup: &Lookup) -> Option<SheenLayer> {
        let sheen = self.sheen.as_ref()?;
        let color = lookup.rgb(&sheen.color).map(|c| c.clamp(0.0, 1.0));
        let roughness = lookup.scalar(&sheen.roughness).clamp(0.0, 1.0);
        (!color.is_black()).then_some(SheenLayer {
            color,
            alpha: (roughness * roughness).max(MIN_SHEEN_ALPHA),
        })
    }

    /// What the matte base sends back, and what it lets through.
    fn matte(&self, lookup: &Lookup, base: Rgb) -> (Rgb, Rgb) {
        let Some(transmission) = &self.diffuse_transmission else {
            return (base, Rgb::BLACK);
        };
        let share = lookup.scalar(&transmission.factor).clamp(0.0, 1.0);
        let color = lookup.rgb(&transmission.color).map(|c| c.min(1.0));
        (base * (1.0 - share), color * share)
    }

    /// Absorption inside the body, per world unit: `KHR_materials_volume`. `None` in a thin wall
    /// and in what is clear.
    pub fn absorption(&self) -> Option<Rgb> {
        let is_entered = self.transmission.factor > 0.0 || self.diffuse_transmission.is_some();
        let is_body = self.thickness.factor > 0.0 && is_entered;
        let is_clear =
            self.attenuation_distance.is_infinite() || self.attenuation_color == Rgb::WHITE;
        (is_body && !is_clear).then(|| {
            // A colour of 0 would be infinite, and infinite × no way at all is not a number.
            let least = f32::MIN_POSITIVE;
            self.attenuation_color
                .map(|c| -c.max(least).ln() / self.attenuation_distance)
        })
    }

    /// Share of ambient light that arrives where `lookup` is, in `[0, 1]`.
    pub fn occlusion(&self, lookup: &Lookup) -> f32 {
        match &self.occlusion.texture {
            None => 1.0,
            Some(texture) => {
                let texel = lookup.texel(texture, Encoding::Linear)[0];
                1.0 + self.occlusion.factor * (texel - 1.0)
            }
        }
    }
}
