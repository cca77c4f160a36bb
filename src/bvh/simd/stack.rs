//! The traversal stack.

use std::mem::MaybeUninit;

use crate::bvh::layout::{ChildRef, MAX_DEPTH};

/// Enough for every level of a 16-wide tree to leave 15 children behind.
const CAPACITY: usize = MAX_DEPTH * 15 + 1;

/// A child still to be visited and the distance at which the ray enters it.
///
/// Entries are ordered by distance: as integers, which for floats that are not negative is the
/// same order. (A distance may be a hair below zero. Such ones come first, in any order.)
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::bvh) struct Entry(i64);

impl Entry {
    /// Of `child`, entered at `distance`.
    #[inline(always)]
    pub fn new(distance: f32, child: ChildRef) -> Self {
        Self(i64::from(distance.to_bits() as i32) << 32 | i64::from(child.bits()))
    }

    /// Where the ray enters.
    #[inline(always)]
    pub fn distance(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    /// The child.
    #[inline(always)]
    pub fn child(self) -> ChildRef {
        ChildRef::from_bits(self.0 as u32)
    }
}

/// Children still to be visited, between two walks.
pub(in crate::bvh) struct Waiting {
    /// Clearing these kilobytes would cost as much as several node visits, so they are left as
    /// they are and only what was pushed is read.
    entries: [MaybeUninit<Entry>; CAPACITY],
    length: usize,
}

impl Waiting {
    /// None.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            entries: [const { MaybeUninit::uninit() }; CAPACITY],
            length: 0,
        }
    }

    /// For a walk, which [keeps](Stack::keep) them.
    #[inline(always)]
    pub fn stack(&mut self) -> Stack<'_> {
        Stack {
            entries: &mut self.entries,
            length: self.length,
            kept: &mut self.length,
        }
    }
}

/// Children still to be visited, nearest last.
pub(in crate::bvh) struct Stack<'a> {
    entries: &'a mut [MaybeUninit<Entry>; CAPACITY],
    /// By itself, to be in a register.
    length: usize,
    kept: &'a mut usize,
}

impl Stack<'_> {
    /// Leaves what is on it to the next walk.
    #[inline(always)]
    pub fn keep(self) {
        *self.kept = self.length;
    }

    /// Number of entries.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.length
    }

    /// Adds an entry.
    #[inline(always)]
    pub fn push(&mut self, entry: Entry) {
        self.entries[self.length].write(entry);
        self.length += 1;
    }

    /// Adds an entry below the nearer ones among those from `base` on, which are in order.
    #[inline(always)]
    pub fn insert(&mut self, base: usize, entry: Entry) {
        let mut at = self.length;
        while at > base && self.get(at - 1) < entry {
            self.entries[at].write(self.get(at - 1));
            at -= 1;
        }
        self.entries[at].write(entry);
        self.length += 1;
    }

    /// Removes the last entry; `None` where there is none.
    #[inline(always)]
    pub fn pop(&mut self) -> Option<Entry> {
        if self.length == 0 {
            return None;
        }
        self.length -= 1;
        Some(self.get(self.length))
    }

    #[inline(always)]
    fn get(&self, index: usize) -> Entry {
        debug_assert!(index <= self.length);
        // SAFETY: the callers read only below `length` (`pop` has just lowered it), and
        // entries below `length` were written by `push` or `insert`, on this stack or on the one that kept that length.
        unsafe { self.entries[index].assume_init() }
    }
}
