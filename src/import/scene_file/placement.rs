//! Where a model stands: `translate`, `rotate`, `scale` or `matrix`, and what they do to its
//! instances, lights and cameras.

use super::section::Section;
use super::value::{ANY, Domain, Value, normalize};
use crate::camera::Camera;
use crate::import::ImportError;
use crate::light::Light;
use crate::math::{DAffine3, DVec3, UnitVec3, Vec3};
use crate::scene::Placed;

const NOT_ZERO: Domain = Domain {
    words: "a number other than 0",
    contains: |v| v != 0.0,
};

/// From a model's coordinates to the world's.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// The transform; it has an inverse.
    pub transform: DAffine3,
    /// The mean factor of lengths; above 0.
    scale: f64,
    /// Whether left becomes right.
    is_mirrored: bool,
    /// Whether some lengths grow more than others.
    is_stretched: bool,
}

impl Placement {
    /// Reads the placement of a `[[model]]`; where it stands already, if nothing is said.
    pub fn read(section: &Section) -> Result<Self, ImportError> {
        let Some(matrix) = section.value("matrix") else {
            return Self::of_parts(section);
        };
        for key in ["translate", "rotate", "scale"] {
            if let Some(value) = section.value(key) {
                let message = format!("\"{key}\" and \"matrix\" cannot both be given");
                return Err(value.invalid(message));
            }
        }
        Self::of_matrix(matrix)
    }

    /// Scaled, then rotated, then moved.
    fn of_parts(section: &Section) -> Result<Self, ImportError> {
        let translate = section.get("translate", |v| v.vector())?;
        let rotate = section.get("rotate", |v| v.vector())?;
        let scale = section.get("scale", scale)?.unwrap_or(DVec3::ONE);
        let rotation = rotation(rotate.unwrap_or(DVec3::ZERO));
        let translation = DAffine3::from_translation(translate.unwrap_or(DVec3::ZERO));
        let size = scale.abs();
        let is_stretched = size.max_element() != size.min_element();
        let mean = size.x.cbrt() * size.y.cbrt() * size.z.cbrt();
        Ok(Self {
            transform: translation * rotation * DAffine3::from_scale(scale),
            scale: if is_stretched { mean } else { size.x },
            is_mirrored: scale.signum().element_product() < 0.0,
            is_stretched,
        })
    }

    fn of_matrix(value: Value) -> Result<Self, ImportError> {
        let m: [f64; 16] = value.array("a list of 16 numbers", |v| v.number(ANY))?;
        let column = |i: usize| DVec3::new(m[4 * i], m[4 * i + 1], m[4 * i + 2]);
        if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
            return Err(value.invalid(
                "matrix is column-major: its numbers 4, 8, 12 and 16 must be 0, 0, 0 and 1",
            ));
        }
        let (x, y, z) = (column(0), column(1), column(2));
        let volume = normalize(x)
            .zip(normalize(y))
            .zip(normalize(z))
            .map_or(0.0, |((x, y), z)| x.cross(y).dot(z));
        // Of three unit vectors: below this, the volume is the rounding error of a flat one.
        if volume.abs() < 1e-14 {
            return Err(value.invalid("matrix makes everything flat"));
        }
        let lengths = DVec3::new(x.length(), y.length(), z.length());
        let mean = lengths.x.cbrt() * lengths.y.cbrt() * lengths.z.cbrt() * volume.abs().cbrt();
        let deviation = (lengths / mean - 1.0).abs().max_element();
        Ok(Self {
            transform: DAffine3::from_cols(x, y, z, column(3)),
            scale: mean,
            is_mirrored: volume < 0.0,
            is_stretched: deviation > 1e-6,
        })
    }

    /// Whether lights of this kind cannot be placed exactly.
    pub fn distorts(&self, light: &Light) -> bool {
        self.is_stretched && !matches!(light, Light::Distant(_) | Light::Rectangle(_))
    }

    /// A light of the model, in the world. It lights the placed model as it lit the model by
    /// itself, at whatever scale.
    pub fn light(&self, light: &Placed<Light>) -> Placed<Light> {
        if self.transform == DAffine3::IDENTITY {
            return light.clone();
        }
        let center = center_of(&light.item);
        let origin = light.origin + center.as_dvec3();
        let item = light.item.placed(1.0, -center);
        Placed {
            name: light.name.clone(),
            origin: self.transform.transform_point3(origin),
            item: self.turned(item),
        }
    }

    /// A light whose own centre is the origin, turned and scaled about it.
    fn turned(&self, mut light: Light) -> Light {
        match &mut light {
            Light::Point(_) | Light::Sphere(_) => {}
            Light::Spot(spot) => spot.direction = self.direction(spot.direction),
            Light::Distant(distant) => distant.direction = self.direction(distant.direction),
            Light::Disk(disk) => disk.normal = self.normal(disk.normal),
            Light::Rectangle(rectangle) => {
                let edge = |v: Vec3| self.transform.transform_vector3(v.as_dvec3()).as_vec3();
                let (u, v) = (edge(rectangle.half_u), edge(rectangle.half_v));
                // A mirror image shines to the mirror image of its side.
                (rectangle.half_u, rectangle.half_v) =
                    if self.is_mirrored { (v, u) } else { (u, v) };
                return light;
            }
        }
        light.placed(self.scale as f32, Vec3::ZERO)
    }

    /// A camera of the model, in the world. Its picture is never mirrored.
    pub fn camera(&self, camera: &Placed<Camera>) -> Placed<Camera> {
        if self.transform == DAffine3::IDENTITY {
            return camera.clone();
        }
        let item = &camera.item;
        let origin = camera.origin + item.position.as_dvec3();
        let vector = |v: UnitVec3| self.transform.transform_vector3(v.get().as_dvec3());
        let back = normalize(vector(item.back)).unwrap_or(DVec3::Z);
        let right = vector(item.up).cross(back);
        let right = normalize(right).unwrap_or_else(|| back.any_orthonormal_vector());
        let unit = |v: DVec3, old| UnitVec3::normalize(v.as_vec3()).unwrap_or(old);
        let turned = Camera {
            position: Vec3::ZERO,
            right: unit(right, item.right),
            up: unit(back.cross(right), item.up),
            back: unit(back, item.back),
            ..*item
        };
        Placed {
            name: camera.name.clone(),
            origin: self.transform.transform_point3(origin),
            item: turned.placed(self.scale as f32, Vec3::ZERO),
        }
    }

    fn direction(&self, v: UnitVec3) -> UnitVec3 {
        let turned = normalize(self.transform.transform_vector3(v.get().as_dvec3()));
        turned
            .and_then(|turned| UnitVec3::normalize(turned.as_vec3()))
            .unwrap_or(v)
    }

    /// Normals stay perpendicular to surfaces under the inverse transpose.
    fn normal(&self, v: UnitVec3) -> UnitVec3 {
        let matrix = self.transform.matrix3;
        let inverse = (matrix * (1.0 / self.scale)).inverse();
        normalize(inverse.transpose() * v.get().as_dvec3())
            .and_then(|turned| UnitVec3::normalize(turned.as_vec3()))
            .unwrap_or(v)
    }
}

/// The point of a light that places it, relative to its origin.
fn center_of(light: &Light) -> Vec3 {
    match light {
        Light::Point(light) => light.position,
        Light::Spot(light) => light.position,
        Light::Distant(_) => Vec3::ZERO,
        Light::Disk(light) => light.center,
        Light::Rectangle(light) => light.center,
        Light::Sphere(light) => light.center,
    }
}

fn scale(value: Value) -> Result<DVec3, ImportError> {
    if let Ok(number) = value.number(NOT_ZERO) {
        return Ok(DVec3::splat(number));
    }
    value
        .array("a number other than 0 or a list of 3", |v| {
            v.number(NOT_ZERO)
        })
        .map(DVec3::from_array)
}

/// By `degrees` about x, then y, then z. Quarter turns are exact.
fn rotation(degrees: DVec3) -> DAffine3 {
    let about = |degrees: f64, [a, b]: [usize; 2]| {
        let (sin, cos) = sin_cos_degrees(degrees);
        let mut columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
        columns[a][a] = cos;
        columns[a][b] = sin;
        columns[b][a] = -sin;
        columns[b][b] = cos;
        DAffine3::from_cols_array_2d(&columns)
    };
    about(degrees.z, [0, 1]) * about(degrees.y, [2, 0]) * about(degrees.x, [1, 2])
}

fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turned = degrees.rem_euclid(360.0);
    match turned {
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => turned.to_radians().sin_cos(),
    }
}
