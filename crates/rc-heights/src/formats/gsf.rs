//! Gwyddion simple field 1.0.
//!
//! The format has a text header, then 32-bit floats with rows from top to bottom
//! (<http://gwyddion.net/documentation/user-guide-en/gsf.html>).

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use rc_core::Field;

use super::binary::Number;
use super::field::field;
use super::fields::{Fields, positive};
use super::unit;
use crate::{Format, FormatError, HeightMap, Unit};

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
    #[expect(clippy::float_cmp, reason = "the default of the format is exactly 1")]
    let is_default = |sides: [f64; 2]| side_unit == Unit::Unnamed && sides == [1.0, 1.0];
    let sides = match (side("XReal")?, side("YReal")?) {
        (Some(x), Some(y)) => Some([x, y]).filter(|sides| !is_default(*sides)),
        (None, None) => None,
        (x, _) => {
            let field = if x.is_none() { "XReal" } else { "YReal" };
            return Err(FormatError::Missing { format: Format::Gsf, field });
        }
    };
    // One to four zero bytes pad the header to a multiple of four.
    let mut values = Number::F32.values_alone(bytes.get(end + 4 - end % 4..).unwrap_or_default(), grid)?;
    crate::map::scale(&mut values, height_factor);
    Ok(HeightMap::new(field(grid, values), height_unit, sides, side_unit).of_numbers(height_factor))
}

/// Writes a field as a simple field of 32-bit floats, with heights and `sides` in m.
///
/// Heights are multiplied by `factor`. The last row is written first, because the rows of the format begin at the top.
///
/// # Errors
/// Errors of the file system.
pub fn write(path: &Path, field: &Field, factor: f64, sides: [f64; 2]) -> io::Result<()> {
    let (nx, ny, [x, y]) = (field.grid().nx(), field.grid().ny(), sides);
    let mut header = MARK.to_vec();
    write!(header, "\nXRes = {nx}\nYRes = {ny}\nXReal = {x:e}\nYReal = {y:e}\nXYUnits = m\nZUnits = m\n")?;
    header.resize(header.len() + 4 - header.len() % 4, 0);
    let mut out = BufWriter::with_capacity(1 << 16, File::create(path)?);
    out.write_all(&header)?;
    for iy in (0..ny).rev() {
        for height in field.row(iy) {
            out.write_all(&((height * factor) as f32).to_le_bytes())?;
        }
    }
    out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}
