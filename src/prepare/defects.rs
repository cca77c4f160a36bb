//! Triangles that are hard to render, by mesh: counted once, as they are traced.

use std::collections::HashMap;
use std::fmt;

use rayon::prelude::*;

use super::geometry::TreeGeometry;
use crate::math::{DVec3, Vec3};
use crate::sampling::mix;
use crate::scene::MeshId;

/// Longest edge over least height from which a triangle counts as a needle.
pub const NEEDLE_ASPECT: f64 = 1e3;

/// The triangles of a mesh that are hard to render. Every copy that is traced by itself counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Defects {
    /// With a vertex that is not a finite number; left out.
    pub non_finite: u64,
    /// Without area; no ray can hit them.
    pub degenerate: u64,
    /// More than [`NEEDLE_ASPECT`] times as long as wide; hit as exactly as any other.
    pub needle: u64,
    /// With the corners of another triangle, which comes first and is seen in their place.
    pub duplicate: u64,
}

impl Defects {
    /// Adds those of `other`.
    pub fn add(&mut self, other: &Self) {
        self.non_finite += other.non_finite;
        self.degenerate += other.degenerate;
        self.needle += other.needle;
        self.duplicate += other.duplicate;
    }

    /// The same counts together.
    fn sum(mut self, other: Self) -> Self {
        self.add(&other);
        self
    }

    /// Those of one triangle, but for its duplicates.
    fn of(corners: [Vec3; 3]) -> Self {
        if corners.iter().any(|p| !p.is_finite()) {
            return Self {
                non_finite: 1,
                ..Self::default()
            };
        }
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let (ab, ac, bc) = (b - a, c - a, c - b);
        let doubled_area = ab.cross(ac);
        let longest = ab.length_squared().max(ac.length_squared());
        let longest = longest.max(bc.length_squared());
        let is_degenerate = doubled_area == DVec3::ZERO;
        // Longest edge over height is its square over twice the area.
        let width = doubled_area.length_squared() * (NEEDLE_ASPECT * NEEDLE_ASPECT);
        Self {
            degenerate: u64::from(is_degenerate),
            needle: u64::from(!is_degenerate && longest * longest > width),
            ..Self::default()
        }
    }

    fn is_whole(&self) -> bool {
        self.non_finite + self.degenerate == 0
    }
}

impl fmt::Display for Defects {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.non_finite, "not finite"),
            (self.degenerate, "without area"),
            (self.duplicate, "duplicate"),
            (self.needle, "needles"),
        ];
        let mut gap = "";
        for (count, what) in counts.into_iter().filter(|(count, _)| *count > 0) {
            write!(f, "{gap}{count} {what}")?;
            gap = ", ";
        }
        Ok(())
    }
}

/// The defects of the triangles of `tree`. Each of `parts` begins at a triangle and belongs to a mesh.
pub(super) fn defects(tree: &TreeGeometry, parts: &[(u32, MeshId)]) -> Vec<(MeshId, Defects)> {
    let corners = |triangle: &[u32; 3]| triangle.map(|i| tree.positions[i as usize]);
    let end = tree.indices.len() as u32;
    let ends = parts.iter().skip(1).map(|part| part.0).chain([end]);
    let mut counts: Vec<(MeshId, Defects)> = (parts.iter().zip(ends))
        .map(|(&(first, mesh), end)| {
            let triangles = &tree.indices[first as usize..end as usize];
            let each = triangles.par_iter().map(|t| Defects::of(corners(t)));
            (mesh, each.reduce(Defects::default, Defects::sum))
        })
        .collect();
    for triangle in duplicates(tree) {
        let part = parts.partition_point(|part| part.0 <= triangle) - 1;
        counts[part].1.duplicate += 1;
    }
    counts
}

/// The triangles that have the same corners as one with a lower number.
fn duplicates(tree: &TreeGeometry) -> Vec<u32> {
    let key = |triangle: &[u32; 3]| {
        let corners = triangle.map(|i| tree.positions[i as usize]);
        Defects::of(corners).is_whole().then(|| key_of(corners))
    };
    let mut keys: Vec<u64> = tree.indices.par_iter().filter_map(key).collect();
    keys.par_sort_unstable();
    let mut repeated: Vec<u64> = keys
        .windows(2)
        .filter(|pair| pair[0] == pair[1])
        .map(|pair| pair[0])
        .collect();
    if repeated.is_empty() {
        return Vec::new();
    }
    repeated.dedup();
    let suspects: Vec<(u64, u32)> = (tree.indices.par_iter().enumerate())
        .filter_map(|(i, triangle)| {
            let key = key(triangle).filter(|key| repeated.binary_search(key).is_ok())?;
            Some((key, i as u32))
        })
        .collect();
    let mut first = HashMap::new();
    suspects
        .into_iter()
        .filter(|&(key, triangle)| *first.entry(key).or_insert(triangle) != triangle)
        .map(|(_, triangle)| triangle)
        .collect()
}

/// A number that is the same for the same corners in any order, and, but for one case in some 2^64,
/// another for others.
fn key_of(corners: [Vec3; 3]) -> u64 {
    let of_corner = |p: Vec3| {
        // Both zeros are one place.
        let [x, y, z] = (p + Vec3::ZERO).to_array().map(|c| u64::from(c.to_bits()));
        mix(mix(x << 32 | y) ^ z)
    };
    let keys = corners.map(of_corner);
    mix(keys[0].wrapping_add(keys[1]).wrapping_add(keys[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_is_counted_in_its_mesh() {
        let far = f32::INFINITY;
        let positions = vec![
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::new(0.5, 1e-4, 0.0),
            Vec3::new(far, 0.0, 0.0),
            Vec3::new(-0.0, 1.0, -0.0),
        ];
        let indices = vec![
            [0, 1, 2],
            [0, 0, 2],
            [0, 1, 3],
            [0, 1, 4],
            [0, 1, 2],
            [5, 0, 1],
            [1, 0, 0],
        ];
        let tree = TreeGeometry { positions, indices };
        let found = defects(&tree, &[(0, MeshId(3)), (4, MeshId(1))]);
        let first = Defects {
            non_finite: 1,
            degenerate: 1,
            needle: 1,
            duplicate: 0,
        };
        let second = Defects {
            degenerate: 1,
            duplicate: 2,
            ..Defects::default()
        };
        assert_eq!(found, [(MeshId(3), first), (MeshId(1), second)]);
        assert_eq!(second.to_string(), "1 without area, 2 duplicate");
    }

    #[test]
    fn needles_begin_at_their_aspect_ratio() {
        let triangle = |height: f32| {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::new(0.3, height, 0.0)];
            Defects::of(corners.map(|p| 1e-12 * p)).needle
        };
        let width = 1.0 / NEEDLE_ASPECT as f32;
        assert_eq!((triangle(1.01 * width), triangle(0.99 * width)), (0, 1));
    }
}
