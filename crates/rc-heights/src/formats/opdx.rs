//! Dektak and Vision files of Bruker (OPDx).
//!
//! The format is a tree of named items, each with a type. Maps are matrices of 32-bit floats with rows from top to
//! bottom, beside quantities for their scale and their sides. The documentation of Gwyddion describes it.

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::channel::{Channel, Channels};
use super::fields::{factor, positive, refused};
use super::instrument::{map, metres, scale_measured, text};
use super::opdx_profile::{self, ProfileItems};
use crate::{Format, FormatError, HeightMap, ReadParams};

/// The first bytes.
pub(super) const MARK: &[u8] = b"VCA DATA\x01\x00\x00\x55";

/// Maximum number of containers in each other. Files have four.
const DEEPEST: usize = 16;

/// Maximum length of the path of a container (bytes). Those of files are below a hundred.
const LONGEST: usize = 512;

/// Folder of the maps, and of profiles.
const MAPS: &str = "/2D_Data/";
const PROFILES: &str = "/1D_Data";
/// The container of the name of the main map, and that name.
const MAIN: [&str; 2] = ["/MetaData", "PrimaryData2D"];

/// Names of the quantities of a map: scale of its heights, and extents along x and y.
const QUANTITIES: [&str; 3] = ["DataScale", "Dimension2Extent", "Dimension1Extent"];

/// What the items of one container say of a map.
struct MapItems<'a> {
    name: String,
    /// Columns, rows and numbers.
    matrix: Option<(u32, u32, &'a [u8])>,
    /// Number and symbol of the unit of each of [`QUANTITIES`].
    quantities: [Option<(f64, String)>; 3],
}

/// What is used of a file.
#[derive(Default)]
struct Contents<'a> {
    /// The maps, in the order of the file.
    maps: Vec<MapItems<'a>>,
    /// The name of the main map.
    main: Option<String>,
    /// The profiles, in the order of the file.
    profiles: Vec<ProfileItems<'a>>,
}

/// A container that is not finished.
struct Open<'a> {
    path: String,
    /// What follows it.
    after: Bytes<'a>,
    /// Place of its map in [`Contents::maps`], or of its profile, once an item of it is found.
    map: Option<usize>,
}

enum Value<'a> {
    Text(String),
    /// A number and the symbol of its unit.
    Quantity(f64, String),
    /// Columns, rows, and the numbers.
    Matrix(u32, u32, &'a [u8]),
    /// The bytes of an array of numbers, after its type.
    Array(&'a [u8]),
    Other,
}

/// Whether the file has a profile and no map.
pub(super) fn has_profile(bytes: &[u8]) -> bool {
    contents(bytes).is_ok_and(|found| {
        found.maps.iter().all(|map| map.matrix.is_none()) && found.profiles.iter().any(|one| one.heights.is_some())
    })
}

/// The maps of a file, or its profiles if it has no map and these are asked for.
pub(super) fn channels<'a>(bytes: &'a [u8], params: &ReadParams) -> Channels<'a> {
    let Contents { maps, main, profiles } = contents(bytes)?;
    let mut channels = Vec::new();
    let mut first = None;
    for map in maps {
        let Some(matrix) = map.matrix else { continue };
        if first.is_none() && main.as_ref() == Some(&map.name) {
            first = Some(channels.len());
        }
        let channel = channel(&map, matrix);
        channels.push((map.name, channel));
    }
    if channels.is_empty() && !profiles.is_empty() {
        if params.is_profile {
            let of_profile = |items: ProfileItems<'a>| Some((items.name.clone(), opdx_profile::channel(items)?));
            return Ok(super::channel::each(profiles.into_iter().filter_map(of_profile).collect()));
        }
        let cure = "give a measurement of an area, or --line for the contact of a profile".to_owned();
        return Err(FormatError::Profile { what: "a line of heights".to_owned(), cure });
    }
    if let Some(at) = first {
        // The main map comes first.
        channels[..=at].rotate_right(1);
    }
    Ok(super::channel::each(channels))
}

fn channel<'a>(map: &MapItems<'_>, matrix: (u32, u32, &'a [u8])) -> Result<Channel<'a>, FormatError> {
    let quantity = |field: &'static str| {
        let at = QUANTITIES.iter().position(|name| *name == field)?;
        map.quantities[at].as_ref().map(|(value, unit)| (*value, unit.as_str()))
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
    Ok(Channel { name: map.name.clone(), is_height, read: Box::new(read) })
}

fn read(data: &[u8], grid: Grid, scale: f64, is_height: bool, sides: [f64; 2]) -> Result<HeightMap, FormatError> {
    let mut values = Number::F32.values_alone(data, grid)?;
    scale_measured(&mut values, scale, f64::is_nan);
    Ok(map(grid, values, is_height, Some(sides)).of_numbers(scale))
}

/// The items that are used.
fn contents(bytes: &[u8]) -> Result<Contents<'_>, FormatError> {
    let mut rest = Bytes::new(bytes, Format::Opdx);
    rest.take(MARK.len())?;
    let mut open: Vec<Open<'_>> = Vec::new();
    let mut found = Contents::default();
    loop {
        if rest.rest().is_empty() {
            let Some(Open { after, .. }) = open.pop() else { return Ok(found) };
            rest = after;
            continue;
        }
        let name = text(name(&mut rest)?);
        match rest.u8()? {
            0x7d | 0x46 | 0x47 => {
                if open.len() == DEEPEST {
                    return Err(refused(Format::Opdx, "depth of containers", &name, "at most 16"));
                }
                let path = open.last().map_or("", |container| container.path.as_str());
                let length = path.len() + 1 + name.len();
                // Each map has the path of its container.
                if length > LONGEST {
                    return Err(refused(Format::Opdx, "length of the path of a container", &length, "at most 512"));
                }
                let path = format!("{path}/{name}");
                let content = part(&mut rest)?;
                let after = std::mem::replace(&mut rest, Bytes::new(content, Format::Opdx));
                open.push(Open { path, after, map: None });
            }
            // The last item of a container, or of the file. Some bytes without meaning follow.
            0x7f => rest = Bytes::new(&[], Format::Opdx),
            kind => {
                let value = value(kind, &mut rest)?;
                if let Some(container) = open.last_mut() {
                    found.add(container, &name, value);
                }
            }
        }
    }
}

impl<'a> Contents<'a> {
    /// Keeps what an item of a container says, if it is used. The first of two items with a name counts.
    fn add(&mut self, container: &mut Open<'_>, name: &str, value: Value<'a>) {
        let of_profile = container.path.strip_prefix(PROFILES);
        if let Some(of_profile) = of_profile.filter(|path| path.is_empty() || path.starts_with('/')) {
            let at = *container.map.get_or_insert_with(|| {
                self.profiles.push(ProfileItems {
                    name: of_profile.trim_start_matches('/').to_owned(),
                    ..ProfileItems::default()
                });
                self.profiles.len() - 1
            });
            self.profiles[at].add(name, value);
            return;
        }
        if [container.path.as_str(), name] == MAIN {
            if let (None, Value::Text(name)) = (&self.main, value) {
                self.main = Some(name);
            }
            return;
        }
        let Some(of_map) = container.path.strip_prefix(MAPS) else { return };
        let quantity = QUANTITIES.iter().position(|quantity| *quantity == name);
        if quantity.is_none() && name != "Matrix" {
            return;
        }
        let at = *container.map.get_or_insert_with(|| {
            self.maps.push(MapItems { name: of_map.to_owned(), matrix: None, quantities: [const { None }; 3] });
            self.maps.len() - 1
        });
        let map = &mut self.maps[at];
        match (quantity, value) {
            (None, Value::Matrix(nx, ny, data)) if map.matrix.is_none() => map.matrix = Some((nx, ny, data)),
            (Some(i), Value::Quantity(value, unit)) if map.quantities[i].is_none() => {
                map.quantities[i] = Some((value, unit));
            }
            _ => {}
        }
    }
}

impl<'a> ProfileItems<'a> {
    /// Keeps what an item says, if it is used. The first of two items with a name counts.
    fn add(&mut self, name: &str, value: Value<'a>) {
        let array = match name {
            "Array" => Some(&mut self.heights),
            "PositionArray" => Some(&mut self.places),
            _ => None,
        };
        let quantity = match name {
            "DataScale" => Some(&mut self.scale),
            "Extent" => Some(&mut self.extent),
            _ => None,
        };
        match (array, quantity, value) {
            (Some(array), _, Value::Array(bytes)) => {
                array.get_or_insert(bytes);
            }
            (_, Some(quantity), Value::Quantity(value, unit)) => {
                quantity.get_or_insert((value, unit));
            }
            _ => {}
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
        0x40 => {
            name(rest)?;
            part(rest).map(Value::Array)
        }
        0x0e | 0x42 | 0x7c => {
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
