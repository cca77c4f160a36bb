//! Large pages, for arrays that rays read at random.

/// Asks the system to keep `elements` in large pages, where it can: then a ray that jumps through
/// hundreds of megabytes does not look up an address translation at every step.
///
/// Nothing happens where the system does not know how, or has none to spare.
pub(in crate::bvh) fn prefer_large_pages<T>(elements: &[T]) {
    #[cfg(target_os = "linux")]
    {
        const LARGE_PAGE: usize = 2 << 20;
        let start = (elements.as_ptr() as usize).next_multiple_of(LARGE_PAGE);
        let end = (elements.as_ptr() as usize + size_of_val(elements)) / LARGE_PAGE * LARGE_PAGE;
        if start < end {
            let (start, length) = (start as *mut libc::c_void, end - start);
            // SAFETY: the range is within a live allocation and starts at a page; both calls only
            // change how it is backed, not what is in it, and may fail without consequence.
            unsafe {
                libc::madvise(start, length, libc::MADV_HUGEPAGE);
                libc::madvise(start, length, libc::MADV_COLLAPSE);
            }
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = elements;
}
