//! Scales of Zygo's `.datx` files, which are HDF5.
//!
//! An array has attributes `X Converter`, `Y Converter` and `Z Converter`: records of a category, a unit and
//! parameters. Those of x and y are 0 and the distance of points (m). Those of z are 0, the wavelength (m), the heights
//! of a fringe in wavelengths, and the factor of obliquity. Readers of prysm and of SurfaceTopography take them so.

use netcdf_reader::{NcAttrValue, NcAttribute, NcValue};

use super::scalings::{Entries, Value};

/// What the converters of an array say, as entries beside it.
pub(super) fn entries(attributes: &[NcAttribute]) -> Entries {
    let converter = |name: &str| {
        let attribute = attributes.iter().find(|attribute| attribute.name == name)?;
        parameters(&attribute.value)
    };
    let distance = |name: &str, axis: &str| {
        let [_, distance, ..] = *converter(name)?.as_slice() else { return None };
        (distance > 0.0).then(|| (axis.to_owned(), Value::Numbers(vec![distance])))
    };
    let unit = attributes.iter().find(|attribute| attribute.name == "Unit").and_then(|unit| unit.value.as_string());
    let is_fringes = unit.is_some_and(|unit| unit.trim_end_matches('\0') == "Fringes");
    let fringe = converter("Z Converter").filter(|_| is_fringes).and_then(|values| match *values.as_slice() {
        [_, wavelength, scale, obliquity, ..] => Some(wavelength * scale * obliquity),
        _ => None,
    });
    // The unit goes before that of the array.
    let fringe = fringe.map(|metres| ("z_scale_m".to_owned(), Value::Numbers(vec![metres])));
    [distance("X Converter", "dx_m"), distance("Y Converter", "dy_m"), fringe].into_iter().flatten().collect()
}

/// The numbers in the first record of a converter.
fn parameters(value: &NcAttrValue) -> Option<Vec<f64>> {
    let NcAttrValue::UserDefined { values, .. } = value else { return None };
    let Some(NcValue::Compound(fields)) = values.first() else { return None };
    let numbers = |values: &[NcValue]| {
        let number = |value: &NcValue| if let NcValue::Double(number) = value { Some(*number) } else { None };
        values.iter().map(number).collect()
    };
    fields.iter().find_map(|field| match &field.value {
        NcValue::VLen(values) => numbers(values),
        NcValue::Array(array) => numbers(&array.values),
        _ => None,
    })
}
