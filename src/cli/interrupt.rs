//! Ctrl-C: the first ends the render and saves what there is, the second ends the program.

use std::io::Write;
use std::process::exit;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use halfshade::output::discard_unfinished;

/// Whether the user wants the render to end.
#[derive(Debug, Default)]
pub struct Interrupt {
    /// Set by the first Ctrl-C.
    is_requested: AtomicBool,
    /// Whether there is a picture to save.
    is_rendering: AtomicBool,
    /// Whether the picture has all its samples, and is being saved.
    is_complete: AtomicBool,
}

impl Interrupt {
    /// Listens for Ctrl-C.
    ///
    /// Before [`Interrupt::rendering_begins`] there is nothing to save, and the program ends at
    /// once. Where the system lets nobody listen, it always does.
    pub fn listen() -> Arc<Self> {
        let interrupt = Arc::new(Self::default());
        let heard = Arc::clone(&interrupt);
        let _ = ctrlc::set_handler(move || heard.on_ctrl_c());
        interrupt
    }

    /// Whether a render is to end; for the renderer.
    pub fn is_requested(&self) -> &AtomicBool {
        &self.is_requested
    }

    /// From now on, until [`Interrupt::rendering_begins`], there is nothing to save.
    pub fn rendering_is_ahead(&self) {
        self.is_rendering.store(false, Ordering::SeqCst);
        self.is_complete.store(false, Ordering::SeqCst);
    }

    /// From now on there is something to save.
    pub fn rendering_begins(&self) {
        self.is_rendering.store(true, Ordering::SeqCst);
    }

    /// From now on there is nothing left to interrupt but the saving.
    pub fn rendering_is_complete(&self) {
        self.is_complete.store(true, Ordering::SeqCst);
    }

    fn on_ctrl_c(&self) {
        let is_first = !self.is_requested.swap(true, Ordering::SeqCst);
        if !is_first || !self.is_rendering.load(Ordering::SeqCst) {
            discard_unfinished();
            exit(1);
        }
        let message = if self.is_complete.load(Ordering::SeqCst) {
            "the picture is complete and being saved; once more to leave without"
        } else {
            "interrupted: saving what there is; once more to leave without"
        };
        let _ = writeln!(std::io::stderr(), "{message}");
    }
}
