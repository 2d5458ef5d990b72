//! Common parts of the readers of instruments.
//!
//! They read fields at fixed places of a header, and texts and units as instruments write them.

use rc_core::Grid;

use super::field::field;
use super::fields::positive;
use crate::{Format, FormatError, HeightMap, LengthUnit, Unit};

/// Bytes with fields at fixed places. Numbers are little-endian unless a name says otherwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Places<'a> {
    bytes: &'a [u8],
    format: Format,
}

impl<'a> Places<'a> {
    pub(super) fn new(bytes: &'a [u8], format: Format) -> Self {
        Self { bytes, format }
    }

    /// The `N` bytes from `at` on.
    pub(super) fn array<const N: usize>(self, at: usize) -> Result<[u8; N], FormatError> {
        let cut = FormatError::HeaderCutShort { format: self.format };
        self.bytes.get(at..).and_then(|rest| rest.first_chunk()).copied().ok_or(cut)
    }

    pub(super) fn u16(self, at: usize) -> Result<u16, FormatError> {
        self.array(at).map(u16::from_le_bytes)
    }

    pub(super) fn i32(self, at: usize) -> Result<i32, FormatError> {
        self.array(at).map(i32::from_le_bytes)
    }

    /// A 32-bit count, size or place.
    pub(super) fn size(self, at: usize) -> Result<usize, FormatError> {
        Ok(self.u32(at)? as usize)
    }

    pub(super) fn u32(self, at: usize) -> Result<u32, FormatError> {
        self.array(at).map(u32::from_le_bytes)
    }

    pub(super) fn f64(self, at: usize) -> Result<f64, FormatError> {
        self.array(at).map(f64::from_le_bytes)
    }

    pub(super) fn f32(self, at: usize) -> Result<f64, FormatError> {
        self.array(at).map(|bytes| f64::from(f32::from_le_bytes(bytes)))
    }

    /// The text in the `N` bytes from `at` on.
    pub(super) fn text<const N: usize>(self, at: usize) -> Result<String, FormatError> {
        Ok(text(&self.array::<N>(at)?))
    }

    /// The bytes from `at` on. They are empty if the file is truncated.
    pub(super) fn rest(self, at: usize) -> &'a [u8] {
        self.bytes.get(at..).unwrap_or_default()
    }
}

/// A text that ends at a zero byte or is padded with blanks.
///
/// It is in UTF-8, or else in Latin-1.
pub(super) fn text(bytes: &[u8]) -> String {
    let bytes = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
    let text =
        std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().copied().map(char::from).collect(), str::to_owned);
    text.trim().to_owned()
}

/// The length in m of a unit, or `None` if it is not a length.
///
/// Units are accepted as instruments write them.
pub(super) fn metres(unit: &str) -> Option<f64> {
    match unit.trim() {
        // "æ" is µ in a code page of DOS, and "~" is µ in Nanoscope.
        "æm" | "~m" => Some(LengthUnit::Micrometre.metres()),
        name => super::unit::length(name).map(LengthUnit::metres),
    }
}

/// Sides of a rectangle with points at distances of `spacing` (m).
pub(super) fn sides(
    format: Format,
    fields: [&'static str; 2],
    grid: Grid,
    spacing: [f64; 2],
) -> Result<[f64; 2], FormatError> {
    let side = |field, spacing: f64, n: usize| positive(format, field, positive(format, field, spacing)? * n as f64);
    Ok([side(fields[0], spacing[0], grid.nx())?, side(fields[1], spacing[1], grid.ny())?])
}

/// The map of `values` on a rectangle of `sides` (m). Values are in m if `is_height`.
pub(super) fn map(grid: Grid, values: Vec<f64>, is_height: bool, sides: Option<[f64; 2]>) -> HeightMap {
    let height_unit = if is_height { Unit::Metre } else { Unit::NotLength };
    let side_unit = if sides.is_some() { Unit::Metre } else { Unit::Unnamed };
    HeightMap::new(field(grid, values), height_unit, sides, side_unit)
}

/// Marks points as missing whose stored value `is_missing`, and multiplies the others by `scale`.
pub(super) fn scale_measured(values: &mut [f64], scale: f64, is_missing: impl Fn(f64) -> bool) {
    for value in values {
        *value = if is_missing(*value) { f64::NAN } else { *value * scale };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_instruments_are_lengths_or_none() {
        for (name, expected) in [("nm", Some(1e-9)), ("~m", Some(1e-6)), ("µm", Some(1e-6)), ("A", None), ("mV", None)]
        {
            assert_eq!(metres(name), expected, "{name}");
        }
        assert_eq!(text(b"\xb5m   \0junk"), "µm");
        assert_eq!(text("µm ".as_bytes()), "µm");
        assert_eq!(metres(&text(b"\xe6m")), Some(1e-6));
    }
}
