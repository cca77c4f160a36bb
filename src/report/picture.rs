//! Pictures as plain data.

use crate::color::Rgb;
use crate::film::Film;
use crate::math::UVec2;

/// Linear colours with Rec. 709 primaries, of any size and not clipped.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels across and down.
    pub size: UVec2,
    /// Row by row from the top, `size.x * size.y` of them.
    pub pixels: Vec<Rgb>,
}

impl Picture {
    /// The picture whose pixel at column `x` and row `y` is `color(x, y)`.
    pub fn from_fn(size: UVec2, mut color: impl FnMut(u32, u32) -> Rgb) -> Self {
        let rows = (0..size.y).flat_map(|y| (0..size.x).map(move |x| (x, y)));
        let pixels = rows.map(|(x, y)| color(x, y)).collect();
        Self { size, pixels }
    }
}

impl From<&Film> for Picture {
    fn from(film: &Film) -> Self {
        Self {
            size: film.size(),
            pixels: film.means(),
        }
    }
}
