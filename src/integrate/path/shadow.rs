//! What paths and their shadow rays cross without a bend.

use crate::color::Rgb;
use crate::prepare::Surface;

/// Share of the light that crosses `surface` in a straight line.
///
/// Shadow rays cross exactly what paths cross without scattering: holes, what is partly transparent,
/// and panes. A body that refracts stops them, whatever it is made of: the light behind it comes
/// by the paths that go through it, and must not be counted twice.
pub(super) fn let_through(surface: &Surface) -> Rgb {
    let opacity = surface.material.opacity(&surface.lookup);
    let clear = Rgb::splat(1.0 - opacity);
    through_pane(surface).map_or(clear, |straight| clear + straight * opacity)
}

/// Share of the light that goes on behind `surface` as if nothing were there, but for its colour; `None` where that
/// is no pane. A body that absorbs on the way is none.
pub(super) fn through_pane(surface: &Surface) -> Option<Rgb> {
    if surface.absorption().is_some() {
        return None;
    }
    let straight = surface.straight();
    (!straight.is_black()).then_some(straight)
}
