//! Plain surfaces: those that scatter light the same way everywhere and do nothing else. What the camera sees of
//! them is computed for rows of hits.

use super::PreparedScene;
use super::facet::{Facet, bulge, smooth_normal};
use super::geometry::Placing;
use super::surface::part_of;
use crate::bvh::HitRow;
use crate::color::Rgb;
use crate::interaction::LitSide;
use crate::material::{Bsdf, Material};
use crate::math::{
    DVec3, FEW, ROW, RayRow, Row, RowJob, UnitVec3, Vec3, VectorRow, places, widely,
};

/// A plain material, and what is read of it most.
#[derive(Debug)]
pub struct PlainMaterial {
    /// How it scatters light.
    bsdf: Bsdf,
    /// [`Bsdf::matte`].
    matte: Option<Rgb>,
}

impl PlainMaterial {
    /// `material`, if it is plain.
    pub fn of(material: &Material) -> Option<Self> {
        material.plain().map(|bsdf| Self {
            matte: bsdf.matte(),
            bsdf,
        })
    }
}

/// Those hits of a row of rays that are on plain surfaces, and what shading reads there; each at the place of its
/// ray.
#[derive(Debug)]
pub struct PlainRow {
    /// A bit for each of them.
    places: u64,
    faces: FaceRow,
    seen: SeenRow,
    /// [`Bsdf::matte`].
    matte: VectorRow,
    /// A bit for each that is not matte.
    glossy: u64,
}

/// The triangles that were hit, and their materials.
#[derive(Debug)]
struct FaceRow {
    materials: [u32; ROW],
    corners: [VectorRow; 3],
    orientation: Row,
    /// Vertex normals by corner, where some mesh has them.
    normals: [VectorRow; 3],
    has_normals: [bool; ROW],
    is_smooth: bool,
}

impl FaceRow {
    const NONE: Self = Self {
        materials: [0; ROW],
        corners: [VectorRow::ZERO; 3],
        orientation: [0.0; ROW],
        normals: [VectorRow::ZERO; 3],
        has_normals: [false; ROW],
        is_smooth: false,
    };

    /// Makes the face at place `to` the one at place `from`.
    #[inline]
    fn copy(&mut self, from: usize, to: usize) {
        self.materials[to] = self.materials[from];
        self.orientation[to] = self.orientation[from];
        for row in &mut self.corners {
            row.set(to, row.get(from));
        }
        if self.is_smooth {
            self.has_normals[to] = self.has_normals[from];
            for row in &mut self.normals {
                row.set(to, row.get(from));
            }
        }
    }
}

/// [`LitSide`]s by field, and where the viewer is.
#[derive(Debug)]
struct SeenRow {
    point: VectorRow,
    shadow_origin: VectorRow,
    is_bulging: [bool; ROW],
    geometric_normal: VectorRow,
    shading_normal: VectorRow,
    wo: VectorRow,
}

impl SeenRow {
    const NOWHERE: Self = Self {
        point: VectorRow::ZERO,
        shadow_origin: VectorRow::ZERO,
        is_bulging: [false; ROW],
        geometric_normal: VectorRow::ZERO,
        shading_normal: VectorRow::ZERO,
        wo: VectorRow::ZERO,
    };

    #[inline(always)]
    fn set(&mut self, i: usize, at: &LitSide, wo: UnitVec3) {
        self.point.set(i, at.point);
        self.shadow_origin.set(i, at.shadow_origin);
        self.is_bulging[i] = at.is_bulging;
        self.geometric_normal.set(i, *at.geometric_normal);
        self.shading_normal.set(i, *at.shading_normal);
        self.wo.set(i, *wo);
    }
}

impl PlainRow {
    /// No hits.
    pub const NONE: Self = Self {
        places: 0,
        faces: FaceRow::NONE,
        seen: SeenRow::NOWHERE,
        matte: VectorRow::ZERO,
        glossy: 0,
    };

    /// A bit for each ray whose hit is on a plain surface.
    pub fn places(&self) -> u64 {
        self.places
    }

    /// The points that were hit.
    pub fn points(&self) -> &VectorRow {
        &self.seen.point
    }

    /// What lights need to know of hit `i`: the same bits as in [`PreparedScene::surface`].
    #[inline(always)]
    pub fn lit_side(&self, i: usize) -> LitSide {
        let seen = &self.seen;
        LitSide {
            point: seen.point.get(i),
            shadow_origin: seen.shadow_origin.get(i),
            is_bulging: seen.is_bulging[i],
            geometric_normal: UnitVec3::from_normalized(seen.geometric_normal.get(i)),
            shading_normal: UnitVec3::from_normalized(seen.shading_normal.get(i)),
        }
    }

    /// Where the viewer of hit `i` is.
    #[inline(always)]
    pub fn wo(&self, i: usize) -> UnitVec3 {
        UnitVec3::from_normalized(self.seen.wo.get(i))
    }

    /// [`Bsdf::matte`] of the surface at hit `i`; means nothing where it is glossy.
    #[inline(always)]
    pub fn matte(&self, i: usize) -> Rgb {
        Rgb::from(self.matte.get(i).to_array())
    }

    /// Whether the surface at hit `i` is not matte.
    #[inline(always)]
    pub fn is_glossy(&self, i: usize) -> bool {
        self.glossy >> i & 1 != 0
    }

    /// A bit for each hit on a surface that is not matte.
    pub fn glossy(&self) -> u64 {
        self.glossy
    }
}

/// Finds what shading reads.
struct Locate<'a> {
    faces: &'a FaceRow,
    rays: &'a RayRow,
    hits: &'a HitRow,
    /// Whether shadows start on the surface that vertex normals describe.
    is_bulging: bool,
}

impl Locate<'_> {
    #[inline(always)]
    fn locate<const IS_SMOOTH: bool>(&self, i: usize, seen: &mut SeenRow) {
        let faces = self.faces;
        let corners: [DVec3; 3] = [
            faces.corners[0].get(i).as_dvec3(),
            faces.corners[1].get(i).as_dvec3(),
            faces.corners[2].get(i).as_dvec3(),
        ];
        let (u, v) = (self.hits.u[i], self.hits.v[i]);
        let wo = UnitVec3::normalize(-self.rays.directions.get(i)).unwrap_or(UnitVec3::Z);
        let facet = Facet::new(&corners, u, v, wo, faces.orientation[i]);
        let (mut smooth, mut height) = (facet.outward, 0.0);
        if IS_SMOOTH {
            let normals = [
                faces.normals[0].get(i),
                faces.normals[1].get(i),
                faces.normals[2].get(i),
            ];
            let weights = [1.0 - u - v, u, v];
            let normal = smooth_normal(&facet, &normals, weights);
            let bulge = bulge(&facet, &corners, &normals, weights);
            smooth = if faces.has_normals[i] { normal } else { smooth };
            height = if faces.has_normals[i] & self.is_bulging {
                bulge
            } else {
                height
            };
        }
        let at = facet.interaction(smooth, height, wo);
        seen.set(i, &at.lit_side(), wo);
    }
}

impl RowJob for Locate<'_> {
    type Output = SeenRow;

    #[inline(always)]
    fn call(self) -> SeenRow {
        let mut seen = SeenRow::NOWHERE;
        // Where there is no plain surface there is no harm in computing something.
        if self.faces.is_smooth {
            for i in 0..ROW {
                self.locate::<true>(i, &mut seen);
            }
        } else {
            for i in 0..ROW {
                self.locate::<false>(i, &mut seen);
            }
        }
        seen
    }
}

impl PreparedScene<'_> {
    /// Adds those `hits` of `rays` with a bit in `of` that are on plain surfaces to `row`, which has none; with
    /// `is_bulging` shadows start on the surface that vertex normals describe.
    pub fn see_plain(
        &self,
        rays: &RayRow,
        hits: &HitRow,
        of: u64,
        is_bulging: bool,
        row: &mut PlainRow,
    ) {
        let mut last: Option<usize> = None;
        for i in places(of) {
            let is_same = |&last: &usize| {
                hits.triangle[i] == hits.triangle[last] && hits.instance[i] == hits.instance[last]
            };
            if let Some(last) = last.filter(is_same) {
                row.faces.copy(last, i);
            } else if !self.see_face(&mut row.faces, hits, i) {
                continue;
            }
            last = Some(i);
            row.places |= 1 << i;
        }
        let PlainRow {
            places: of,
            faces,
            seen,
            ..
        } = row;
        let job = Locate {
            faces,
            rays,
            hits,
            is_bulging,
        };
        if (of.count_ones() as usize) < FEW {
            places(*of).for_each(|i| job.locate::<true>(i, seen));
        } else {
            *seen = widely(job);
        }
        self.read_matte(row);
    }

    /// Reads what [`PlainRow::matte`] and [`PlainRow::glossy`] say.
    fn read_matte(&self, row: &mut PlainRow) {
        let mut last = None;
        for i in places(row.places) {
            let material = row.faces.materials[i];
            let matte = match last {
                Some((known, matte)) if known == material => matte,
                _ => self.plain[material as usize]
                    .as_ref()
                    .and_then(|plain| plain.matte),
            };
            last = Some((material, matte));
            match matte {
                Some(matte) => row.matte.set(i, Vec3::from(matte.channels())),
                None => row.glossy |= 1 << i,
            }
        }
    }

    /// Puts what hit `i` is on into `faces`, if it is plain; whether it is.
    fn see_face(&self, faces: &mut FaceRow, hits: &HitRow, i: usize) -> bool {
        let (instance, triangle) = (hits.instance[i], hits.triangle[i]);
        let traced = &self.geometry.traced[instance as usize];
        let Placing::Flattened(parts) = &traced.placing else {
            return false;
        };
        let (instance, number) = part_of(parts, triangle);
        let of_scene = &self.scene.instances[instance as usize];
        let mesh = self.scene.mesh(of_scene.mesh);
        let material = of_scene.material.0;
        if self.plain[material as usize].is_none() || !mesh.colors().is_empty() {
            return false;
        }
        let tree = &self.geometry.trees[traced.tree as usize];
        let corners = tree.indices[triangle as usize];
        for (row, corner) in faces.corners.iter_mut().zip(corners) {
            row.set(i, tree.positions[corner as usize]);
        }
        faces.orientation[i] = self.orientation[instance as usize];
        faces.materials[i] = material;
        let normals = self.normals_of(instance, mesh, || mesh.indices()[number as usize]);
        faces.has_normals[i] = normals.is_some();
        if let Some(normals) = normals {
            faces.is_smooth = true;
            for (row, normal) in faces.normals.iter_mut().zip(normals) {
                row.set(i, normal);
            }
        }
        true
    }

    /// How the surface at hit `i` of `row` scatters light.
    pub fn plain_bsdf(&self, row: &PlainRow, i: usize) -> Option<&Bsdf> {
        let plain = self.plain[row.faces.materials[i] as usize].as_ref();
        plain.map(|plain| &plain.bsdf)
    }
}
