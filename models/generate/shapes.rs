//! Simple bodies, added to a part.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec3;

use super::model::Part;

impl Part {
    /// A flat polygon.
    pub fn polygon(&mut self, corners: &[DVec3]) {
        let first = self.positions.len() as u32;
        self.positions.extend_from_slice(corners);
        self.faces
            .push((first..first + corners.len() as u32).collect());
    }

    /// A body over a polygon: `base` moved along `height`, with its sides and both ends. Seen from
    /// where `height` points to, the base is counter-clockwise.
    pub fn prism(&mut self, base: &[DVec3], height: DVec3) {
        let first = self.positions.len() as u32;
        let n = base.len() as u32;
        self.positions.extend_from_slice(base);
        self.positions.extend(base.iter().map(|&p| p + height));
        self.faces.push((first..first + n).rev().collect());
        self.faces.push((first + n..first + 2 * n).collect());
        for i in 0..n {
            let j = (i + 1) % n;
            self.faces
                .push(vec![first + i, first + j, first + n + j, first + n + i]);
        }
    }

    /// A box along the axes.
    pub fn cuboid(&mut self, min: DVec3, max: DVec3) {
        self.parallelepiped(
            min,
            DVec3::X * (max.x - min.x),
            DVec3::Y * (max.y - min.y),
            DVec3::Z * (max.z - min.z),
        );
    }

    /// A box with the corner `corner` and the edges `u`, `v`, `w`, which are right-handed.
    pub fn parallelepiped(&mut self, corner: DVec3, u: DVec3, v: DVec3, w: DVec3) {
        self.prism(&[corner, corner + u, corner + u + v, corner + v], w);
    }

    /// A beam of square section between two points, `width` across.
    pub fn beam(&mut self, from: DVec3, to: DVec3, width: f64) {
        let along = to - from;
        let (u, v) = across(along);
        let corner = from - 0.5 * width * (u + v);
        self.parallelepiped(corner, u * width, v * width, along);
    }

    /// A tube with rounded shading and open ends, of radius `r0` at `from` and `r1` at `to`.
    /// All of its part must be smooth.
    pub fn tube(&mut self, from: DVec3, to: DVec3, r0: f64, r1: f64, sides: u32) {
        let along = to - from;
        let (u, v) = across(along);
        let first = self.positions.len() as u32;
        let lean = along.normalize() * ((r0 - r1) / along.length());
        for i in 0..sides {
            let (sin, cos) = (TAU * f64::from(i) / f64::from(sides)).sin_cos();
            let out = u * cos + v * sin;
            self.positions.extend([from + out * r0, to + out * r1]);
            self.normals.extend([(out + lean).normalize(); 2]);
        }
        for i in 0..sides {
            let (a, b) = (first + 2 * i, first + 2 * ((i + 1) % sides));
            self.faces.push(vec![a, b, b + 1, a + 1]);
        }
    }

    /// A sphere of triangles, each side of an icosahedron halved `subdivisions` times; the
    /// point in each direction is where `surface` says. Normals follow the surface.
    pub fn sphere(&mut self, subdivisions: u32, surface: impl Fn(DVec3) -> DVec3) {
        let (directions, faces) = icosphere(subdivisions);
        let positions = directions.into_iter().map(surface).collect();
        self.smooth(positions, faces);
    }

    /// A sheet of `cells` × `cells` quadrilaterals over the unit square, with smooth normals.
    /// `surface` turns (u, v) into a point; seen from outside, u, v and the normal are right-handed.
    pub fn sheet(&mut self, cells: u32, surface: impl Fn(f64, f64) -> DVec3) {
        let row = cells + 1;
        let at = |i: u32| f64::from(i) / f64::from(cells);
        let positions = (0..row * row)
            .map(|i| surface(at(i % row), at(i / row)))
            .collect();
        let faces = (0..cells * cells)
            .map(|i| {
                let a = i / cells * row + i % cells;
                vec![a, a + 1, a + row + 1, a + row]
            })
            .collect();
        self.smooth(positions, faces);
    }

    /// Adds faces whose normals at each vertex are the mean of the faces around it.
    fn smooth(&mut self, positions: Vec<DVec3>, faces: Vec<Vec<u32>>) {
        let first = self.positions.len() as u32;
        let mut normals = vec![DVec3::ZERO; positions.len()];
        for face in &faces {
            let [a, b, c] = [0, 1, face.len() - 1].map(|i| positions[face[i] as usize]);
            let normal = (b - a).cross(c - a);
            for &i in face {
                normals[i as usize] += normal;
            }
        }
        self.positions.extend(positions);
        self.normals
            .extend(normals.into_iter().map(DVec3::normalize));
        self.faces.extend(
            faces
                .into_iter()
                .map(|f| f.into_iter().map(|i| i + first).collect()),
        );
    }
}

/// Two directions across `along`, right-handed with it.
fn across(along: DVec3) -> (DVec3, DVec3) {
    let helper = if along.x.abs() < 0.5 * along.length() {
        DVec3::X
    } else {
        DVec3::Z
    };
    let u = helper.cross(along).normalize();
    let v = along.cross(u).normalize();
    (u, v)
}

fn icosphere(subdivisions: u32) -> (Vec<DVec3>, Vec<Vec<u32>>) {
    let t = 0.5 * (1.0 + 5f64.sqrt());
    let mut points: Vec<DVec3> = [
        (-1.0, t, 0.0),
        (1.0, t, 0.0),
        (-1.0, -t, 0.0),
        (1.0, -t, 0.0),
        (0.0, -1.0, t),
        (0.0, 1.0, t),
        (0.0, -1.0, -t),
        (0.0, 1.0, -t),
        (t, 0.0, -1.0),
        (t, 0.0, 1.0),
        (-t, 0.0, -1.0),
        (-t, 0.0, 1.0),
    ]
    .map(|(x, y, z)| DVec3::new(x, y, z).normalize())
    .to_vec();
    let mut faces: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..subdivisions {
        faces = halve(&mut points, &faces);
    }
    (points, faces.into_iter().map(Vec::from).collect())
}

/// Each triangle of a sphere as four.
fn halve(points: &mut Vec<DVec3>, faces: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            points.push((points[a as usize] + points[b as usize]).normalize());
            points.len() as u32 - 1
        })
    };
    let mut halved = Vec::with_capacity(4 * faces.len());
    for &[a, b, c] in faces {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        halved.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    halved
}
