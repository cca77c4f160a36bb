//! What a generated model is made of: materials, meshes, and nodes that place them.

use glam::{DQuat, DVec3};

/// How a surface scatters light, in words that both OBJ and glTF can say.
#[derive(Clone, Copy)]
pub enum Finish {
    Matte,
    /// With a glossy highlight; perceptual roughness in `(0, 1]`.
    Glossy(f64),
    /// Clear; the index of refraction.
    Glass(f64),
    /// A perfect mirror.
    Mirror,
}

/// A material. `color` is linear: the diffuse reflectance, of a mirror its tint, of glass what it
/// lets through.
pub struct Material {
    pub name: &'static str,
    pub color: [f64; 3],
    pub finish: Finish,
}

/// Index of a [`Material`] in its model.
pub type MaterialId = usize;

/// Index of a [`Mesh`] in its model.
pub type MeshId = usize;

/// Polygons of one material. Faces are convex and counter-clockwise seen from outside.
#[derive(Default)]
pub struct Part {
    pub material: MaterialId,
    pub positions: Vec<DVec3>,
    /// One for each position; none where the part is flat.
    pub normals: Vec<DVec3>,
    pub faces: Vec<Vec<u32>>,
}

/// A thing that can be placed more than once.
pub struct Mesh {
    pub name: String,
    pub parts: Vec<Part>,
}

/// Where a thing stands: scaled, then turned, then moved.
#[derive(Clone, Copy)]
pub struct Placement {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

/// A mesh and the places where it stands. More than one place is written as one node with
/// `EXT_mesh_gpu_instancing` where `is_crowd`, else as a node each.
pub struct Group {
    pub mesh: MeshId,
    pub places: Vec<Placement>,
    pub is_crowd: bool,
}

/// A pinhole camera.
pub struct Camera {
    pub position: DVec3,
    pub look_at: DVec3,
    /// In radians.
    pub vertical_fov: f64,
}

/// A light of `KHR_lights_punctual`.
pub enum Light {
    Point {
        name: &'static str,
        position: DVec3,
        color: [f64; 3],
        intensity: f64,
    },
    Directional {
        name: &'static str,
        direction: DVec3,
        color: [f64; 3],
        irradiance: f64,
    },
}

/// A whole model.
#[derive(Default)]
pub struct Model {
    pub materials: Vec<Material>,
    pub meshes: Vec<Mesh>,
    pub groups: Vec<Group>,
    pub lights: Vec<Light>,
    pub camera: Option<Camera>,
}

impl Placement {
    pub const IDENTITY: Self = Self {
        translation: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
    };

    pub fn at(translation: DVec3) -> Self {
        Self {
            translation,
            ..Self::IDENTITY
        }
    }

    /// Turned by `angle` about the vertical, and of `size`.
    pub fn turned(translation: DVec3, angle: f64, size: f64) -> Self {
        Self {
            translation,
            rotation: DQuat::from_rotation_y(angle),
            scale: DVec3::splat(size),
        }
    }

    pub fn point(&self, p: DVec3) -> DVec3 {
        self.translation + self.rotation * (self.scale * p)
    }

    pub fn normal(&self, n: DVec3) -> DVec3 {
        (self.rotation * (n / self.scale)).normalize()
    }
}

impl Part {
    pub fn new(material: MaterialId) -> Self {
        Self {
            material,
            ..Self::default()
        }
    }

    /// How many triangles the faces make.
    pub fn triangle_count(&self) -> usize {
        self.faces.iter().map(|f| f.len() - 2).sum()
    }

    /// Faces as triangles.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.faces
            .iter()
            .flat_map(|f| (1..f.len() - 1).map(move |i| [f[0], f[i], f[i + 1]]))
    }
}

impl Model {
    pub fn material(&mut self, name: &'static str, color: [f64; 3], finish: Finish) -> MaterialId {
        self.materials.push(Material {
            name,
            color,
            finish,
        });
        self.materials.len() - 1
    }

    pub fn mesh(&mut self, name: impl Into<String>, parts: Vec<Part>) -> MeshId {
        let name = name.into();
        self.meshes.push(Mesh { name, parts });
        self.meshes.len() - 1
    }

    pub fn place(&mut self, mesh: MeshId, places: Vec<Placement>) {
        self.groups.push(Group {
            mesh,
            places,
            is_crowd: false,
        });
    }

    pub fn place_crowd(&mut self, mesh: MeshId, places: Vec<Placement>) {
        self.groups.push(Group {
            mesh,
            places,
            is_crowd: true,
        });
    }

    /// A mesh that stands once, where its own coordinates say.
    pub fn add(&mut self, name: impl Into<String>, parts: Vec<Part>) {
        let mesh = self.mesh(name, parts);
        self.place(mesh, vec![Placement::IDENTITY]);
    }

    /// Triangles as rendered: every place counts.
    pub fn triangle_count(&self) -> usize {
        self.groups
            .iter()
            .map(|group| {
                let parts = &self.meshes[group.mesh].parts;
                parts.iter().map(Part::triangle_count).sum::<usize>() * group.places.len()
            })
            .sum()
    }
}
