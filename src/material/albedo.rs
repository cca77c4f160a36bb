//! How much of the light of a uniform sky rough lobes give back, from tables.
//!
//! They are computed when first asked for, which takes some milliseconds, and are interpolated
//! linearly. Tests hold them against a finer integral.

use std::f32::consts::TAU;
use std::sync::LazyLock;

use super::fresnel::{reflect, schlick_weight};
use super::microfacet::Ggx;
use super::sheen;
use crate::math::{Vec2, Vec3};

/// Entries along each side of a table.
const SIDE: usize = 32;

/// Values over the square root of the cosine (rows) and of α (columns), each from 0 to 1.
type Table<T> = [[T; SIDE]; SIDE];

/// Directional albedos of GGX, and their means over the hemisphere by α.
struct Albedos {
    directional: Box<Table<Vec2>>,
    mean: [Vec2; SIDE],
}

static GGX: LazyLock<Albedos> = LazyLock::new(|| {
    let directional = Box::new(table(ggx_integral));
    let mean = std::array::from_fn(|column| {
        // Of the interpolated table itself, so that what is added for it adds up.
        let steps = 4 * SIDE;
        let sum: Vec2 = (0..steps)
            .map(|i| {
                let cos = (i as f32 + 0.5) / steps as f32;
                let (row, rest) = place(cos);
                let ends = [row, row + 1].map(|row| directional[row][column]);
                ends[0].lerp(ends[1], rest) * (2.0 * cos / steps as f32)
            })
            .sum();
        sum.min(Vec2::ONE)
    });
    Albedos { directional, mean }
});

static SHEEN: LazyLock<Box<Table<f32>>> = LazyLock::new(|| Box::new(table(sheen_integral)));

fn table<T>(value: fn(f32, f32) -> T) -> Table<T> {
    let root = |i: usize| i as f32 / (SIDE - 1) as f32;
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let (cos, alpha) = (root(row).powi(2), root(column).powi(2));
            value(cos.max(1e-4), alpha.max(1e-4))
        })
    })
}

/// The entry below the square root of `v` in `[0, 1]`, and how far it is to the next.
fn place(v: f32) -> (usize, f32) {
    let at = v.clamp(0.0, 1.0).sqrt() * (SIDE - 1) as f32;
    let below = (at as usize).min(SIDE - 2);
    (below, at - below as f32)
}

/// Albedo of a GGX lobe whose facets reflect by Schlick's formula: `f0 * x + f90 * y`; `x + y` is
/// that of white facets. One scattering event, so that light is lost where it is rough.
///
/// Within 4e-3 of the integral, and for the most part within 3e-4.
pub fn ggx(cos_o: f32, alpha: f32) -> Vec2 {
    let ((row, down), (column, right)) = (place(cos_o), place(alpha));
    let at = |row: usize| {
        let row = &GGX.directional[row];
        row[column].lerp(row[column + 1], right)
    };
    at(row).lerp(at(row + 1), down)
}

/// Mean of [`ggx`] over the hemisphere, weighted by the cosine.
pub fn ggx_mean(alpha: f32) -> Vec2 {
    let (column, right) = place(alpha);
    GGX.mean[column].lerp(GGX.mean[column + 1], right)
}

/// Albedo of the sheen lobe of colour 1, before it is kept below 1.
pub fn charlie(cos_o: f32, alpha: f32) -> f32 {
    let ((row, down), (column, right)) = (place(cos_o), place(alpha));
    let lerp = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let at = |row: usize| lerp(SHEEN[row][column], SHEEN[row][column + 1], right);
    lerp(at(row), at(row + 1), down)
}

/// Mean of what facets that `cos_o` sees send on, over a grid of their normals.
fn ggx_integral(cos_o: f32, alpha: f32) -> Vec2 {
    const CUTS: u32 = 24;
    let ggx = Ggx::isotropic(alpha);
    let wo = Vec3::new((1.0 - cos_o * cos_o).max(0.0).sqrt(), 0.0, cos_o);
    let mut sum = Vec2::ZERO;
    for i in 0..CUTS * CUTS {
        let cut = |i: u32| (i as f32 + 0.5) / CUTS as f32;
        // Both halves of the second number give the same, by symmetry.
        let half = ggx.sample(wo, Vec2::new(cut(i / CUTS), 0.25 + 0.5 * cut(i % CUTS)));
        let wi = reflect(wo, half);
        if wi.z <= 0.0 {
            continue;
        }
        let weight = 4.0 * ggx.visibility(wo, wi) * wi.z * wo.z / ggx.masking(wo);
        let white = schlick_weight(wo.dot(half));
        sum += weight * Vec2::new(1.0 - white, white);
    }
    sum / (CUTS * CUTS) as f32
}

/// The lobe times the cosine, over the hemisphere.
fn sheen_integral(cos_o: f32, alpha: f32) -> f32 {
    const CUTS: u32 = 32;
    let wo = Vec3::new((1.0 - cos_o * cos_o).max(0.0).sqrt(), 0.0, cos_o);
    let mut sum = 0.0;
    for i in 0..CUTS * CUTS {
        let cut = |i: u32| (i as f32 + 0.5) / CUTS as f32;
        // Denser near the horizon, where the lobe is: z is the square of the first number.
        let root = cut(i / CUTS);
        let z = root * root;
        let (sin, cos) = (0.5 * TAU * cut(i % CUTS)).sin_cos();
        let ring = (1.0 - z * z).sqrt();
        let wi = Vec3::new(ring * cos, ring * sin, z);
        sum += sheen::lobe(wo, wi, alpha) * z * 2.0 * root;
    }
    sum * TAU / (CUTS * CUTS) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean weight of many facets in place of few.
    #[test]
    fn interpolated_albedos_are_near_their_integrals() {
        for alpha in [0.001, 0.01, 0.03, 0.09, 0.2, 0.45, 0.8, 1.0f32] {
            for cos in [0.003, 0.02, 0.05, 0.13, 0.3, 0.55, 0.8, 1.0f32] {
                let (got, exact) = (ggx(cos, alpha), ggx_integral(cos, alpha));
                let error = (got - exact).abs().max_element();
                assert!(error < 4e-3, "α {alpha}, cos {cos}: {got} {exact}");
            }
        }
    }
}
