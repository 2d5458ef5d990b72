//! Gwyddion simple field 1.0.
//!
//! The format has a text header, then 32-bit floats with rows from top to bottom
//! (<http://gwyddion.net/documentation/user-guide-en/gsf.html>).

use super::binary::Number;
use super::field::field;
use super::fields::{Fields, positive};
use super::unit;
use crate::{Format, FormatError, HeightMap};

/// The first line.
pub(super) const MARK: &[u8] = b"Gwyddion Simple Field 1.0";

pub(super) fn parse(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let end = bytes.iter().position(|byte| *byte == 0);
    let end = end.ok_or(FormatError::HeaderCutShort { format: Format::Gsf })?;
    let header = String::from_utf8_lossy(&bytes[..end]);
    let fields = Fields::of(&header, Format::Gsf);
    let grid = fields.grid("XRes", "YRes")?;
    let (side_unit, side_factor) = unit::of_sides(Format::Gsf, "XYUnits", fields.text("XYUnits").unwrap_or_default())?;
    let (height_unit, height_factor) = unit::of_values(fields.text("ZUnits").unwrap_or_default());
    let side = |name| {
        let length: Option<f64> = fields.optional(name)?;
        length.map(|length| positive(Format::Gsf, name, length * side_factor)).transpose()
    };
    // By the format, missing sizes are 1 without a unit, so they are not known.
    let sides = match (side("XReal")?, side("YReal")?) {
        (Some(x), Some(y)) => Some([x, y]),
        (None, None) => None,
        (x, _) => {
            let field = if x.is_none() { "XReal" } else { "YReal" };
            return Err(FormatError::Missing { format: Format::Gsf, field });
        }
    };
    // One to four zero bytes pad the header to a multiple of four.
    let mut values = Number::F32.values_alone(bytes.get(end + 4 - end % 4..).unwrap_or_default(), grid)?;
    crate::map::scale(&mut values, height_factor);
    Ok(HeightMap::new(field(grid, values), height_unit, sides, side_unit))
}
