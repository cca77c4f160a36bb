//! Meshes of any size, made of nothing but formulae.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use crate::math::{DVec2, DVec3, Vec3};

use super::Triangles;

/// A kind of mesh that can be made with any number of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Generated {
    /// Hills over the unit square, one height field with detail at every scale.
    Terrain,
    /// Sixteen bumpy spheres in the unit cube, some of which overlap.
    Spheres,
}

/// Detail below this share of the coarsest is left out.
const OCTAVES: i32 = 10;
const SPHERES: usize = 16;
const SPHERE_RADIUS: f64 = 0.12;
const BUMPS: f64 = 0.15;
const HILLS: f64 = 0.12;

impl Generated {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Terrain, Self::Spheres];

    /// As in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Terrain => "terrain",
            Self::Spheres => "spheres",
        }
    }

    /// About `count` triangles: the nearest number that the kind's grid can have.
    pub fn triangles(self, count: usize) -> Triangles {
        match self {
            Self::Terrain => terrain((count as f64 / 2.0).sqrt().round().max(1.0) as u32),
            Self::Spheres => {
                // 2 columns (rows - 1) triangles each, about twice as many columns as rows.
                let each = count as f64 / SPHERES as f64;
                let rows = (0.5 + 0.5 * (1.0 + each).sqrt()).round().max(2.0);
                let columns = (each / (2.0 * (rows - 1.0))).round().max(3.0);
                spheres(rows as u32, columns as u32)
            }
        }
    }
}

/// `2 * side²` triangles.
fn terrain(side: u32) -> Triangles {
    let place = |i: u32| f64::from(i) / f64::from(side);
    let positions = (0..=side).into_par_iter().flat_map_iter(|row| {
        (0..=side).map(move |column| {
            let (x, z) = (place(column), place(row));
            DVec3::new(x, HILLS * height(DVec2::new(x, z)), z).as_vec3()
        })
    });
    let indices = (0..side).into_par_iter().flat_map_iter(|row| {
        (0..side).flat_map(move |column| {
            let a = row * (side + 1) + column;
            let b = a + side + 1;
            [[a, b, a + 1], [a + 1, b, b + 1]]
        })
    });
    Triangles {
        positions: positions.collect(),
        indices: indices.collect(),
    }
}

/// Waves of ever half the length and half the height, each turned by the golden angle.
fn height(p: DVec2) -> f64 {
    let octave = |o: i32| {
        let turned = DVec2::from_angle(2.399_963 * f64::from(o)).rotate(p);
        let frequency = 5.0 * 2f64.powi(o);
        let phase = 1.7 * f64::from(o);
        0.5f64.powi(o) * (frequency * turned.x + phase).sin() * (frequency * turned.y).cos()
    };
    (0..OCTAVES).map(octave).sum()
}

/// Spheres of `rows` rows and `columns` columns of quadrilaterals, which are triangles at the poles.
fn spheres(rows: u32, columns: u32) -> Triangles {
    let in_sphere = (rows - 1) * columns + 2;
    let positions = (0..SPHERES).into_par_iter().flat_map_iter(|sphere| {
        let ring = move |row: u32| {
            (0..columns).map(move |column| {
                let polar = PI * f64::from(row) / f64::from(rows);
                let around = TAU * f64::from(column) / f64::from(columns);
                let (sin, cos) = around.sin_cos();
                DVec3::new(polar.sin() * cos, polar.cos(), polar.sin() * sin)
            })
        };
        let directions = (1..rows).flat_map(ring).chain([DVec3::Y, DVec3::NEG_Y]);
        directions.map(move |direction| on_sphere(sphere, direction))
    });
    let indices = (0..SPHERES as u32).into_par_iter().flat_map_iter(|sphere| {
        let first = sphere * in_sphere;
        let last = first + in_sphere - 1;
        (0..columns).flat_map(move |column| {
            let right = (column + 1) % columns;
            let at = move |row: u32, column: u32| first + row * columns + column;
            let caps = [
                [last - 1, at(0, right), at(0, column)],
                [last, at(rows - 2, column), at(rows - 2, right)],
            ];
            let sides = (0..rows - 2).flat_map(move |row| {
                let [a, b] = [column, right].map(|column| at(row, column));
                let [c, d] = [column, right].map(|column| at(row + 1, column));
                [[a, b, c], [b, d, c]]
            });
            caps.into_iter().chain(sides)
        })
    });
    Triangles {
        positions: positions.collect(),
        indices: indices.collect(),
    }
}

fn on_sphere(sphere: usize, direction: DVec3) -> Vec3 {
    // Spread evenly by the powers of the root of x⁴ = x + 1 (Roberts 2018, "The Unreasonable
    // Effectiveness of Quasirandom Sequences").
    let steps = DVec3::new(0.819_172_5, 0.671_043_6, 0.549_700_5);
    let center = (0.5 + sphere as f64 * steps).fract();
    let octave = |o: i32| {
        let p = direction * 3.0 * 2f64.powi(o) + sphere as f64;
        0.5f64.powi(o) * p.x.sin() * p.y.sin() * p.z.sin()
    };
    let bump: f64 = (0..OCTAVES).map(octave).sum();
    (center + SPHERE_RADIUS * (1.0 + BUMPS * bump) * direction).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    #[test]
    fn counts_are_near_what_was_asked_for() {
        for kind in Generated::ALL {
            for count in [1_000, 16_000, 250_000] {
                let made = kind.triangles(count).indices.len();
                assert!(made.abs_diff(count) * 20 < count, "{kind:?}: {made}");
            }
        }
    }

    /// Every edge of a closed surface belongs to two triangles, which pass it in opposite ways.
    #[test]
    fn spheres_are_closed() {
        let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
        let triangles = Generated::Spheres.triangles(3_000);
        for [a, b, c] in triangles.indices {
            for edge in [(a, b), (b, c), (c, a)] {
                *edges.entry(edge).or_default() += 1;
            }
        }
        for (&(a, b), &count) in &edges {
            assert_eq!((count, edges.get(&(b, a))), (1, Some(&1)), "edge {a} {b}");
        }
    }

    #[test]
    fn surfaces_face_outwards() {
        let terrain = Generated::Terrain.triangles(200);
        let normal = |mesh: &Triangles, corners: [u32; 3]| {
            let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
            (b - a).cross(c - a)
        };
        assert!(terrain.indices.iter().all(|&t| normal(&terrain, t).y > 0.0));
        let spheres = Generated::Spheres.triangles(4_000);
        let in_one = spheres.indices.len() / SPHERES;
        let volume: f32 = spheres.indices[..in_one]
            .iter()
            .map(|&t| normal(&spheres, t).dot(spheres.positions[t[0] as usize]) / 6.0)
            .sum();
        assert!(volume > 0.0, "{volume}");
    }
}
