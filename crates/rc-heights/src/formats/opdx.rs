//! Dektak and Vision files of Bruker (OPDx).
//!
//! The format is a tree of named items, each with a type. Maps are matrices of 32-bit floats with rows from top to
//! bottom, beside quantities for their scale and their sides. The documentation of Gwyddion describes it.

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::channel::{Channel, Channels};
use super::fields::{factor, positive, refused};
use super::instrument::{map, metres, scale_measured, text};
use crate::{Format, FormatError, HeightMap};

/// The first bytes.
pub(super) const MARK: &[u8] = b"VCA DATA\x01\x00\x00\x55";

/// Maximum number of containers in each other. Files have four.
const DEEPEST: usize = 16;

/// Folder of the maps, and of profiles.
const MAPS: &str = "/2D_Data/";
const PROFILES: &str = "/1D_Data/";
/// The name of the main map.
const MAIN: &str = "/MetaData/PrimaryData2D";

/// An item that is used, with its path.
struct Item<'a> {
    path: String,
    value: Value<'a>,
}

enum Value<'a> {
    Text(String),
    /// A number and the symbol of its unit.
    Quantity(f64, String),
    /// Columns, rows, and the numbers.
    Matrix(u32, u32, &'a [u8]),
    Other,
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let items = items(bytes)?;
    let main = items.iter().find(|item| item.path == MAIN);
    let main = main.and_then(|item| if let Value::Text(name) = &item.value { Some(name.as_str()) } else { None });
    let mut channels = Vec::new();
    for item in &items {
        let name = item.path.strip_prefix(MAPS).and_then(|path| path.strip_suffix("/Matrix"));
        if let (Some(name), Value::Matrix(nx, ny, data)) = (name, &item.value) {
            let channel = channel(name, &items, (*nx, *ny, data));
            // The main map comes first.
            let at = if Some(name) == main { 0 } else { channels.len() };
            channels.insert(at, (name.to_owned(), channel));
        }
    }
    if channels.is_empty() && items.iter().any(|item| item.path.starts_with(PROFILES)) {
        let cure = "a map is needed: give a measurement of an area".to_owned();
        return Err(FormatError::Profile { what: "a line of heights".to_owned(), cure });
    }
    Ok(super::channel::each(channels))
}

fn channel<'a>(name: &str, items: &[Item<'_>], matrix: (u32, u32, &'a [u8])) -> Result<Channel<'a>, FormatError> {
    let quantity = |field: &'static str| {
        let path = format!("{MAPS}{name}/{field}");
        items.iter().find_map(|item| match &item.value {
            Value::Quantity(value, unit) if item.path == path => Some((*value, unit.as_str())),
            _ => None,
        })
    };
    let missing = |field| FormatError::Missing { format: Format::Opdx, field };
    let (nx, ny, data) = matrix;
    let grid = Grid::new(nx as usize, ny as usize)?;
    // An extent is from the first point to the last one.
    let side = |field, n: usize| {
        let Some((value, unit)) = quantity(field) else { return Err(missing(field)) };
        let Some(unit) = metres(unit) else { return Err(refused(Format::Opdx, field, unit, "a length")) };
        positive(Format::Opdx, field, value * unit / (n - 1).max(1) as f64 * n as f64)
    };
    let sides = [side("Dimension2Extent", grid.nx())?, side("Dimension1Extent", grid.ny())?];
    let (scale, unit) = quantity("DataScale").ok_or_else(|| missing("DataScale"))?;
    let unit = metres(unit);
    let scale = factor(Format::Opdx, "DataScale", scale * unit.unwrap_or(1.0))?;
    let is_height = unit.is_some();
    let read = move || read(data, grid, scale, is_height, sides);
    Ok(Channel { name: name.to_owned(), is_height, read: Box::new(read) })
}

fn read(data: &[u8], grid: Grid, scale: f64, is_height: bool, sides: [f64; 2]) -> Result<HeightMap, FormatError> {
    let mut values = Number::F32.values_alone(data, grid)?;
    scale_measured(&mut values, scale, f64::is_nan);
    Ok(map(grid, values, is_height, Some(sides)).of_numbers(scale))
}

/// All items but containers, in the order of the file.
fn items(bytes: &[u8]) -> Result<Vec<Item<'_>>, FormatError> {
    let mut rest = Bytes::new(bytes, Format::Opdx);
    rest.take(MARK.len())?;
    // Containers that are not finished: the path, and what follows them.
    let mut open: Vec<(String, Bytes<'_>)> = Vec::new();
    let mut items = Vec::new();
    loop {
        let path = open.last().map_or("", |(path, _)| path.as_str());
        if rest.rest().is_empty() {
            let Some((_, after)) = open.pop() else { return Ok(items) };
            rest = after;
            continue;
        }
        let path = format!("{path}/{}", text(name(&mut rest)?));
        match rest.u8()? {
            0x7d | 0x46 | 0x47 => {
                if open.len() == DEEPEST {
                    return Err(refused(Format::Opdx, "depth of containers", &path, "at most 16"));
                }
                let content = part(&mut rest)?;
                open.push((path, std::mem::replace(&mut rest, Bytes::new(content, Format::Opdx))));
            }
            // The last item of a container, or of the file. Some bytes without meaning follow.
            0x7f => rest = Bytes::new(&[], Format::Opdx),
            kind => {
                let value = value(kind, &mut rest)?;
                if [MAPS, PROFILES, MAIN].iter().any(|start| path.starts_with(start)) {
                    items.push(Item { path, value });
                }
            }
        }
    }
}

/// The value of an item that is not a container.
fn value<'a>(kind: u8, rest: &mut Bytes<'a>) -> Result<Value<'a>, FormatError> {
    let fixed = match kind {
        0x01 => 1,
        0x04 | 0x05 => 2,
        0x06 | 0x07 | 0x0c => 4,
        0x0a | 0x0b | 0x0d => 8,
        // A time.
        0x15 => 9,
        _ => 0,
    };
    match kind {
        _ if fixed > 0 => rest.take(fixed).map(|_| Value::Other),
        0x12 => Ok(Value::Text(text(part(rest)?))),
        0x13 => {
            let mut content = Bytes::new(part(rest)?, Format::Opdx);
            let number = content.f64()?;
            name(&mut content)?;
            Ok(Value::Quantity(number, text(name(&mut content)?)))
        }
        // A unit.
        0x18 => part(rest).map(|_| Value::Other),
        // Things with the name of their type: a number, arrays, a list of texts, positions.
        0x0e | 0x40 | 0x42 | 0x7c => {
            name(rest)?;
            part(rest).map(|_| Value::Other)
        }
        0x00 | 0x45 => {
            name(rest)?;
            if kind == 0 {
                rest.u32()?;
                name(rest)?;
            }
            matrix(rest)
        }
        other => Err(refused(Format::Opdx, "type of an item", &other, "a known one")),
    }
}

/// Rows, columns and numbers. A truncated file has fewer numbers.
fn matrix<'a>(rest: &mut Bytes<'a>) -> Result<Value<'a>, FormatError> {
    let length = length(rest)?;
    let (ny, nx) = (rest.u32()?, rest.u32()?);
    let data = rest.take(length.saturating_sub(8).min(rest.rest().len()))?;
    Ok(Value::Matrix(nx, ny, data))
}

/// Bytes after a length of four bytes.
fn name<'a>(rest: &mut Bytes<'a>) -> Result<&'a [u8], FormatError> {
    let length = rest.u32()?;
    rest.take(length as usize)
}

/// Bytes after a length of one, two or four bytes.
fn part<'a>(rest: &mut Bytes<'a>) -> Result<&'a [u8], FormatError> {
    let length = length(rest)?;
    rest.take(length)
}

fn length(rest: &mut Bytes<'_>) -> Result<usize, FormatError> {
    match rest.u8()? {
        1 => Ok(rest.u8()?.into()),
        2 => Ok(rest.u16()?.into()),
        4 => Ok(rest.u32()? as usize),
        other => Err(refused(Format::Opdx, "bytes of a length", &other, "1, 2 or 4")),
    }
}
