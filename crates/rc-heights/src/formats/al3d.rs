//! Files of Alicona.
//!
//! The format has tags of fixed length, then a depth image of 32-bit floats in metres, with rows from top to bottom.
//! The documentation of Gwyddion describes it.

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::channel::{Channels, only};
use super::fields::refused;
use super::instrument::{Places, map, scale_measured, sides, text};
use crate::{Format, FormatError, HeightMap};

/// The first bytes.
pub(super) const MARK: &[u8] = b"AliconaImaging\0\r\n";

/// Bytes of a tag's name, of its value, and of its line end.
const TAG: [usize; 3] = [20, 30, 2];

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let header = tags(bytes)?;
    let grid = Grid::new(number(&header, "Cols")?, number(&header, "Rows")?)?;
    let spacing = [number(&header, "PixelSizeXMeter")?, number(&header, "PixelSizeYMeter")?];
    let sides = sides(Format::Al3d, ["PixelSizeXMeter", "PixelSizeYMeter"], grid, spacing)?;
    let at: usize = number(&header, "DepthImageOffset")?;
    if at == 0 {
        return Err(refused(Format::Al3d, "DepthImageOffset", &at, "the place of a depth image"));
    }
    let invalid =
        if value(&header, "InvalidPixelValue").is_some() { number(&header, "InvalidPixelValue")? } else { f64::NAN };
    Ok(only(move || read(Places::new(bytes, Format::Al3d).rest(at), grid, invalid, sides)))
}

/// Reads the depth image.
///
/// Rows are padded to a multiple of eight bytes, except possibly the last one.
fn read(depth: &[u8], grid: Grid, invalid: f64, sides: [f64; 2]) -> Result<HeightMap, FormatError> {
    let row = Grid::new(grid.nx(), 1)?;
    let stored = Number::F32.size() * grid.nx();
    let step = stored.next_multiple_of(8);
    let needed = (step * (grid.ny() - 1) + stored) as u64;
    if (depth.len() as u64) < needed {
        return Err(FormatError::CutShort { grid, needed, found: depth.len() as u64 });
    }
    let mut values = Vec::with_capacity(grid.len());
    for iy in 0..grid.ny() {
        values.extend(Number::F32.values(&depth[iy * step..], row)?);
    }
    // The tag has about seven digits, fewer than the float.
    scale_measured(&mut values, 1.0, |value| (value - invalid).abs() <= 1.5e-7 * invalid.abs());
    Ok(map(grid, values, true, Some(sides)))
}

/// Names and values of the tags. The second tag says how many tags follow.
fn tags(bytes: &[u8]) -> Result<Vec<(String, String)>, FormatError> {
    let mut bytes = Bytes::new(bytes, Format::Al3d);
    bytes.take(MARK.len())?;
    let mut tags = vec![tag(&mut bytes)?, tag(&mut bytes)?];
    let count: usize = number(&tags, "TagCount")?;
    for _ in 0..count {
        tags.push(tag(&mut bytes)?);
    }
    Ok(tags)
}

fn tag(bytes: &mut Bytes<'_>) -> Result<(String, String), FormatError> {
    let (name, value) = (text(bytes.take(TAG[0])?), text(bytes.take(TAG[1])?));
    match bytes.take(TAG[2])? {
        b"\r\n" => Ok((name, value)),
        other => Err(refused(Format::Al3d, "end of a tag", &text(other), "a carriage return and a line feed")),
    }
}

fn value<'a>(tags: &'a [(String, String)], name: &str) -> Option<&'a str> {
    tags.iter().find(|(tag, _)| tag == name).map(|(_, value)| value.as_str())
}

fn number<T: std::str::FromStr>(tags: &[(String, String)], name: &'static str) -> Result<T, FormatError> {
    let text = value(tags, name).ok_or(FormatError::Missing { format: Format::Al3d, field: name })?;
    text.parse().map_err(|_| refused(Format::Al3d, name, text, "a number"))
}
