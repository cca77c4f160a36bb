//! The one home of unsafe code: vectors of 8 or 16 floats, and what memory is like.
//!
//! Traversal is written once over [`Lanes`]. [`Level`] runs it compiled for an instruction set,
//! and there is a `Level` only of what the running processor has.

#![allow(unsafe_code)]

mod large_pages;
mod portable;
mod prefetch;
mod stack;
#[cfg(target_arch = "x86_64")]
mod x86;

pub(super) use large_pages::prefer_large_pages;
pub(super) use portable::Portable;
pub(super) use prefetch::prefetch;
pub(super) use stack::{Entry, Stack, Waiting};

/// A vector of `W` floats.
///
/// Where an operand of `min` or `max` is NaN the result is the second one.
pub(super) trait Lanes<const W: usize>: Copy {
    /// `x` everywhere.
    fn splat(x: f32) -> Self;
    /// From memory.
    fn load(from: &[f32; W]) -> Self;
    /// To memory.
    fn store(self, to: &mut [f32; W]);
    /// `self - other`.
    fn sub(self, other: Self) -> Self;
    /// `self + other`.
    fn add(self, other: Self) -> Self;
    /// `self * other`.
    fn mul(self, other: Self) -> Self;
    /// `self / other`.
    fn div(self, other: Self) -> Self;
    /// `self * factor + addend`, rounded once or twice.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// `self * factor - subtrahend`, rounded once or twice.
    fn mul_sub(self, factor: Self, subtrahend: Self) -> Self;
    /// `minuend - self * factor`, rounded once or twice.
    fn neg_mul_add(self, factor: Self, minuend: Self) -> Self;
    /// The lesser of each pair.
    fn min(self, other: Self) -> Self;
    /// The greater of each pair.
    fn max(self, other: Self) -> Self;
    /// The greater magnitude of each pair.
    fn max_abs(self, other: Self) -> Self;
    /// Each negated where the sign bit of `other` is set.
    fn with_sign_flipped_by(self, other: Self) -> Self;
    /// The least of all.
    fn least(self) -> f32;
    /// The greatest of all.
    fn greatest(self) -> f32;
    /// Bit `i` says whether `self[i] <= other[i]`; false of NaN.
    fn le(self, other: Self) -> u32;
    /// Bit `i` says whether `self[i] < other[i]`; false of NaN.
    fn lt(self, other: Self) -> u32;
}

/// Something to be compiled for each instruction set.
pub(super) trait Job<const W: usize> {
    /// What it returns.
    type Output;
    /// Does it with vectors `S`. Must be `#[inline(always)]`.
    fn run<S: Lanes<W>>(self) -> Self::Output;
}

/// An instruction set that this processor has: others than the portable one are only made by
/// the functions that ask the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Level(Set);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Level {
    /// What every processor can do.
    pub const PORTABLE: Self = Self(Set::Portable);

    /// AVX2 and FMA, where the processor has them.
    pub fn avx2() -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        if x86::has_avx2() {
            return Some(Self(Set::Avx2));
        }
        None
    }

    /// The AVX-512 of server processors since Skylake, where the processor has it.
    pub fn avx512() -> Option<Self> {
        #[cfg(target_arch = "x86_64")]
        if x86::has_avx512() {
            return Some(Self(Set::Avx512));
        }
        None
    }

    /// The best that this processor has.
    pub fn best() -> Self {
        Self::avx512().or(Self::avx2()).unwrap_or(Self::PORTABLE)
    }
}

/// Runs jobs on vectors of `W`.
pub(super) trait Run<const W: usize> {
    /// Runs `job`.
    fn run<J: Job<W>>(self, job: J) -> J::Output;
}

impl Run<8> for Level {
    #[inline(always)]
    fn run<J: Job<8>>(self, job: J) -> J::Output {
        match self.0 {
            Set::Portable => job.run::<Portable<8>>(),
            // SAFETY: a `Level` with this set exists only where the processor has AVX2 and FMA
            // (every processor with the AVX-512 asked for has both).
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 | Set::Avx512 => unsafe { x86::run_avx2(job) },
        }
    }
}

impl Run<16> for Level {
    #[inline(always)]
    fn run<J: Job<16>>(self, job: J) -> J::Output {
        match self.0 {
            // SAFETY: a `Level` with this set exists only where the processor has AVX-512.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { x86::run_avx512(job) },
            _ => job.run::<Portable<16>>(),
        }
    }
}
