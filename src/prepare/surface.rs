//! From a hit to everything that shading reads.

use crate::bvh::Hit;
use crate::color::Rgb;
use crate::interaction::Interaction;
use crate::material::{
    AlphaMode, Bsdf, BsdfSample, Lookup, MAX_UV_SETS, Material, NormalMap, View, reflect, refract,
};
use crate::math::{DVec3, Frame, ONE_MINUS_EPSILON, Ray, UnitVec3, Vec2, Vec3};
use crate::scene::{Instance, Mesh};
use crate::texture::{Encoding, TextureRef};

use super::PreparedScene;
use super::facet::{Facet, bulge, facing, smooth_normal};
use super::geometry::{Part, Placing};

/// What a ray met: where, of what material, and what textures are read with.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// The point.
    pub interaction: Interaction,
    /// What it is made of.
    pub material: &'a Material,
    /// What the material reads there.
    pub lookup: Lookup<'a>,
    /// How it scatters light there.
    pub bsdf: Bsdf,
    /// Around the shading normal; its tangent is the direction in which highlights are long.
    pub frame: Frame,
    /// Normal of a coat, on the viewer's side.
    pub coat_normal: UnitVec3,
}

impl Surface<'_> {
    /// Value for light from `wi`, on either side, per channel and steradian: all lobes that have
    /// area. The cosine is not included.
    pub fn eval(&self, wi: UnitVec3) -> Rgb {
        if self.is_torn(*wi) {
            return Rgb::BLACK;
        }
        self.bsdf.value(&self.view(), wi)
    }

    /// Density per solid angle with which [`Surface::sample`] chooses `wi` by a lobe that has
    /// area.
    pub fn pdf(&self, wi: UnitVec3) -> f32 {
        if self.is_torn(*wi) {
            return 0.0;
        }
        self.bsdf.pdf(&self.view(), wi)
    }

    /// [`Surface::eval`] and [`Surface::pdf`]. Where the surface `is_smooth`, light that is above the shading
    /// normal's horizon alone has its value too, though [`Surface::sample`] never takes such a direction.
    pub fn eval_and_pdf(&self, wi: UnitVec3, is_smooth: bool) -> (Rgb, f32) {
        if !self.is_torn(*wi) {
            return self.bsdf.value_and_pdf(&self.view(), wi);
        }
        let is_above = self.interaction.shading_normal.dot(*wi) > 0.0;
        match is_smooth && is_above {
            true => (self.bsdf.value(&self.view(), wi), 0.0),
            false => (Rgb::BLACK, 0.0),
        }
    }

    /// Draws a direction for two independent numbers `u_lobe` in `[0, 1)` and `u` in its square;
    /// `None` where nothing comes from the one that was drawn.
    pub fn sample(&self, u_lobe: f32, u: Vec2) -> Option<BsdfSample> {
        let drawn = self.bsdf.sample(&self.view(), u_lobe, u)?;
        if !self.is_torn(*drawn.wi) {
            return Some(drawn);
        }
        // Mirrors and glass would show holes: they follow the triangle where their own normal
        // sends light through it.
        let at = &self.interaction;
        let normal = *at.geometric_normal;
        let wi = match drawn.is_transmitted {
            _ if !drawn.is_specular => return None,
            true => refract(*at.wo, normal, self.relative_index())?,
            false => reflect(*at.wo, normal),
        };
        let wi = UnitVec3::normalize(wi)?;
        Some(BsdfSample { wi, ..drawn })
    }

    /// Absorption inside the body, per world unit; `None` where light crosses it unchanged.
    pub fn absorption(&self) -> Option<Rgb> {
        self.material.absorption()
    }

    /// Whether `wi` is above the shading normal's horizon and below the triangle's, or the other
    /// way round.
    fn is_torn(&self, wi: Vec3) -> bool {
        let at = &self.interaction;
        (at.geometric_normal.dot(wi) > 0.0) != (at.shading_normal.dot(wi) > 0.0)
    }

    /// Share of the light from behind that goes on as if nothing were there, but for its colour:
    /// what [`Surface::sample`] sends straight on.
    pub fn straight(&self) -> Rgb {
        self.bsdf.straight(&self.view())
    }

    /// As the viewer sees it.
    pub fn view(&self) -> View {
        View {
            frame: self.frame,
            coat_normal: self.coat_normal,
            wo: self.interaction.wo,
            is_inside: self.is_inside(),
        }
    }

    /// Whether the viewer is inside of a body that light passes.
    pub fn is_inside(&self) -> bool {
        !self.interaction.is_front && self.material.is_glass() && !self.bsdf.specular.is_thin
    }

    /// Index of refraction of the side beyond over the index of the viewer's side.
    pub fn relative_index(&self) -> f32 {
        self.bsdf.specular.relative_index(self.is_inside())
    }
}

/// A hit traced back to the scene's own triangle.
pub(super) struct Located<'a> {
    instance: &'a Instance,
    instance_number: u32,
    pub mesh: &'a Mesh,
    pub corners: [u32; 3],
    /// Weights of the corners; they add up to 1.
    pub weights: [f32; 3],
}

impl Located<'_> {
    /// A vertex attribute, interpolated; `zero` is where the sum starts.
    fn interpolate<T: Copy>(&self, values: &[T], mix: impl Fn(T, f32, T, f32, T, f32) -> T) -> T {
        let [a, b, c] = self.corners.map(|i| values[i as usize]);
        let [wa, wb, wc] = self.weights;
        mix(a, wa, b, wb, c, wc)
    }
}

fn mix2(a: Vec2, wa: f32, b: Vec2, wb: f32, c: Vec2, wc: f32) -> Vec2 {
    a * wa + b * wb + c * wc
}

fn mix4(a: [f32; 4], wa: f32, b: [f32; 4], wb: f32, c: [f32; 4], wc: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] * wa + b[i] * wb + c[i] * wc)
}

/// The number of the instance whose part of a flattened tree holds this `triangle`, and of its mesh's triangle.
pub(super) fn part_of(parts: &[Part], triangle: u32) -> (u32, u32) {
    let part = parts.partition_point(|p| p.first_triangle <= triangle) - 1;
    let part = parts[part];
    (part.instance, triangle - part.first_triangle)
}

impl<'a> PreparedScene<'a> {
    /// The number of the scene's instance that was hit, and of its mesh's triangle.
    pub(super) fn triangle(&self, hit: &Hit) -> (u32, u32) {
        match &self.geometry.traced[hit.instance as usize].placing {
            Placing::Flattened(parts) => part_of(parts, hit.triangle),
            Placing::Instanced { instance, .. } => (*instance, hit.triangle),
        }
    }

    pub(super) fn locate(&self, hit: &Hit) -> Located<'a> {
        let (instance_number, triangle) = self.triangle(hit);
        let instance = &self.scene.instances[instance_number as usize];
        let mesh = self.scene.mesh(instance.mesh);
        Located {
            instance,
            instance_number,
            mesh,
            corners: mesh.indices()[triangle as usize],
            weights: [1.0 - hit.u - hit.v, hit.u, hit.v],
        }
    }

    pub(super) fn lookup(&self, at: &Located) -> Lookup<'a> {
        let mut uvs = [Vec2::ZERO; MAX_UV_SETS];
        for (uv, set) in uvs.iter_mut().zip(at.mesh.uv_sets()) {
            *uv = at.interpolate(set, mix2);
        }
        let colors = at.mesh.colors();
        Lookup {
            textures: &self.scene.textures,
            images: &self.scene.images,
            uvs,
            color: if colors.is_empty() {
                [1.0; 4]
            } else {
                at.interpolate(colors, mix4)
            },
        }
    }

    /// The number of the instance of the scene that `hit` is on.
    pub fn instance(&self, hit: &Hit) -> u32 {
        self.triangle(hit).0
    }

    pub(super) fn material(&self, at: &Located) -> &'a Material {
        &self.scene.materials[at.instance.material.0 as usize]
    }

    /// Share of the light that the surface at `hit` stops, in `[0, 1]`, but for what glass
    /// refracts.
    pub(super) fn opacity(&self, hit: &Hit) -> f32 {
        if self.is_opaque(hit) {
            return 1.0;
        }
        let at = self.locate(hit);
        let material = self.material(&at);
        let opacity = material.opacity(&self.lookup(&at));
        if material.is_glass() {
            opacity.min(ONE_MINUS_EPSILON)
        } else {
            opacity
        }
    }

    /// Share of what is behind `hit` that stays hidden from who looks along `ray`, in `[0, 1]`.
    pub fn visibility(&self, ray: &Ray, hit: &Hit) -> f32 {
        let at = self.locate(hit);
        let material = self.material(&at);
        if !material.is_seen_from_back() {
            let [a, b, c] = self.vertices(hit);
            let normal = (b - a).cross(c - a) * f64::from(self.orientation(&at));
            if normal.dot(ray.direction.as_dvec3()) > 0.0 {
                return 0.0;
            }
        }
        match material.alpha_mode {
            AlphaMode::Opaque => 1.0,
            AlphaMode::Mask { .. } | AlphaMode::Blend => material.opacity(&self.lookup(&at)),
        }
    }

    /// -1 where the instance mirrors its mesh, else 1.
    pub(super) fn orientation(&self, at: &Located) -> f32 {
        self.orientation[at.instance_number as usize]
    }

    /// Everything that shading reads at `hit` of `ray`.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> Surface<'a> {
        let at = self.locate(hit);
        let material = self.material(&at);
        let lookup = self.lookup(&at);

        let vertices = self.vertices(hit);
        let edges = [vertices[1] - vertices[0], vertices[2] - vertices[0]];
        let wo = UnitVec3::normalize(-ray.direction).unwrap_or(UnitVec3::Z);
        let facet = Facet::new(&vertices, hit.u, hit.v, wo, self.orientation(&at));
        let (smooth, height) = match self.vertex_normals(&at) {
            Some(normals) => (
                smooth_normal(&facet, &normals, at.weights),
                bulge(&facet, &vertices, &normals, at.weights),
            ),
            None => (facet.outward, 0.0),
        };
        let interaction = facet.interaction(smooth, height, wo);
        let bent = |map: &NormalMap| {
            let normal = self.bumped(map, &at, &lookup, edges, smooth);
            facing(normal, facet.geometric_normal, wo)
        };
        let unbent = interaction.shading_normal;
        let shading_normal = material.normal_map.as_ref().map_or(unbent, bent);
        let coat_normal = match material.has_coat() {
            true => material.coat_normal_map().map_or(unbent, bent),
            false => shading_normal,
        };
        let grain = material.grain(&lookup).and_then(|grain| {
            let map = material.normal_map.map(|map| map.texture);
            let frame = self
                .vertex_frame(&at, smooth)
                .or_else(|| texture_frame(map.as_ref(), &at, edges, smooth))?;
            let along = frame.tangent * grain.x + frame.bitangent * grain.y;
            frame_along(shading_normal, along, 1.0)
        });
        Surface {
            bsdf: material.bsdf(&lookup),
            interaction: Interaction {
                point_error: self.point_error(hit, ray, &interaction),
                shading_normal,
                ..interaction
            },
            frame: grain.unwrap_or_else(|| Frame::around(shading_normal)),
            coat_normal,
            material,
            lookup,
        }
    }

    /// The corners of the triangle that was hit, as traced, in prepared coordinates.
    pub(super) fn vertices(&self, hit: &Hit) -> [DVec3; 3] {
        let traced = &self.geometry.traced[hit.instance as usize];
        let tree = &self.geometry.trees[traced.tree as usize];
        let corners = tree.indices[hit.triangle as usize];
        let corners = corners.map(|i| tree.positions[i as usize].as_dvec3());
        match &traced.placing {
            Placing::Flattened(_) => corners,
            Placing::Instanced { to_prepared, .. } => {
                corners.map(|p| to_prepared.transform_point3(p))
            }
        }
    }

    /// Where a triangle is traced as it is, its points are rounded once. A ray to an instance is
    /// rounded on its way into the instance's coordinates too, and so is all that starts there.
    fn point_error(&self, hit: &Hit, ray: &Ray, at: &Interaction) -> Vec3 {
        match &self.geometry.traced[hit.instance as usize].placing {
            Placing::Flattened(_) => at.point_error,
            Placing::Instanced { error, .. } => {
                at.point_error + error.bound(ray.origin.abs().max(at.point.abs()))
            }
        }
    }

    /// The vertex normals of the triangle's corners, pointing outwards, of any length; `None` where the mesh has none.
    fn vertex_normals(&self, at: &Located) -> Option<[Vec3; 3]> {
        self.normals_of(at.instance_number, at.mesh, || at.corners)
    }

    /// See [`Self::vertex_normals`].
    pub(super) fn normals_of(
        &self,
        instance: u32,
        mesh: &Mesh,
        corners: impl FnOnce() -> [u32; 3],
    ) -> Option<[Vec3; 3]> {
        let normals = mesh.normals();
        let matrix = &self.normal_matrices[instance as usize];
        (!normals.is_empty()).then(|| corners().map(|i| *matrix * normals[i as usize]))
    }

    /// `normal` bent by a normal map.
    fn bumped(
        &self,
        map: &NormalMap,
        at: &Located,
        lookup: &Lookup,
        edges: [DVec3; 2],
        normal: UnitVec3,
    ) -> UnitVec3 {
        let tangent_space = self.map_normal(map, lookup);
        let frame = self
            .vertex_frame(at, normal)
            .or_else(|| texture_frame(Some(&map.texture), at, edges, normal))
            .unwrap_or_else(|| Frame::around(normal));
        UnitVec3::normalize(frame.to_world(tangent_space)).unwrap_or(normal)
    }

    fn map_normal(&self, map: &NormalMap, lookup: &Lookup) -> Vec3 {
        let texel = |lookup: &Lookup| lookup.texel(&map.texture, Encoding::Linear);
        if !map.is_height {
            let [x, y, z, _] = texel(lookup).map(|c| 2.0 * c - 1.0);
            return Vec3::new(x * map.scale, y * map.scale, z);
        }
        // Slopes of the height between the neighbouring texels, in heights per texel.
        let texture = &self.scene.textures[map.texture.texture.0 as usize];
        let image = &self.scene.images[texture.image.0 as usize];
        let step = Vec2::new(1.0 / image.width as f32, 1.0 / image.height as f32);
        let height = |offset: Vec2| {
            let uv = lookup.uvs[usize::from(map.texture.uv_set).min(MAX_UV_SETS - 1)];
            let uv = map.texture.transform.transform_point2(uv) + offset;
            texture.eval(image, uv, Encoding::Linear)[0]
        };
        let dx = Vec2::new(step.x, 0.0);
        let dy = Vec2::new(0.0, step.y);
        let slope = Vec2::new(height(dx) - height(-dx), height(-dy) - height(dy)) * 0.5;
        (-slope * map.scale).extend(1.0)
    }

    /// The frame of the mesh's own tangents around `normal`; `None` where it has none.
    fn vertex_frame(&self, at: &Located, normal: UnitVec3) -> Option<Frame> {
        let tangents = at.mesh.tangents();
        if tangents.is_empty() {
            return None;
        }
        let [x, y, z, sign] = at.interpolate(tangents, mix4);
        let tangent =
            at.instance
                .transform
                .matrix3
                .mul_vec3(DVec3::new(x.into(), y.into(), z.into()));
        frame_along(
            normal,
            UnitVec3::normalize_f64(tangent)?.get(),
            sign * self.orientation(at),
        )
    }
}

/// The frame whose tangent follows u of the texture coordinates that `map` is read with; without
/// one, of the first.
fn texture_frame(
    map: Option<&TextureRef>,
    at: &Located,
    edges: [DVec3; 2],
    normal: UnitVec3,
) -> Option<Frame> {
    let set = map.map_or(0, |map| usize::from(map.uv_set));
    let uvs = at.mesh.uv_sets().get(set)?;
    let [a, b, c] = at.corners.map(|i| {
        let uv = uvs[i as usize];
        map.map_or(uv, |map| map.transform.transform_point2(uv))
    });
    let (d1, d2) = ((b - a).as_dvec2(), (c - a).as_dvec2());
    let determinant = d1.perp_dot(d2);
    if determinant == 0.0 {
        return None;
    }
    let sign = determinant.signum();
    let tangent = UnitVec3::normalize_f64((edges[0] * d2.y - edges[1] * d1.y) * sign)?;
    // v grows downwards: green points against it.
    let toward_v = (edges[1] * d1.x - edges[0] * d2.x) * sign;
    let handed = normal.as_dvec3().cross(tangent.as_dvec3()).dot(-toward_v);
    frame_along(normal, *tangent, if handed < 0.0 { -1.0 } else { 1.0 })
}

/// The frame around `normal` whose first axis is nearest to `tangent`.
fn frame_along(normal: UnitVec3, tangent: Vec3, handedness: f32) -> Option<Frame> {
    let tangent = UnitVec3::normalize(tangent - *normal * normal.dot(tangent))?;
    Some(Frame {
        tangent: *tangent,
        bitangent: normal.cross(*tangent) * handedness.signum(),
        normal,
    })
}
