//! Images of WSxM.
//!
//! The format has sections of `key: value` lines, and numbers, the bottom right point first. The documentation of
//! Gwyddion describes it. `Z Amplitude` is the length of the range of all numbers.

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels};
use super::field::flip;
use super::fields::{factor, refused};
use super::instrument::{map, metres, scale_measured, text};
use crate::{Format, FormatError};

const MARK: &[u8] = b"WSxM file copyright";
/// The second line. Other files of WSxM are texts.
const IMAGE: &[u8] = b"SxM Image file";
/// The last line of the header. The size in the header may be wrong.
const END: &[u8] = b"[Header end]";

/// Whether a file that begins with `start` is an image of WSxM.
pub(super) fn is_image(start: &[u8]) -> bool {
    let second = start.split(|byte| *byte == b'\n').nth(1);
    start.starts_with(MARK) && second.is_some_and(|line| line.starts_with(IMAGE))
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let missing = FormatError::Missing { format: Format::Wsxm, field: "[Header end]" };
    let end = bytes.windows(END.len()).position(|part| part == END).ok_or(missing)?;
    let rest = &bytes[end + END.len()..];
    let data = rest.strip_prefix(b"\r\n").or_else(|| rest.strip_prefix(b"\n")).unwrap_or(rest);
    let header = Header::of(&bytes[..end]);
    let grid = Grid::new(header.number("Number of columns")?, header.number("Number of rows")?)?;
    let number = match header.get("Image Data Type").unwrap_or("short") {
        "double" => Number::F64,
        "float" => Number::F32,
        "short" | "integer" => Number::I16,
        other => return Err(refused(Format::Wsxm, "Image Data Type", other, "double, float, short or integer")),
    };
    let length = |key| Ok::<_, FormatError>(header.quantity(key)?).map(|(length, unit)| Some(length * metres(unit)?));
    let sides = match (length("X Amplitude")?, length("Y Amplitude")?) {
        (Some(x), Some(y)) if x > 0.0 && y > 0.0 && x.is_finite() && y.is_finite() => Some([x, y]),
        (Some(x), Some(_)) => return Err(refused(Format::Wsxm, "X or Y Amplitude", &x, "a positive length")),
        _ => None,
    };
    let (amplitude, unit) = header.quantity("Z Amplitude")?;
    let (amplitude, is_height) = metres(unit).map_or((amplitude, false), |unit| (amplitude * unit, true));
    Ok(vec![Channel {
        name: header.get("Acquisition channel").unwrap_or_default().to_owned(),
        is_height,
        read: Box::new(move || {
            let mut values = number.values_alone(data, grid)?;
            let scale = scale(&values, amplitude)?;
            scale_measured(&mut values, scale, |_| false);
            flip(&mut values, grid, [true, false]);
            Ok(map(grid, values, is_height, sides).of_numbers(scale))
        }),
    }])
}

/// The value of the number 1.
fn scale(values: &[f64], amplitude: f64) -> Result<f64, FormatError> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    factor(Format::Wsxm, "Z Amplitude / range of numbers", amplitude / (high - low))
}

/// The lines of the header. Keys that are read are in one section only.
struct Header {
    pairs: Vec<(String, String)>,
}

impl Header {
    fn of(header: &[u8]) -> Self {
        let lines = header.split(|byte| *byte == b'\n').map(text);
        let pair =
            |line: String| line.split_once(':').map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()));
        Self { pairs: lines.filter_map(pair).collect() }
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.pairs.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    fn number(&self, key: &'static str) -> Result<usize, FormatError> {
        let text = self.get(key).ok_or(FormatError::Missing { format: Format::Wsxm, field: key })?;
        text.parse().map_err(|_| refused(Format::Wsxm, key, text, "a number of points"))
    }

    /// Number and unit, as in `600 nm`.
    fn quantity(&self, key: &'static str) -> Result<(f64, &str), FormatError> {
        let text = self.get(key).ok_or(FormatError::Missing { format: Format::Wsxm, field: key })?;
        let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
        let number = number.parse().map_err(|_| refused(Format::Wsxm, key, text, "a number and a unit"))?;
        Ok((number, unit.trim()))
    }
}
