//! Vectors as plain arrays, for the compiler to map to what the target has.

use super::Lanes;

/// `W` floats.
#[derive(Clone, Copy)]
pub(in crate::bvh) struct Portable<const W: usize>([f32; W]);

impl<const W: usize> Portable<W> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let mut out = self.0;
        for (x, y) in out.iter_mut().zip(other.0) {
            *x = f(*x, y);
        }
        Self(out)
    }

    #[inline(always)]
    fn mask(self, other: Self, f: impl Fn(f32, f32) -> bool) -> u32 {
        let mut bits = 0;
        for i in 0..W {
            bits |= u32::from(f(self.0[i], other.0[i])) << i;
        }
        bits
    }
}

impl<const W: usize> Lanes<W> for Portable<W> {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; W])
    }
    #[inline(always)]
    fn load(from: &[f32; W]) -> Self {
        Self(*from)
    }
    #[inline(always)]
    fn store(self, to: &mut [f32; W]) {
        *to = self.0;
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |x, y| x - y)
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |x, y| x + y)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |x, y| x * y)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |x, y| x / y)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self.mul(factor).add(addend)
    }
    #[inline(always)]
    fn mul_sub(self, factor: Self, subtrahend: Self) -> Self {
        self.mul(factor).sub(subtrahend)
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, minuend: Self) -> Self {
        minuend.sub(self.mul(factor))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |x, y| if x < y { x } else { y })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |x, y| if x > y { x } else { y })
    }
    #[inline(always)]
    fn max_abs(self, other: Self) -> Self {
        let magnitude = |v: Self| Self(v.0.map(f32::abs));
        magnitude(self).max(magnitude(other))
    }
    #[inline(always)]
    fn with_sign_flipped_by(self, other: Self) -> Self {
        let sign = (-0.0f32).to_bits();
        self.zip(other, |x, y| {
            f32::from_bits(x.to_bits() ^ (y.to_bits() & sign))
        })
    }
    #[inline(always)]
    fn least(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, f32::min)
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, f32::max)
    }
    #[inline(always)]
    fn le(self, other: Self) -> u32 {
        self.mask(other, |x, y| x <= y)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> u32 {
        self.mask(other, |x, y| x < y)
    }
}
