//! The progress bar of a render.

use std::time::Duration;

use halfshade::render::Progress;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// Share, rate and time left of a render.
pub struct RenderProgress {
    bar: ProgressBar,
}

impl RenderProgress {
    /// A bar on standard error; none where `is_shown` is false.
    pub fn new(is_shown: bool) -> Self {
        let bar = ProgressBar::new(1);
        if is_shown {
            bar.set_style(style());
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(Duration::from_millis(200));
        } else {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        Self { bar }
    }

    /// Shows how far it has come; from any thread.
    pub fn observe(&self, progress: Progress) {
        self.bar.set_length(progress.total);
        self.bar.set_position(progress.done);
    }

    /// Says something while the bar is out of the way.
    pub fn suspend(&self, say: impl FnOnce()) {
        self.bar.suspend(say);
    }

    /// Takes the bar away.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}

fn style() -> ProgressStyle {
    let rate = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{:.2} million samples/s", state.per_sec() / 1e6);
    };
    let left = |state: &ProgressState, out: &mut dyn std::fmt::Write| {
        let _ = write!(out, "{} left", HumanDuration(state.eta()));
    };
    ProgressStyle::with_template("rendering {wide_bar} {percent:>3} %, {rate}, {left}")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
        .with_key("rate", rate)
        .with_key("left", left)
}
