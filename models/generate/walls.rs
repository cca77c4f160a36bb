//! Walls with openings.

use glam::DVec3;

use super::model::Part;

/// An upright wall with an outside and an inside.
pub struct Plate {
    /// Seen from outside, its left end at height 0.
    pub origin: DVec3,
    /// To the right, seen from outside.
    pub u: DVec3,
    pub width: f64,
    /// Of its foot and its top.
    pub heights: (f64, f64),
    pub thickness: f64,
}

impl Plate {
    /// Adds the wall to `part`, without its openings: (u0, u1, y0, y1) each.
    pub fn add_to(&self, part: &mut Part, openings: &[(f64, f64, f64, f64)]) {
        let us = cuts(0.0, self.width, openings.iter().flat_map(|o| [o.0, o.1]));
        let (low, high) = self.heights;
        let ys = cuts(low, high, openings.iter().flat_map(|o| [o.2, o.3]));
        // Cells of the grid that the openings' edges make; beyond the wall is nothing.
        let is_solid = |i: usize, j: usize| {
            if i == 0 || j == 0 || i == us.len() || j == ys.len() {
                return false;
            }
            let (u, y) = (0.5 * (us[i - 1] + us[i]), 0.5 * (ys[j - 1] + ys[j]));
            !openings
                .iter()
                .any(|o| o.0 < u && u < o.1 && o.2 < y && y < o.3)
        };
        let outside = |u: f64, y: f64| self.origin + self.u * u + DVec3::Y * y;
        let inward = self.u.cross(DVec3::Y) * -self.thickness;
        for (i, j) in (1..us.len()).flat_map(|i| (1..ys.len()).map(move |j| (i, j))) {
            if !is_solid(i, j) {
                continue;
            }
            let corners = [
                outside(us[i - 1], ys[j - 1]),
                outside(us[i], ys[j - 1]),
                outside(us[i], ys[j]),
                outside(us[i - 1], ys[j]),
            ];
            part.polygon(&corners);
            let [a, b, c, d] = corners.map(|p| p + inward);
            part.polygon(&[d, c, b, a]);
            let neighbours = [(i, j - 1), (i + 1, j), (i, j + 1), (i - 1, j)];
            for (side, (ni, nj)) in neighbours.into_iter().enumerate() {
                if !is_solid(ni, nj) {
                    let (p, q) = (corners[side], corners[(side + 1) % 4]);
                    part.polygon(&[p, p + inward, q + inward, q]);
                }
            }
        }
    }
}

/// `from`, `to` and what is between them, in rising order, each once.
fn cuts(from: f64, to: f64, between: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut cuts: Vec<f64> = between.filter(|&v| from < v && v < to).collect();
    cuts.extend([from, to]);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts
}
