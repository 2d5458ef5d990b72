//! Nanosurf files.
//!
//! The format has sections of `key=value` lines, a mark, and the integers of each data set, whose first row has the
//! lowest y. The section `DataSet` lists the data sets in the order of their integers. The documentation of Gwyddion
//! describes the format.
//!
//! The least integer is `Dim2Min`, and all integers span `Dim2Range`.

use std::collections::HashMap;

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels, each};
use super::endian::Endian;
use super::fields::{factor, positive, refused};
use super::instrument::{Places, map, metres, text};
use crate::{Format, FormatError, HeightMap};

/// The first bytes.
pub(super) const MARK: &[u8] = b"[DataSet]";

/// The mark before the integers, at the start of a line.
const DATA: &[u8] = b"\n#!";

/// A section: `[name]`, then lines of `key=value`.
struct Section {
    name: String,
    pairs: Vec<(String, String)>,
}

/// Form of the integers of a data set.
struct DataSet {
    grid: Grid,
    number: Number,
    order: Endian,
    /// The value of an integer of 1 without offset, and the value of an integer of 0, in m if they are heights.
    scale: [f64; 2],
    is_height: bool,
    /// Sides (m), or `None` if the axes are not lengths.
    sides: Option<[f64; 2]>,
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let missing = FormatError::Missing { format: Format::Nid, field: "the mark #! before the integers" };
    let end = bytes.windows(DATA.len()).position(|part| part == DATA).ok_or(missing)?;
    let sections = sections(&bytes[..end]);
    let mut at = end + DATA.len();
    let mut found = Vec::new();
    for section in listed(&sections) {
        let data = Places::new(bytes, Format::Nid).rest(at);
        let set = section.data_set();
        // It is not known where the integers of the next ones begin.
        let is_known = set.is_ok();
        let channel = set.map(|set| {
            at = at.saturating_add(usize::try_from(set.number.bytes_of(set.grid)).unwrap_or(usize::MAX));
            let is_height = set.is_height;
            Channel { name: section.title(), is_height, read: Box::new(move || read(data, &set)) }
        });
        found.push((section.title(), channel));
        if !is_known {
            break;
        }
    }
    Ok(each(found))
}

fn read(data: &[u8], set: &DataSet) -> Result<HeightMap, FormatError> {
    let mut values = set.order.values(set.number, data, set.grid)?;
    let [scale, zero] = set.scale;
    for value in &mut values {
        *value = *value * scale + zero;
    }
    Ok(map(set.grid, values, set.is_height, set.sides))
}

fn sections(header: &[u8]) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    for line in header.split(|byte| *byte == b'\n') {
        let line = text(line);
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            sections.push(Section { name: name.to_owned(), pairs: Vec::new() });
        } else if let (Some(section), Some((key, value))) = (sections.last_mut(), line.split_once('=')) {
            section.pairs.push((key.to_owned(), value.trim().to_owned()));
        }
    }
    sections
}

/// The sections of data sets, in the order of their groups and channels.
fn listed(sections: &[Section]) -> Vec<&Section> {
    let place = |key: &str| {
        let (group, channel) = key.strip_prefix("Gr")?.split_once("-Ch")?;
        Some((group.parse::<u32>().ok()?, channel.parse::<u32>().ok()?))
    };
    // The first section of each name. Each is one data set, even if it is listed again.
    let mut named = HashMap::new();
    for section in sections {
        named.entry(section.name.as_str()).or_insert(section);
    }
    let list = named.get("DataSet").copied();
    let pairs = list.iter().flat_map(|list| &list.pairs);
    let mut places: Vec<_> = pairs.filter_map(|(key, name)| Some((place(key)?, name))).collect();
    places.sort();
    places.iter().filter_map(|(_, name)| named.remove(name.as_str())).collect()
}

impl Section {
    fn get(&self, key: &'static str) -> Result<&str, FormatError> {
        let pair = self.pairs.iter().find(|(name, _)| name == key);
        pair.map(|(_, value)| value.as_str()).ok_or(FormatError::Missing { format: Format::Nid, field: key })
    }

    fn number<T: std::str::FromStr>(&self, key: &'static str) -> Result<T, FormatError> {
        let text = self.get(key)?;
        text.parse().map_err(|_| refused(Format::Nid, key, text, "a number"))
    }

    /// The name of the quantity, with the direction of its lines unless they run forward.
    fn title(&self) -> String {
        let name = self.get("Dim2Name").unwrap_or_default();
        let frame = self.get("Frame").unwrap_or_default();
        match frame.strip_prefix("Scan ").unwrap_or(frame) {
            "forward" | "" => name.to_owned(),
            direction => format!("{name} {direction}"),
        }
    }

    fn data_set(&self) -> Result<DataSet, FormatError> {
        let mode = self.get("SaveMode")?;
        if mode != "Binary" {
            return Err(refused(Format::Nid, "SaveMode", mode, "Binary"));
        }
        let grid = Grid::new(self.number("Points")?, self.number("Lines")?)?;
        let is_signed = self.get("SaveSign")? == "Signed";
        let number = match (self.number("SaveBits")?, is_signed) {
            (8, true) => Number::I8,
            (8, false) => Number::U8,
            (16, true) => Number::I16,
            (16, false) => Number::U16,
            (32, true) => Number::I32,
            (32, false) => Number::U32,
            (other, _) => return Err(refused(Format::Nid, "SaveBits", &other, "8, 16 or 32")),
        };
        let order = if self.get("SaveOrder")? == "Intel" { Endian::Little } else { Endian::Big };
        let units = [self.get("Dim0Unit")?, self.get("Dim1Unit")?, self.get("Dim2Unit")?].map(metres);
        let [x, y, z] = units;
        let sides = match (x, y) {
            (Some(x), Some(y)) => Some([
                positive(Format::Nid, "Dim0Range", x * self.number::<f64>("Dim0Range")?)?,
                positive(Format::Nid, "Dim1Range", y * self.number::<f64>("Dim1Range")?)?,
            ]),
            _ => None,
        };
        let unit = z.unwrap_or(1.0);
        let range = factor(Format::Nid, "Dim2Range", unit * self.number::<f64>("Dim2Range")?)?;
        let least = if is_signed { 0.5 * range } else { 0.0 };
        let scale = [range / 256_f64.powi(number.size() as i32), unit * self.number::<f64>("Dim2Min")? + least];
        // Curves over a distance along z are data sets too, with other axes.
        Ok(DataSet { grid, number, order, scale, is_height: z.is_some() && sides.is_some(), sides })
    }
}
