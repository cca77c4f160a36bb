//! Charts to SVG elements.

use std::error::Error;

use plotters::chart::ChartContext;
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::{LogAxis, is_drawable};
use super::{Chart, Guide, Line, Marker, Point, Series, Style};

/// Plotters draws on whole units: so many to a pixel keep curves smooth.
const UNITS: u32 = 10;

/// Okabe and Ito's colours, without the yellow that is too light for lines.
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];
const INK: RGBColor = RGBColor(40, 40, 40);
const GUIDE: RGBColor = RGBColor(130, 130, 130);
const MAJOR: RGBColor = RGBColor(215, 215, 215);
const MINOR: RGBColor = RGBColor(240, 240, 240);

/// Pixels.
const LEGEND_ROW: u32 = 22;
const LEGEND_SWATCH: u32 = 34;
const TEXT: u32 = 13;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Context<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<LogAxis, LogAxis>>;
type Drawn = Result<(), Box<dyn Error>>;

/// See [`super::svg`].
pub fn svg(charts: &[Chart], columns: usize, size: [u32; 2]) -> Result<String, Box<dyn Error>> {
    let columns = columns.clamp(1, charts.len().max(1));
    let rows = charts.len().div_ceil(columns).max(1);
    let width = size[0] * columns as u32;
    let legend = Legend::of(charts, width);
    let height = size[1] * rows as u32 + legend.height();
    let mut text = String::new();
    {
        let root =
            SVGBackend::with_string(&mut text, (width * UNITS, height * UNITS)).into_drawing_area();
        root.fill(&WHITE)?;
        let (top, body) = root.split_vertically(legend.height() * UNITS);
        legend.draw(&top)?;
        for (area, chart) in body.split_evenly((rows, columns)).iter().zip(charts) {
            draw_chart(area, chart)?;
        }
        root.present()?;
    }
    // The view box keeps its units.
    let of_units = format!("width=\"{}\" height=\"{}\"", width * UNITS, height * UNITS);
    let of_pixels = format!("width=\"{width}\" height=\"{height}\"");
    Ok(text.replacen(&of_units, &of_pixels, 1))
}

fn font(pixels: u32) -> TextStyle<'static> {
    ("sans-serif", pixels * UNITS).into_font().color(&INK)
}

fn stroke(color: RGBColor, tenths_of_a_pixel: u32) -> ShapeStyle {
    color.stroke_width(tenths_of_a_pixel * UNITS / 10)
}

fn color(style: Style) -> RGBColor {
    COLORS[style.color % COLORS.len()]
}

/// Every name once, in columns of one width and rows of one length.
struct Legend {
    entries: Vec<(String, Style)>,
    columns: usize,
    column_width: u32,
}

impl Legend {
    fn of(charts: &[Chart], width: u32) -> Self {
        let mut entries: Vec<(String, Style)> = Vec::new();
        for series in charts.iter().flat_map(|chart| &chart.series) {
            if !entries.iter().any(|(name, _)| *name == series.name) {
                entries.push((series.name.clone(), series.style));
            }
        }
        let longest = entries.iter().map(|(name, _)| name.chars().count());
        // There are no fonts here to measure with; this is enough for most.
        let column_width = LEGEND_SWATCH + (longest.max().unwrap_or(0) as u32 + 3) * TEXT * 3 / 5;
        let most = ((width - TEXT.min(width)) / column_width).max(1) as usize;
        let rows = entries.len().div_ceil(most).max(1);
        Self {
            columns: entries.len().div_ceil(rows).max(1),
            entries,
            column_width,
        }
    }

    fn height(&self) -> u32 {
        match self.entries.len().div_ceil(self.columns) {
            0 => 0,
            rows => LEGEND_ROW * rows as u32 + LEGEND_ROW / 2,
        }
    }

    fn draw(&self, area: &Area) -> Drawn {
        let anchor = Pos::new(HPos::Left, VPos::Center);
        for (i, (name, style)) in self.entries.iter().enumerate() {
            let [row, column] = [i / self.columns, i % self.columns].map(|n| n as u32);
            let y = (LEGEND_ROW * (row + 1) * UNITS) as i32;
            let x = ((TEXT + self.column_width * column) * UNITS) as i32;
            let end = x + (LEGEND_SWATCH * UNITS) as i32;
            draw_line(area, &[(x, y), (end, y)], *style)?;
            draw_marker(area, ((x + end) / 2, y), *style)?;
            let at = (end + (TEXT * UNITS / 2) as i32, y);
            area.draw(&Text::new(name.as_str(), at, font(TEXT).pos(anchor)))?;
        }
        Ok(())
    }
}

fn draw_chart(area: &Area, chart: &Chart) -> Drawn {
    let points = || chart.series.iter().flat_map(|series| &series.points);
    let drawable = || points().filter(|p| is_drawable(p.x) && is_drawable(p.y));
    let x = LogAxis::around(drawable().map(|p| p.x));
    let y = LogAxis::around(drawable().flat_map(|p| {
        let (low, high) = p.range.unwrap_or((p.y, p.y));
        [p.y, low, high]
    }));
    let mut context = ChartBuilder::on(area)
        .margin(8 * UNITS)
        .margin_right(16 * UNITS)
        .caption(&chart.title, font(TEXT + 2))
        .x_label_area_size(38 * UNITS)
        .y_label_area_size(58 * UNITS)
        .build_cartesian_2d(x.clone(), y.clone())?;
    context
        .configure_mesh()
        .x_label_formatter(&|v| x.label(*v))
        .y_label_formatter(&|v| y.label(*v))
        .x_desc(&chart.x)
        .y_desc(&chart.y)
        .label_style(font(TEXT - 1))
        .axis_desc_style(font(TEXT))
        .axis_style(stroke(INK, 10))
        .bold_line_style(stroke(MAJOR, 8))
        .light_line_style(stroke(MINOR, 6))
        .set_all_tick_mark_size(4 * UNITS)
        .draw()?;
    for guide in &chart.guides {
        draw_guide(&mut context, guide)?;
    }
    for series in &chart.series {
        draw_series(&mut context, series)?;
    }
    Ok(())
}

fn draw_guide(context: &mut Context, guide: &Guide) -> Drawn {
    let logs = |(low, high): (f64, f64)| (low.ln(), high.ln());
    let (x_axis, y_axis) = (context.x_range(), context.y_range());
    let (mut left, mut right) = logs((x_axis.start, x_axis.end));
    let (bottom, top) = logs((y_axis.start, y_axis.end));
    let (x0, y0) = logs(guide.through);
    if guide.slope != 0.0 {
        let at_x = |y: f64| x0 + (y - y0) / guide.slope;
        let (a, b) = (at_x(bottom), at_x(top));
        (left, right) = (left.max(a.min(b)), right.min(a.max(b)));
    }
    if !(left < right && (guide.slope != 0.0 || (bottom..top).contains(&y0))) {
        return Ok(());
    }
    let at = |x: f64| (x.exp(), (y0 + guide.slope * (x - x0)).exp());
    let line = [at(left), at(right)];
    let (dash, gap) = (2 * UNITS, 3 * UNITS);
    context.draw_series(DashedLineSeries::new(line, dash, gap, stroke(GUIDE, 10)))?;
    // Beside the line, on the side away from it to the right.
    let vertical = if guide.slope > 0.0 {
        VPos::Top
    } else {
        VPos::Bottom
    };
    let name = font(TEXT - 2)
        .color(&GUIDE)
        .pos(Pos::new(HPos::Left, vertical));
    let place = at(left + 0.6 * (right - left));
    context.draw_series([Text::new(guide.name.clone(), place, name)])?;
    Ok(())
}

fn draw_series(context: &mut Context, series: &Series) -> Drawn {
    let points: Vec<&Point> = series
        .points
        .iter()
        .filter(|p| is_drawable(p.x) && is_drawable(p.y))
        .collect();
    let area = context.plotting_area().strip_coord_spec();
    let (left, top) = area.get_base_pixel();
    // The area takes places relative to its corner.
    let place = |context: &Context, x: f64, y: f64| {
        let (column, row) = context.backend_coord(&(x, y));
        (column - left, row - top)
    };
    for p in &points {
        if let Some((low, high)) = p.range.filter(|r| is_drawable(r.0) && is_drawable(r.1)) {
            let ends = vec![place(context, p.x, low), place(context, p.x, high)];
            area.draw(&PathElement::new(ends, stroke(color(series.style), 10)))?;
        }
    }
    let places: Vec<_> = points.iter().map(|p| place(context, p.x, p.y)).collect();
    draw_line(&area, &places, series.style)?;
    for &at in &places {
        draw_marker(&area, at, series.style)?;
    }
    Ok(())
}

fn draw_line(area: &Area, places: &[(i32, i32)], style: Style) -> Drawn {
    let stroke = stroke(color(style), 17);
    match style.line {
        Line::Solid => area.draw(&PathElement::new(places.to_vec(), stroke))?,
        Line::Dashed => {
            let places = places.iter().copied();
            area.draw(&DashedPathElement::new(
                places,
                9 * UNITS,
                5 * UNITS,
                stroke,
            ))?;
        }
        Line::None => {}
    }
    Ok(())
}

fn draw_marker(area: &Area, at: (i32, i32), style: Style) -> Drawn {
    let color = color(style);
    let radius = 7 * UNITS / 2;
    match style.marker {
        Marker::Disk => area.draw(&Circle::new(at, radius, color.filled()))?,
        Marker::Ring => {
            area.draw(&Circle::new(at, radius, WHITE.filled()))?;
            area.draw(&Circle::new(at, radius, stroke(color, 15)))?;
        }
        Marker::Triangle => area.draw(&TriangleMarker::new(at, 9 * UNITS / 2, color.filled()))?,
        Marker::Cross => area.draw(&Cross::new(at, radius, stroke(color, 17)))?,
    }
    Ok(())
}
