//! What a scene does not need: what a render reads, what it may leave out, and what it did.

use serde::Serialize;

use super::IntegratorKind;

/// What a render reads of surfaces, beyond where they are and what they hide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// How they scatter light and what they give off.
    pub scattering: bool,
    /// Their shading normals.
    pub normals: bool,
    /// Their colours.
    pub albedo: bool,
    /// How much ambient light comes to them.
    pub ambient: bool,
    /// Their first texture coordinates, whatever textures there are.
    pub uv: bool,
}

impl Needs {
    /// What the picture of `integrator` takes.
    pub fn of(integrator: IntegratorKind) -> Self {
        let nothing = Self::default();
        match integrator {
            IntegratorKind::Whitted | IntegratorKind::Path => Self {
                scattering: true,
                normals: true,
                albedo: true,
                ambient: integrator == IntegratorKind::Whitted,
                uv: false,
            },
            IntegratorKind::Normal => Self {
                normals: true,
                ..nothing
            },
            IntegratorKind::Depth => nothing,
            IntegratorKind::Albedo => Self {
                albedo: true,
                ..nothing
            },
        }
    }

    /// What either of them reads.
    pub fn and(self, other: Self) -> Self {
        Self {
            scattering: self.scattering || other.scattering,
            normals: self.normals || other.normals,
            albedo: self.albedo || other.albedo,
            ambient: self.ambient || other.ambient,
            uv: self.uv || other.uv,
        }
    }
}

/// A kind of thing that can be left out without a change of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Omission {
    /// Meshes of a file that no node of the shown scene uses.
    Meshes,
    /// Images that no texture of a shown surface reads.
    Images,
    /// Normals, tangents, texture coordinates and colours of vertices that nothing reads.
    Attributes,
    /// Samples of lights without power.
    Lights,
    /// Lookups of opacity where surfaces are opaque; without them shadow rays go in packets.
    Opacity,
}

impl Omission {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Meshes,
        Self::Images,
        Self::Attributes,
        Self::Lights,
        Self::Opacity,
    ];
}

/// What is kept though the scene does not need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Keep(u8);

impl Keep {
    /// Nothing: all is left out that can be.
    pub const NOTHING: Self = Self(0);
    /// Everything: nothing is left out.
    pub const EVERYTHING: Self = Self(u8::MAX);

    /// Only `omission` is kept.
    pub fn only(omission: Omission) -> Self {
        Self(1 << omission as u8)
    }

    /// Whether `omission` is kept.
    pub fn contains(self, omission: Omission) -> bool {
        self.0 & Self::only(omission).0 != 0
    }
}

impl Default for Keep {
    /// Everything, so that a scene can be rendered in any way.
    fn default() -> Self {
        Self::EVERYTHING
    }
}

/// Something that was left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// Its kind.
    pub kind: Omission,
    /// What it is.
    pub what: String,
    /// Why it changes nothing.
    pub why: String,
    /// Memory that it would take, bytes; 0 where only time is saved.
    pub saved_bytes: u64,
    /// Processor time that it would take; `None` where that was not measured.
    pub saved_seconds: Option<f64>,
}

impl LeftOut {
    /// Something whose time was not measured.
    pub fn new(
        kind: Omission,
        what: impl Into<String>,
        why: impl Into<String>,
        saved_bytes: u64,
    ) -> Self {
        Self {
            kind,
            what: what.into(),
            why: why.into(),
            saved_bytes,
            saved_seconds: None,
        }
    }
}
