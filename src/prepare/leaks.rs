//! Rays that leave a closed mesh through its surface: there must be none.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::ops::Range;

use rayon::prelude::*;

use super::PreparedScene;
use super::geometry::{Placing, TreeGeometry};
use crate::bvh::Hit;
use crate::math::{DVec3, Ray, Vec3, gamma};
use crate::sampling::mix;

/// What came of rays that started inside closed meshes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Leaks {
    /// Meshes that are closed, as placed: every copy counts.
    pub meshes: u64,
    /// Rays that were aimed at edges and vertices from just below the surface.
    pub rays: u64,
    /// How many of them met nothing on their way out.
    pub leaked: u64,
}

/// A run of triangles that close around a volume.
struct Body {
    /// Which instance of the tracer.
    instance: u32,
    /// Its triangles in the tree.
    triangles: Range<u32>,
    /// 1 where its triangles face outwards, -1 where they face inwards, as placed.
    orientation: f64,
    /// In prepared coordinates.
    bounds: [DVec3; 2],
}

impl PreparedScene<'_> {
    /// Aims about `count` rays at edges and vertices of closed meshes, each from just below the surface of the same
    /// mesh. The same count gives the same rays.
    pub fn leaks(&self, count: u64) -> Leaks {
        let bodies = self.bodies();
        let Some(each) = count.checked_div(bodies.len() as u64) else {
            return Leaks::default();
        };
        let step = bodies.len().div_ceil(count.max(1) as usize);
        let rays = bodies.par_iter().step_by(step).flat_map(|body| {
            let ray = move |i| self.way_out(body, i);
            let is_lost = move |ray| u64::from(self.is_lost(body, &ray));
            let rays = (0..each.max(1)).into_par_iter().filter_map(ray);
            rays.map(move |ray| (1, is_lost(ray)))
        });
        let (rays, leaked) = rays.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        Leaks {
            meshes: bodies.len() as u64,
            rays,
            leaked,
        }
    }

    /// All closed meshes, as placed.
    fn bodies(&self) -> Vec<Body> {
        let mut shared = HashMap::new();
        let mut bodies = Vec::new();
        for (instance, traced) in (0..).zip(&self.geometry.traced) {
            let tree = &self.geometry.trees[traced.tree as usize];
            let end = tree.indices.len() as u32;
            match &traced.placing {
                Placing::Flattened(parts) => {
                    let ends = parts.iter().skip(1).map(|part| part.first_triangle);
                    for (part, end) in parts.iter().zip(ends.chain([end])) {
                        let triangles = part.first_triangle..end;
                        bodies.extend(enclosed(tree, &triangles).map(|(orientation, bounds)| {
                            Body {
                                instance,
                                triangles,
                                orientation,
                                bounds,
                            }
                        }));
                    }
                }
                Placing::Instanced { to_prepared, .. } => {
                    let found = shared.entry(traced.tree);
                    let found = found.or_insert_with(|| enclosed(tree, &(0..end)));
                    bodies.extend(found.map(|(orientation, corners)| {
                        let corner = |i: usize| {
                            let of = |axis: usize| corners[i >> axis & 1][axis];
                            to_prepared.transform_point3(DVec3::new(of(0), of(1), of(2)))
                        };
                        Body {
                            instance,
                            triangles: 0..end,
                            orientation: orientation * to_prepared.matrix3.determinant().signum(),
                            bounds: bounds((0..8).map(corner)),
                        }
                    }));
                }
            }
        }
        bodies
    }

    /// A ray from just below the surface of `body` to an edge or, every fourth, a vertex, as far as the body reaches;
    /// `None` where it would start outwards.
    fn way_out(&self, body: &Body, number: u64) -> Option<Ray> {
        let random = |dimension| mix(mix(number) ^ dimension);
        let unit = |dimension| (random(dimension) >> 11) as f64 / (1u64 << 53) as f64;
        let any = |dimension| {
            let count = u64::from(body.triangles.end - body.triangles.start);
            body.triangles.start + (random(dimension) % count) as u32
        };
        // Off the edges, where rounding may take the start to the other side of a neighbour.
        let (a, b) = (unit(2), unit(3));
        let (a, b) = if a + b > 1.0 {
            (1.0 - a, 1.0 - b)
        } else {
            (a, b)
        };
        let [u, v] = [a, b].map(|weight| (0.05 + 0.85 * weight) as f32);
        let hit = Hit {
            t: 0.0,
            u,
            v,
            triangle: any(1),
            instance: body.instance,
        };
        let [p, q, r] = self.vertices(&hit);
        let outward = (q - p).cross(r - p).try_normalize()? * body.orientation;
        let start = p + (q - p) * f64::from(u) + (r - p) * f64::from(v);

        let aimed_at = Hit {
            triangle: any(4),
            ..hit
        };
        let corners = self.vertices(&aimed_at);
        let k = (random(5) % 3) as usize;
        let along = if number.is_multiple_of(4) {
            0.0
        } else {
            unit(6)
        };
        let target = corners[k].lerp(corners[(k + 1) % 3], along);
        let way = target - start;
        if way.dot(outward) > -1e-3 * way.length() {
            return None;
        }
        let from_outside = Ray::new(start.as_vec3(), -outward.as_vec3());
        let at = self.surface(&from_outside, &hit).interaction;
        let ray = at.spawn_ray((target - at.point.as_dvec3()).as_vec3());
        Some(Ray {
            t_max: exit(&ray, body.bounds),
            ..ray
        })
    }

    /// Whether `ray` starts inside of `body` and leaves it without meeting anything.
    fn is_lost(&self, body: &Body, ray: &Ray) -> bool {
        let origin = ray.origin.as_dvec3();
        // The angle that the body fills around a point inside is that of a whole sphere (van
        // Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle").
        let angle = |triangle| {
            let hit = Hit {
                t: 0.0,
                u: 0.0,
                v: 0.0,
                triangle,
                instance: body.instance,
            };
            let [a, b, c] = self.vertices(&hit).map(|p| p - origin);
            let [la, lb, lc] = [a, b, c].map(DVec3::length);
            let dots = a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            a.dot(b.cross(c)).atan2(la * lb * lc + dots)
        };
        let turns = || body.triangles.clone().map(angle).sum::<f64>() / TAU;
        self.closest_hit(ray, None).is_none() && turns() * body.orientation > 0.5
    }
}

/// Which way the `triangles` of `tree` face, and a box around them, where they are closed: each edge is
/// run along in one direction as often as in the other.
fn enclosed(tree: &TreeGeometry, triangles: &Range<u32>) -> Option<(f64, [DVec3; 2])> {
    let triangles = &tree.indices[triangles.start as usize..triangles.end as usize];
    let mut numbers = HashMap::new();
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for triangle in triangles {
        // Vertices at one place are one, whatever their normals.
        let corners = triangle.map(|i| {
            let place = tree.positions[i as usize] + Vec3::ZERO;
            let new = numbers.len() as u32;
            let bits = place.to_array().map(f32::to_bits);
            *numbers.entry(bits).or_insert(new)
        });
        for k in 0..3 {
            let (p, q) = (corners[k], corners[(k + 1) % 3]);
            if p != q {
                edges.push((p.min(q), p.max(q), if p < q { 1i32 } else { -1 }));
            }
        }
    }
    edges.sort_unstable();
    let is_closed = edges
        .chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))
        .all(|edge| edge.iter().map(|(_, _, direction)| direction).sum::<i32>() == 0);
    let place = |i: u32| tree.positions[i as usize].as_dvec3();
    let anchor = place(triangles.first()?[0]);
    let volumes = triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| place(i) - anchor);
        a.dot(b.cross(c))
    });
    let volume: f64 = volumes.sum();
    let corners = triangles.iter().flatten().map(|&i| place(i));
    (is_closed && volume != 0.0).then(|| (volume.signum(), bounds(corners)))
}

fn bounds(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    let nothing = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    points.fold(nothing, |[low, high], p| [low.min(p), high.max(p)])
}

/// Where `ray` has left the box, with room for rounding.
fn exit(ray: &Ray, [low, high]: [DVec3; 2]) -> f32 {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let room = 1e-3 * (high - low) + f64::from(gamma(16)) * low.abs().max(high.abs());
    let far = DVec3::select(direction.cmpgt(DVec3::ZERO), high + room, low - room);
    let moves = direction.cmpne(DVec3::ZERO);
    let ends = DVec3::select(moves, (far - origin) / direction, DVec3::INFINITY);
    ends.min_element().max(0.0) as f32
}
