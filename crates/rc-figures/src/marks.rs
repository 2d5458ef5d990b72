//! Marks of data points with their scatter, dashed lines, and their legend.

use plotters::prelude::{
    Circle, DashedLineSeries, DrawingBackend, EmptyElement, LineSeries, PathElement, Rectangle, TriangleMarker,
};
use plotters::style::{BLACK, Color, RGBColor};

use crate::chart::{BLUE, Chart, Drawn, RED, Side, TEXT, write};

/// Half the size of a mark, in pixels.
const SIZE: i32 = 8;

/// Style of one surface in all figures that show both surfaces.
///
/// As in the paper, N = 64 has red dots and solid lines, and N = 128 has blue triangles and dashed lines. Shape and
/// dashes distinguish them without colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Style {
    pub(crate) colour: RGBColor,
    pub(crate) dot: bool,
}

/// The styles of the first and second surface.
pub(crate) const STYLES: [Style; 2] = [Style { colour: RED, dot: true }, Style { colour: BLUE, dot: false }];

impl Style {
    /// Draws marks at `points`.
    pub(crate) fn marks<B: DrawingBackend>(
        self,
        chart: &mut Chart<'_, B>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Drawn<(), B> {
        self.marks_of(chart, points, SIZE)
    }

    /// Draws marks with the half-size `size`, in pixels.
    pub(crate) fn marks_of<B: DrawingBackend>(
        self,
        chart: &mut Chart<'_, B>,
        points: impl IntoIterator<Item = (f64, f64)>,
        size: i32,
    ) -> Drawn<(), B> {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        let fill = self.colour.filled();
        if self.dot {
            chart.draw_series(points.into_iter().map(|at| Circle::new(at, size, fill)))?;
        } else {
            chart.draw_series(points.into_iter().map(|at| TriangleMarker::new(at, size + 2, fill)))?;
        }
        Ok(())
    }

    /// Draws a solid or dashed line through `points`.
    pub(crate) fn line<B: DrawingBackend>(
        self,
        chart: &mut Chart<'_, B>,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Drawn<(), B> {
        let points: Vec<(f64, f64)> = points.into_iter().collect();
        if self.dot {
            chart.draw_series(LineSeries::new(points, self.colour.stroke_width(3)))?;
        } else {
            chart.draw_series(DashedLineSeries::new(points, 14, 8, self.colour.stroke_width(3)))?;
        }
        Ok(())
    }
}

/// Draws error bars with caps, along x or across it.
///
/// A bar extends by `half_width` to both sides of its point.
pub(crate) fn error_bars<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    points: impl IntoIterator<Item = ((f64, f64), f64)>,
    along_x: bool,
    colour: RGBColor,
) -> Drawn<(), B> {
    for ((x, y), half) in points {
        let ends = if along_x { [(x - half, y), (x + half, y)] } else { [(x, y - half), (x, y + half)] };
        chart.draw_series([PathElement::new(ends, colour.stroke_width(2))])?;
        let cap = if along_x { [(0, -6), (0, 6)] } else { [(-6, 0), (6, 0)] };
        chart.draw_series(ends.map(|end| EmptyElement::at(end) + PathElement::new(cap, colour.stroke_width(2))))?;
    }
    Ok(())
}

/// The sample in a line of the legend.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sample {
    /// A mark of a style, with a bar across it.
    Mark(Style),
    /// A line of a style.
    Line(Style),
    /// A thin line of a colour, solid or dotted.
    Thin(RGBColor),
    Dotted(RGBColor),
    /// An open square.
    Square(RGBColor),
}

/// Writes a legend with its first line at `corner`.
///
/// `corner` is in the coordinates of the chart. Each line is `step` below the previous one.
pub(crate) fn legend<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    corner: (f64, f64),
    step: f64,
    lines: &[(Sample, String)],
) -> Drawn<(), B> {
    // This is the distance in pixels from the left end of the sample to the text.
    let width = (1.8 * TEXT) as i32;
    for (i, (sample, text)) in lines.iter().enumerate() {
        let at = (corner.0, corner.1 - step * i as f64);
        let mut draw = |pieces: &[(i32, i32)], colour: RGBColor, stroke: u32| -> Drawn<(), B> {
            let line = colour.stroke_width(stroke);
            let piece = |&(from, to): &(i32, i32)| EmptyElement::at(at) + PathElement::new([(from, 0), (to, 0)], line);
            chart.draw_series(pieces.iter().map(piece))?;
            Ok(())
        };
        match *sample {
            Sample::Mark(style) => {
                let fill = style.colour.filled();
                if style.dot {
                    chart.draw_series([EmptyElement::at(at) + Circle::new((width / 2, 0), SIZE, fill)])?;
                } else {
                    chart.draw_series([EmptyElement::at(at) + TriangleMarker::new((width / 2, 0), SIZE + 2, fill)])?;
                }
            }
            Sample::Line(style) if style.dot => draw(&[(0, width)], style.colour, 3)?,
            Sample::Line(style) => draw(&[(0, 14), (22, 36), (44, width)], style.colour, 3)?,
            Sample::Thin(colour) => draw(&[(0, width)], colour, 2)?,
            Sample::Dotted(colour) => {
                let dots: Vec<(i32, i32)> = (0..width / 9).map(|i| (9 * i, 9 * i + 4)).collect();
                draw(&dots, colour, 3)?;
            }
            Sample::Square(colour) => square(chart, at, width / 2, colour)?,
        }
        write(chart, at, Side::RightOf(width), text, BLACK)?;
    }
    Ok(())
}

/// Draws an open square for a printed value, `right` pixels right of `at`.
pub(crate) fn square<B: DrawingBackend>(
    chart: &mut Chart<'_, B>,
    at: (f64, f64),
    right: i32,
    colour: RGBColor,
) -> Drawn<(), B> {
    // The square is open, since the value under it is compared with it.
    let frame = Rectangle::new([(right - 11, -11), (right + 11, 11)], colour.stroke_width(4));
    chart.draw_series([EmptyElement::at(at) + frame])?;
    Ok(())
}
