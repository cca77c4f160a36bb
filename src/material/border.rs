//! How much of the light of a uniform sky the rough border of a clear body loses, from tables.
//!
//! The light is counted that meets one facet. What is reflected or refracted into other facets is lost; it would
//! leave in the end, to either side.
//!
//! A table is computed for each side of an index that is asked for, and for the two next to it where it lies between:
//! some twenty milliseconds each, twelve of them at most for dispersive glass. Between entries values are interpolated
//! linearly; tests hold them against a finer integral.

use std::sync::OnceLock;

use super::fresnel::{fresnel_dielectric, reflect, refract};
use super::microfacet::Ggx;
use crate::math::{Vec2, Vec3};

/// Entries of a table by cosine and by α.
const ROWS: usize = 24;
/// See `ROWS`.
const COLUMNS: usize = 32;
/// Facets that an entry is the mean of.
const FACETS: u32 = 256;
/// Steps of the inverse index from 0 to 1; 1.2, 1.5, 1.6 and 2 are met by one.
const STEPS: usize = 24;
/// What tabulated losses are lowered by, so that they are too high by at most 0.0025 (the test below).
const TABLE_ERROR: f32 = 4e-3;

/// A rough border, seen from one of its sides.
#[derive(Clone, Copy, Debug)]
pub struct Border {
    /// GGX's α along both axes.
    pub alpha: Vec2,
    /// Index of the side beyond over that of the viewer's; above 0 and finite.
    pub eta: f32,
    /// Reflectance at normal incidence.
    pub f0: f32,
    /// Reflectance at grazing incidence.
    pub f90: f32,
}

/// Albedos over the square root of the cosine (rows) and of α (columns), each from 0 to 1, as
/// `x + f0 * y + f90 * z`; and their means over the hemisphere, weighted by the cosine.
struct Table {
    directional: [[Vec3; COLUMNS]; ROWS],
    mean: [Vec3; COLUMNS],
}

/// The golden section of 1, whose multiples spread evenly over a circle.
const GOLDEN: f32 = 0.618_034;

/// From the side of the lower index, and from that of the higher.
static TABLES: [[OnceLock<Box<Table>>; STEPS + 1]; 2] =
    [const { [const { OnceLock::new() }; STEPS + 1] }; 2];

impl Border {
    /// Share of the light of a uniform sky around both sides that a viewer at a cosine misses.
    pub fn lost(&self, cos: f32) -> f32 {
        let (row, down) = place::<ROWS>(cos);
        self.missing(|table, column| {
            table.directional[row][column].lerp(table.directional[row + 1][column], down)
        })
    }

    /// Mean of [`Border::lost`] over the hemisphere, weighted by the cosine; rather more than
    /// less.
    pub fn mean_lost(&self) -> f32 {
        self.missing(|table, column| table.mean[column]) + TABLE_ERROR
    }

    fn missing(&self, entry: impl Fn(&Table, usize) -> Vec3) -> f32 {
        let inverse = self.eta.min(1.0 / self.eta);
        let at = inverse * STEPS as f32;
        let below = (at as usize).min(STEPS - 1);
        let rest = at - below as f32;
        let side = usize::from(self.eta < 1.0);
        let of = |alpha: f32| {
            let (column, right) = place::<COLUMNS>(alpha);
            let of = |step: usize| {
                let table = TABLES[side][step].get_or_init(|| Box::new(Table::new(side, step)));
                entry(table, column).lerp(entry(table, column + 1), right)
            };
            // No table is made of which nothing is taken.
            let parts = if rest == 0.0 {
                of(below)
            } else if rest == 1.0 {
                of(below + 1)
            } else {
                of(below).lerp(of(below + 1), rest)
            };
            (1.0 - parts.dot(Vec3::new(1.0, self.f0, self.f90)) - TABLE_ERROR).max(0.0)
        };
        // Tables are those of round highlights: of both roughnesses of long ones the one counts
        // that loses less.
        let Vec2 { x, y } = self.alpha;
        let along = of(x);
        if x == y { along } else { along.min(of(y)) }
    }
}

impl Table {
    fn new(side: usize, step: usize) -> Self {
        // An index without a bound reflects everything, and so does a high one almost.
        let inverse = (step as f32 / STEPS as f32).max(1e-3);
        let eta = if side == 0 { 1.0 / inverse } else { inverse };
        let directional: [[Vec3; COLUMNS]; ROWS] = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let (cos, alpha) = (square(row, ROWS), square(column, COLUMNS));
                integral::<FACETS>(cos.max(1e-4), alpha.max(1e-4), eta)
            })
        });
        let mean = std::array::from_fn(|column| {
            // Of the interpolated table itself, so that what is added for it adds up.
            let steps = 4 * ROWS;
            (0..steps)
                .map(|i| {
                    let cos = (i as f32 + 0.5) / steps as f32;
                    let (row, down) = place::<ROWS>(cos);
                    let ends = [row, row + 1].map(|row| directional[row][column]);
                    ends[0].lerp(ends[1], down) * (2.0 * cos / steps as f32)
                })
                .sum()
        });
        Self { directional, mean }
    }
}

/// The entry below the square root of `v` in `[0, 1]`, and how far it is to the next.
fn place<const ENTRIES: usize>(v: f32) -> (usize, f32) {
    let at = v.clamp(0.0, 1.0).sqrt() * (ENTRIES - 1) as f32;
    let below = (at as usize).min(ENTRIES - 2);
    (below, at - below as f32)
}

/// What the entry stands for.
fn square(entry: usize, entries: usize) -> f32 {
    (entry as f32 / (entries - 1) as f32).powi(2)
}

/// Mean of what facets that `cos_o` sees send on, over a lattice of their normals; parts as in
/// [`Table`].
fn integral<const COUNT: u32>(cos_o: f32, alpha: f32, eta: f32) -> Vec3 {
    let ggx = Ggx::isotropic(alpha);
    let wo = Vec3::new((1.0 - cos_o * cos_o).max(0.0).sqrt(), 0.0, cos_o);
    let normal = fresnel_dielectric(1.0, eta);
    let seen = ggx.masking(wo);
    let weight = |wi: Vec3| 4.0 * ggx.visibility(wo, wi) * wi.z.abs() * wo.z / seen;
    let mut sum = Vec3::ZERO;
    for i in 0..COUNT {
        let i = i as f32 + 0.5;
        let turn = (i * GOLDEN).fract();
        // Both halves of the second number give the same, by symmetry.
        let half = ggx.sample(wo, Vec2::new(i / COUNT as f32, 0.25 + 0.5 * turn));
        let mirrored = reflect(wo, half);
        let reflected = match mirrored.z > 0.0 {
            true => weight(mirrored),
            false => 0.0,
        };
        let Some(bent) = refract(wo, half, eta) else {
            sum.x += reflected;
            continue;
        };
        let through = match bent.z < 0.0 {
            true => weight(bent),
            false => 0.0,
        };
        let exact = fresnel_dielectric(wo.dot(half).min(1.0), eta);
        let white = (exact - normal) / (1.0 - normal);
        let gain = reflected - through;
        sum += Vec3::new(through, (1.0 - white) * gain, white * gain);
    }
    sum / COUNT as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is added for the loss should not be more than it: losses are hardly ever overstated, and not
    /// understated by much, for indices on and between the steps.
    #[test]
    fn interpolated_losses_are_near_their_integrals() {
        let mut worst = [0.0f32; 2];
        for index in [1.05, 1.2, 1.33, 1.5, 1.77, 2.4, 4.0f32] {
            let f0 = fresnel_dielectric(1.0, index);
            for eta in [index, 1.0 / index] {
                for alpha in [0.01, 0.04, 0.09, 0.2, 0.45, 0.8, 1.0f32] {
                    for cos in [0.01, 0.05, 0.13, 0.3, 0.55, 0.8, 1.0f32] {
                        let border = Border {
                            alpha: Vec2::splat(alpha),
                            eta,
                            f0,
                            f90: 1.0,
                        };
                        let exact =
                            1.0 - integral::<4096>(cos, alpha, eta).dot(Vec3::new(1.0, f0, 1.0));
                        let over = border.lost(cos) - exact.max(0.0);
                        worst = [worst[0].max(over), worst[1].max(-over)];
                    }
                }
            }
        }
        let [over, under] = worst;
        assert!(over <= 2.5e-3 && under <= 0.015, "{over} {under}");
    }
}
