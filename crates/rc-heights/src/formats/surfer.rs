//! Surfer grids: version 6 as text (DSAA) and binary (DSBB), and version 7 (DSRB).
//!
//! Golden Software's help has the tables. The files contain coordinates of the first and last grid line. The first row
//! has the lowest y. Units are not given.

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::field::field;
use super::fields::{positive, refused, shown};
use crate::{Format, FormatError, HeightMap, Unit};

/// Heights from this value on are missing points.
///
/// Texts have 1.70141e38, some with fewer digits. Infinite heights are errors.
const MISSING: f64 = 1.70140e38;

fn is_missing(value: f64) -> bool {
    value >= MISSING && value.is_finite()
}

/// The tag of the header of version 7, "DSRB".
const HEADER: u32 = 0x4252_5344;
/// The tag of a grid, "GRID".
const GRID: u32 = 0x4449_5247;
/// The tag of the heights of a grid, "DATA".
const DATA: u32 = 0x4154_4144;

pub(super) fn parse(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    match bytes.get(..4) {
        Some(b"DSAA") => text(&bytes[4..]),
        Some(b"DSBB") => version_6(&bytes[4..]),
        _ => version_7(bytes),
    }
}

/// The map of `values` on grid lines at distances of `spacing`.
fn map(grid: Grid, spacing: [f64; 2], mut values: Vec<f64>, missing: impl Fn(f64) -> bool) -> HeightMap {
    values.iter_mut().filter(|value| missing(**value)).for_each(|value| *value = f64::NAN);
    let sides = Some([spacing[0] * grid.nx() as f64, spacing[1] * grid.ny() as f64]);
    HeightMap::new(field(grid, values), Unit::Unnamed, sides, Unit::Unnamed)
}

/// Distance of `n` grid lines from `low` to `high`.
fn spacing(field: &'static str, low: f64, high: f64, n: usize) -> Result<f64, FormatError> {
    if n < 2 {
        return Err(refused(Format::Surfer, field, &format!("only one line, at {low}"), "two lines at least"));
    }
    positive(Format::Surfer, field, (high - low) / (n - 1) as f64)
}

const SPACING_X: &str = "distance of grid lines along x";
const SPACING_Y: &str = "distance of grid lines along y";

fn version_6(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let mut bytes = Bytes::new(bytes, Format::Surfer);
    let (nx, ny) = (usize::from(bytes.u16()?), usize::from(bytes.u16()?));
    let grid = Grid::new(nx, ny)?;
    let (x, y) = ([bytes.f64()?, bytes.f64()?], [bytes.f64()?, bytes.f64()?]);
    bytes.take(16)?; // Minimum and maximum height.
    let spacing = [spacing(SPACING_X, x[0], x[1], nx)?, spacing(SPACING_Y, y[0], y[1], ny)?];
    Ok(map(grid, spacing, Number::F32.values_alone(bytes.rest(), grid)?, is_missing))
}

/// Reads sections, each with its tag and size. Other sections are skipped.
fn version_7(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let mut bytes = Bytes::new(bytes, Format::Surfer);
    let (mut version, mut found) = (1, None);
    loop {
        let (tag, size) = (bytes.u32()?, bytes.u32()? as usize);
        match (tag, found) {
            (HEADER, _) => version = section(&mut bytes, size)?.u32()?,
            (GRID, _) => found = Some(grid_section(section(&mut bytes, size)?)?),
            (DATA, Some((grid, spacing, blank))) => {
                let available = bytes.rest();
                let values = Number::F64.values(&available[..size.min(available.len())], grid)?;
                #[expect(clippy::float_cmp, reason = "version 2 marks missing points by one exact value")]
                let missing = |value: f64| if version == 1 { value >= blank } else { value == blank };
                return Ok(map(grid, spacing, values, |value| missing(value) || is_missing(value)));
            }
            (DATA, None) => return Err(FormatError::Missing { format: Format::Surfer, field: "GRID" }),
            _ => drop(section(&mut bytes, size)?),
        }
    }
}

fn section<'a>(bytes: &mut Bytes<'a>, size: usize) -> Result<Bytes<'a>, FormatError> {
    Ok(Bytes::new(bytes.take(size)?, Format::Surfer))
}

/// Grid, distances of lines, and the value of missing points.
fn grid_section(mut bytes: Bytes<'_>) -> Result<(Grid, [f64; 2], f64), FormatError> {
    let (ny, nx) = (bytes.u32()? as usize, bytes.u32()? as usize);
    let grid = Grid::new(nx, ny)?;
    bytes.take(16)?; // Lower left corner.
    let x = positive(Format::Surfer, SPACING_X, bytes.f64()?)?;
    let y = positive(Format::Surfer, SPACING_Y, bytes.f64()?)?;
    bytes.take(24)?; // Minimum and maximum height, and a rotation that is not used.
    Ok((grid, [x, y], bytes.f64()?))
}

fn text(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let mut words = text.split_ascii_whitespace();
    let mut header = |field: &'static str| {
        let word = words.next().ok_or(FormatError::Missing { format: Format::Surfer, field })?;
        word.parse::<f64>().map_err(|_| refused(Format::Surfer, field, word, "a number"))
    };
    // A cast of an invalid count gives 0 or a count that no grid accepts.
    let (nx, ny) = (header("columns")? as usize, header("rows")? as usize);
    let grid = Grid::new(nx, ny)?;
    let (x, y) = ([header("xlo")?, header("xhi")?], [header("ylo")?, header("yhi")?]);
    let spacing = [spacing(SPACING_X, x[0], x[1], nx)?, spacing(SPACING_Y, y[0], y[1], ny)?];
    header("zlo")?;
    header("zhi")?;
    // The minimum is one digit for each height and a blank between them. This is checked before memory is taken.
    let needed = 2 * grid.len() as u64 - 1;
    let cut_short = FormatError::CutShort { grid, needed, found: bytes.len() as u64 };
    if (bytes.len() as u64) < needed {
        return Err(cut_short);
    }
    let mut values = Vec::with_capacity(grid.len());
    for word in words.by_ref().take(grid.len()) {
        let expected = "a number";
        values.push(word.parse().map_err(|_| refused(Format::Surfer, "height", &shown(word), expected))?);
    }
    let there = values.len() + words.count();
    if there != grid.len() {
        let found = format!("{grid}, of which {there} heights are there");
        return Err(refused(Format::Surfer, "columns x rows", &found, "as many as there are heights"));
    }
    Ok(map(grid, spacing, values, is_missing))
}
