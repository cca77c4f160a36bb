//! The traversal stack.

use std::mem::MaybeUninit;

use crate::bvh::layout::{ChildRef, MAX_DEPTH};

/// Enough for every level of a 16-wide tree to leave 15 children behind.
const CAPACITY: usize = MAX_DEPTH * 15 + 1;

/// Children still to be visited, with the distances at which the ray enters them.
///
/// Clearing its kilobytes would cost as much as several node visits, so they are left as
/// they are and only what was pushed is read.
pub(in crate::bvh) struct Stack {
    entries: [MaybeUninit<u64>; CAPACITY],
    length: usize,
}

impl Stack {
    /// Empty.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            entries: [const { MaybeUninit::uninit() }; CAPACITY],
            length: 0,
        }
    }

    /// Number of entries.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.length
    }

    /// Adds an entry.
    #[inline(always)]
    pub fn push(&mut self, distance: f32, child: ChildRef) {
        self.entries[self.length].write(pack(distance, child));
        self.length += 1;
    }

    /// Adds an entry below the nearer ones among those from `base` on, which are in order.
    #[inline(always)]
    pub fn insert(&mut self, base: usize, distance: f32, child: ChildRef) {
        let mut at = self.length;
        while at > base && unpack(self.get(at - 1)).0 < distance {
            self.entries[at].write(self.get(at - 1));
            at -= 1;
        }
        self.entries[at].write(pack(distance, child));
        self.length += 1;
    }

    /// Removes the last entry; `None` where there is none.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<(f32, ChildRef)> {
        if self.length == 0 {
            return None;
        }
        self.length -= 1;
        Some(unpack(self.get(self.length)))
    }

    #[inline(always)]
    fn get(&self, index: usize) -> u64 {
        debug_assert!(index <= self.length);
        // SAFETY: the callers read only below `length` (`pop` has just lowered it), and
        // entries below `length` were written by `push` or `insert`.
        unsafe { self.entries[index].assume_init() }
    }
}

#[inline(always)]
fn pack(distance: f32, child: ChildRef) -> u64 {
    u64::from(distance.to_bits()) << 32 | u64::from(child.bits())
}

#[inline(always)]
fn unpack(entry: u64) -> (f32, ChildRef) {
    (
        f32::from_bits((entry >> 32) as u32),
        ChildRef::from_bits(entry as u32),
    )
}
