//! The heat map of the stress table.
//!
//! It has a band for each group, a line for each property, and a square for each scene.

use plotters::element::{Rectangle, Text};
use plotters::prelude::{DrawingBackend, IntoFont as _};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color as _, RGBColor, TextStyle};
use rc_plot::{Area, FONT, Palette, PictureError};

use super::row::Row;

/// Side of a square, in pixels. The sizes of the spaces for text follow.
const SQUARE: u32 = 14;
const LABELS: u32 = 380;
const TITLE: u32 = 40;
const MARGIN: u32 = 20;

/// Maximum number of squares in a line. The rest of a property is on further lines.
const PER_LINE: usize = 90;

/// Colour of failures. The colour of properties without a bound follows.
const FAILED: RGBColor = RGBColor(220, 40, 30);
const HOLDS: RGBColor = RGBColor(185, 205, 190);

/// Number of decades of the colour scale. Values of 1e-6 of their bound and below have the lightest colour.
const DECADES: f64 = 6.0;

/// A property with its rows.
type Line<'a> = (&'static str, Vec<&'a Row>);

/// The lines of each group; a property with many scenes has more than one line.
fn lines<'a>(rows: &'a [Row], groups: &[&'static str]) -> Vec<(&'static str, Vec<Line<'a>>)> {
    let of_group = |group: &&'static str| {
        let mut lines: Vec<Line<'_>> = Vec::new();
        for row in rows.iter().filter(|row| row.group == *group) {
            match lines.iter_mut().rev().find(|(property, _)| *property == row.property) {
                Some((_, line)) if line.len() < PER_LINE => line.push(row),
                _ => lines.push((row.property, vec![row])),
            }
        }
        (*group, lines)
    };
    groups.iter().map(of_group).collect()
}

/// Width and height of the picture, in pixels.
pub(super) fn size(rows: &[Row], groups: &[&'static str]) -> (u32, u32) {
    let groups = lines(rows, groups);
    let longest = groups.iter().flat_map(|(_, lines)| lines.iter().map(|(_, line)| line.len())).max().unwrap_or(0);
    let height: u32 = groups.iter().map(|(_, lines)| TITLE + SQUARE * lines.len() as u32).sum();
    (LABELS + SQUARE * longest as u32 + 2 * MARGIN, height + TITLE + 2 * MARGIN)
}

/// Draws the squares.
///
/// Properties that hold without a bound are pale. Values are darker the closer they are to their bound. Failures are
/// red.
pub(super) fn draw<B: DrawingBackend>(
    area: &Area<B>,
    rows: &[Row],
    groups: &[&'static str],
) -> Result<(), PictureError> {
    let n_failed = rows.iter().filter(|row| !row.passed).count();
    let legend = format!("{} rows, {n_failed} failed (red); darker: more of the bound is used", rows.len());
    text(area, &legend, (MARGIN, MARGIN + TITLE / 3), HPos::Left, 0.8 * f64::from(TITLE) * 0.6)?;
    let mut y = MARGIN + TITLE;
    for (group, lines) in lines(rows, groups) {
        text(area, group, (MARGIN, y + TITLE / 2), HPos::Left, 0.6 * f64::from(TITLE))?;
        y += TITLE;
        for (property, line) in lines {
            text(area, property, (LABELS, y + SQUARE / 2), HPos::Right, f64::from(SQUARE))?;
            for (i, row) in line.into_iter().enumerate() {
                square(area, (LABELS + MARGIN / 2 + SQUARE * i as u32, y), colour(row))?;
            }
            y += SQUARE;
        }
    }
    Ok(())
}

fn colour(row: &Row) -> RGBColor {
    match row.use_of_bound {
        _ if !row.passed => FAILED,
        None => HOLDS,
        // The scale begins at a third of the palette, so that the smallest value is not white.
        Some(part) => Palette::Viridis.colour(0.9 - 0.6 * (1.0 + part.max(1e-30).log10() / DECADES).clamp(0.0, 1.0)),
    }
}

fn square<B: DrawingBackend>(area: &Area<B>, (x, y): (u32, u32), colour: RGBColor) -> Result<(), PictureError> {
    let (x, y, side) = (x as i32, y as i32, SQUARE as i32 - 2);
    area.draw(&Rectangle::new([(x, y), (x + side, y + side)], colour.filled())).map_err(PictureError::new)
}

fn text<B: DrawingBackend>(
    area: &Area<B>,
    text: &str,
    (x, y): (u32, u32),
    anchor: HPos,
    size: f64,
) -> Result<(), PictureError> {
    let style: TextStyle<'_> = (FONT, size).into_font().color(&BLACK).pos(Pos::new(anchor, VPos::Center));
    area.draw(&Text::new(text.to_owned(), (x as i32, y as i32), style)).map_err(PictureError::new)
}
