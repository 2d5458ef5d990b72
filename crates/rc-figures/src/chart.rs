//! Charts with linear axes as plain data: lines, marks, bars and texts, in the order of drawing.

use plotters::chart::ChartContext;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{
    Cartesian2d, ChartBuilder, Circle, DashedLineSeries, DrawingAreaErrorKind, DrawingBackend, EmptyElement, IntoFont,
    LineSeries, PathElement, Polygon, RGBColor, Rectangle, Text, TriangleMarker,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color, ShapeStyle, TextStyle, WHITE};
use rc_plot::{Area, FONT, PictureError};

/// Size of the text, in pixels.
pub(crate) const TEXT: f64 = 30.0;
/// Height of the space for numbers and the name of the x axis, in pixels. The width of that of the y axis follows.
const LABELS: u32 = 84;
const LABELS_OF_Y: u32 = LABELS * 3 / 2;
/// Space to the left, to the right, above and below, in pixels.
const MARGINS: [u32; 4] = [10, (1.5 * TEXT) as u32, TEXT as u32, 10];
/// Length of the sample of a line in the legend, in pixels.
const SAMPLE: i32 = (1.8 * TEXT) as i32;
/// Colours that colour-blind readers can tell apart, also in print (after Okabe and Ito).
pub(crate) const BLUE: RGBColor = RGBColor(0, 90, 160);
pub(crate) const RED: RGBColor = RGBColor(200, 60, 20);
pub(crate) const GREEN: RGBColor = RGBColor(0, 130, 100);
pub(crate) const GREY: RGBColor = RGBColor(110, 110, 110);
/// Colour of lines that only guide the eye.
const PALE: RGBColor = RGBColor(228, 228, 228);

/// A point in the coordinates of a chart.
pub(crate) type Point = (f64, f64);
type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
type Drawn<T, B> = Result<T, DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// A line's colour, width in pixels, and lengths of its dashes and of the spaces between them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pen {
    colour: RGBColor,
    opacity: f64,
    width: u32,
    dashes: Option<(i32, i32)>,
}

impl Pen {
    pub(crate) const fn new(colour: RGBColor, width: u32) -> Self {
        Self { colour, opacity: 1.0, width, dashes: None }
    }

    pub(crate) const fn dashed(self, dash: i32, space: i32) -> Self {
        Self { dashes: Some((dash, space)), ..self }
    }

    pub(crate) const fn pale(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    fn stroke(self) -> ShapeStyle {
        self.colour.mix(self.opacity).stroke_width(self.width)
    }

    /// Ends of the pieces of a sample, in pixels.
    fn pieces(self) -> Vec<(i32, i32)> {
        let Some((dash, space)) = self.dashes else { return vec![(0, SAMPLE)] };
        (0..SAMPLE).step_by((dash + space) as usize).map(|from| (from, (from + dash).min(SAMPLE))).collect()
    }
}

/// Shape of a mark.
#[derive(Clone, Copy, Debug)]
enum Shape {
    Dot,
    Triangle,
    /// An open square, since the value under it is compared with it.
    Square,
}

/// A mark at a data point, with half its size in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    shape: Shape,
    colour: RGBColor,
    size: i32,
}

impl Mark {
    pub(crate) const fn dot(colour: RGBColor, size: i32) -> Self {
        Self { shape: Shape::Dot, colour, size }
    }

    /// The mark of a printed value.
    pub(crate) const fn square(colour: RGBColor) -> Self {
        Self { shape: Shape::Square, colour, size: 11 }
    }

    pub(crate) const fn sized(self, size: i32) -> Self {
        Self { size, ..self }
    }

    /// Draws the mark `right` pixels right of each point.
    fn draw<B: DrawingBackend>(self, chart: &mut Chart<'_, B>, points: &[Point], right: i32) -> Drawn<(), B> {
        let Self { colour, size, .. } = self;
        let points = points.iter().copied();
        match self.shape {
            Shape::Dot => chart
                .draw_series(points.map(|at| EmptyElement::at(at) + Circle::new((right, 0), size, colour.filled())))?,
            Shape::Triangle => chart.draw_series(
                points.map(|at| EmptyElement::at(at) + TriangleMarker::new((right, 0), size + 2, colour.filled())),
            )?,
            Shape::Square => chart.draw_series(points.map(|at| {
                let corners = [(right - size, -size), (right + size, size)];
                EmptyElement::at(at) + Rectangle::new(corners, colour.stroke_width(4))
            }))?,
        };
        Ok(())
    }
}

/// Style of one surface in all figures that show both surfaces.
///
/// As in the paper, N = 64 has red dots and solid lines, and N = 128 has blue triangles and dashed lines. Shape and
/// dashes distinguish them without colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    pub(crate) colour: RGBColor,
    pub(crate) mark: Mark,
    pub(crate) pen: Pen,
}

/// The styles of the first and second surface.
pub(crate) const STYLES: [Style; 2] = [
    Style { colour: RED, mark: Mark::dot(RED, 8), pen: Pen::new(RED, 3) },
    Style {
        colour: BLUE,
        mark: Mark { shape: Shape::Triangle, colour: BLUE, size: 8 },
        pen: Pen::new(BLUE, 3).dashed(14, 8),
    },
];

/// Position of a text relative to its point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Side {
    Left,
    Right,
    Above,
    RightAbove,
    Below,
    /// To the right of the sample of a line in the legend.
    RightOfSample,
}

/// The sample in a line of the legend.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Key {
    Mark(Mark),
    Line(Pen),
}

#[derive(Clone, Debug)]
enum Item {
    Line(Vec<Point>, Pen),
    Body(Vec<Point>, RGBColor),
    Marks(Vec<Point>, Mark),
    /// Points with half the length of their bar, and whether bars are along x.
    Bars(Vec<(Point, f64)>, bool, RGBColor),
    Text(Point, Side, String, RGBColor),
    /// A vertical dimension at x, with heads at both ends.
    Dimension(f64, (f64, f64)),
    Key(Point, Key),
}

/// A chart: ranges and names of its axes, and its items.
#[derive(Clone, Debug)]
pub(crate) struct Panel {
    x: (f64, f64),
    y: (f64, f64),
    labels: [&'static str; 2],
    /// Approximate number of labels along x and along y.
    n_labels: (usize, usize),
    /// Factor and name of a second scale along the top.
    top: Option<(f64, &'static str)>,
    items: Vec<Item>,
}

impl Panel {
    /// An empty chart over these ranges with these names of its axes.
    pub(crate) fn new((x_label, x): (&'static str, Point), (y_label, y): (&'static str, Point)) -> Self {
        Self { x, y, labels: [x_label, y_label], n_labels: (7, 7), top: None, items: Vec::new() }
    }

    pub(crate) fn ticks(self, along_x: usize, along_y: usize) -> Self {
        Self { n_labels: (along_x, along_y), ..self }
    }

    /// The chart with a second scale along its top, `factor` times x.
    pub(crate) fn with_top(self, factor: f64, label: &'static str) -> Self {
        Self { top: Some((factor, label)), ..self }
    }

    pub(crate) fn line(&mut self, points: impl IntoIterator<Item = Point>, pen: Pen) {
        self.items.push(Item::Line(points.into_iter().collect(), pen));
    }

    /// Adds a filled polygon.
    pub(crate) fn body(&mut self, corners: impl IntoIterator<Item = Point>, colour: RGBColor) {
        self.items.push(Item::Body(corners.into_iter().collect(), colour));
    }

    pub(crate) fn marks(&mut self, points: impl IntoIterator<Item = Point>, mark: Mark) {
        self.items.push(Item::Marks(points.into_iter().collect(), mark));
    }

    /// Adds error bars, which extend by half their length to both sides of their points.
    pub(crate) fn bars(&mut self, points: impl IntoIterator<Item = (Point, f64)>, colour: RGBColor) {
        self.items.push(Item::Bars(points.into_iter().collect(), false, colour));
    }

    /// As [`Panel::bars`], along x.
    pub(crate) fn bars_along_x(&mut self, points: impl IntoIterator<Item = (Point, f64)>, colour: RGBColor) {
        self.items.push(Item::Bars(points.into_iter().collect(), true, colour));
    }

    pub(crate) fn text(&mut self, at: Point, side: Side, text: impl Into<String>, colour: RGBColor) {
        self.items.push(Item::Text(at, side, text.into(), colour));
    }

    /// Adds black text to the right of `at`.
    pub(crate) fn note(&mut self, at: Point, text: impl Into<String>) {
        self.text(at, Side::Right, text, BLACK);
    }

    pub(crate) fn dimension(&mut self, x: f64, ends: (f64, f64)) {
        self.items.push(Item::Dimension(x, ends));
    }

    /// Adds a legend with its first line at `corner`. Each line is `step` below the previous one.
    pub(crate) fn legend(
        &mut self,
        corner: Point,
        step: f64,
        lines: impl IntoIterator<Item = (Key, impl Into<String>)>,
    ) {
        for (i, (key, text)) in lines.into_iter().enumerate() {
            let at = (corner.0, corner.1 - step * i as f64);
            self.items.push(Item::Key(at, key));
            self.text(at, Side::RightOfSample, text, BLACK);
        }
    }

    /// Width and height between the axes, in pixels, on an area of `size` without a second scale.
    pub(crate) fn plotting_size(size: (u32, u32)) -> (f64, f64) {
        let [left, right, top, bottom] = MARGINS;
        (f64::from(size.0 - left - right - LABELS_OF_Y), f64::from(size.1 - top - bottom - LABELS))
    }

    /// Draws the chart.
    pub(crate) fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        self.drawn(area).map_err(PictureError::new)
    }

    fn drawn<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let (x, y) = (self.x.0..self.x.1, self.y.0..self.y.1);
        let mut builder = ChartBuilder::on(area);
        let [left, right, top, bottom] = MARGINS;
        builder.margin_left(left).margin_right(right).margin_top(top).margin_bottom(bottom);
        builder.x_label_area_size(LABELS).y_label_area_size(LABELS_OF_Y);
        let Some((factor, label_of_top)) = self.top else {
            let mut chart = builder.build_cartesian_2d(x, y)?;
            self.axes(&mut chart)?;
            return self.items.iter().try_for_each(|item| item.draw(&mut chart));
        };
        builder.margin_top((0.6 * TEXT) as u32).top_x_label_area_size(LABELS);
        let second = factor * self.x.0..factor * self.x.1;
        let mut chart = builder.build_cartesian_2d(x, y.clone())?.set_secondary_coord(second, y);
        self.axes(&mut chart)?;
        let mut top = chart.configure_secondary_axes();
        top.x_desc(label_of_top).x_labels(self.n_labels.0).x_label_formatter(&|x| label(*x)).set_all_tick_mark_size(6);
        top.label_style(words(0.85 * TEXT, BLACK)).axis_desc_style(words(TEXT, BLACK)).draw()?;
        self.items.iter().try_for_each(|item| item.draw(&mut chart))
    }

    fn axes<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>) -> Drawn<(), B> {
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(self.labels[0]).y_desc(self.labels[1]).x_labels(self.n_labels.0).y_labels(self.n_labels.1);
        mesh.x_label_formatter(&|x| label(*x)).y_label_formatter(&|y| label(*y)).set_all_tick_mark_size(6);
        mesh.label_style(words(0.85 * TEXT, BLACK)).axis_desc_style(words(TEXT, BLACK));
        mesh.light_line_style(WHITE).bold_line_style(PALE).draw()
    }
}

/// Draws `panels` in rows and columns of equal size.
pub(crate) fn draw_panels<B: DrawingBackend>(
    area: &Area<B>,
    rows_and_columns: (usize, usize),
    panels: &[Panel],
) -> Result<(), PictureError> {
    area.split_evenly(rows_and_columns).iter().zip(panels).try_for_each(|(area, panel)| panel.draw(area))
}

impl Item {
    fn draw<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>) -> Drawn<(), B> {
        match self {
            Self::Line(points, pen) => {
                let points = points.iter().copied();
                match pen.dashes {
                    None => chart.draw_series(LineSeries::new(points, pen.stroke()))?,
                    Some((dash, space)) => {
                        chart.draw_series(DashedLineSeries::new(points, dash, space, pen.stroke()))?
                    }
                };
                Ok(())
            }
            Self::Body(corners, colour) => {
                chart.draw_series([Polygon::new(corners.clone(), colour.filled())]).map(|_| ())
            }
            Self::Marks(points, mark) => mark.draw(chart, points, 0),
            Self::Bars(bars, along_x, colour) => {
                bars.iter().try_for_each(|bar| draw_bar(chart, bar, *along_x, *colour))
            }
            Self::Text(at, side, text, colour) => draw_text(chart, *at, *side, text, *colour),
            Self::Dimension(x, (from, to)) => draw_dimension(chart, *x, (*from, *to)),
            Self::Key(at, Key::Mark(mark)) => mark.draw(chart, &[*at], SAMPLE / 2),
            Self::Key(at, Key::Line(pen)) => {
                let piece = |(from, to)| EmptyElement::at(*at) + PathElement::new([(from, 0), (to, 0)], pen.stroke());
                chart.draw_series(pen.pieces().into_iter().map(piece)).map(|_| ())
            }
        }
    }
}

fn draw_bar<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    &((x, y), half): &(Point, f64),
    along_x: bool,
    colour: RGBColor,
) -> Drawn<(), B> {
    let ends = if along_x { [(x - half, y), (x + half, y)] } else { [(x, y - half), (x, y + half)] };
    let cap = if along_x { [(0, -6), (0, 6)] } else { [(-6, 0), (6, 0)] };
    chart.draw_series([PathElement::new(ends, colour.stroke_width(2))])?;
    chart.draw_series(ends.map(|end| EmptyElement::at(end) + PathElement::new(cap, colour.stroke_width(2))))?;
    Ok(())
}

fn draw_dimension<B: DrawingBackend>(chart: &mut Chart<'_, B>, x: f64, (from, to): (f64, f64)) -> Drawn<(), B> {
    chart.draw_series([PathElement::new([(x, from), (x, to)], BLACK.stroke_width(2))])?;
    let up = if to > from { 1 } else { -1 };
    for (end, sign) in [(from, -up), (to, up)] {
        // Coordinates in pixels increase downwards.
        let head = [(0, 0), (-7, 18 * sign), (7, 18 * sign)];
        chart.draw_series([EmptyElement::at((x, end)) + Polygon::new(head, BLACK.filled())])?;
    }
    Ok(())
}

fn draw_text<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    at: Point,
    side: Side,
    text: &str,
    colour: RGBColor,
) -> Drawn<(), B> {
    let gap = (0.35 * TEXT) as i32;
    let (offset, horizontal, vertical) = match side {
        Side::Left => ((-gap, 0), HPos::Right, VPos::Center),
        Side::Right => ((gap, 0), HPos::Left, VPos::Center),
        // The backends centre the box of the line, not the digits.
        Side::RightOfSample => ((gap + SAMPLE, (0.14 * TEXT) as i32), HPos::Left, VPos::Center),
        Side::RightAbove => ((gap, -gap), HPos::Left, VPos::Bottom),
        Side::Above => ((0, -gap), HPos::Center, VPos::Bottom),
        Side::Below => ((0, gap), HPos::Center, VPos::Top),
    };
    let style = words(0.95 * TEXT, colour).pos(Pos::new(horizontal, vertical));
    chart.draw_series([EmptyElement::at(at) + Text::new(text.to_owned(), offset, style)])?;
    Ok(())
}

/// Text of a number on an axis.
///
/// Ticks are sums of steps, so rounding removes their last digits.
fn label(value: f64) -> String {
    // Adding zero turns -0 into 0.
    rc_core::quantity::label(1e-9 * (1e9 * value).round() + 0.0)
}

/// Text of a size and colour.
pub(crate) fn words(size: f64, colour: RGBColor) -> TextStyle<'static> {
    (FONT, size).into_font().color(&colour)
}
