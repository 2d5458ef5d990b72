//! What stands beside the arrays of HDF5 and NetCDF files: units, sizes, attributes.

use netcdf_reader::{NcAttrValue, NcAttribute, NcType, NcVariable};

use super::netcdf::{Arrays, is_number};
use super::scalings::{Entries, Scalings, Value};
use super::{datx, unit};
use crate::{Format, FormatError, Unit};

/// Number of values above which a vector is a profile or an axis, not a few settings.
pub(super) const FEW: u64 = 8;

/// Dimensions that are longer than 1, with their lengths.
pub(super) fn long(variable: &NcVariable) -> Vec<(usize, u64)> {
    variable.shape().into_iter().enumerate().filter(|(_, n)| *n != 1).collect()
}

/// Attributes that are numbers or texts.
pub(super) fn attributes(attributes: &[NcAttribute]) -> Entries {
    let value = |value: &NcAttrValue| match value {
        NcAttrValue::Chars(_) | NcAttrValue::Strings(_) => value.as_string().map(Value::Text),
        other => other.as_f64_vec().map(Value::Numbers),
    };
    // Missing values of NetCDF are applied already, to the numbers as they are stored.
    let is_applied = |name: &str| name == "missing_value";
    let kept = attributes.iter().filter(|attribute| !is_applied(&attribute.name));
    let others = kept.filter_map(|attribute| Some((attribute.name.clone(), value(&attribute.value)?)));
    datx::entries(attributes).into_iter().chain(others).collect()
}

/// What stands around the arrays of the group at `path`: single numbers and texts, and attributes of the group and of
/// those around it.
pub(super) fn others(arrays: &Arrays, path: &str) -> Result<Entries, FormatError> {
    let groups: Vec<&str> = path.split('/').filter(|name| !name.is_empty()).collect();
    let mut chain = vec![arrays.root()?];
    for name in groups {
        let Some(inner) = chain.last().and_then(|group| group.groups.iter().find(|inner| inner.name == name)) else {
            break;
        };
        chain.push(inner);
    }
    let mut entries = Entries::new();
    if let Some(group) = chain.last() {
        let is_short = |variable: &&NcVariable| {
            variable.shape().iter().try_fold(1, |n: u64, m| n.checked_mul(*m)).is_some_and(|n| n <= 2)
        };
        for variable in group.variables.iter().filter(is_short) {
            let path = format!("{path}{}", variable.name());
            let value = match variable.dtype() {
                NcType::String | NcType::Char => arrays.file.read_variable_as_string(&path).ok().map(Value::Text),
                kind if is_number(kind) => arrays.values(&path, None).ok().map(Value::Numbers),
                _ => None,
            };
            entries.extend(value.map(|value| (variable.name().to_owned(), value)));
        }
    }
    entries.extend(chain.iter().rev().flat_map(|group| attributes(&group.attributes)));
    Ok(entries)
}

/// Sides in metres if one of the units of x and y is named.
pub(super) fn with_units(
    format: Format,
    sides: [f64; 2],
    units: &[String; 2],
) -> Result<(Option<[f64; 2]>, Unit), FormatError> {
    let [x, y] = units;
    let both = [unit::of_sides(format, "unit of x", x)?, unit::of_sides(format, "unit of y", y)?];
    let (factors, unit) = unit::of_both(both);
    Ok((Some([sides[0] * factors[0], sides[1] * factors[1]]), unit))
}

/// What stands beside the array at `path`.
pub(super) fn scalings(arrays: &Arrays, path: &str) -> Result<Scalings, FormatError> {
    let group = path.rsplit_once('/').map_or(String::new(), |(group, _)| format!("{group}/"));
    Ok(Scalings::of(&attributes(arrays.variable(path)?.attributes()), &others(arrays, &group)?))
}
