//! ISO 25178-71 surface data files.
//!
//! The format has a header of scales in metres, then heights as text (`a…`) or binary (`b…`). Versions 1.0 and 2.0 are
//! read. Version 2.0 has 32 bits for the number of points. The older proposal BCR is read too. It marks missing points
//! by the maximum of a type, where the standard uses the minimum.

use super::binary::{Bytes, Number};
use super::field::field;
use super::fields::{Fields, factor, positive, refused, shown};
use crate::{Format, FormatError, HeightMap, Unit};

use rc_core::Grid;

/// Length of the names of format and version at the start.
const MARK: usize = 8;

/// Number of bytes that Olympus puts between header and heights in binary files of version 1.0.
const OLYMPUS_EXTRA: usize = 8;

/// The common contents of both kinds of header.
struct Header {
    grid: Grid,
    scales: [f64; 3],
    compression: u8,
    data_type: u8,
    check_type: u8,
}

pub(super) fn parse(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let mut bytes = Bytes::new(bytes, Format::Sdf);
    let mark = bytes.take(MARK)?;
    let (header, mut values) = if mark[0] == b'a' { text(bytes.rest())? } else { binary(bytes, mark)? };
    let [x, y, z] = header.scales;
    let x = positive(Format::Sdf, "Xscale", x)?;
    let y = positive(Format::Sdf, "Yscale", y)?;
    let z = factor(Format::Sdf, "Zscale", z)?;
    crate::map::scale(&mut values, z);
    let sides = Some([x * header.grid.nx() as f64, y * header.grid.ny() as f64]);
    let heights = field(header.grid, values);
    Ok(HeightMap::new(heights, Unit::Metre, sides, Unit::Metre).of_numbers(z))
}

fn binary(mut bytes: Bytes<'_>, mark: &[u8]) -> Result<(Header, Vec<f64>), FormatError> {
    // Manufacturer, and the dates of creation and of the last change.
    bytes.take(10 + 12 + 12)?;
    let mut count = || if mark.ends_with(b"2.0") { bytes.u32() } else { bytes.u16().map(u32::from) };
    let (nx, ny) = (count()? as usize, count()? as usize);
    let grid = Grid::new(nx, ny)?;
    let scales = [bytes.f64()?, bytes.f64()?, bytes.f64()?];
    bytes.f64()?; // Resolution of the instrument.
    let (compression, data_type, check_type) = (bytes.u8()?, bytes.u8()?, bytes.u8()?);
    let header = Header { grid, scales, compression, data_type, check_type };
    let (number, missing) = number(&header, mark[1..].starts_with(b"BCR"))?;
    if mark == b"bISO-1.0" && bytes.rest().len() as u64 == number.bytes_of(grid) + OLYMPUS_EXTRA as u64 {
        bytes.take(OLYMPUS_EXTRA)?;
    }
    let mut values = number.values(bytes.rest(), grid)?;
    for value in &mut values {
        #[expect(clippy::float_cmp, reason = "the mark of a missing point is one value of the stored type")]
        if *value == missing {
            *value = f64::NAN;
        }
    }
    Ok((header, values))
}

/// The stored type, and the value that marks a point as missing.
///
/// It is the minimum of a signed type, and the maximum of any type in files of BCR. Unsigned types use the maximum too,
/// because their minimum may be a height. For bytes, the standard has no such value.
fn number(header: &Header, bcr: bool) -> Result<(Number, f64), FormatError> {
    if header.compression != 0 {
        let what = "compressed data".to_owned();
        return Err(FormatError::Unsupported { format: Format::Sdf, what, cure: "save it without compression" });
    }
    if header.check_type != 0 {
        let what = format!("data with a checksum (CheckType {})", header.check_type);
        return Err(FormatError::Unsupported { format: Format::Sdf, what, cure: "save it without one" });
    }
    let either = |low: f64, high: f64| if bcr { high } else { low };
    Ok(match header.data_type {
        0 => (Number::U8, either(f64::NAN, f64::from(u8::MAX))),
        1 => (Number::U16, f64::from(u16::MAX)),
        2 => (Number::U32, f64::from(u32::MAX)),
        3 => (Number::F32, either(f64::from(f32::MIN), f64::from(f32::MAX))),
        4 => (Number::I8, either(f64::from(i8::MIN), f64::from(i8::MAX))),
        5 => (Number::I16, either(f64::from(i16::MIN), f64::from(i16::MAX))),
        6 => (Number::I32, either(f64::from(i32::MIN), f64::from(i32::MAX))),
        7 => (Number::F64, either(f64::MIN, f64::MAX)),
        other => return Err(refused(Format::Sdf, "DataType", &other, "from 0 to 7")),
    })
}

/// Reads a file with text.
///
/// A `*` ends header, heights and remarks. After the header it is alone in its line, because a name may contain one.
fn text(bytes: &[u8]) -> Result<(Header, Vec<f64>), FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut end = 0;
    let mut lines = text.split_inclusive('\n').map(|line| {
        end += line.len();
        (line.trim() == "*", end)
    });
    let ended = lines.find(|(ends, _)| *ends).ok_or(FormatError::HeaderCutShort { format: Format::Sdf })?;
    let (header, data) = text.split_at(ended.1);
    let fields = Fields::of(header, Format::Sdf);
    let first_line = header.lines().count() + 1;
    let header = Header {
        grid: fields.grid("NumPoints", "NumProfiles")?,
        scales: [fields.number("Xscale")?, fields.number("Yscale")?, fields.number("Zscale")?],
        compression: fields.optional("Compression")?.unwrap_or(0),
        data_type: fields.optional("DataType")?.unwrap_or(7),
        check_type: fields.optional("CheckType")?.unwrap_or(0),
    };
    number(&header, false)?;
    let values = words(data.split('*').next().unwrap_or_default(), header.grid, first_line)?;
    Ok((header, values))
}

/// The heights of `grid`, where `BAD` is a missing point.
///
/// The text begins with line `line`.
fn words(data: &str, grid: Grid, line: usize) -> Result<Vec<f64>, FormatError> {
    let cut_short =
        |found: usize| FormatError::CutShort { grid, needed: 2 * grid.len() as u64 - 1, found: found as u64 };
    // The minimum is one digit for each height and a space between them. This is checked before memory is taken.
    if data.len() + 1 < grid.len().saturating_mul(2) {
        return Err(cut_short(data.len()));
    }
    let mut values = Vec::with_capacity(grid.len());
    for (n, row) in data.lines().enumerate() {
        for (i, word) in row.split_ascii_whitespace().enumerate() {
            let value = if word == "BAD" { Ok(f64::NAN) } else { word.parse() };
            let no_number = FormatError::NoNumber { line: line + n, value: i + 1, text: shown(word) };
            values.push(value.map_err(|_| no_number)?);
        }
    }
    if values.len() == grid.len() {
        return Ok(values);
    }
    let found = format!("{grid}, of which {} heights are there", values.len());
    Err(refused(Format::Sdf, "NumPoints x NumProfiles", &found, "as many as there are heights"))
}
