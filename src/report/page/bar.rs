//! A colour bar as a drawing inside of a page.

use crate::color::{Rgb, linear_to_srgb};
use crate::report::color_map::color;
use crate::report::scale::{Scale, Tick};

/// Colours of the bar: rectangles, since a gradient would need a name of its own in every page.
const STEPS: u32 = 120;
/// Length of the bar and what its numbers need beside it, units of the drawing.
const LENGTH: f32 = 600.0;
const SIDE: f32 = 30.0;

/// A colour bar with its numbers, as SVG. It prints, which the background of an element does not.
pub fn color_bar(scale: Scale) -> String {
    let width = LENGTH / STEPS as f32;
    let steps: String = (0..STEPS)
        .map(|i| {
            let x = SIDE + i as f32 * width;
            let fill = hex(color((i as f32 + 0.5) / STEPS as f32));
            format!("<rect x=\"{x}\" y=\"2\" width=\"{width}\" height=\"16\" fill=\"{fill}\"/>")
        })
        .collect();
    let ticks: String = scale
        .ticks()
        .iter()
        .map(|Tick { position, label }| {
            let x = SIDE + position * LENGTH;
            format!(
                "<path d=\"M{x} 18v6\"/><text x=\"{x}\" y=\"40\" text-anchor=\"middle\">{label}</text>\n"
            )
        })
        .collect();
    format!(
        "<svg class=\"bar\" viewBox=\"0 0 {} 46\" role=\"img\" aria-label=\"colour bar\">\n\
         <g shape-rendering=\"crispEdges\">{steps}</g>\n{ticks}</svg>\n",
        LENGTH + 2.0 * SIDE
    )
}

fn hex(color: Rgb) -> String {
    let level = |c: f32| (linear_to_srgb(c) * 255.0).round() as u8;
    let [r, g, b] = color.channels().map(level);
    format!("#{r:02x}{g:02x}{b:02x}")
}
