//! A map of a field, with title, bitmap, scale bar and colour bar.

use plotters::element::{BitMapElement, Circle, PathElement, Rectangle, Text};
use plotters::prelude::{DrawingBackend, IntoFont as _};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color as _, RGBColor, TextStyle, WHITE};
use rc_core::{DVec2, Field, Grid};

use crate::{Area, FONT, Palette, PictureError, Raster};
use rc_core::quantity::{Scale, engineering, label, round_below, ticks};

/// A map of a field over the cell.
#[derive(Clone, Copy, Debug)]
pub struct Map<'a> {
    /// Text above the map.
    pub title: &'a str,
    /// The field to show.
    pub field: &'a Field,
    /// Conversion of values to colours.
    pub shade: Shade,
    /// Side of the cell along x, for the scale bar (m).
    pub side: f64,
}

/// Conversion of values to colours.
#[derive(Clone, Copy, Debug)]
pub enum Shade {
    /// Positive values are dark, and others are light.
    ///
    /// A pixel of several elements has a grey that shows the positive part.
    Contact,
    /// Values are parts of contact, from 0 (light) to 1 (dark).
    PartOfContact,
    /// A flux: colours of a logarithmic scale, with a colour bar of powers of ten.
    ///
    /// Where nothing flows, contact ([`WALL`]) is light grey and closed pockets (0) are brown.
    Flow {
        /// log10 of value divided by `unit` at the ends of the colour bar.
        range: (f64, f64),
        /// Colours of the scale.
        palette: Palette,
        /// The value whose logarithm is 0.
        unit: f64,
        /// Place of a ring, in parts of the sides of the cell.
        ring: Option<[f64; 2]>,
    },
    /// Colours of a linear scale, with a colour bar. `NaN` is red.
    Values {
        /// Values of the field at the ends of the colour bar.
        range: (f64, f64),
        /// Colours of the scale.
        palette: Palette,
        /// Factor that converts values of the field to `unit`.
        factor: f64,
        /// SI unit of the colour bar, to which a prefix is added.
        unit: &'static str,
    },
}

/// The value of elements in contact in a map of a flux.
///
/// It is negative and so small that a pixel with any flux has the colour of the flux.
pub const WALL: f64 = -1e-300;

/// Part of the points below, and above, the range of colours of heights.
const BEYOND: f64 = 1e-3;

/// Number of points from which the range of colours of a large field is taken.
const SAMPLE: usize = 1 << 20;

impl Shade {
    /// The colours of heights, which `factor` converts to metres. They span 0.1 to 99.9 % of the points.
    ///
    /// A few spikes and pits do not take the colours of the rest.
    #[must_use]
    pub fn of_heights(field: &Field, factor: f64) -> Self {
        Self::Values { range: range_of_most(field), palette: Palette::Viridis, factor, unit: "m" }
    }

    /// Whether the map has a colour bar beside it.
    #[must_use]
    pub fn has_colour_bar(&self) -> bool {
        matches!(self, Self::Values { .. } | Self::Flow { .. })
    }
}

/// The range of the values of a field but the smallest and the largest in a thousand; the whole range of few values.
///
/// Values that are not finite do not count.
#[must_use]
pub fn range_of_most(field: &Field) -> (f64, f64) {
    let n = field.values().len();
    // Steps of the golden ratio do not follow any pattern of the map.
    let at =
        |i: usize| if n <= SAMPLE { i } else { ((i as f64 * 0.618_033_988_749_894_9).fract() * n as f64) as usize };
    let sampled = (0..n.min(SAMPLE)).map(|i| field.values()[at(i)]);
    let mut values: Vec<f64> = sampled.filter(|value| value.is_finite()).collect();
    let beyond = (BEYOND * values.len() as f64) as usize;
    if beyond == 0 {
        return (field.min(), field.max());
    }
    let last = values.len() - 1;
    let high = *values.select_nth_unstable_by(last - beyond, f64::total_cmp).1;
    let low = *values.select_nth_unstable_by(beyond, f64::total_cmp).1;
    if low < high { (low, high) } else { (field.min(), field.max()) }
}

/// Sizes, in units of the font size.
const TITLE: f64 = 1.9;
const TITLE_WIDTH: f64 = 16.0;
const FOOT: f64 = 2.0;
const BAR_GAP: f64 = 0.6;
const BAR_WIDTH: f64 = 0.9;
const BAR_LABELS: f64 = 3.2;

/// Width and height of a map in pixels, for a bitmap of this size.
///
/// The width includes the colour bar if there is one.
#[must_use]
pub fn map_extent((width, height): (u32, u32), font: f64, colour_bar: bool) -> (u32, u32) {
    let bar = if colour_bar { BAR_GAP + BAR_WIDTH + BAR_LABELS } else { 0.0 };
    let least = if width > 0 { (TITLE_WIDTH * font) as u32 } else { 0 };
    ((width + (bar * font) as u32).max(least), height + ((TITLE + FOOT) * font) as u32)
}

/// Maximum ratio of the sides of a cell's picture.
///
/// A longer cell is drawn shorter than it is. Otherwise its width would not be visible.
const LONGEST: f64 = 4.0;

/// Size of the bitmap of a cell, as large as fits into `most`.
#[must_use]
pub fn bitmap_size(grid: Grid, most: (u32, u32)) -> (u32, u32) {
    let ratio = grid.cell_ratio().clamp(LONGEST.recip(), LONGEST);
    let width = f64::from(most.0).min(f64::from(most.1) / ratio);
    ((width as u32).max(1), ((width * ratio) as u32).max(1))
}

/// Draws `map` into `area`, as large as fits, with text of `font` pixels.
///
/// # Errors
/// [`PictureError`] of the backend.
pub fn draw_map<B: DrawingBackend>(area: &Area<B>, map: &Map<'_>, font: f64) -> Result<(), PictureError> {
    let (width, height) = area.dim_in_pixel();
    let (bar_width, text_height) = map_extent((0, 0), font, map.shade.has_colour_bar());
    let most = (width.saturating_sub(bar_width), height.saturating_sub(text_height));
    let size = bitmap_size(map.field.grid(), most);
    let top = (TITLE * font) as i32;
    let (place, anchor) =
        if f64::from(size.0) < TITLE_WIDTH * font { (0, HPos::Left) } else { (size.0 as i32 / 2, HPos::Center) };
    text(area, map.title, (place, (TITLE * font / 2.0) as i32), anchor, font)?;

    let raster = rasterise(map, size);
    let bitmap = BitMapElement::with_owned_buffer((0, top), size, raster.rgb)
        .ok_or_else(|| PictureError::new("the bitmap has another size than its area"))?;
    area.draw(&bitmap).map_err(PictureError::new)?;
    let (right, bottom) = (size.0 as i32, top + size.1 as i32);
    frame(area, (0, top), (right, bottom))?;
    scale_bar(area, map.side, size.0, bottom, font)?;
    match map.shade {
        Shade::Contact | Shade::PartOfContact => Ok(()),
        Shade::Flow { range: (low, high), palette, ring, .. } => {
            if let Some([x, y]) = ring {
                let place = (x * f64::from(size.0), f64::from(bottom) - y * f64::from(size.1));
                draw_ring(area, (place.0 as i32, place.1 as i32), font)?;
            }
            let bar = ColourBar { low, high, palette, unit: "" };
            bar.draw(area, (right + (BAR_GAP * font) as i32, top), size.1, font)
        }
        Shade::Values { range, palette, factor, unit } => {
            let left = right + (BAR_GAP * font) as i32;
            let bar = ColourBar { low: range.0 * factor, high: range.1 * factor, palette, unit };
            bar.draw(area, (left, top), size.1, font)
        }
    }
}

/// The colours of contact and of closed pockets in a map of a flux, which its palette does not have.
const CONTACT: RGBColor = RGBColor(205, 205, 205);
const POCKET: RGBColor = RGBColor(150, 84, 42);

/// A red ring with a white edge around a place.
fn draw_ring<B: DrawingBackend>(area: &Area<B>, place: (i32, i32), font: f64) -> Result<(), PictureError> {
    for (colour, width) in [(WHITE, 9), (MISSING, 5)] {
        let ring = Circle::new(place, (0.7 * font) as i32, colour.stroke_width(width));
        area.draw(&ring).map_err(PictureError::new)?;
    }
    Ok(())
}

/// The colour of a missing point, which no palette has.
const MISSING: RGBColor = RGBColor(214, 39, 40);

fn rasterise(map: &Map<'_>, size: (u32, u32)) -> Raster {
    match map.shade {
        Shade::Contact => {
            let inside = |value: f64| if value > 0.0 { 1.0 } else { 0.0 };
            Raster::of(map.field, size, inside, |part| Palette::Ink.colour(part))
        }
        Shade::Flow { range: (low, high), palette, unit, .. } => {
            let span = if high > low { high - low } else { 1.0 };
            let colour = |value: f64| match value {
                flux if flux > 0.0 => palette.colour(((flux / unit).log10() - low) / span),
                wall if wall < 0.5 * WALL => CONTACT,
                _ => POCKET,
            };
            Raster::of(map.field, size, |value| value, colour)
        }
        Shade::PartOfContact => Raster::of(map.field, size, |part| part, |part| Palette::Ink.colour(part)),
        Shade::Values { range: (low, high), palette, .. } => {
            let span = if high > low { high - low } else { 1.0 };
            // A pixel with a missing point is missing, so that single ones stay visible.
            let colour = |value: f64| if value.is_nan() { MISSING } else { palette.colour((value - low) / span) };
            Raster::of(map.field, size, |value| value, colour)
        }
    }
}

/// An arrow along `direction`, below the right end of a map of this width, in an area of this height.
pub(crate) fn arrow<B: DrawingBackend>(
    area: &Area<B>,
    direction: DVec2,
    (width, height): (u32, u32),
    font: f64,
) -> Result<(), PictureError> {
    let middle = DVec2::new(f64::from(width) - 0.9 * font, f64::from(height) - 0.5 * FOOT * font);
    // Rows of pixels go down.
    let (along, across) = (DVec2::new(direction.x, -direction.y), DVec2::new(direction.y, direction.x));
    let place = |[a, b]: [f64; 2]| {
        let DVec2 { x, y } = middle + font * (a * along + b * across);
        (x.round() as i32, y.round() as i32)
    };
    for line in [&[[-0.8, 0.0], [0.8, 0.0]][..], &[[0.4, -0.35], [0.8, 0.0], [0.4, 0.35]]] {
        let points: Vec<(i32, i32)> = line.iter().copied().map(place).collect();
        area.draw(&PathElement::new(points, BLACK.stroke_width(3))).map_err(PictureError::new)?;
    }
    text(area, "sliding", ((middle.x - 1.3 * font) as i32, middle.y as i32), HPos::Right, font)
}

/// A bar of round length at the lower left of the map.
///
/// It is about a quarter of the cell long.
fn scale_bar<B: DrawingBackend>(
    area: &Area<B>,
    side: f64,
    pixels: u32,
    bottom: i32,
    font: f64,
) -> Result<(), PictureError> {
    let length = round_below(side * 0.3);
    let right = (length / side * f64::from(pixels)).round() as i32;
    let middle = bottom + (FOOT * font / 2.0) as i32;
    let half = (font * 0.14) as i32;
    let bar = Rectangle::new([(0, middle - half), (right, middle + half)], BLACK.filled());
    area.draw(&bar).map_err(PictureError::new)?;
    text(area, &engineering(length, "m"), (right + (0.5 * font) as i32, middle), HPos::Left, font)
}

/// A colour bar with tick marks at its right.
struct ColourBar {
    low: f64,
    high: f64,
    palette: Palette,
    unit: &'static str,
}

impl ColourBar {
    fn draw<B: DrawingBackend>(
        &self,
        area: &Area<B>,
        (left, top): (i32, i32),
        height: u32,
        font: f64,
    ) -> Result<(), PictureError> {
        let width = (BAR_WIDTH * font) as u32;
        let colours = (0..height).rev().map(|row| self.palette.colour((f64::from(row) + 0.5) / f64::from(height)));
        let rgb =
            colours.flat_map(|RGBColor(r, g, b)| std::iter::repeat_n([r, g, b], width as usize).flatten()).collect();
        let bitmap = BitMapElement::with_owned_buffer((left, top), (width, height), rgb)
            .ok_or_else(|| PictureError::new("the colour bar has another size than its area"))?;
        area.draw(&bitmap).map_err(PictureError::new)?;
        let (right, bottom) = (left + width as i32, top + height as i32);
        frame(area, (left, top), (right, bottom))?;

        let scale = Scale::of(self.low.abs().max(self.high.abs()), self.unit);
        text(area, &scale.unit(), (left, (TITLE * font / 2.0) as i32), HPos::Left, font)?;
        let (low, high) = (self.low / scale.factor, self.high / scale.factor);
        let most_ticks = (f64::from(height) / (1.5 * font)) as usize;
        for tick in ticks(low, high, most_ticks.clamp(2, 6)) {
            let part = if high > low { (tick - low) / (high - low) } else { 0.0 };
            let y = bottom - (part * f64::from(height)).round() as i32;
            let mark = Rectangle::new([(right, y - 1), (right + (0.25 * font) as i32, y + 1)], BLACK.filled());
            area.draw(&mark).map_err(PictureError::new)?;
            text(area, &label(tick), (right + (0.4 * font) as i32, y), HPos::Left, font)?;
        }
        Ok(())
    }
}

/// A thin frame just outside the rectangle.
fn frame<B: DrawingBackend>(area: &Area<B>, from: (i32, i32), to: (i32, i32)) -> Result<(), PictureError> {
    let grey = RGBColor(90, 90, 90);
    area.draw(&Rectangle::new([(from.0, from.1 - 1), to], grey.stroke_width(1))).map_err(PictureError::new)
}

/// Draws text with the middle of its digits at `at`.
pub(crate) fn text<B: DrawingBackend>(
    area: &Area<B>,
    text: &str,
    at: (i32, i32),
    anchor: HPos,
    font: f64,
) -> Result<(), PictureError> {
    // Backends centre the line box, not the digits. This offset is correct within a fifteenth of the font size for
    // both.
    let at = (at.0, at.1 + (0.14 * font) as i32);
    let style: TextStyle<'_> = (FONT, font).into_font().color(&BLACK).pos(Pos::new(anchor, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style)).map_err(PictureError::new)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colours_of_heights_leave_out_one_in_a_thousand_at_each_end() {
        let grid = Grid::new(100, 50).expect("a grid");
        let mut field = Field::new(grid, (0..5000).map(|i| f64::from((i * 7) % 5000)).collect()).expect("a field");
        assert_eq!(range_of_most(&field), (5.0, 4994.0));
        // Four spikes and missing points do not change the range by more than the points that they replace.
        field.values_mut()[..4].fill(1e9);
        field.values_mut()[10..20].fill(f64::NAN);
        let (low, high) = range_of_most(&field);
        assert!((0.0..=10.0).contains(&low) && (4980.0..5000.0).contains(&high), "from {low} to {high}");
        let Shade::Values { range, factor, unit, .. } = Shade::of_heights(&field, 2.0) else { panic!("other colours") };
        assert_eq!((range, factor, unit), ((low, high), 2.0, "m"));
    }

    #[test]
    fn few_values_and_few_that_differ_have_all_colours() {
        let grid = Grid::new(40, 30).expect("a grid");
        let post = |i: usize| if i == 77 { 3.0 } else { 1.0 };
        let field = Field::new(grid, (0..1200).map(post).collect()).expect("a field");
        assert_eq!(range_of_most(&field), (1.0, 3.0));
        let few = Field::new(Grid::new(2, 1).expect("a grid"), vec![-1.0, 4.0]).expect("a field");
        assert_eq!(range_of_most(&few), (-1.0, 4.0));
    }
}
