//! What ends a render from outside: the user, and the clock.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Whether the work is to end.
pub(super) struct Stop<'a> {
    cancel: &'a AtomicBool,
    deadline: Option<Instant>,
    /// Set by the first who sees that the deadline has passed.
    is_late: AtomicBool,
}

impl<'a> Stop<'a> {
    pub fn new(cancel: &'a AtomicBool, deadline: Option<Instant>) -> Self {
        Self {
            cancel,
            deadline,
            is_late: AtomicBool::new(false),
        }
    }

    /// Whether the user wants the end.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Whether the deadline has passed; looks at the clock.
    pub fn is_late(&self) -> bool {
        let Some(deadline) = self.deadline else {
            return false;
        };
        if !self.is_late.load(Ordering::Relaxed) && Instant::now() >= deadline {
            self.is_late.store(true, Ordering::Relaxed);
        }
        self.is_late.load(Ordering::Relaxed)
    }
}
