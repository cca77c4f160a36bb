//! Triangles that give off light.

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::light::LightBounds;
use crate::material::{Material, Surface};
use crate::math::{Aabb, DVec3, UnitVec3};

use super::PreparedScene;
use super::geometry::Placing;

/// Points of a triangle at which textured emission is read, to know its mean: at least, at most.
const READINGS: (f64, f64) = (4.0, 256.0);

/// A triangle of the tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TriangleId {
    /// Which instance of the tracer.
    pub instance: u32,
    /// Which triangle of it.
    pub triangle: u32,
}

impl TriangleId {
    /// The triangle that was hit.
    pub fn of(hit: &Hit) -> Self {
        Self {
            instance: hit.instance,
            triangle: hit.triangle,
        }
    }

    /// A hit at this place of it; its distance is not known.
    fn hit(self, [u, v]: [f64; 2]) -> Hit {
        Hit {
            t: 0.0,
            u: u as f32,
            v: v as f32,
            triangle: self.triangle,
            instance: self.instance,
        }
    }
}

/// Triangles in a row that are of one emissive material.
#[derive(Clone, Copy, Debug)]
pub struct EmissiveRun {
    /// The first of them.
    pub first: TriangleId,
    /// How many.
    pub count: u32,
}

impl PreparedScene<'_> {
    /// All triangles whose material gives off light, in the order of their ids. Unlit surfaces are
    /// none: their colour is not meant as light.
    pub fn emissive_runs(&self) -> Vec<EmissiveRun> {
        let mut runs = Vec::new();
        for (instance, traced) in (0..).zip(&self.geometry.traced) {
            let mut add = |of: u32, triangle: u32| {
                let of = &self.scene.instances[of as usize];
                let material = &self.scene.materials[of.material.0 as usize];
                let count = self.scene.mesh(of.mesh).indices().len() as u32;
                if gives_light(material) && count > 0 {
                    let first = TriangleId { instance, triangle };
                    runs.push(EmissiveRun { first, count });
                }
            };
            match &traced.placing {
                Placing::Flattened(parts) => {
                    parts.iter().for_each(|p| add(p.instance, p.first_triangle));
                }
                Placing::Instanced { instance, .. } => add(*instance, 0),
            }
        }
        runs
    }

    /// The corners of a triangle, in prepared coordinates, counter-clockwise seen from the front.
    pub fn corners(&self, id: TriangleId) -> [DVec3; 3] {
        let hit = id.hit([0.0; 2]);
        let [a, b, c] = self.vertices(&hit);
        if self.orientation(&self.locate(&hit)) < 0.0 {
            [a, c, b]
        } else {
            [a, b, c]
        }
    }

    /// Radiance that a triangle gives off at the place with these weights of the second and third of its
    /// [`Self::corners`], W/(m² sr), where it is opaque times its opacity.
    pub fn emission(&self, id: TriangleId, [v, w]: [f64; 2]) -> Rgb {
        let hit = id.hit([v, w]);
        let mut at = self.locate(&hit);
        if self.orientation(&at) < 0.0 {
            at.weights.swap(1, 2);
        }
        let material = self.material(&at);
        let lookup = self.lookup(&at);
        material.emitted(&lookup) * material.opacity(&lookup)
    }

    /// Whether the back of a triangle shines as its front does.
    pub fn shines_from_back(&self, id: TriangleId) -> bool {
        self.material(&self.locate(&id.hit([0.0; 2])))
            .is_seen_from_back()
    }

    /// Where a triangle is and how strong it is; `None` where it gives no light.
    pub fn emission_bounds(&self, id: TriangleId) -> Option<LightBounds> {
        let corners = self.corners(id);
        let cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let mean = self.mean_emission(id);
        let intensity = 0.5 * cross.length() * mean;
        (intensity > 0.0 && intensity.is_finite()).then_some(())?;
        let bounds = Aabb::of_points(corners.map(DVec3::as_vec3));
        let normal = UnitVec3::normalize_f64(cross)?;
        let is_two_sided = self.shines_from_back(id);
        Some(LightBounds::flat(bounds, normal, is_two_sided, intensity))
    }

    /// By luminance, from as many readings as its textures have pixels on it, within limits.
    fn mean_emission(&self, id: TriangleId) -> f64 {
        let count = self.texels(id).clamp(READINGS.0, READINGS.1) as u32;
        let reading = |i: u32| {
            // Points of even spread (Basu and Owen 2015 fold the square in the same way): a rank-1
            // lattice, folded onto the triangle.
            let x = (f64::from(i) + 0.5) / f64::from(count);
            let y = (f64::from(i) * 0.618_033_988_749_894_9 + 0.25).fract();
            let place = if x + y > 1.0 {
                [1.0 - x, 1.0 - y]
            } else {
                [x, y]
            };
            f64::from(self.emission(id, place).luminance())
        };
        (0..count).map(reading).sum::<f64>() / f64::from(count)
    }

    /// How many pixels its textures of emission and opacity have on it.
    fn texels(&self, id: TriangleId) -> f64 {
        let at = self.locate(&id.hit([0.0; 2]));
        let material = self.material(&at);
        let textures = [&material.emission.texture, &material.opacity.texture];
        let texels = textures.into_iter().flatten().map(|reference| {
            let Some(uvs) = at.mesh.uv_sets().get(usize::from(reference.uv_set)) else {
                return 1.0;
            };
            let [a, b, c] = at.corners.map(|i| {
                reference
                    .transform
                    .transform_point2(uvs[i as usize])
                    .as_dvec2()
            });
            let texture = &self.scene.textures[reference.texture.0 as usize];
            let image = &self.scene.images[texture.image.0 as usize];
            let pixels = f64::from(image.width) * f64::from(image.height);
            0.5 * (b - a).perp_dot(c - a).abs() * pixels
        });
        texels.fold(1.0, f64::max)
    }
}

fn gives_light(material: &Material) -> bool {
    !material.emission.factor.is_black() && !matches!(material.surface, Surface::Unlit(_))
}
