//! Grayscale PNG of 16 bits, with levels of grey in rows from top to bottom.
//!
//! Gwyddion writes sizes and heights beside the levels, as texts called `Gwy::XReal`, `Gwy::ZMin` and the like. Other
//! programs write the density of points, which is that of the measurement only where it is finer than any printer's.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Info, Limits, Reader, Transformations};
use rc_core::Grid;

use super::channel::{Channel, only};
use super::field::field;
use super::fields::{positive, shown_as_line};
use super::{limit, unit};
use crate::{Format, FormatError, HeightMap, Unit};

/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: u64 = 1032;

/// Points per metre above which they are those of a measurement: 10 µm. Screens and printers have fewer.
const FINEST_PRINT: u32 = 100_000;

/// The height of the highest level, and of level 0.
type Heights = [f64; 2];

pub(super) fn channels(bytes: &[u8], max_bytes: u64) -> Vec<Channel<'_>> {
    only(move || parse(bytes, max_bytes))
}

/// Whether an image says the size of the measured rectangle.
pub(super) fn says_sides(bytes: &[u8]) -> bool {
    opened(bytes).is_ok_and(|image| sides(image.info()).is_ok_and(|sides| sides.is_some()))
}

fn opened(bytes: &[u8]) -> Result<Reader<Cursor<&[u8]>>, FormatError> {
    // Rows are decoded one by one. The total size of the image is checked later.
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 64 << 20 });
    decoder.set_transformations(Transformations::IDENTITY);
    decoder.read_info().map_err(|cause| invalid(&cause))
}

fn invalid(cause: &png::DecodingError) -> FormatError {
    FormatError::Container { format: Format::Png, reason: shown_as_line(&cause.to_string()) }
}

fn parse(bytes: &[u8], max_bytes: u64) -> Result<HeightMap, FormatError> {
    let mut image = opened(bytes)?;
    let info = image.info();
    let grid = Grid::new(info.width as usize, info.height as usize)?;
    let alpha = match (info.color_type, info.bit_depth) {
        (ColorType::Grayscale, BitDepth::Sixteen) => 1,
        (ColorType::GrayscaleAlpha, BitDepth::Sixteen) => 2,
        (colour, depth) => {
            let what = format!("a {}-bit {colour:?} image", depth as u8);
            let cure = "save it as 16-bit grayscale; 8 bits are too few for heights";
            return Err(FormatError::Unsupported { format: Format::Png, what, cure });
        }
    };
    if info.interlaced {
        let what = "an interlaced image".to_owned();
        return Err(FormatError::Unsupported { format: Format::Png, what, cure: "save it without interlacing" });
    }
    let (needed, found) = (2 * alpha * grid.len() as u64, (bytes.len() as u64).saturating_mul(MOST_INFLATION));
    if found < needed {
        return Err(FormatError::CutShort { grid, needed, found });
    }
    limit::check_map(grid, 0, bytes.len() as u64, max_bytes)?;
    let (sides, heights) = (sides(info)?, heights(info));
    let mut values = Vec::with_capacity(grid.len());
    while let Some(row) = image.next_row().map_err(|cause| invalid(&cause))? {
        let samples = row.data().chunks_exact(2 * alpha as usize);
        values.extend(samples.map(|sample| f64::from(u16::from_be_bytes([sample[0], sample[1]]))));
    }
    if values.len() != grid.len() {
        return Err(FormatError::CutShort { grid, needed, found: 2 * alpha * values.len() as u64 });
    }
    let unit = heights.map_or(Unit::GreyLevel, |(unit, [highest, lowest])| {
        let level = (highest - lowest) / f64::from(u16::MAX);
        for value in &mut values {
            *value = lowest + level * *value;
        }
        unit
    });
    let (sides, side_unit) = sides.map_or((None, Unit::Unnamed), |(sides, unit)| (Some(sides), unit));
    Ok(HeightMap::new(field(grid, values), unit, sides, side_unit))
}

/// A text beside the image.
fn text<'a>(info: &'a Info<'_>, name: &str) -> Option<&'a str> {
    let chunk = info.uncompressed_latin1_text.iter().find(|chunk| chunk.keyword == name);
    chunk.map(|chunk| chunk.text.trim())
}

fn number(info: &Info<'_>, name: &str) -> Option<f64> {
    text(info, name)?.parse().ok()
}

/// The heights of the highest and of the lowest level as Gwyddion writes them.
fn heights(info: &Info<'_>) -> Option<(Unit, Heights)> {
    let (lowest, highest) = (number(info, "Gwy::ZMin")?, number(info, "Gwy::ZMax")?);
    let (unit, factor) = unit::of_values(text(info, "Gwy::ZUnit").unwrap_or_default());
    (highest > lowest && (highest - lowest).is_finite()).then_some((unit, [highest * factor, lowest * factor]))
}

/// Sides as Gwyddion writes them, or from a density of points.
fn sides(info: &Info<'_>) -> Result<Option<([f64; 2], Unit)>, FormatError> {
    if let (Some(x), Some(y)) = (number(info, "Gwy::XReal"), number(info, "Gwy::YReal")) {
        let name = text(info, "Gwy::XYUnit").unwrap_or_default();
        let (unit, factor) = unit::of_sides(Format::Png, "Gwy::XYUnit", name)?;
        let x = positive(Format::Png, "Gwy::XReal", x * factor)?;
        return Ok(Some(([x, positive(Format::Png, "Gwy::YReal", y * factor)?], unit)));
    }
    let density = info.pixel_dims.filter(|density| matches!(density.unit, png::Unit::Meter));
    let fine = density.filter(|density| density.xppu.min(density.yppu) >= FINEST_PRINT);
    let side = |n: u32, density: u32| f64::from(n) / f64::from(density);
    Ok(fine.map(|fine| ([side(info.width, fine.xppu), side(info.height, fine.yppu)], Unit::Metre)))
}
