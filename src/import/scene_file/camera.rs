//! `[camera]`: a view of the scene's own, or a choice among the cameras of its models.

use super::section::Section;
use super::value::{Domain, NON_NEGATIVE, POSITIVE, Value, normalize};
use crate::camera::{Camera, Projection};
use crate::import::ImportError;
use crate::math::{DVec3, UnitVec3, Vec3};
use crate::scene::Placed;

const KEYS: &[&str] = &[
    "name",
    "position",
    "look_at",
    "up",
    "vertical_fov",
    "lens_radius",
    "focus_distance",
];

/// Degrees between the bottom and the top of a picture where nobody says.
pub const DEFAULT_VERTICAL_FOV: f64 = 40.0;

const FIELD_OF_VIEW: Domain = Domain {
    words: "a number of degrees between 0 and 180",
    contains: |v| {
        let radians = v.to_radians() as f32;
        radians > 0.0 && radians < std::f32::consts::PI
    },
};

/// A perspective camera in the words of a scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye.
    pub position: DVec3,
    /// What is in the middle of the picture; another point than `position`.
    pub look_at: DVec3,
    /// What is up in the picture.
    pub up: DVec3,
    /// Degrees.
    pub vertical_fov: f64,
    /// Metres; 0 for a pinhole.
    pub lens_radius: f32,
    /// Metres; `None` for the distance to `look_at`.
    pub focus_distance: Option<f32>,
}

impl View {
    /// The camera; `None` where `position` and `look_at` coincide.
    pub fn camera(&self) -> Option<Placed<Camera>> {
        let towards = self.look_at - self.position;
        let back = normalize(-towards)?;
        let right = normalize(self.up).map(|up| up.cross(back));
        // Both have length 1: what is left of an `up` along the view is its rounding error.
        let right = right.filter(|right| right.length() > 1e-12);
        let right = normalize(right.unwrap_or_else(|| back.any_orthonormal_vector()))?;
        let unit = |v: DVec3| UnitVec3::normalize(v.as_vec3());
        let distance = towards.length() as f32;
        let item = Camera {
            position: Vec3::ZERO,
            right: unit(right)?,
            up: unit(back.cross(right))?,
            back: unit(back)?,
            projection: Projection::Perspective {
                vertical_fov_radians: self.vertical_fov.to_radians() as f32,
            },
            lens_radius: self.lens_radius,
            focus_distance: self
                .focus_distance
                .unwrap_or(distance.clamp(f32::MIN_POSITIVE, f32::MAX)),
        };
        Some(Placed {
            name: String::new(),
            origin: self.position,
            item,
        })
    }
}

/// What a scene file says about its camera.
#[derive(Clone, Debug, Default)]
pub struct CameraSection<'a> {
    /// A camera of its own.
    pub own: Option<Placed<Camera>>,
    /// The name of a model's camera.
    pub name: Option<Value<'a>>,
    /// Degrees, for a camera that is not its own.
    pub vertical_fov: Option<f64>,
    /// Metres, for a camera that is not its own.
    pub lens_radius: Option<f32>,
    /// Metres, for a camera that is not its own.
    pub focus_distance: Option<f32>,
    fov_value: Option<Value<'a>>,
    lens_value: Option<Value<'a>>,
}

impl<'a> CameraSection<'a> {
    /// Reads the section `camera` of `root`; all `None` where it is left out.
    pub fn read(root: &Section<'a>) -> Result<Self, ImportError> {
        let Some(value) = root.value("camera") else {
            return Ok(Self::default());
        };
        let section = Section::new(root.source, value.node, "[camera]", KEYS)?;
        let position = section.get("position", |v| v.vector())?;
        let read = Self {
            own: None,
            name: section.value("name"),
            vertical_fov: section.get("vertical_fov", |v| v.number(FIELD_OF_VIEW))?,
            lens_radius: section.get("lens_radius", |v| v.single(NON_NEGATIVE))?,
            focus_distance: section.get("focus_distance", |v| v.single(POSITIVE))?,
            fov_value: section.value("vertical_fov"),
            lens_value: section.value("lens_radius"),
        };
        section.get("name", |v| v.string())?;
        match position {
            None => read.of_a_model(&section),
            Some(position) => read.of_its_own(&section, position),
        }
    }

    /// Without a position the keys that need one must be left out.
    fn of_a_model(self, section: &Section<'a>) -> Result<Self, ImportError> {
        for key in ["look_at", "up"] {
            if let Some(value) = section.value(key) {
                return Err(value.invalid(format!("\"{key}\" needs \"position\" beside it")));
            }
        }
        Ok(self)
    }

    fn of_its_own(self, section: &Section<'a>, position: DVec3) -> Result<Self, ImportError> {
        if let Some(name) = self.name {
            return Err(name.invalid(
                "\"name\" picks the camera of a model and \"position\" makes a new one: only one of them can be",
            ));
        }
        let view = View {
            position,
            look_at: section.require("look_at", |v| v.vector())?,
            up: section.get("up", |v| v.direction())?.unwrap_or(DVec3::Y),
            vertical_fov: self.vertical_fov.unwrap_or(DEFAULT_VERTICAL_FOV),
            lens_radius: self.lens_radius.unwrap_or(0.0),
            focus_distance: self.focus_distance,
        };
        let camera = view
            .camera()
            .ok_or_else(|| section.invalid("position and look_at are the same point"))?;
        Ok(Self {
            own: Some(camera),
            ..self
        })
    }

    /// Applies the lens and the field of view to the camera of a model.
    ///
    /// # Errors
    /// Where a lens has no distance to focus on, or a field of view meets an orthographic camera.
    pub fn adjust(&self, camera: &mut Camera) -> Result<(), ImportError> {
        if let (Some(fov), Some(value)) = (self.vertical_fov, self.fov_value) {
            match &mut camera.projection {
                Projection::Perspective {
                    vertical_fov_radians,
                } => *vertical_fov_radians = fov.to_radians() as f32,
                Projection::Orthographic { .. } => {
                    return Err(value.invalid("an orthographic camera has no vertical_fov"));
                }
            }
        }
        if let Some(distance) = self.focus_distance {
            camera.focus_distance = distance;
        }
        if let (Some(radius), Some(value)) = (self.lens_radius, self.lens_value) {
            if radius > 0.0 && self.focus_distance.is_none() {
                return Err(value.invalid(
                    "\"lens_radius\" needs \"focus_distance\" beside it: models do not say where their cameras focus",
                ));
            }
            camera.lens_radius = radius;
        }
        Ok(())
    }
}
