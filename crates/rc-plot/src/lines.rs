//! Line plots with linear or logarithmic axes.

use plotters::chart::{ChartBuilder, ChartContext, SeriesLabelPosition};
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::combinators::BindKeyPoints as _;
use plotters::coord::combinators::IntoLogRange as _;
use plotters::coord::ranged1d::{Ranged, ValueFormatter};
use plotters::element::{Circle, EmptyElement, PathElement};
use plotters::prelude::{DrawingBackend, IntoFont as _};
use plotters::series::{DashedLineSeries, LineSeries};
use plotters::style::{BLACK, Color as _, RGBColor, WHITE};

use crate::{Area, FONT, PictureError};
use rc_core::quantity::label;

/// A plot of one or more series.
#[derive(Clone, Debug)]
pub struct LinePlot<'a> {
    /// Text above the plot.
    pub title: &'a str,
    /// Label of the x axis.
    pub x_label: &'a str,
    /// Label of the y axis.
    pub y_label: &'a str,
    /// Range along x.
    pub x: (f64, f64),
    /// Range along y.
    pub y: (f64, f64),
    /// The series, drawn from first to last.
    pub series: Vec<Series<'a>>,
}

/// A series of points.
#[derive(Clone, Debug)]
pub struct Series<'a> {
    /// Name in the legend, or an empty text without an entry.
    pub name: &'a str,
    /// The points, in the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Colour of the series.
    pub colour: RGBColor,
    /// Style of the series.
    pub style: LineStyle,
}

/// Style of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStyle {
    /// A continuous line.
    Solid,
    /// A dashed line.
    Dashed,
    /// A dot at each point.
    Dots,
}

/// Which axes are logarithmic. Their ranges must be positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LogAxes {
    /// Whether x is.
    pub x: bool,
    /// Whether y is.
    pub y: bool,
}

/// Draws `plot` into `area` on linear axes, with text of `font` pixels.
///
/// # Errors
/// [`PictureError`] of the backend.
pub fn draw_lines<B: DrawingBackend>(area: &Area<B>, plot: &LinePlot<'_>, font: f64) -> Result<(), PictureError> {
    let mut chart = builder(area, plot, font);
    let chart = chart.build_cartesian_2d(plot.x.0..plot.x.1, plot.y.0..plot.y.1).map_err(PictureError::new)?;
    draw_on(chart, plot, font, SeriesLabelPosition::UpperRight)
}

/// As [`draw_lines`], with the legend in the emptiest corner, and `log` axes.
///
/// # Errors
/// [`PictureError`] of the backend.
pub fn draw_lines_on<B: DrawingBackend>(
    area: &Area<B>,
    plot: &LinePlot<'_>,
    log: LogAxes,
    font: f64,
) -> Result<(), PictureError> {
    let mut chart = builder(area, plot, font);
    let (x, y, corner) = (plot.x.0..plot.x.1, plot.y.0..plot.y.1, emptiest_corner(plot, log));
    let fail = PictureError::new;
    let marks = |(low, high), is_log: bool| if is_log { log_marks(low, high) } else { Vec::new() };
    let (x_marks, y_marks) = (marks(plot.x, log.x), marks(plot.y, log.y));
    match (log.x, log.y) {
        (false, false) => draw_on(chart.build_cartesian_2d(x, y).map_err(fail)?, plot, font, corner),
        (true, false) => draw_on(
            chart.build_cartesian_2d(x.log_scale().with_key_points(x_marks), y).map_err(fail)?,
            plot,
            font,
            corner,
        ),
        (false, true) => draw_on(
            chart.build_cartesian_2d(x, y.log_scale().with_key_points(y_marks)).map_err(fail)?,
            plot,
            font,
            corner,
        ),
        (true, true) => draw_on(
            chart
                .build_cartesian_2d(x.log_scale().with_key_points(x_marks), y.log_scale().with_key_points(y_marks))
                .map_err(fail)?,
            plot,
            font,
            corner,
        ),
    }
}

/// Powers of ten in a positive range; with fewer than three of them also twice and five times these.
fn log_marks(low: f64, high: f64) -> Vec<f64> {
    let exponents = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let marks = |factors: &'static [f64]| -> Vec<f64> {
        let all = exponents.clone().flat_map(|e| factors.iter().map(move |factor| factor * 10_f64.powi(e)));
        all.filter(|mark| (low..=high).contains(mark)).collect()
    };
    let decades = marks(&[1.0]);
    if decades.len() < 3 {
        return marks(&[1.0, 2.0, 5.0]);
    }
    let every = decades.len().div_ceil(8);
    decades.into_iter().step_by(every).collect()
}

fn builder<'a, 'b, B: DrawingBackend>(area: &'a Area<B>, plot: &LinePlot<'_>, font: f64) -> ChartBuilder<'a, 'b, B> {
    let mut chart = ChartBuilder::on(area);
    chart
        .caption(plot.title, (FONT, 1.1 * font).into_font().color(&BLACK))
        .margin((0.8 * font) as i32)
        .x_label_area_size((2.6 * font) as i32)
        .y_label_area_size(((if has_exponents(plot.y) { 5.4 } else { 4.0 }) * font) as i32);
    chart
}

/// Whether tick marks have exponents, which need more room.
fn has_exponents((low, high): (f64, f64)) -> bool {
    let largest = low.abs().max(high.abs());
    !(1e-3..1e6).contains(&largest)
}

/// The corner of the plot with the fewest points, those of drawn segments included.
fn emptiest_corner(plot: &LinePlot<'_>, log: LogAxes) -> SeriesLabelPosition {
    let part = |value: f64, (low, high): (f64, f64), is_log: bool| {
        if is_log { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) }
    };
    let place = |at: &(f64, f64)| (part(at.0, plot.x, log.x), part(at.1, plot.y, log.y));
    let places: Vec<(f64, f64)> = plot.series.iter().flat_map(|series| series.points.iter().map(place)).collect();
    let near = |right: bool, upper: bool| {
        let is_near = |part: f64, at_end: bool| if at_end { part > 0.55 } else { part < 0.45 };
        places.iter().filter(|(x, y)| is_near(*x, right) && is_near(*y, upper)).count()
    };
    let corners = [
        (near(false, true), SeriesLabelPosition::UpperLeft),
        (near(true, true), SeriesLabelPosition::UpperRight),
        (near(true, false), SeriesLabelPosition::LowerRight),
        (near(false, false), SeriesLabelPosition::LowerLeft),
    ];
    corners.into_iter().min_by_key(|(n, _)| *n).map_or(SeriesLabelPosition::UpperRight, |(_, corner)| corner)
}

fn draw_on<'a, B: DrawingBackend + 'a, X, Y>(
    mut chart: ChartContext<'a, B, Cartesian2d<X, Y>>,
    plot: &LinePlot<'_>,
    font: f64,
    legend: SeriesLabelPosition,
) -> Result<(), PictureError>
where
    X: Ranged<ValueType = f64> + ValueFormatter<f64>,
    Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
{
    chart
        .configure_mesh()
        .x_desc(plot.x_label)
        .y_desc(plot.y_label)
        .x_label_formatter(&|value| label(*value))
        .y_label_formatter(&|value| label(*value))
        .x_labels(8)
        .y_labels(6)
        .label_style((FONT, 0.85 * font).into_font().color(&BLACK))
        .axis_desc_style((FONT, font).into_font().color(&BLACK))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .draw()
        .map_err(PictureError::new)?;
    let stroke = (font / 11.0).max(1.0) as u32;
    let mut named = false;
    for series in &plot.series {
        let points = series.points.iter().copied();
        let line = series.colour.stroke_width(stroke);
        let drawn = match series.style {
            LineStyle::Solid => chart.draw_series(LineSeries::new(points, line)),
            LineStyle::Dashed => chart.draw_series(DashedLineSeries::new(points, 4 * stroke, 3 * stroke, line)),
            LineStyle::Dots => chart.draw_series(points.map(|at| Circle::new(at, stroke, series.colour.filled()))),
        };
        let annotation = drawn.map_err(PictureError::new)?;
        if !series.name.is_empty() {
            named = true;
            let ([first, second], radius) = sample(series.style, (1.4 * font) as i32, stroke);
            let piece = move |(from, to): (i32, i32)| PathElement::new([(from, 0), (to, 0)], line);
            annotation.label(series.name).legend(move |at| {
                EmptyElement::at(at) + piece(first) + piece(second) + Circle::new((first.0, 0), radius, line.filled())
            });
        }
    }
    if named {
        chart
            .configure_series_labels()
            .position(legend)
            .legend_area_size((1.8 * font) as u32)
            .label_font((FONT, 0.85 * font).into_font().color(&BLACK))
            .background_style(WHITE.mix(0.85))
            .border_style(RGBColor(225, 225, 225))
            .draw()
            .map_err(PictureError::new)?;
    }
    Ok(())
}

/// The sample of a series in the legend.
///
/// It consists of two line pieces and the radius of a dot. Positions are relative to the left end of the sample. The
/// dot is at the start of the first piece. Some pieces have no length, and some dots no radius.
fn sample(style: LineStyle, length: i32, stroke: u32) -> ([(i32, i32); 2], u32) {
    match style {
        LineStyle::Solid => ([(0, length / 2), (length / 2, length)], 0),
        LineStyle::Dashed => ([(0, length * 2 / 5), (length * 3 / 5, length)], 0),
        LineStyle::Dots => ([(length / 2, length / 2); 2], stroke),
    }
}
