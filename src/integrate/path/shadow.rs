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
    let mut through = Rgb::splat(1.0 - opacity);
    if is_pane(surface) {
        through += surface.straight() * opacity;
    }
    through
}

/// Whether what `surface` lets through goes on as if nothing were there, but for its colour. A body
/// that absorbs on the way is none.
pub(super) fn is_pane(surface: &Surface) -> bool {
    surface.absorption().is_none() && !surface.straight().is_black()
}
