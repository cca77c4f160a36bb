//! Errors as pictures.

use super::Picture;
use super::color_map::color;
use super::digits;
use super::metrics::ErrorValues;
use super::scale::{Scale, Tick};
use crate::color::Rgb;
use crate::math::UVec2;

/// Pixels that are not finite in one of the pictures; no error has this colour.
pub const NON_FINITE: Rgb = Rgb::new(0.0, 1.0, 1.0);

/// Behind the colour bar and beside a narrow map.
const BACKGROUND: Rgb = Rgb::splat(0.02);
/// Columns that the numbers of a bar need.
const LEAST_WIDTH: u32 = 200;
/// Columns for which the bar has pixels of its own size; it grows with wider maps.
const PLAIN_WIDTH: u32 = 480;

/// Parts of the strip with the bar, in its pixels.
const MARGIN: u32 = 4;
const SIDE: u32 = 14;
const BAR_HEIGHT: u32 = 8;
const TICK_HEIGHT: u32 = 3;
const STRIP_HEIGHT: u32 = MARGIN + BAR_HEIGHT + TICK_HEIGHT + 1 + digits::HEIGHT + MARGIN;

/// The errors in colours.
pub fn colored(errors: &ErrorValues, scale: Scale) -> Picture {
    let shown = |error: &Option<f32>| match error {
        Some(error) => color(scale.position(*error)),
        None => NON_FINITE,
    };
    Picture {
        size: errors.size,
        pixels: errors.values.iter().map(shown).collect(),
    }
}

/// The errors in colours, above a colour bar with numbers.
pub fn with_bar(errors: &ErrorValues, scale: Scale) -> Picture {
    let map = colored(errors, scale);
    let zoom = (map.size.x / PLAIN_WIDTH).max(1);
    let width = map.size.x.max(LEAST_WIDTH);
    let strip = strip(width, zoom, scale);
    let size = UVec2::new(width, map.size.y + STRIP_HEIGHT * zoom);
    let left = (width - map.size.x) / 2;
    Picture::from_fn(size, |x, y| {
        if let Some(y) = y.checked_sub(map.size.y) {
            strip[(y * width + x) as usize]
        } else if (left..left + map.size.x).contains(&x) {
            map.pixels[y as usize * map.size.x as usize + (x - left) as usize]
        } else {
            BACKGROUND
        }
    })
}

/// The pixels of a strip of `width` columns with a bar, ticks and numbers, `zoom` times enlarged.
fn strip(width: u32, zoom: u32, scale: Scale) -> Vec<Rgb> {
    let mut pixels = vec![BACKGROUND; (width * STRIP_HEIGHT * zoom) as usize];
    let mut fill = |x: u32, y: u32, width_and_height: (u32, u32), color: Rgb| {
        for row in y..y + width_and_height.1 {
            let start = (row * width + x) as usize;
            pixels[start..start + width_and_height.0 as usize].fill(color);
        }
    };
    let (left, length) = (SIDE * zoom, width - 2 * SIDE * zoom);
    let last = (length - 1).max(1) as f32;
    for x in 0..length {
        let below = (1, BAR_HEIGHT * zoom);
        fill(left + x, MARGIN * zoom, below, color(x as f32 / last));
    }
    for Tick { position, label } in scale.ticks() {
        let middle = left + (position * last).round() as u32;
        let mut y = (MARGIN + BAR_HEIGHT) * zoom;
        fill(middle - zoom / 2, y, (zoom, TICK_HEIGHT * zoom), Rgb::WHITE);
        y += (TICK_HEIGHT + 1) * zoom;
        let start = middle - digits::width(&label) * zoom / 2;
        for (column, row) in digits::pixels(&label) {
            let (x, y) = (start + column * zoom, y + row * zoom);
            fill(x, y, (zoom, zoom), Rgb::WHITE);
        }
    }
    pixels
}
