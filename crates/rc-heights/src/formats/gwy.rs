//! Gwyddion native files, version 2.
//!
//! The format is a tree of named, typed, little-endian values. A channel is the object `/N/data`
//! (<http://gwyddion.net/documentation/user-guide-en/gwyfile-format.html>). Masks are not read: they show what the user
//! of Gwyddion selected, not what was not measured.

use std::collections::BTreeMap;

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::channel::{Channel, Channels, each};
use super::field::field;
use super::fields::{positive, refused, shown};
use super::unit;
use crate::{Format, FormatError, HeightMap, Unit};

/// The first bytes.
pub(super) const MARK: &[u8] = b"GWYP";

/// A value of the tree. Arrays and objects are parsed only when they are needed.
#[derive(Clone, Copy)]
enum Value<'a> {
    Integer(i32),
    Double(f64),
    Text(&'a [u8]),
    Object { name: &'a [u8], content: &'a [u8] },
    Doubles(&'a [u8]),
    Other,
}

type Tree<'a> = Vec<(&'a [u8], Value<'a>)>;

/// The parts of a channel that are found so far.
#[derive(Default)]
struct Found<'a> {
    title: Option<&'a [u8]>,
    data: Option<&'a [u8]>,
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let mut bytes = Bytes::new(bytes, Format::Gwy);
    bytes.take(MARK.len())?;
    let Value::Object { name: b"GwyContainer", content } = object(&mut bytes)? else {
        return Err(refused(Format::Gwy, "the first object", "another object", "a GwyContainer"));
    };
    let mut found: BTreeMap<u32, Found<'_>> = BTreeMap::new();
    for (key, value) in tree(content)? {
        let Some((number, rest)) = channel_of(key) else { continue };
        match (rest, value) {
            ("data", Value::Object { name: b"GwyDataField", content }) => {
                found.entry(number).or_default().data = Some(content);
            }
            ("data/title", Value::Text(title)) => found.entry(number).or_default().title = Some(title),
            _ => {}
        }
    }
    let channels = found.into_values().filter_map(|Found { title, data }| Some((title.unwrap_or_default(), data?)));
    let channel = |(title, data)| {
        let name = String::from_utf8_lossy(title).into_owned();
        let channel = DataField::of(data).map(|data| Channel {
            name: name.clone(),
            is_height: data.height.0 != Unit::NotLength,
            read: Box::new(move || data.map()),
        });
        (name, channel)
    };
    Ok(each(channels.map(channel).collect()))
}

/// Number of the channel and rest of a key such as `/0/data/title`.
fn channel_of(key: &[u8]) -> Option<(u32, &str)> {
    let (number, rest) = std::str::from_utf8(key).ok()?.strip_prefix('/')?.split_once('/')?;
    Some((number.parse().ok()?, rest))
}

/// Contents of a data field.
struct DataField<'a> {
    resolution: [i32; 2],
    sides: [f64; 2],
    /// Name of the unit of the sides.
    side: String,
    height: (Unit, f64),
    values: &'a [u8],
}

impl<'a> DataField<'a> {
    fn of(content: &'a [u8]) -> Result<Self, FormatError> {
        // By the format, missing numbers are 1 and missing units are empty. Numbers without a dimension are not
        // heights.
        let (side, height) = (String::new(), (Unit::NotLength, 1.0));
        let mut this = Self { resolution: [0; 2], sides: [1.0; 2], side, height, values: &[] };
        for (key, value) in tree(content)? {
            match (key, value) {
                (b"xres", Value::Integer(n)) => this.resolution[0] = n,
                (b"yres", Value::Integer(n)) => this.resolution[1] = n,
                (b"xreal", Value::Double(side)) => this.sides[0] = side,
                (b"yreal", Value::Double(side)) => this.sides[1] = side,
                (b"si_unit_xy", Value::Object { content, .. }) => this.side = unit_name(content)?,
                (b"si_unit_z", Value::Object { content, .. }) => {
                    let (unit, factor) = unit::of_values(&unit_name(content)?);
                    this.height = (if unit == Unit::Metre { unit } else { Unit::NotLength }, factor);
                }
                (b"data", Value::Doubles(values)) => this.values = values,
                _ => {}
            }
        }
        Ok(this)
    }

    fn map(&self) -> Result<HeightMap, FormatError> {
        let side = |n: i32| usize::try_from(n).unwrap_or(0);
        let grid = Grid::new(side(self.resolution[0]), side(self.resolution[1]))?;
        let mut values = Number::F64.values_alone(self.values, grid)?;
        crate::map::scale(&mut values, self.height.1);
        let (side_unit, factor) = unit::of_sides(Format::Gwy, "si_unit_xy", &self.side)?;
        let x = positive(Format::Gwy, "xreal", self.sides[0] * factor)?;
        let y = positive(Format::Gwy, "yreal", self.sides[1] * factor)?;
        let (heights, height_unit) = (field(grid, values), self.height.0);
        Ok(HeightMap::new(heights, height_unit, Some([x, y]), side_unit))
    }
}

/// The name in a `GwySIUnit`.
fn unit_name(content: &[u8]) -> Result<String, FormatError> {
    let tree = tree(content)?;
    let name = tree.into_iter().find_map(|(key, value)| match (key, value) {
        (b"unitstr", Value::Text(name)) => Some(String::from_utf8_lossy(name).into_owned()),
        _ => None,
    });
    Ok(name.unwrap_or_default())
}

/// The components of an object.
fn tree(content: &[u8]) -> Result<Tree<'_>, FormatError> {
    let mut bytes = Bytes::new(content, Format::Gwy);
    let mut tree = Vec::new();
    while !bytes.rest().is_empty() {
        let name = text(&mut bytes)?;
        tree.push((name, value(&mut bytes)?));
    }
    Ok(tree)
}

fn value<'a>(bytes: &mut Bytes<'a>) -> Result<Value<'a>, FormatError> {
    Ok(match bytes.u8()? {
        b'i' => Value::Integer(bytes.u32()?.cast_signed()),
        b'd' => Value::Double(bytes.f64()?),
        b's' => Value::Text(text(bytes)?),
        b'o' => object(bytes)?,
        b'D' => Value::Doubles(array(bytes, 8)?),
        b'b' | b'c' => skip(bytes, 1)?,
        b'q' => skip(bytes, 8)?,
        b'C' => drop_array(bytes, 1)?,
        b'I' => drop_array(bytes, 4)?,
        b'Q' => drop_array(bytes, 8)?,
        b'S' => {
            for _ in 0..bytes.u32()? {
                text(bytes)?;
            }
            Value::Other
        }
        b'O' => {
            for _ in 0..bytes.u32()? {
                object(bytes)?;
            }
            Value::Other
        }
        other => {
            return Err(refused(
                Format::Gwy,
                "the type of a value",
                &shown(&char::from(other).to_string()),
                "one of bciqdsoCIQDSO",
            ));
        }
    })
}

fn skip<'a>(bytes: &mut Bytes<'a>, n: usize) -> Result<Value<'a>, FormatError> {
    bytes.take(n)?;
    Ok(Value::Other)
}

fn drop_array<'a>(bytes: &mut Bytes<'a>, size: usize) -> Result<Value<'a>, FormatError> {
    array(bytes, size)?;
    Ok(Value::Other)
}

fn array<'a>(bytes: &mut Bytes<'a>, size: usize) -> Result<&'a [u8], FormatError> {
    let n = bytes.u32()? as usize;
    bytes.take(n.saturating_mul(size))
}

fn object<'a>(bytes: &mut Bytes<'a>) -> Result<Value<'a>, FormatError> {
    let name = text(bytes)?;
    let size = bytes.u32()? as usize;
    Ok(Value::Object { name, content: bytes.take(size)? })
}

/// A text that ends with a zero byte.
fn text<'a>(bytes: &mut Bytes<'a>) -> Result<&'a [u8], FormatError> {
    let end = bytes.rest().iter().position(|byte| *byte == 0);
    let text = bytes.take(end.ok_or(FormatError::HeaderCutShort { format: Format::Gwy })?)?;
    bytes.take(1)?;
    Ok(text)
}
