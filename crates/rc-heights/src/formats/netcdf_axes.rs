//! Coordinates beside the arrays of HDF5 and NetCDF files.

use netcdf_reader::{NcAttrValue, NcGroup, NcVariable};
use rc_core::Grid;

use super::axes;
use super::field::transposed;
use super::netcdf::{Arrays, is_number};
use crate::FormatError;

/// Coordinates along an axis.
pub(super) struct Coordinates {
    pub(super) values: Vec<f64>,
    /// Name of the unit of the values.
    pub(super) unit: String,
}

/// The map whose coordinates are searched.
pub(super) struct Beside<'a> {
    pub(super) path: &'a str,
    /// Names of the dimensions along x and y.
    pub(super) dimensions: [&'a str; 2],
    pub(super) grid: Grid,
    pub(super) of_matlab: bool,
}

/// The type of an array that MATLAB wrote.
pub(super) fn class_of_matlab(variable: &NcVariable) -> Option<String> {
    let class = variable.attribute("MATLAB_class")?.value.as_string()?;
    Some(class.trim_end_matches('\0').to_owned())
}

/// The name of the unit of a variable, which may be empty.
pub(super) fn unit_name(variable: &NcVariable) -> String {
    let attribute = ["units", "unit", "Units", "Unit"].iter().find_map(|name| variable.attribute(name));
    let name = attribute.and_then(|attribute| attribute.value.as_string()).unwrap_or_default();
    name.trim_end_matches('\0').to_owned()
}

/// Coordinates along x and y, and whether the axes of the map are the other way round.
///
/// They are vectors, or matrices of the shape of the map.
pub(super) fn coordinates(
    arrays: &Arrays,
    beside: &Beside<'_>,
) -> Result<Option<([Coordinates; 2], bool)>, FormatError> {
    let Some((group, folder)) = group_of(arrays, beside.path)? else { return Ok(None) };
    let (nx, ny) = (beside.grid.nx() as u64, beside.grid.ny() as u64);
    let candidates = [0, 1].map(|axis| candidates(group, beside, axis));
    let find = |axis: usize, shapes: &[&[u64]]| {
        candidates[axis].iter().find(|variable| shapes.contains(&variable.shape().as_slice())).copied()
    };
    let vector = |axis: usize, n: u64| {
        let shapes: [&[u64]; 3] = [&[n], &[1, n], &[n, 1]];
        find(axis, if beside.of_matlab { &shapes } else { &shapes[..1] })
    };
    let values = |variable: &NcVariable| arrays.values(&format!("{folder}{}", variable.name()), None);
    let of = |variable: &NcVariable, values| Coordinates { values, unit: unit_name(variable) };
    for (x, y, is_other_way) in [(nx, ny, false), (ny, nx, true)] {
        if let (Some(x), Some(y)) = (vector(0, x), vector(1, y)) {
            return Ok(Some(([of(x, values(x)?), of(y, values(y)?)], is_other_way)));
        }
    }
    let shape = if beside.of_matlab { [nx, ny] } else { [ny, nx] };
    let (Some(x), Some(y)) = (find(0, &[&shape]), find(1, &[&shape])) else { return Ok(None) };
    let mesh = |variable: &NcVariable| {
        let stored = values(variable)?;
        Ok::<_, FormatError>(if beside.of_matlab { transposed(&stored, beside.grid) } else { stored })
    };
    let meshes = axes::of_meshes(&mesh(x)?, &mesh(y)?, beside.grid.nx());
    Ok(meshes.map(|([along_x, along_y], is_other_way)| ([of(x, along_x), of(y, along_y)], is_other_way)))
}

/// The group of an array, and its path with a slash at its end.
fn group_of<'a>(arrays: &'a Arrays, path: &str) -> Result<Option<(&'a NcGroup, String)>, FormatError> {
    let Some((folder, _)) = path.rsplit_once('/') else { return Ok(Some((arrays.root()?, String::new()))) };
    Ok(arrays.file.group(folder).ok().map(|group| (group, format!("{folder}/"))))
}

/// Arrays that may be the coordinates along an axis, those with the best reason first.
///
/// They have the name of the dimension, are named by the attribute `axes` of the group, or are called x or y.
fn candidates<'a>(group: &'a NcGroup, beside: &Beside<'_>, axis: usize) -> Vec<&'a NcVariable> {
    let own = beside.path.rsplit('/').next().unwrap_or_default();
    let named = |name: &str| group.variables.iter().find(|variable| variable.name() == name);
    let axes = axes_of(group);
    // The axes of NeXus are in the order of the dimensions, of which x is the last.
    let of_nexus = axes.len().checked_sub(1 + axis).and_then(|i| axes.get(i)).filter(|_| axes.len() >= 2);
    let called = group.variables.iter().filter(|variable| axes::axis_of(variable.name()) == Some(axis));
    let all = named(beside.dimensions[axis]).into_iter().chain(of_nexus.and_then(|name| named(name))).chain(called);
    all.filter(|variable| is_number(variable.dtype()) && variable.name() != own).collect()
}

/// The names in the attribute `axes` of a group.
fn axes_of(group: &NcGroup) -> Vec<String> {
    match group.attribute("axes").map(|attribute| &attribute.value) {
        Some(NcAttrValue::Strings(names)) => names.clone(),
        Some(NcAttrValue::Chars(names)) => {
            names.trim_matches(['[', ']', '\0']).split([',', ':', ' ']).map(|name| name.trim().to_owned()).collect()
        }
        _ => Vec::new(),
    }
}
