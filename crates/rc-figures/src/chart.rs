//! Elements that line figures share: colours, axes, text at a point, and dimension arrows.

use plotters::chart::DualCoordChartContext;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    Cartesian2d, ChartBuilder, ChartContext, DrawingAreaErrorKind, DrawingBackend, EmptyElement, IntoFont, PathElement,
    Polygon, RGBColor, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color, TextStyle, WHITE};
use rc_plot::{Area, FONT};

/// Size of the text, in pixels.
pub(crate) const TEXT: f64 = 30.0;
/// Height of the space for numbers and the name of the x axis, in pixels.
const LABELS: u32 = 84;
/// Colours that colour-blind readers can tell apart, also in print (after Okabe and Ito).
pub(crate) const BLUE: RGBColor = RGBColor(0, 90, 160);
pub(crate) const RED: RGBColor = RGBColor(200, 60, 20);
pub(crate) const GREEN: RGBColor = RGBColor(0, 130, 100);
pub(crate) const GREY: RGBColor = RGBColor(110, 110, 110);
/// Colour of lines that only guide the eye.
const PALE: RGBColor = RGBColor(228, 228, 228);

/// A chart with linear axes.
pub(crate) type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// A chart with a second scale along its top. Series use the first scale.
pub(crate) type TwoScales<'a, B> = DualCoordChartContext<
    'a,
    B,
    Cartesian2d<RangedCoordf64, RangedCoordf64>,
    Cartesian2d<RangedCoordf64, RangedCoordf64>,
>;

/// Result of drawing.
pub(crate) type Drawn<T, B> = Result<T, DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// Ranges and names of the axes of a chart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes<'a> {
    pub(crate) x: (f64, f64),
    pub(crate) y: (f64, f64),
    pub(crate) x_label: &'a str,
    pub(crate) y_label: &'a str,
    /// Approximate number of labels along x and along y.
    pub(crate) n_labels: (usize, usize),
}

impl Axes<'_> {
    /// A chart with its axes drawn.
    pub(crate) fn on<'a, B: DrawingBackend>(&self, area: &'a Area<B>) -> Drawn<Chart<'a, B>, B> {
        let mut chart =
            builder(area).margin_top(TEXT as u32).build_cartesian_2d(self.x.0..self.x.1, self.y.0..self.y.1)?;
        self.draw(&mut chart)?;
        Ok(chart)
    }

    /// A chart with its axes and a second scale along its top.
    ///
    /// The second scale is `factor` times x, and its name is `x_label`.
    pub(crate) fn with_top<'a, B: DrawingBackend>(
        &self,
        area: &'a Area<B>,
        factor: f64,
        x_label: &str,
    ) -> Drawn<TwoScales<'a, B>, B> {
        let (x, y) = (self.x.0..self.x.1, self.y.0..self.y.1);
        let chart = builder(area)
            .margin_top((0.6 * TEXT) as u32)
            .top_x_label_area_size(LABELS)
            .build_cartesian_2d(x, y.clone())?;
        let mut chart = chart.set_secondary_coord(factor * self.x.0..factor * self.x.1, y);
        self.draw(&mut chart)?;
        let mut top = chart.configure_secondary_axes();
        top.x_desc(x_label).x_labels(self.n_labels.0).x_label_formatter(&|x| label(*x)).set_all_tick_mark_size(6);
        top.label_style(words(0.85 * TEXT, BLACK)).axis_desc_style(words(TEXT, BLACK)).draw()?;
        Ok(chart)
    }

    fn draw<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>) -> Drawn<(), B> {
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(self.x_label).y_desc(self.y_label).x_labels(self.n_labels.0).y_labels(self.n_labels.1);
        mesh.x_label_formatter(&|x| label(*x)).y_label_formatter(&|y| label(*y)).set_all_tick_mark_size(6);
        mesh.label_style(words(0.85 * TEXT, BLACK)).axis_desc_style(words(TEXT, BLACK));
        mesh.light_line_style(WHITE).bold_line_style(PALE).draw()
    }
}

/// A builder of charts with space for numbers and names.
fn builder<'b, B: DrawingBackend>(area: &Area<B>) -> ChartBuilder<'_, 'b, B> {
    let mut builder = ChartBuilder::on(area);
    builder.margin_left(10).margin_right((1.5 * TEXT) as u32).margin_bottom(10);
    builder.x_label_area_size(LABELS).y_label_area_size((1.5 * f64::from(LABELS)) as u32);
    builder
}

/// Text of a number on an axis.
///
/// Ticks are sums of steps, so rounding removes their last digits.
fn label(value: f64) -> String {
    // Adding zero turns -0 into 0.
    rc_core::quantity::label(1e-9 * (1e9 * value).round() + 0.0)
}

/// Text of a size and colour.
fn words(size: f64, colour: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&colour)
}

/// Position of a text relative to its point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Side {
    Left,
    Right,
    /// To the right by this many pixels.
    RightOf(i32),
    Above,
    RightAbove,
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
        // The backends centre the box of the line, not the digits.
        Side::RightOf(pixels) => ((gap + pixels, (0.14 * TEXT) as i32), HPos::Left, VPos::Center),
        Side::RightAbove => ((gap, -gap), HPos::Left, VPos::Bottom),
        Side::Above => ((0, -gap), HPos::Center, VPos::Bottom),
        Side::Below => ((0, gap), HPos::Center, VPos::Top),
    };
    let style = words(0.95 * TEXT, colour).pos(Pos::new(horizontal, vertical));
    chart.draw_series([EmptyElement::at(at) + Text::new(text.to_owned(), offset, style)])?;
    Ok(())
}

/// Draws a vertical dimension arrow with heads at both ends.
pub(crate) fn dimension<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    x: f64,
    (from, to): (f64, f64),
    colour: RGBColor,
) -> Drawn<(), B> {
    chart.draw_series([PathElement::new([(x, from), (x, to)], colour.stroke_width(2))])?;
    let up = if to > from { 1 } else { -1 };
    for (end, sign) in [(from, -up), (to, up)] {
        // Coordinates in pixels increase downwards.
        let head = [(0, 0), (-7, 18 * sign), (7, 18 * sign)];
        chart.draw_series([EmptyElement::at((x, end)) + Polygon::new(head, colour.filled())])?;
    }
    Ok(())
}
