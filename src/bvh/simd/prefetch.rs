//! Prefetching, for arrays that rays read at random.

/// Has the processor fetch `elements[index]`, which will be needed soon.
#[inline(always)]
pub(in crate::bvh) fn prefetch<T>(elements: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    for line in 0..size_of::<T>().div_ceil(64) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        let address = elements.as_ptr().wrapping_add(index).cast::<i8>();
        // SAFETY: a prefetch of any address at all is without effect on the program, and every
        // x86-64 processor has the instruction.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(64 * line)) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (elements, index);
}
