//! Plain surfaces: those that scatter light the same way everywhere and do nothing else. What the camera sees of
//! them is computed for rows of hits.

use super::PreparedScene;
use super::facet::{Facet, bulge, smooth_normal};
use super::geometry::Placing;
use crate::bvh::Hit;
use crate::interaction::LitSide;
use crate::material::Bsdf;
use crate::math::{DVec3, FEW, ROW, Ray, Row, RowJob, UnitVec3, VectorRow, widely};

/// Hits on plain surfaces, and what shading reads there.
#[derive(Debug)]
pub struct PlainRow {
    /// Hits are 0 to this.
    count: usize,
    /// Their materials.
    materials: [u32; ROW],
    corners: [VectorRow; 3],
    /// Weights of the second and third corner.
    weights: [Row; 2],
    /// Against the direction of the rays.
    back: VectorRow,
    orientation: Row,
    /// Vertex normals by corner, where some mesh has them.
    normals: [VectorRow; 3],
    has_normals: [bool; ROW],
    is_smooth: bool,
    seen: SeenRow,
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
        geometric_normal: VectorRow::Z,
        shading_normal: VectorRow::Z,
        wo: VectorRow::Z,
    };
}

impl PlainRow {
    /// Without hits.
    pub const EMPTY: Self = Self {
        count: 0,
        materials: [0; ROW],
        corners: [VectorRow::ZERO; 3],
        weights: [[0.0; ROW]; 2],
        back: VectorRow::ZERO,
        orientation: [1.0; ROW],
        normals: [VectorRow::ZERO; 3],
        has_normals: [false; ROW],
        is_smooth: false,
        seen: SeenRow::NOWHERE,
    };

    /// Takes all hits out.
    pub fn clear(&mut self) {
        self.count = 0;
        self.is_smooth = false;
    }

    /// How many hits there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The points that were hit, once they are [`PlainRow::locate`]d.
    pub fn points(&self) -> &VectorRow {
        &self.seen.point
    }

    /// What lights need to know of hit `i`, once they are [`PlainRow::locate`]d: the same bits as in
    /// [`PreparedScene::surface`].
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

    /// Where the viewer of hit `i` is, once they are [`PlainRow::locate`]d.
    #[inline(always)]
    pub fn wo(&self, i: usize) -> UnitVec3 {
        UnitVec3::from_normalized(self.seen.wo.get(i))
    }

    /// Computes what shading reads at all hits; with `is_bulging` shadows start on the surface that vertex normals
    /// describe.
    pub fn locate(&mut self, is_bulging: bool) {
        if self.count < FEW {
            let mut seen = SeenRow::NOWHERE;
            for i in 0..self.count {
                self.locate_one::<true>(i, is_bulging, &mut seen);
            }
            self.seen = seen;
        } else {
            self.seen = widely(Locate(self, is_bulging));
        }
    }

    #[inline(always)]
    fn locate_one<const IS_SMOOTH: bool>(&self, i: usize, is_bulging: bool, seen: &mut SeenRow) {
        let corners: [DVec3; 3] = [
            self.corners[0].get(i).as_dvec3(),
            self.corners[1].get(i).as_dvec3(),
            self.corners[2].get(i).as_dvec3(),
        ];
        let [u, v] = [self.weights[0][i], self.weights[1][i]];
        let wo = UnitVec3::normalize(self.back.get(i)).unwrap_or(UnitVec3::Z);
        let facet = Facet::new(&corners, u, v, wo, self.orientation[i]);
        let (mut smooth, mut height) = (facet.outward, 0.0);
        if IS_SMOOTH {
            let normals = [
                self.normals[0].get(i),
                self.normals[1].get(i),
                self.normals[2].get(i),
            ];
            let weights = [1.0 - u - v, u, v];
            let normal = smooth_normal(&facet, &normals, weights);
            let bulge = bulge(&facet, &corners, &normals, weights);
            smooth = if self.has_normals[i] { normal } else { smooth };
            height = if self.has_normals[i] & is_bulging {
                bulge
            } else {
                height
            };
        }
        let at = facet.interaction(smooth, height, wo).lit_side();
        seen.point.set(i, at.point);
        seen.shadow_origin.set(i, at.shadow_origin);
        seen.is_bulging[i] = at.is_bulging;
        seen.geometric_normal.set(i, *at.geometric_normal);
        seen.shading_normal.set(i, *at.shading_normal);
        seen.wo.set(i, *wo);
    }
}

struct Locate<'a>(&'a PlainRow, bool);

impl RowJob for Locate<'_> {
    type Output = SeenRow;

    #[inline(always)]
    fn call(self) -> SeenRow {
        let Self(row, is_bulging) = self;
        let mut seen = SeenRow::NOWHERE;
        // Past the last hit there is what was there before: no harm in computing it.
        if row.is_smooth {
            for i in 0..ROW {
                row.locate_one::<true>(i, is_bulging, &mut seen);
            }
        } else {
            for i in 0..ROW {
                row.locate_one::<false>(i, is_bulging, &mut seen);
            }
        }
        seen
    }
}

impl PreparedScene<'_> {
    /// Adds `hit` of `ray` to `row` where the surface is plain; whether it is. There is room for [`ROW`].
    pub fn add_plain(&self, row: &mut PlainRow, ray: &Ray, hit: &Hit) -> bool {
        let traced = &self.geometry.traced[hit.instance as usize];
        let (instance, triangle) = self.triangle(hit);
        let is_flat = matches!(traced.placing, Placing::Flattened(_));
        let of_scene = &self.scene.instances[instance as usize];
        let mesh = self.scene.mesh(of_scene.mesh);
        let is_plain = self.plain[of_scene.material.0 as usize].is_some();
        if !(is_flat && is_plain && mesh.colors().is_empty()) {
            return false;
        }
        let i = row.count;
        row.count += 1;
        let tree = &self.geometry.trees[traced.tree as usize];
        let corners = tree.indices[hit.triangle as usize];
        for (row, corner) in row.corners.iter_mut().zip(corners) {
            row.set(i, tree.positions[corner as usize]);
        }
        row.weights[0][i] = hit.u;
        row.weights[1][i] = hit.v;
        row.back.set(i, -ray.direction);
        row.orientation[i] = self.orientation[instance as usize];
        row.materials[i] = of_scene.material.0;
        let normals = self.normals_of(instance, mesh, || mesh.indices()[triangle as usize]);
        row.has_normals[i] = normals.is_some();
        if let Some(normals) = normals {
            row.is_smooth = true;
            for (row, normal) in row.normals.iter_mut().zip(normals) {
                row.set(i, normal);
            }
        }
        true
    }

    /// How hit `i` of `row` scatters light.
    pub fn plain_bsdf(&self, row: &PlainRow, i: usize) -> Option<&Bsdf> {
        self.plain[row.materials[i] as usize].as_ref()
    }
}
