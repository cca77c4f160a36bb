//! Numbers that look random and are the same on every machine.

use glam::DVec3;

/// A stream of numbers that its seed alone decides (splitmix64: Steele, Lea and Flood 2014,
/// "Fast Splittable Pseudorandom Number Generators").
pub struct Random(u64);

impl Random {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.0)
    }

    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        to_unit(self.next())
    }

    /// In `[low, high)`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// One of `count` things.
    pub fn index(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// An angle, in radians.
    pub fn angle(&mut self) -> f64 {
        self.range(0.0, std::f64::consts::TAU)
    }

    /// A direction, uniform over the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let y = self.range(-1.0, 1.0);
        let (sin, cos) = self.angle().sin_cos();
        let r = (1.0 - y * y).sqrt();
        DVec3::new(r * cos, y, r * sin)
    }
}

fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

fn to_unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1u64 << 53) as f64
}

/// Smooth noise in `[-1, 1]` with features of size 1: random values at the corners of a
/// lattice, blended between them.
pub fn noise(p: DVec3, seed: u64) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let weight = f * f * (3.0 - 2.0 * f);
    let mut sum = 0.0;
    for corner in 0..8 {
        let offset = DVec3::new(
            f64::from(corner & 1),
            f64::from(corner >> 1 & 1),
            f64::from(corner >> 2),
        );
        let side = DVec3::ONE - offset + (2.0 * offset - DVec3::ONE) * weight;
        sum += side.x * side.y * side.z * lattice(cell + offset, seed);
    }
    sum
}

fn lattice(corner: DVec3, seed: u64) -> f64 {
    let key = [corner.x, corner.y, corner.z].iter().fold(seed, |key, &c| {
        mix(key.wrapping_mul(31) ^ (c as i64 as u64))
    });
    2.0 * to_unit(mix(key)) - 1.0
}

/// Noise of several sizes: each of `octaves` is half as large and half as strong as the one before.
pub fn fractal_noise(p: DVec3, octaves: u32, seed: u64) -> f64 {
    (0..octaves)
        .map(|octave| {
            let scale = f64::from(1 << octave);
            noise(p * scale, seed + u64::from(octave)) / scale
        })
        .sum()
}
