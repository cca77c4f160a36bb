//! From what the author said to what rays meet.
//!
//! Takes a [`Scene`] apart into triangles in one set of single-precision coordinates, the trees
//! over them, and lights in the same coordinates. What leaves here can be rendered without
//! failing.

mod defects;
mod emission;
mod facet;
mod geometry;
mod leaks;
mod left_out;
mod placement;
mod plain;
mod surface;

use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::BTreeMap;

use crate::bvh::{Builder, Hit, HitRow};
use crate::camera::Camera;
use crate::color::Rgb;
use crate::import::{WarningCode, Warnings};
use crate::light::Light;
use crate::math::{DAffine3, DVec3, Mat3, Ray, RayRow, UnitVec3, Vec3, gamma};
use crate::scene::{Background, Keep, LeftOut, MeshId, Omission, Placed, Scene};

pub use defects::{Defects, NEEDLE_ASPECT};
pub use emission::{EmissiveRun, TriangleId};
use geometry::Geometry;
pub use leaks::Leaks;
pub use placement::Placement;
use plain::PlainMaterial;
pub use plain::PlainRow;
pub use surface::Surface;

/// A scene that is ready to be rendered.
#[derive(Debug)]
pub struct PreparedScene<'a> {
    /// What it was made from.
    pub scene: &'a Scene,
    /// The coordinates that it lives in.
    pub placement: Placement,
    /// Lights in prepared coordinates, in file order.
    pub lights: Vec<Light>,
    /// The numbers of those that shading points are lit by, in rising order.
    pub shining: Vec<u32>,
    /// What rays bring back that leave the scene.
    pub background: Background,
    geometry: Geometry,
    /// Per instance of the scene: takes normals of its mesh to prepared coordinates.
    normal_matrices: Vec<Mat3>,
    /// Per instance of the scene: -1 where its transform mirrors, else 1.
    orientation: Vec<f32>,
    /// Per material, where it is plain.
    plain: Vec<Option<PlainMaterial>>,
    /// Whether blockers are asked for their opacity.
    has_transparency: bool,
}

/// A prepared scene, and what was repaired on the way.
#[derive(Debug)]
pub struct Prepared<'a> {
    /// The scene.
    pub scene: PreparedScene<'a>,
    /// What was repaired.
    pub warnings: Warnings,
    /// What its rays do not need.
    pub left_out: Vec<LeftOut>,
}

/// Triangles that flattening may add to a scene, beyond one copy of each mesh, before shared
/// meshes are kept as instances.
pub const FLATTEN_BUDGET: u64 = 1 << 21;

/// How many triangles [`prepare`] will build trees over: what their memory is reckoned by.
pub fn traced_triangles(scene: &Scene) -> u64 {
    geometry::traced_triangles(scene, FLATTEN_BUDGET)
}

/// Makes `scene` ready to be rendered.
pub fn prepare(scene: &Scene, builder: Builder) -> Prepared<'_> {
    prepare_within(scene, builder, FLATTEN_BUDGET)
}

/// As [`prepare`], but for what `keep` holds nothing is left out.
pub fn prepare_keeping(scene: &Scene, builder: Builder, keep: Keep) -> Prepared<'_> {
    prepare_all(scene, builder, FLATTEN_BUDGET, keep)
}

/// As [`prepare`], with a budget of its own in place of [`FLATTEN_BUDGET`]: with 0 every mesh that
/// is used more than once is kept as instances.
pub fn prepare_within(scene: &Scene, builder: Builder, flatten_budget: u64) -> Prepared<'_> {
    prepare_all(scene, builder, flatten_budget, Keep::NOTHING)
}

fn prepare_all(scene: &Scene, builder: Builder, flatten_budget: u64, keep: Keep) -> Prepared<'_> {
    let asks_all = keep.contains(Omission::Opacity);
    let bounds = scene.bounds();
    let placement = Placement::around(bounds);
    let geometry = Geometry::build(scene, &placement, builder, flatten_budget, asks_all);
    let mut warnings = Warnings::default();
    warnings.add_many(
        WarningCode::NonFiniteVertex,
        "triangles with a vertex that is not a finite number were left out",
        geometry.defects.values().map(|d| d.non_finite).sum(),
    );
    let lights: Vec<Light> = scene.lights.iter().map(|l| light(l, &placement)).collect();
    warnings.add_many(
        WarningCode::DegenerateTriangle,
        "triangles without area were left out",
        geometry.defects.values().map(|d| d.degenerate).sum(),
    );
    let prepared = PreparedScene {
        scene,
        placement,
        lights,
        shining: left_out::shining(scene, keep),
        background: scene.background,
        normal_matrices: scene
            .instances
            .iter()
            .map(|i| normal_matrix(&i.transform))
            .collect(),
        orientation: scene
            .instances
            .iter()
            .map(|i| i.transform.matrix3.determinant().signum() as f32)
            .collect(),
        plain: scene.materials.iter().map(PlainMaterial::of).collect(),
        has_transparency: asks_all || !scene.instances.iter().all(|i| scene.is_opaque(i)),
        geometry,
    };
    Prepared {
        left_out: left_out::left_out(&prepared, keep),
        scene: prepared,
        warnings,
    }
}

fn light(placed: &Placed<Light>, placement: &Placement) -> Light {
    let offset = placement.point(placed.origin);
    placed.item.placed(placement.scale as f32, offset)
}

/// Takes normals along: the cofactors of the transform, scaled to a largest element of 1, which
/// are defined even where the inverse is not.
fn normal_matrix(transform: &DAffine3) -> Mat3 {
    let m = transform.matrix3;
    let largest = m
        .to_cols_array()
        .map(f64::abs)
        .into_iter()
        .fold(0.0, f64::max);
    let [a, b, c] = [m.x_axis, m.y_axis, m.z_axis].map(|v| v / largest);
    let sign = a.cross(b).dot(c).signum();
    let [x, y, z] = [b.cross(c), c.cross(a), a.cross(b)].map(|v: DVec3| (v * sign).as_vec3());
    Mat3::from_cols(x, y, z)
}

impl PreparedScene<'_> {
    /// A camera of the scene in prepared coordinates.
    pub fn camera(&self, placed: &Placed<Camera>) -> Camera {
        let offset = self.placement.point(placed.origin);
        placed.item.placed(self.placement.scale as f32, offset)
    }

    /// What `ray` brings back where it leaves the scene, W/(m² sr).
    pub fn radiance_beyond(&self, ray: &Ray) -> Rgb {
        let seen = self
            .scene
            .environment
            .as_ref()
            .zip(UnitVec3::normalize(ray.direction));
        let environment = seen.map(|(map, direction)| map.radiance(direction));
        match environment {
            None => self.background.radiance,
            Some(environment) => self.background.radiance + environment,
        }
    }

    /// A distance along a unit direction, in world units.
    pub fn world_distance(&self, prepared: f32) -> f32 {
        (f64::from(prepared) / self.placement.scale) as f32
    }

    /// A point in world coordinates.
    pub fn world_point(&self, prepared: Vec3) -> DVec3 {
        prepared.as_dvec3() / self.placement.scale + self.placement.origin
    }

    /// The nearest hit of `ray`, or the nearest beyond `after`, a former hit of the same ray.
    ///
    /// Hits at the same distance come in the order of their triangles, so that a walk from hit to
    /// hit meets each of several coincident surfaces once; and a ray through the edge of two
    /// triangles crosses one surface there, not two.
    pub fn closest_hit(&self, ray: &Ray, after: Option<&Hit>) -> Option<Hit> {
        let Some(last) = after else {
            return self.geometry.tracer.closest_hit(ray);
        };
        // What is nearer has been seen; coincident surfaces have not.
        let rest = Ray {
            t_min: ray.t_min.max(last.t.next_down()),
            ..*ray
        };
        self.geometry.tracer.closest_hit_if(&rest, |hit| {
            order(hit) > order(last) && !self.is_same_crossing(ray, last, hit)
        })
    }

    /// The nearest hit of each of `rays`.
    pub fn closest_hits(&self, rays: &RayRow) -> HitRow {
        self.geometry.tracer.closest_hits(rays)
    }

    /// Whether something is in the way of each of `rays`, a bit for each; `None` where [`Self::crossings`] may
    /// tell more than that.
    pub fn are_blocked(&self, rays: &RayRow) -> Option<u64> {
        (!self.has_transparency).then(|| self.geometry.tracer.any_hits(rays))
    }

    /// Whether two hits of a ray are on an edge or corner that their triangles share, and the
    /// triangles face the same way.
    fn is_same_crossing(&self, ray: &Ray, a: &Hit, b: &Hit) -> bool {
        let is_near = a.instance == b.instance && b.t - a.t <= gamma(8) * b.t.abs();
        if !(is_near && is_on_edge(a) && is_on_edge(b)) {
            return false;
        }
        let (p, q) = (self.vertices(a), self.vertices(b));
        let faces = |[x, y, z]: [DVec3; 3]| {
            let normal = (y - x).cross(z - x);
            normal.dot(ray.direction.as_dvec3()) < 0.0
        };
        p.iter().any(|v| q.contains(v)) && faces(p) == faces(q)
    }

    /// The surfaces that `ray` crosses and that let some light pass, from front to back; `None`
    /// where something that no light passes is in the way.
    pub fn crossings(&self, ray: &Ray) -> Option<Vec<Hit>> {
        let tracer = &self.geometry.tracer;
        if !self.has_transparency {
            return (!tracer.any_hit(ray)).then(Vec::new);
        }
        let crossed = RefCell::new(Vec::new());
        let is_blocked = tracer.any_hit_if(ray, |hit| {
            let opacity = self.opacity(hit);
            if opacity > 0.0 && opacity < 1.0 {
                crossed.borrow_mut().push(*hit);
            }
            opacity >= 1.0
        });
        if is_blocked {
            return None;
        }
        let mut crossed = crossed.into_inner();
        // The tree meets them in an order of its own, which must not show.
        crossed.sort_by(|a, b| order(a).partial_cmp(&order(b)).unwrap_or(Ordering::Equal));
        crossed.dedup_by(|next, kept| {
            order(next) == order(kept) || self.is_same_crossing(ray, kept, next)
        });
        Some(crossed)
    }

    /// Whether no light passes the triangle that was hit, wherever it was hit.
    fn is_opaque(&self, hit: &Hit) -> bool {
        hit.triangle < self.geometry.traced[hit.instance as usize].opaque_triangles
    }

    /// The meshes that have triangles which are hard to render; one that is kept as instances counts once.
    pub fn defects(&self) -> &BTreeMap<MeshId, Defects> {
        &self.geometry.defects
    }

    /// Bytes of triangles, trees and tables, beyond what the scene itself holds.
    pub fn memory_bytes(&self) -> usize {
        self.geometry.memory_bytes()
            + size_of_val(self.normal_matrices.as_slice())
            + size_of_val(self.orientation.as_slice())
            + size_of_val(self.lights.as_slice())
            + size_of_val(self.plain.as_slice())
    }
}

/// Whether a hit is on the border of its triangle, up to rounding of its barycentric weights.
fn is_on_edge(hit: &Hit) -> bool {
    hit.u.min(hit.v).min(1.0 - hit.u - hit.v) <= 4.0 * f32::EPSILON
}

fn order(hit: &Hit) -> (f32, u32, u32) {
    (hit.t, hit.instance, hit.triangle)
}
