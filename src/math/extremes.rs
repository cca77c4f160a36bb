//! The lesser and the larger of two numbers, each in a single instruction.

/// The lesser of two numbers, neither of which is NaN; `b` where one is.
#[inline(always)]
pub fn lesser<T: PartialOrd>(a: T, b: T) -> T {
    if a < b { a } else { b }
}

/// The larger of two numbers, neither of which is NaN; `b` where one is.
#[inline(always)]
pub fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if a > b { a } else { b }
}
