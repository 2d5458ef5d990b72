//! Gwyddion native files, version 2.
//!
//! The format is a tree of named, typed, little-endian values. A channel is the object `/N/data`
//! (<http://gwyddion.net/documentation/user-guide-en/gwyfile-format.html>), and its mask is `/N/mask`. Gwyddion has no
//! other mark for missing points: its readers of instruments fill them and mask them. Masked points are therefore
//! missing, unless the user ignores masks because they are a selection.

use std::collections::BTreeMap;

use rc_core::Grid;

use super::binary::{Bytes, Number};
use super::channel::{Channel, Channels, each};
use super::field::field;
use super::fields::{positive, refused, shown};
use super::unit;
use crate::{Format, FormatError, HeightMap, Mask, ReadNote, Unit};

/// The first bytes.
pub(super) const MARK: &[u8] = b"GWYP";

/// Names of pixels as a unit of the sides. The size of such a map is not known.
const PIXELS: [&str; 4] = ["px", "pix", "pixel", "pixels"];

/// Values of a mask from this one on mask a point. Masks are 0 and 1, and fractions after interpolation.
const MASKED: f64 = 0.5;

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
    mask: Option<&'a [u8]>,
}

impl<'a> Found<'a> {
    /// Name and channel, or `None` for a title or a mask without data.
    fn channel(self) -> Option<(String, Result<Channel<'a>, FormatError>)> {
        let name = String::from_utf8_lossy(self.title.unwrap_or_default()).into_owned();
        let mask = self.mask;
        let channel = DataField::of(self.data?).map(|data| Channel {
            name: name.clone(),
            is_height: data.height.0 != Unit::NotLength,
            read: Box::new(move || match mask {
                Some(mask) => DataField::of(mask)?.applied(data.map()?),
                None => data.map(),
            }),
        });
        Some((name, channel))
    }
}

/// The channels of a file. Masked points are missing if `mask` says so.
pub(super) fn channels(bytes: &[u8], mask: Mask) -> Channels<'_> {
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
            ("mask", Value::Object { name: b"GwyDataField", content }) if mask == Mask::Use => {
                found.entry(number).or_default().mask = Some(content);
            }
            ("data/title", Value::Text(title)) => found.entry(number).or_default().title = Some(title),
            _ => {}
        }
    }
    let channels = found.into_values().filter_map(Found::channel);
    Ok(each(channels.collect()))
}

/// Number of the channel and rest of a key such as `/0/data/title`.
fn channel_of(key: &[u8]) -> Option<(u32, &str)> {
    let (number, rest) = std::str::from_utf8(key).ok()?.strip_prefix('/')?.split_once('/')?;
    Some((number.parse().ok()?, rest))
}

/// Contents of a data field.
struct DataField<'a> {
    resolution: [i32; 2],
    /// Sides, or `None` where the file does not have them.
    sides: [Option<f64>; 2],
    /// Name of the unit of the sides.
    side: String,
    height: (Unit, f64),
    values: &'a [u8],
}

impl<'a> DataField<'a> {
    fn of(content: &'a [u8]) -> Result<Self, FormatError> {
        // By the format, missing units are empty. Numbers without a dimension are not heights.
        let (side, height) = (String::new(), (Unit::NotLength, 1.0));
        let mut this = Self { resolution: [0; 2], sides: [None; 2], side, height, values: &[] };
        for (key, value) in tree(content)? {
            match (key, value) {
                (b"xres", Value::Integer(n)) => this.resolution[0] = n,
                (b"yres", Value::Integer(n)) => this.resolution[1] = n,
                (b"xreal", Value::Double(side)) => this.sides[0] = Some(side),
                (b"yreal", Value::Double(side)) => this.sides[1] = Some(side),
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

    fn grid(&self) -> Result<Grid, FormatError> {
        let [nx, ny] = self.resolution.map(|n| usize::try_from(n).unwrap_or(0));
        Ok(Grid::new(nx, ny)?)
    }

    fn map(&self) -> Result<HeightMap, FormatError> {
        let grid = self.grid()?;
        let mut values = Number::F64.values_alone(self.values, grid)?;
        crate::map::scale(&mut values, self.height.1);
        let (sides, side_unit) = self.known_sides()?;
        Ok(HeightMap::new(field(grid, values), self.height.0, sides, side_unit).of_numbers(self.height.1))
    }

    /// The sides and their unit.
    ///
    /// By the format, a missing side is 1, so the size is not known then. Sides of 1 without a unit are that default
    /// too.
    fn known_sides(&self) -> Result<(Option<[f64; 2]>, Unit), FormatError> {
        let unknown = Ok((None, Unit::Unnamed));
        let [Some(x), Some(y)] = self.sides else { return unknown };
        #[expect(clippy::float_cmp, reason = "the default of the format is exactly 1")]
        let is_default = self.side.trim().is_empty() && [x, y] == [1.0, 1.0];
        if is_default || PIXELS.contains(&self.side.trim()) {
            return unknown;
        }
        let (unit, factor) = unit::of_sides(Format::Gwy, "si_unit_xy", &self.side)?;
        let x = positive(Format::Gwy, "xreal", x * factor)?;
        let y = positive(Format::Gwy, "yreal", y * factor)?;
        Ok((Some([x, y]), unit))
    }

    /// `map` without the points that this field masks.
    fn applied(&self, mut map: HeightMap) -> Result<HeightMap, FormatError> {
        let (of_mask, grid) = (self.grid()?, map.heights.grid());
        if of_mask != grid {
            let expected = "as many points as the data; --mask ignore reads the map without it";
            return Err(refused(Format::Gwy, "the mask", &format!("{of_mask} points, for {grid}"), expected));
        }
        let mask = Number::F64.values_alone(self.values, grid)?;
        let masked = |value: &&f64| **value >= MASKED;
        let points = mask.iter().filter(masked).count();
        if points == grid.len() {
            let expected = "one that leaves some points; --mask ignore reads the map without it";
            return Err(refused(Format::Gwy, "the mask", "one of all points", expected));
        }
        for (height, _) in map.heights.values_mut().iter_mut().zip(&mask).filter(|(_, value)| masked(value)) {
            *height = f64::NAN;
        }
        Ok(if points > 0 { map.with_note(ReadNote::Masked { points }) } else { map })
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
