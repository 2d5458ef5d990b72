//! Igor Pro binary waves, version 5 (WaveMetrics' technical note PTN003).
//!
//! The format has two headers, values whose first index changes fastest, notes and labels. The first index is x, the
//! second y, and the third counts channels.

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels, is_topography};
use super::endian::Endian;
use super::field::{field, flip};
use super::fields::{positive, refused};
use super::instrument::text;
use super::unit;
use crate::{Format, FormatError, HeightMap, Unit};

/// Bytes of both headers. The sum of their 16-bit words is 0.
const HEADERS: usize = FIRST + 320;
/// Bytes of the first header.
const FIRST: usize = 64;
/// Bytes of the label of an element of a dimension.
const LABEL: usize = 32;

/// The byte order of a wave, or `None` for other files.
///
/// It follows from the headers.
pub(super) fn order(start: &[u8]) -> Option<Endian> {
    let headers = start.get(..HEADERS)?;
    let order = match headers[..2] {
        [5, 0] => Endian::Little,
        [0, 5] => Endian::Big,
        _ => return None,
    };
    let words = headers.as_chunks::<2>().0;
    let sum = words.iter().fold(0_u16, |sum, word| sum.wrapping_add(order.u16(*word)));
    (sum == 0).then_some(order)
}

/// Contents of the headers.
struct Wave<'a> {
    order: Endian,
    number: Number,
    grid: Grid,
    layers: usize,
    /// Distances of points, negative where an axis runs backwards.
    steps: [f64; 2],
    /// Names of the units of values, x and y.
    units: [String; 3],
    values: &'a [u8],
    labels: Vec<String>,
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let wave = std::rc::Rc::new(Wave::of(bytes)?);
    let is_named = wave.labels.iter().any(|name| is_topography(name));
    let is_length = unit::of_values(&wave.units[0]).0 != Unit::NotLength;
    let channel = |layer: usize| {
        let wave = wave.clone();
        let name = wave.labels.get(layer).cloned().unwrap_or_default();
        // The single unit of all layers is the unit of the heights.
        let is_height = is_length && (!is_named || is_topography(&name));
        Channel { name, is_height, read: Box::new(move || wave.map(layer, is_height)) }
    };
    Ok((0..wave.layers).map(channel).collect())
}

impl<'a> Wave<'a> {
    fn of(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let cut = FormatError::HeaderCutShort { format: Format::Ibw };
        let Some(order) = order(bytes) else {
            let start = bytes.get(..2).unwrap_or_default();
            if matches!(start, [1..=3, 0] | [0, 1..=3]) {
                let what = "a wave older than version 5, which has one dimension,".to_owned();
                return Err(FormatError::Unsupported {
                    format: Format::Ibw,
                    what,
                    cure: "save an image as a wave of Igor Pro 3 or later",
                });
            }
            let whole = bytes.len() >= HEADERS;
            return Err(if whole { refused(Format::Ibw, "checksum", "another", "that of the headers") } else { cut });
        };
        let (first, second) = (&bytes[..FIRST], &bytes[FIRST..HEADERS]);
        let (number, n) = (number(order.i16_at(second, 16))?, |dim: usize| order.i32_at(second, 68 + 4 * dim));
        let count = |dim: usize| usize::try_from(n(dim)).unwrap_or(0);
        if count(3) > 1 {
            let what = "a wave of four dimensions".to_owned();
            return Err(FormatError::Unsupported {
                format: Format::Ibw,
                what,
                cure: "save one image or a stack of images",
            });
        }
        let (grid, layers) = (Grid::new(count(0), count(1))?, count(2).max(1));
        let needed = number.bytes_of(grid).saturating_mul(layers as u64);
        let found = (bytes.len() - HEADERS) as u64;
        let values = usize::try_from(needed).ok().and_then(|needed| bytes.get(HEADERS..)?.get(..needed));
        let values = values.ok_or(FormatError::CutShort { grid, needed, found })?;
        let ascii = |at: usize| text(second.get(at..at + 4).unwrap_or_default());
        let sizes = |at: usize| usize::try_from(order.i32_at(first, at)).unwrap_or(0);
        // After the values: formula, note, long names of units of the values and of four dimensions, labels.
        let mut at = FIRST
            .saturating_add(sizes(4))
            .max(HEADERS + values.len())
            .saturating_add(sizes(8))
            .saturating_add(sizes(12));
        let mut block = |size: usize| {
            // Labels say which layer has the heights, so a file without them is truncated.
            let block = bytes.get(at..).and_then(|rest| rest.get(..size)).ok_or_else(|| cut.clone());
            at = at.saturating_add(size);
            block
        };
        let mut long = Vec::new();
        for i in 0..5 {
            long.push(text(block(sizes(16 + 4 * i))?));
        }
        let mut labels = Vec::new();
        for i in 0..4 {
            labels.push(block(sizes(36 + 4 * i))?);
        }
        // The first label belongs to the dimension.
        let labels = labels[2].chunks(LABEL).skip(1).take(layers).map(text).collect();
        let units = [0, 1, 2].map(|i| if long[i].is_empty() { ascii(148 + 4 * i) } else { long[i].clone() });
        let steps = [order.f64_at(second, 84), order.f64_at(second, 92)];
        Ok(Self { order, number, grid, layers, steps, units, values, labels })
    }

    fn map(&self, layer: usize, is_height: bool) -> Result<HeightMap, FormatError> {
        let (grid, size) = (self.grid, self.values.len() / self.layers);
        let stored = &self.values[layer * size..][..size];
        let mut values = self.order.values(self.number, stored, grid)?;
        let (height_unit, factor) = if is_height { unit::of_values(&self.units[0]) } else { (Unit::NotLength, 1.0) };
        crate::map::scale(&mut values, factor);
        let of_side = |field, name: &str| unit::of_sides(Format::Ibw, field, name);
        let units = [of_side("unit of x", &self.units[1])?, of_side("unit of y", &self.units[2])?];
        let (factors, side_unit) = unit::of_both(units);
        let step = |i: usize, name| positive(Format::Ibw, name, self.steps[i].abs() * factors[i]);
        let (x, y) = (step(0, "distance of points along x")?, step(1, "distance of points along y")?);
        flip(&mut values, grid, self.steps.map(|step| step < 0.0));
        // A wave that was never scaled has a step of 1 without a unit.
        #[expect(clippy::float_cmp, reason = "the step of a wave that was never scaled is exactly 1")]
        let is_scaled = side_unit == Unit::Metre || self.steps != [1.0, 1.0];
        let sides = is_scaled.then(|| [x * grid.nx() as f64, y * grid.ny() as f64]);
        Ok(HeightMap::new(field(grid, values), height_unit, sides, side_unit).of_numbers(factor))
    }
}

/// The type of the numbers of a wave.
fn number(kind: i16) -> Result<Number, FormatError> {
    Ok(match kind {
        0x02 => Number::F32,
        0x04 => Number::F64,
        0x08 => Number::I8,
        0x10 => Number::I16,
        0x20 => Number::I32,
        0x48 => Number::U8,
        0x50 => Number::U16,
        0x60 => Number::U32,
        other => return Err(refused(Format::Ibw, "type", &other, "that of real numbers")),
    })
}
