//! Layers and properties that extensions add to materials.

use super::document_material::{
    AnisotropyEntry, ClearcoatEntry, DiffuseTransmissionEntry, Dispersion, IridescenceEntry,
    SheenEntry,
};
use super::material::{ALPHA, GREEN, MaterialReader, RED};
use crate::material::{Anisotropy, Clearcoat, DiffuseTransmission, Iridescence, Sheen};
use crate::texture::{TexturedRgb, TexturedScalar};

impl MaterialReader<'_> {
    fn layer<T: serde::de::DeserializeOwned>(&mut self, name: &str) -> Option<T> {
        let entry = self.entry;
        self.optional(&entry.extensions, name)
    }

    pub(super) fn dispersion(&mut self) -> f32 {
        let Dispersion { dispersion } = self.extension("KHR_materials_dispersion");
        self.number("dispersion", dispersion, 0.0, f32::MAX)
    }

    pub(super) fn clearcoat(&mut self) -> Option<Clearcoat> {
        let entry: ClearcoatEntry = self.layer("KHR_materials_clearcoat")?;
        let (factor, roughness) = (entry.clearcoat_factor, entry.clearcoat_roughness_factor);
        Some(Clearcoat {
            factor: TexturedScalar {
                factor: self.number("clearcoatFactor", factor, 0.0, 1.0),
                texture: self.texture(entry.clearcoat_texture.as_ref()),
                channel: RED,
            },
            roughness: TexturedScalar {
                factor: self.number("clearcoatRoughnessFactor", roughness, 0.0, 1.0),
                texture: self.texture(entry.clearcoat_roughness_texture.as_ref()),
                channel: GREEN,
            },
            normal_map: self.bumps(
                "clearcoatNormalTexture",
                entry.clearcoat_normal_texture.as_ref(),
            ),
        })
    }

    pub(super) fn sheen(&mut self) -> Option<Sheen> {
        let entry: SheenEntry = self.layer("KHR_materials_sheen")?;
        let roughness = entry.sheen_roughness_factor;
        Some(Sheen {
            color: TexturedRgb {
                factor: self.color("sheenColorFactor", entry.sheen_color_factor, 1.0),
                texture: self.texture(entry.sheen_color_texture.as_ref()),
            },
            roughness: TexturedScalar {
                factor: self.number("sheenRoughnessFactor", roughness, 0.0, 1.0),
                texture: self.texture(entry.sheen_roughness_texture.as_ref()),
                channel: ALPHA,
            },
        })
    }

    pub(super) fn anisotropy(&mut self) -> Option<Anisotropy> {
        let entry: AnisotropyEntry = self.layer("KHR_materials_anisotropy")?;
        let rotation = entry.anisotropy_rotation;
        Some(Anisotropy {
            strength: self.number("anisotropyStrength", entry.anisotropy_strength, 0.0, 1.0),
            rotation: self.number("anisotropyRotation", rotation, f32::MIN, f32::MAX),
            texture: self.texture(entry.anisotropy_texture.as_ref()),
        })
    }

    pub(super) fn iridescence(&mut self) -> Option<Iridescence> {
        let entry: IridescenceEntry = self.layer("KHR_materials_iridescence")?;
        let (min, max) = (
            entry.iridescence_thickness_minimum,
            entry.iridescence_thickness_maximum,
        );
        Some(Iridescence {
            factor: TexturedScalar {
                factor: self.number("iridescenceFactor", entry.iridescence_factor, 0.0, 1.0),
                texture: self.texture(entry.iridescence_texture.as_ref()),
                channel: RED,
            },
            index_of_refraction: self.number(
                "iridescenceIor",
                entry.iridescence_ior,
                1.0,
                f32::MAX,
            ),
            thickness: [
                self.number("iridescenceThicknessMinimum", min, 0.0, f32::MAX),
                self.number("iridescenceThicknessMaximum", max, 0.0, f32::MAX),
            ],
            thickness_texture: self.texture(entry.iridescence_thickness_texture.as_ref()),
        })
    }

    pub(super) fn diffuse_transmission(&mut self) -> Option<DiffuseTransmission> {
        let entry: DiffuseTransmissionEntry = self.layer("KHR_materials_diffuse_transmission")?;
        let factor = entry.diffuse_transmission_factor;
        let color = entry.diffuse_transmission_color_factor;
        Some(DiffuseTransmission {
            factor: TexturedScalar {
                factor: self.number("diffuseTransmissionFactor", factor, 0.0, 1.0),
                texture: self.texture(entry.diffuse_transmission_texture.as_ref()),
                channel: ALPHA,
            },
            color: TexturedRgb {
                factor: self.color("diffuseTransmissionColorFactor", color, 1.0),
                texture: self.texture(entry.diffuse_transmission_color_texture.as_ref()),
            },
        })
    }
}
