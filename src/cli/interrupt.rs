//! Ctrl-C: the first ends the render and saves what there is, the second ends the program.

use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user wants the render to end.
#[derive(Debug, Default)]
pub struct Interrupt {
    /// Set by the first Ctrl-C.
    pub is_requested: AtomicBool,
    /// Whether there is a picture to save.
    is_rendering: AtomicBool,
}

impl Interrupt {
    /// Listens for Ctrl-C.
    ///
    /// Before [`Interrupt::rendering_begins`] there is nothing to save, and the program ends at
    /// once. Where the system lets nobody listen, it always does.
    pub fn listen() -> Arc<Self> {
        let interrupt = Arc::new(Self::default());
        let heard = Arc::clone(&interrupt);
        let handler = move || {
            let is_first = !heard.is_requested.swap(true, Ordering::SeqCst);
            if is_first && heard.is_rendering.load(Ordering::SeqCst) {
                let _ = writeln!(
                    std::io::stderr(),
                    "interrupted: saving what there is; once more to leave without"
                );
            } else {
                std::process::exit(1);
            }
        };
        let _ = ctrlc::set_handler(handler);
        interrupt
    }

    /// From now on there is something to save.
    pub fn rendering_begins(&self) {
        self.is_rendering.store(true, Ordering::SeqCst);
    }
}
