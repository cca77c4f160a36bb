//! Triangles to trace, and every tree of them.

use std::collections::HashMap;

use crate::bench::Triangles;
use crate::bvh::{Builder, Bvh, Width};
use crate::math::{Aabb, Ray, Vec3};

/// A fixed stream of numbers (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom
/// Number Generators").
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// In `[-1, 1)` by component.
    pub fn vector(&mut self) -> Vec3 {
        let mut next = || 2.0 * self.unit() - 1.0;
        Vec3::new(next(), next(), next())
    }

    /// Below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
}

impl Triangles {
    /// The corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.indices[triangle].map(|i| self.positions[i as usize])
    }

    /// The same triangles with other positions.
    pub fn map(mut self, f: impl Fn(Vec3) -> Vec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p = f(*p));
        self
    }

    /// Adds a triangle with vertices of its own.
    pub fn add(&mut self, corners: [Vec3; 3]) {
        let first = self.positions.len() as u32;
        self.positions.extend(corners);
        self.indices.push([first, first + 1, first + 2]);
    }

    /// Its tree for this processor.
    pub fn tree(&self, builder: Builder) -> Bvh {
        Bvh::build(&self.positions, &self.indices, builder)
    }

    /// Its tree by every builder, in every width of this processor, each with its name.
    pub fn trees(&self) -> Vec<(String, Bvh)> {
        let each = |width: Width| {
            Builder::ALL.into_iter().filter_map(move |builder| {
                let tree = Bvh::build_with(&self.positions, &self.indices, builder, width)?;
                Some((format!("{builder}, {width:?}"), tree))
            })
        };
        Width::available().into_iter().flat_map(each).collect()
    }

    /// Rays from random points in and around its box, half of them to points of triangles.
    pub fn rays(&self, count: usize, seed: u64) -> Vec<Ray> {
        let mut random = Random(seed);
        let bounds = Aabb::of_points(self.positions.iter().copied());
        let (center, half) = (bounds.center(), 0.75 * bounds.extent());
        let half = half.max(Vec3::splat(0.1 * half.max_element()));
        (0..count)
            .map(|i| {
                let origin = center + half * random.vector();
                let mut target = center + half * random.vector();
                if i % 2 == 0 {
                    let [a, b, c] = self.corners(random.below(self.indices.len()));
                    let (u, v) = (random.unit(), random.unit());
                    target = a + 0.5 * u * (b - a) + 0.5 * v * (c - a);
                }
                Ray::new(origin, target - origin)
            })
            .collect()
    }
}

/// Triangles of random size, place and direction in the unit cube.
pub fn soup(triangles: usize, seed: u64) -> Triangles {
    let mut random = Random(seed);
    let mut mesh = Triangles::default();
    for _ in 0..triangles {
        let center = random.vector();
        let size = 0.3 * random.unit().powi(3);
        mesh.add([0, 1, 2].map(|_| center + size * random.vector()));
    }
    mesh
}

/// An icosahedron, each triangle of which is cut in four `levels` times; closed.
pub fn sphere(levels: u32) -> Triangles {
    let g = 0.5 + 1.25f32.sqrt();
    let mut positions = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        positions.extend([
            Vec3::new(0.0, a, b),
            Vec3::new(a, b, 0.0),
            Vec3::new(b, 0.0, a),
        ]);
    }
    // Faces: corners at the edge length 2 from each other.
    let mut indices = Vec::new();
    let near = |i: usize, j: usize| (positions[i].distance(positions[j]) - 2.0).abs() < 1e-3;
    for (i, j, k) in (0..12).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| (i, j, k))))
    {
        if near(i, j) && near(j, k) && near(i, k) {
            indices.push([i as u32, j as u32, k as u32]);
        }
    }
    let mut mesh = Triangles { positions, indices };
    for _ in 0..levels {
        mesh = subdivide(&mesh);
    }
    mesh.map(Vec3::normalize)
}

fn subdivide(mesh: &Triangles) -> Triangles {
    let mut positions = mesh.positions.clone();
    let mut middles = HashMap::new();
    let mut middle = |i: u32, j: u32| {
        *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
            positions.push(0.5 * (mesh.positions[i as usize] + mesh.positions[j as usize]));
            positions.len() as u32 - 1
        })
    };
    let cut = |&[i, j, k]: &[u32; 3]| {
        let (a, b, c) = (middle(j, k), middle(i, k), middle(i, j));
        [[i, c, b], [c, j, a], [b, a, k], [a, b, c]]
    };
    let indices = mesh.indices.iter().flat_map(cut).collect();
    Triangles { positions, indices }
}

/// A wavy sheet of `2 * side²` triangles over the unit square.
pub fn terrain(side: u32) -> Triangles {
    let mut mesh = Triangles::default();
    for (i, j) in (0..=side).flat_map(|i| (0..=side).map(move |j| (i, j))) {
        let (x, y) = (i as f32 / side as f32, j as f32 / side as f32);
        mesh.positions
            .push(Vec3::new(x, y, 0.1 * (9.0 * x).sin() * (7.0 * y).cos()));
    }
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let a = i * (side + 1) + j;
        let b = a + side + 1;
        mesh.indices.extend([[a, b, a + 1], [b, b + 1, a + 1]]);
    }
    mesh
}
