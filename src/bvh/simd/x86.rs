//! AVX2 and AVX-512.
//!
//! Every function of the two vector types is inlined into [`run_avx2`] or [`run_avx512`],
//! which are compiled with the features that its instructions need.

use std::arch::x86_64::*;

use super::{Job, Lanes};

/// Whether [`run_avx2`] may be called.
pub(super) fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
}

/// Whether [`run_avx512`] may be called.
pub(super) fn has_avx512() -> bool {
    has_avx2()
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("avx512bw")
}

/// Runs `job` on 8 lanes.
#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt")]
pub(super) fn run_avx2<J: Job<8>>(job: J) -> J::Output {
    job.run::<Avx2>()
}

/// Runs `job` on 16 lanes.
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx512bw,avx2,fma,bmi1,bmi2,lzcnt")]
pub(super) fn run_avx512<J: Job<16>>(job: J) -> J::Output {
    job.run::<Avx512>()
}

/// Eight floats. Exists only inside [`run_avx2`].
#[derive(Clone, Copy)]
struct Avx2(__m256);

/// Sixteen floats. Exists only inside [`run_avx512`].
#[derive(Clone, Copy)]
struct Avx512(__m512);

/// The functions whose names and shapes are the same in both sets.
macro_rules! lanes {
    ($type:ident, $width:literal, $set1:ident, $load:ident, $store:ident, $sub:ident, $add:ident,
     $mul:ident, $div:ident, $fmadd:ident, $fmsub:ident, $fnmadd:ident, $min:ident, $max:ident,
     $max_abs:ident, $flip:ident, $least:ident, $greatest:ident, $compare:ident) => {
        // SAFETY (of all blocks in here): a value of this type exists only where `run_avx2` or
        // `run_avx512` called the job, hence on a processor that has the instructions; loads
        // and stores are unaligned ones of exactly the array behind the reference.
        impl Lanes<$width> for $type {
            #[inline(always)]
            fn splat(x: f32) -> Self {
                Self(unsafe { $set1(x) })
            }
            #[inline(always)]
            fn load(from: &[f32; $width]) -> Self {
                Self(unsafe { $load(from.as_ptr()) })
            }
            #[inline(always)]
            fn store(self, to: &mut [f32; $width]) {
                unsafe { $store(to.as_mut_ptr(), self.0) }
            }
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                Self(unsafe { $sub(self.0, other.0) })
            }
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                Self(unsafe { $add(self.0, other.0) })
            }
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                Self(unsafe { $mul(self.0, other.0) })
            }
            #[inline(always)]
            fn div(self, other: Self) -> Self {
                Self(unsafe { $div(self.0, other.0) })
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                Self(unsafe { $fmadd(self.0, factor.0, addend.0) })
            }
            #[inline(always)]
            fn mul_sub(self, factor: Self, subtrahend: Self) -> Self {
                Self(unsafe { $fmsub(self.0, factor.0, subtrahend.0) })
            }
            #[inline(always)]
            fn neg_mul_add(self, factor: Self, minuend: Self) -> Self {
                Self(unsafe { $fnmadd(self.0, factor.0, minuend.0) })
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self(unsafe { $min(self.0, other.0) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self(unsafe { $max(self.0, other.0) })
            }
            #[inline(always)]
            fn max_abs(self, other: Self) -> Self {
                Self(unsafe { $max_abs(self.0, other.0) })
            }
            #[inline(always)]
            fn with_sign_flipped_by(self, other: Self) -> Self {
                Self(unsafe { $flip(self.0, other.0) })
            }
            #[inline(always)]
            fn least(self) -> f32 {
                unsafe { $least(self.0) }
            }
            #[inline(always)]
            fn greatest(self) -> f32 {
                unsafe { $greatest(self.0) }
            }
            #[inline(always)]
            fn le(self, other: Self) -> u32 {
                unsafe { $compare::<_CMP_LE_OQ>(self.0, other.0) }
            }
            #[inline(always)]
            fn lt(self, other: Self) -> u32 {
                unsafe { $compare::<_CMP_LT_OQ>(self.0, other.0) }
            }
        }
    };
}

lanes!(
    Avx2,
    8,
    _mm256_set1_ps,
    _mm256_loadu_ps,
    _mm256_storeu_ps,
    _mm256_sub_ps,
    _mm256_add_ps,
    _mm256_mul_ps,
    _mm256_div_ps,
    _mm256_fmadd_ps,
    _mm256_fmsub_ps,
    _mm256_fnmadd_ps,
    _mm256_min_ps,
    _mm256_max_ps,
    max_abs_8,
    flip_8,
    least_8,
    greatest_8,
    compare_8
);

lanes!(
    Avx512,
    16,
    _mm512_set1_ps,
    _mm512_loadu_ps,
    _mm512_storeu_ps,
    _mm512_sub_ps,
    _mm512_add_ps,
    _mm512_mul_ps,
    _mm512_div_ps,
    _mm512_fmadd_ps,
    _mm512_fmsub_ps,
    _mm512_fnmadd_ps,
    _mm512_min_ps,
    _mm512_max_ps,
    max_abs_16,
    flip_16,
    _mm512_reduce_min_ps,
    _mm512_reduce_max_ps,
    compare_16
);

#[inline]
#[target_feature(enable = "avx2")]
fn max_abs_8(a: __m256, b: __m256) -> __m256 {
    let sign = _mm256_set1_ps(-0.0);
    _mm256_max_ps(_mm256_andnot_ps(sign, a), _mm256_andnot_ps(sign, b))
}

#[inline]
#[target_feature(enable = "avx2")]
fn flip_8(a: __m256, by: __m256) -> __m256 {
    _mm256_xor_ps(a, _mm256_and_ps(_mm256_set1_ps(-0.0), by))
}

#[inline]
#[target_feature(enable = "avx2")]
fn least_8(a: __m256) -> f32 {
    let four = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps::<1>(a));
    let two = _mm_min_ps(four, _mm_movehl_ps(four, four));
    _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)))
}

#[inline]
#[target_feature(enable = "avx2")]
fn greatest_8(a: __m256) -> f32 {
    let four = _mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps::<1>(a));
    let two = _mm_max_ps(four, _mm_movehl_ps(four, four));
    _mm_cvtss_f32(_mm_max_ss(two, _mm_movehdup_ps(two)))
}

#[inline]
#[target_feature(enable = "avx2")]
fn compare_8<const OPERATOR: i32>(a: __m256, b: __m256) -> u32 {
    _mm256_movemask_ps(_mm256_cmp_ps::<OPERATOR>(a, b)) as u32
}

#[inline]
#[target_feature(enable = "avx512f,avx512dq")]
fn max_abs_16(a: __m512, b: __m512) -> __m512 {
    // Selects the maximum (1) of magnitudes, sign cleared (2 << 2).
    _mm512_range_ps::<0b1011>(a, b)
}

#[inline]
#[target_feature(enable = "avx512f,avx512dq")]
fn flip_16(a: __m512, by: __m512) -> __m512 {
    _mm512_xor_ps(a, _mm512_and_ps(_mm512_set1_ps(-0.0), by))
}

#[inline]
#[target_feature(enable = "avx512f")]
fn compare_16<const OPERATOR: i32>(a: __m512, b: __m512) -> u32 {
    u32::from(_mm512_cmp_ps_mask::<OPERATOR>(a, b))
}
