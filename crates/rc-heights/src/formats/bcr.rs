//! BCR-STM and BCRF files of Image Metrology (SPIP).
//!
//! The format has `name = value` lines that are padded to a fixed length, in Latin-1 or UTF-16, and 16-bit integers or
//! 32-bit floats with rows from top to bottom. The documentation of Gwyddion describes it.

use super::binary::Number;
use super::channel::{Channels, only};
use super::endian::Endian;
use super::fields::{Fields, factor, positive, refused};
use super::instrument::{map, metres, scale_measured, text};
use crate::Format;

/// The first bytes, in Latin-1 and in UTF-16.
pub(super) const MARKS: [&[u8]; 2] = [b"fileformat = bcr", b"f\0i\0l\0e\0f\0o\0r\0m\0a\0t\0 \0=\0 \0b\0c\0r\0"];

/// Characters of the header, unless it says otherwise.
const HEADER: usize = 2048;

/// The integer of a missing point.
const MISSING_INTEGER: f64 = 32767.0;
/// Floats from this value on are missing points.
const MISSING_FLOAT: f64 = 1.7e38;

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    // Characters of UTF-16 have two bytes, of which the second is 0 but for units.
    let width = if bytes.starts_with(MARKS[1]) { 2 } else { 1 };
    let header = |length: usize| {
        let header: Vec<u8> = bytes.iter().copied().step_by(width).take(length).collect();
        text(&header)
    };
    let start = header(HEADER);
    let length = Fields::of(&start, Format::Bcr).optional("headersize")?.unwrap_or(HEADER);
    let header = header(length);
    let fields = Fields::of(&header, Format::Bcr);
    let (number, missing) = match fields.text("fileformat").unwrap_or_default() {
        "bcrstm" | "bcrstm_unicode" => (Number::I16, MISSING_INTEGER),
        "bcrf" | "bcrf_unicode" => (Number::F32, MISSING_FLOAT),
        other => return Err(refused(Format::Bcr, "fileformat", other, "bcrstm or bcrf")),
    };
    let order = if fields.text("intelmode") == Some("0") { Endian::Big } else { Endian::Little };
    let grid = fields.grid("xpixels", "ypixels")?;
    let unit = |name| metres(fields.text(name).unwrap_or("nm"));
    let sides = match (unit("xunit"), unit("yunit")) {
        (Some(x), Some(y)) => Some([
            positive(Format::Bcr, "xlength", x * fields.number::<f64>("xlength")?)?,
            positive(Format::Bcr, "ylength", y * fields.number::<f64>("ylength")?)?,
        ]),
        _ => None,
    };
    let unit = unit("zunit");
    let digit = if number == Number::I16 { fields.optional("bit2nm")?.unwrap_or(1.0) } else { 1.0 };
    let scale = factor(Format::Bcr, "bit2nm", digit * unit.unwrap_or(1.0))?;
    let data = bytes.get(length.saturating_mul(width)..).unwrap_or_default();
    let mut channels = only(move || {
        let mut values = order.values(number, data, grid)?;
        scale_measured(&mut values, scale, |value| value >= missing);
        Ok(map(grid, values, unit.is_some(), sides).of_numbers(scale))
    });
    channels[0].is_height = unit.is_some();
    Ok(channels)
}
