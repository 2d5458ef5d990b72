//! What line figures share: colours, axes, words at a point, and dimension arrows.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    Cartesian2d, ChartBuilder, ChartContext, DrawingAreaErrorKind, DrawingBackend, EmptyElement, IntoFont, PathElement,
    Polygon, RGBColor, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color, TextStyle};
use rc_cli::picture::{Area, FONT};

/// Text, in pixels.
pub(crate) const TEXT: f64 = 24.0;
/// Colours that stay apart in print and for colour-blind readers (after Okabe and Ito).
pub(crate) const BLUE: RGBColor = RGBColor(0, 90, 160);
pub(crate) const RED: RGBColor = RGBColor(200, 60, 20);
pub(crate) const GREEN: RGBColor = RGBColor(0, 130, 100);
pub(crate) const GREY: RGBColor = RGBColor(110, 110, 110);
/// Lines that only guide the eye.
const PALE: RGBColor = RGBColor(228, 228, 228);

/// A chart with linear axes.
pub(crate) type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// What drawing returns.
pub(crate) type Drawn<T, B> = Result<T, DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// Ranges and names of the axes of a chart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes<'a> {
    pub(crate) x: (f64, f64),
    pub(crate) y: (f64, f64),
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    /// About how many numbers along x and along y.
    pub(crate) n_labels: (usize, usize),
    /// Pixels above the chart: `TEXT` or so, or more for a second axis.
    pub(crate) top: u32,
}

impl Axes<'_> {
    /// Draws the axes and returns the chart.
    pub(crate) fn on<'a, B: DrawingBackend>(&self, area: &'a Area<B>) -> Drawn<Chart<'a, B>, B> {
        let mut chart = ChartBuilder::on(area)
            .margin_left(10)
            .margin_right(34)
            .margin_bottom(10)
            .top_x_label_area_size(self.top)
            .x_label_area_size((2.9 * TEXT) as u32)
            .y_label_area_size((4.4 * TEXT) as u32)
            .build_cartesian_2d(self.x.0..self.x.1, self.y.0..self.y.1)?;
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(self.x_label).y_desc(self.y_label).x_labels(self.n_labels.0).y_labels(self.n_labels.1);
        mesh.x_label_formatter(&label).y_label_formatter(&label).set_all_tick_mark_size(6);
        mesh.label_style(words(0.85 * TEXT, BLACK)).axis_desc_style(words(TEXT, BLACK));
        mesh.light_line_style(RGBColor(255, 255, 255)).bold_line_style(PALE).draw()?;
        Ok(chart)
    }
}

/// A number on an axis. Ticks are sums of steps, so their last digits are rounding.
pub(crate) fn label(value: &f64) -> String {
    rc_cli::quantity::label(1e-9 * (1e9 * value).round())
}

/// Text of a size and colour.
pub(crate) fn words(size: f64, colour: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&colour)
}

/// Where a text stands about its point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Side {
    Left,
    Right,
    Above,
    Below,
}

/// Writes `text` beside the point `at`.
pub(crate) fn write<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    at: (f64, f64),
    side: Side,
    text: &str,
    colour: RGBColor,
) -> Drawn<(), B> {
    let gap = (0.35 * TEXT) as i32;
    let (offset, horizontal, vertical) = match side {
        Side::Left => ((-gap, 0), HPos::Right, VPos::Center),
        Side::Right => ((gap, 0), HPos::Left, VPos::Center),
        Side::Above => ((0, -gap), HPos::Center, VPos::Bottom),
        Side::Below => ((0, gap), HPos::Center, VPos::Top),
    };
    let style = words(0.95 * TEXT, colour).pos(Pos::new(horizontal, vertical));
    chart.draw_series([EmptyElement::at(at) + Text::new(text.to_owned(), offset, style)])?;
    Ok(())
}

/// A vertical dimension arrow with heads at both ends, as in drawings.
pub(crate) fn dimension<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    x: f64,
    (from, to): (f64, f64),
    colour: RGBColor,
) -> Drawn<(), B> {
    chart.draw_series([PathElement::new([(x, from), (x, to)], colour.stroke_width(2))])?;
    let up = if to > from { 1 } else { -1 };
    for (end, sign) in [(from, -up), (to, up)] {
        // Pixels count downwards.
        let head = [(0, 0), (-6, 14 * sign), (6, 14 * sign)];
        chart.draw_series([EmptyElement::at((x, end)) + Polygon::new(head, colour.filled())])?;
    }
    Ok(())
}
