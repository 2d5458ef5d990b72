//! Contact maps of the rows of a sweep, small enough for a page, under one scale of pressures.

use std::path::Path;

use rc_core::Field;
use rc_core::quantity::{count, digits};
use rc_plot::{Palette, PixelMean};
use serde::Serialize;

use super::embedded::{Bits, EmbeddedField};
use crate::curves::columns::PRESSURE;
use crate::curves::table::{Row, SweepTable};
use crate::error::CliError;
use crate::files::result::ResultFolder;

/// Numbers of pixels per side, of which the greatest is taken that fits.
const PIXELS: [usize; 4] = [256, 192, 128, 64];

/// Bytes that all maps together may take in a page.
const MOST_BYTES: usize = 9_000_000;

/// Maps of contact and pressure.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Frames {
    /// Pressure (Pa) at the end of the colours of all frames.
    greatest: f64,
    surfaces: Vec<SurfaceFrames>,
}

/// The frames of a surface, in the order of the loads.
#[derive(Clone, Debug, Serialize)]
struct SurfaceFrames {
    /// Name of the scene and seed.
    name: String,
    /// Sides of the cell along x and y (m).
    sides: [f64; 2],
    frames: Vec<Frame>,
}

/// The contact under one load.
#[derive(Clone, Debug, Serialize)]
struct Frame {
    /// Load and contact area in words.
    label: String,
    /// The load in words.
    load: String,
    pressure: EmbeddedField,
    /// Fraction of each pixel in contact.
    contact: EmbeddedField,
}

/// Maps of a row before they are embedded.
struct Means {
    pressure: Field,
    contact: Field,
    sides: [f64; 2],
    of_elements: bool,
}

impl Frames {
    /// The maps of a sweep, and a sentence about them; no maps if the sweep has no fields.
    ///
    /// # Errors
    /// [`CliError::Input`] for fields that cannot be read.
    pub(super) fn of(table: &SweepTable) -> Result<(Option<Self>, String), CliError> {
        let surfaces: Vec<Vec<(&Row, &Path)>> = table.surfaces().into_iter().map(with_fields).collect();
        let n: usize = surfaces.iter().map(Vec::len).sum();
        if n == 0 {
            let hint = if table.against.name == "time" {
                "No contact maps: the pressure after a time is not that of an elastic contact."
            } else {
                "No contact maps: the rows have no fields. Repeat the sweep with --fields to see them here."
            };
            return Ok((None, hint.to_owned()));
        }
        let (pixels, every) = size(n);
        let mut maps = Vec::new();
        for rows in &surfaces {
            let taken = taken(rows, every);
            let read = taken.map(|(row, fields)| Ok((*row, Means::read(fields, pixels)?)));
            maps.push(read.collect::<Result<Vec<(&Row, Means)>, CliError>>()?);
        }
        let all = || maps.iter().flatten().map(|(_, means)| means);
        let greatest = all().map(|means| means.pressure.max()).fold(0.0, f64::max);
        let what = if table.against == PRESSURE { "load" } else { table.against.name };
        let note = note(all().all(|means| means.of_elements), (pixels, every), (n, what));
        let surfaces = maps.iter().filter_map(|rows| SurfaceFrames::of(rows, greatest)).collect();
        Ok((Some(Self { greatest, surfaces }), note))
    }
}

/// Pixels per side of `n` maps, and the step between the loads that are taken.
fn size(n: usize) -> (usize, usize) {
    let bytes = |pixels: usize, n: usize| n * 2 * (pixels * pixels).div_ceil(3) * 4;
    let fits = PIXELS.into_iter().find(|pixels| bytes(*pixels, n) <= MOST_BYTES);
    let least = PIXELS[PIXELS.len() - 1];
    fits.map_or_else(|| (least, bytes(least, n).div_ceil(MOST_BYTES)), |pixels| (pixels, 1))
}

/// Every `every`-th row, and the last.
fn taken<T>(rows: &[T], every: usize) -> impl Iterator<Item = &T> {
    let last = rows.len().saturating_sub(1);
    rows.iter().enumerate().filter(move |(i, _)| (last - i).is_multiple_of(every)).map(|(_, row)| row)
}

fn with_fields(rows: &[Row]) -> Vec<(&Row, &Path)> {
    rows.iter().filter_map(|row| Some((row, row.place.as_ref()?.fields.as_deref()?))).collect()
}

fn note(of_elements: bool, (pixels, every): (usize, usize), (n, what): (usize, &str)) -> String {
    let part =
        if of_elements { "" } else { " The fields are means over blocks (output_grid), and touched blocks are dark." };
    let loads = if every > 1 {
        format!(" Of {}, every {every}th {what} is shown, and the last.", count(n, "map"))
    } else {
        String::new()
    };
    format!(
        "All frames have the same scale of pressures and colours. A map has at most {pixels} x {pixels} pixels, each a mean over \
         its elements.{loads}{part} Scroll to zoom, drag to move; arrow keys on the slider change the {what}."
    )
}

impl Means {
    fn read(fields: &Path, pixels: usize) -> Result<Self, CliError> {
        let result = ResultFolder::read_finite(fields)?;
        let grid = result.pressure.grid();
        let mut pressure = PixelMean::new(grid, pixels);
        let mut contact = pressure.clone();
        for iy in 0..grid.ny() {
            let row = result.pressure.row(iy);
            pressure.take(|ix| row[ix]);
            contact.take(|ix| f64::from(u8::from(row[ix] > 0.0)));
        }
        let of_elements = result.is_of_elements();
        Ok(Self { pressure: pressure.finish(), contact: contact.finish(), sides: result.sides(), of_elements })
    }
}

impl SurfaceFrames {
    /// The frames of the rows of a surface; `None` of none.
    fn of(rows: &[(&Row, Means)], greatest: f64) -> Option<Self> {
        let (first, means) = rows.first()?;
        let mut order: Vec<&(&Row, Means)> = rows.iter().collect();
        order.sort_by(|a, b| a.0.load.total_cmp(&b.0.load));
        let frames = order.into_iter().map(|(row, means)| Frame::of(row, means, greatest)).collect();
        Some(Self { name: first.surface(), sides: means.sides, frames })
    }
}

impl Frame {
    fn of(row: &Row, means: &Means, greatest: f64) -> Self {
        let load = row.load_in_words();
        let area = digits(100.0 * row.number("area_fraction").unwrap_or_default(), 3);
        Self {
            label: format!("{} {load}, contact area {area} %", row.control),
            load,
            pressure: EmbeddedField::of_contact(&means.pressure, greatest, Bits::Eight, Palette::Heat),
            contact: EmbeddedField::of_contact(&means.contact, 1.0, Bits::Eight, Palette::Ink),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_maps_get_fewer_pixels_and_then_fewer_loads() {
        assert_eq!([1, 50, 60, 150, 400].map(size), [(256, 1), (256, 1), (192, 1), (128, 1), (64, 1)]);
        let (pixels, every) = size(10_000);
        assert_eq!((pixels, every), (64, 13));
        assert!(10_000 / every * 2 * pixels * pixels * 4 / 3 <= MOST_BYTES);
        let rows: Vec<usize> = (0..8).collect();
        assert_eq!(taken(&rows, 3).copied().collect::<Vec<_>>(), [1, 4, 7], "the last load is there");
        assert_eq!(taken(&rows, 1).count(), 8);
        assert_eq!(taken::<usize>(&[], 3).count(), 0);
    }
}
