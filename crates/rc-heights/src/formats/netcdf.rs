//! HDF5 and NetCDF (classic, 64-bit, NetCDF-4), read with the crate netcdf-reader.
//!
//! Every array of numbers with two dimensions longer than 1 is a channel. Its name is its path. The attribute `units`
//! (or `unit`) of an array is its unit. `scale_factor`, `add_offset`, `_FillValue` and `missing_value` are applied.
//! Coordinates are the variables of the dimensions in NetCDF, and otherwise arrays called `x` and `y` beside the map.
//!
//! The last index is x, with two exceptions: the dimensions are called x and y in this order, or MATLAB wrote the
//! array. Files of MATLAB have dimensions in reverse order, and vectors of two dimensions.

use std::rc::Rc;

use hdf5_reader::group::Group;
use hdf5_reader::{Hdf5File, OpenOptions};
use netcdf_reader::{NcFile, NcGroup, NcMetadataMode, NcOpenOptions, NcType, NcVariable};
use rc_core::Grid;

use super::axes;
use super::channel::{Channel, Channels};
use super::field::{field, flip, transposed};
use super::unit;
use crate::{Format, FormatError, HeightMap, Unit};

/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: usize = 1032;

/// The value of NetCDF where nothing was written, as 32-bit and as 64-bit float.
///
/// Each integer type has a value of its own.
const NEVER_WRITTEN: f64 = 9.969209968386869e36;

/// Maximum depth of groups.
const DEEPEST: usize = 32;

/// Maximum number of groups in a file.
const MOST_GROUPS: usize = 1024;

/// Coordinates along an axis.
struct Coordinates {
    values: Vec<f64>,
    /// Name of the unit of the values.
    unit: String,
}

/// The map whose coordinates are searched.
struct Beside<'a> {
    path: &'a str,
    /// Names of the dimensions along x and y.
    dimensions: [&'a str; 2],
    grid: Grid,
    of_matlab: bool,
}

/// An open file.
struct Arrays {
    file: NcFile,
    format: Format,
    /// Number of bytes of the file.
    bytes: u64,
}

pub(super) fn channels(bytes: &[u8], format: Format) -> Channels<'_> {
    let arrays = Rc::new(open(bytes, format)?);
    let mut listed = Vec::new();
    list(arrays.root()?, "", &mut listed);
    let (names, units): (Vec<String>, Vec<Unit>) = listed.into_iter().unzip();
    let channel = |(name, is_height): (String, bool)| {
        let (arrays, path) = (arrays.clone(), name.clone());
        Channel { name, is_height, read: Box::new(move || arrays.map(&path)) }
    };
    Ok(names.into_iter().zip(unit::are_heights(&units)).map(channel).collect())
}

/// The rows of a table of four columns in an HDF5 file.
///
/// The table is the first array of n × 4 numbers, or the first group with four vectors of equal length and these names.
///
/// # Errors
/// [`FormatError::NoTable`] when there is no such table.
pub(crate) fn hdf5_table(bytes: &[u8], names: [&str; 4]) -> Result<Vec<[f64; 4]>, FormatError> {
    let arrays = open(bytes, Format::Hdf5)?;
    match table_in(arrays.root()?, "", names).ok_or(FormatError::NoTable { names: names.join(", ") })? {
        Table::Array(path) => Ok(arrays.values(&path)?.as_chunks::<4>().0.to_vec()),
        Table::Vectors(paths) => {
            let [a, b, c, d] = paths.map(|path| arrays.values(&path));
            let (a, b, c, d) = (a?, b?, c?, d?);
            Ok((0..a.len().min(b.len()).min(c.len()).min(d.len())).map(|i| [a[i], b[i], c[i], d[i]]).collect())
        }
    }
}

/// Place of a table of four columns.
enum Table {
    Array(String),
    Vectors([String; 4]),
}

fn table_in(group: &NcGroup, path: &str, names: [&str; 4]) -> Option<Table> {
    let numbers = || group.variables.iter().filter(|variable| is_number(variable.dtype()));
    let vector = |name: &str| {
        numbers().find(|variable| variable.name().eq_ignore_ascii_case(name) && variable.shape().len() == 1)
    };
    let path_of = |variable: &NcVariable| format!("{path}{}", variable.name());
    if let [Some(a), Some(b), Some(c), Some(d)] = names.map(vector)
        && [b, c, d].iter().all(|other| other.shape() == a.shape())
    {
        return Some(Table::Vectors([a, b, c, d].map(path_of)));
    }
    let array = numbers().find(|variable| matches!(variable.shape()[..], [_, 4]));
    let inner = || group.groups.iter().find_map(|inner| table_in(inner, &format!("{path}{}/", inner.name), names));
    array.map(|array| Table::Array(path_of(array))).or_else(inner)
}

/// Opens a file. Its values are not read yet.
fn open(bytes: &[u8], format: Format) -> Result<Arrays, FormatError> {
    let invalid = |cause: &netcdf_reader::Error| container(format, cause);
    let most = bytes.len().saturating_mul(MOST_INFLATION);
    let options = NcOpenOptions {
        metadata_mode: NcMetadataMode::Lossy,
        max_chunk_bytes: most,
        max_read_bytes: most,
        max_object_header_bytes: bytes.len().max(1 << 12),
        ..NcOpenOptions::default()
    };
    if format == Format::Hdf5 {
        check_groups(bytes, most)?;
    }
    let file = NcFile::from_bytes_with_options(bytes, options).map_err(|cause| invalid(&cause))?;
    Ok(Arrays { file, format, bytes: bytes.len() as u64 })
}

/// Refuses groups that contain themselves. netcdf-reader would follow them without an end.
fn check_groups(bytes: &[u8], most: usize) -> Result<(), FormatError> {
    let options = OpenOptions {
        max_chunk_bytes: most,
        max_read_bytes: most,
        max_object_header_bytes: bytes.len().max(1 << 12),
        ..OpenOptions::default()
    };
    let file = Hdf5File::from_bytes_with_options(bytes, options).and_then(|file| file.root_group());
    let mut left = MOST_GROUPS;
    file.map_err(netcdf_reader::Error::from)
        .and_then(|root| count(&root, DEEPEST, &mut left))
        .map_err(|cause| container(Format::Hdf5, &cause))
}

/// Subtracts the group and all groups in it from the number that is `left`.
fn count(group: &Group, depth: usize, left: &mut usize) -> Result<(), netcdf_reader::Error> {
    let refused = || {
        let message = format!("more than {MOST_GROUPS} groups, or some inside each other more than {DEEPEST} deep");
        netcdf_reader::Error::InvalidData(message)
    };
    *left = left.checked_sub(1).ok_or_else(refused)?;
    let depth = depth.checked_sub(1).ok_or_else(refused)?;
    group.groups()?.iter().try_for_each(|inner| count(inner, depth, left))
}

/// Paths and units of the maps in a group.
fn list(group: &NcGroup, path: &str, found: &mut Vec<(String, Unit)>) {
    for variable in group.variables.iter().filter(|variable| is_map(variable)) {
        found.push((format!("{path}{}", variable.name()), unit_of(variable).0));
    }
    for inner in &group.groups {
        list(inner, &format!("{path}{}/", inner.name), found);
    }
}

/// Whether a variable has numbers along two dimensions. Other dimensions must have length 1.
fn is_map(variable: &NcVariable) -> bool {
    let is_mesh = ["x", "y"].iter().any(|name| variable.name().eq_ignore_ascii_case(name));
    let is_text = class_of_matlab(variable).is_some_and(|class| class == "char");
    is_number(variable.dtype()) && !is_mesh && !is_text && variable.shape().iter().filter(|n| **n != 1).count() == 2
}

fn is_number(kind: &NcType) -> bool {
    use NcType::{Byte, Double, Float, Int, Int64, Short, UByte, UInt, UInt64, UShort};
    matches!(kind, Byte | Double | Float | Int | Int64 | Short | UByte | UInt | UInt64 | UShort)
}

/// The type of an array that MATLAB wrote.
fn class_of_matlab(variable: &NcVariable) -> Option<String> {
    let class = variable.attribute("MATLAB_class")?.value.as_string()?;
    Some(class.trim_end_matches('\0').to_owned())
}

/// The name of the unit of a variable, which may be empty.
fn unit_name(variable: &NcVariable) -> String {
    let attribute = ["units", "unit"].iter().find_map(|name| variable.attribute(name));
    let name = attribute.and_then(|attribute| attribute.value.as_string()).unwrap_or_default();
    name.trim_end_matches('\0').to_owned()
}

/// Unit of the values of a variable, and its factor.
fn unit_of(variable: &NcVariable) -> (Unit, f64) {
    unit::of_values(&unit_name(variable))
}

/// The value of NetCDF in a variable where nothing was written.
///
/// In HDF5 only floats have it, because unwritten integers are 0 there.
fn default_fill(variable: &NcVariable, format: Format) -> Option<f64> {
    if variable.attribute("_FillValue").is_some() {
        return None;
    }
    match variable.dtype() {
        NcType::Float | NcType::Double => Some(NEVER_WRITTEN),
        _ if format != Format::NetCdf => None,
        NcType::Short => Some(-32767.0),
        NcType::Int => Some(-2_147_483_647.0),
        NcType::UShort => Some(65535.0),
        NcType::UInt => Some(4_294_967_295.0),
        // All values of a byte are in use. Values of 64 bits cannot be distinguished as floats.
        _ => None,
    }
}

fn container(format: Format, cause: &netcdf_reader::Error) -> FormatError {
    // Messages are one short line.
    FormatError::Container { format, reason: super::fields::shown_as_line(&cause.to_string()) }
}

impl Arrays {
    fn root(&self) -> Result<&NcGroup, FormatError> {
        self.file.root_group().map_err(|cause| container(self.format, &cause))
    }

    fn map(&self, path: &str) -> Result<HeightMap, FormatError> {
        let variable = self.file.variable(path).map_err(|cause| container(self.format, &cause))?;
        let lengths: Vec<(usize, u64)> = variable.shape().into_iter().enumerate().filter(|(_, n)| *n != 1).collect();
        let &[(first, rows), (second, columns)] = lengths.as_slice() else {
            return Err(FormatError::Missing { format: self.format, field: "an array of two dimensions" });
        };
        let name =
            |dimension: usize| variable.dimensions().get(dimension).map_or("", |dimension| dimension.name.as_str());
        let of_matlab = class_of_matlab(variable).is_some();
        let x_is_first = of_matlab || name(first).eq_ignore_ascii_case("x") && name(second).eq_ignore_ascii_case("y");
        let [nx, ny] = if x_is_first { [rows, columns] } else { [columns, rows] };
        let side = |n: u64| usize::try_from(n).unwrap_or(usize::MAX);
        let grid = Grid::new(side(nx), side(ny))?;
        let size = variable.dtype().size().unwrap_or(8) as u64;
        let (needed, found) = (size * grid.len() as u64, self.bytes.saturating_mul(MOST_INFLATION as u64));
        if found < needed {
            return Err(FormatError::CutShort { grid, needed, found });
        }
        let stored = self.values(path)?;
        if stored.len() != grid.len() {
            return Err(FormatError::CutShort { grid, needed, found: size * stored.len() as u64 });
        }
        let mut values = if x_is_first { transposed(&stored, grid) } else { stored };
        let (height_unit, factor) = unit_of(variable);
        crate::map::scale(&mut values, factor);
        let dimensions = if x_is_first { [name(first), name(second)] } else { [name(second), name(first)] };
        let (mut sides, mut side_unit) = (None, Unit::Unnamed);
        if let Some([x, y]) = self.coordinates(&Beside { path, dimensions, grid, of_matlab })? {
            let steps = [axes::step("x", &x.values)?, axes::step("y", &y.values)?];
            flip(&mut values, grid, steps.map(|step| step < 0.0));
            let of_side = |field, axis: &Coordinates| unit::of_sides(self.format, field, &axis.unit);
            let (factors, unit) = unit::of_both([of_side("unit of x", &x)?, of_side("unit of y", &y)?]);
            let side = |axis: usize, n: usize| steps[axis].abs() * n as f64 * factors[axis];
            (sides, side_unit) = (Some([side(0, grid.nx()), side(1, grid.ny())]), unit);
        }
        Ok(HeightMap::new(field(grid, values), height_unit, sides, side_unit))
    }

    /// The values of a variable, unpacked. Values that are marked as missing are `NaN`.
    #[expect(clippy::float_cmp, reason = "the mark of a missing value is one value of the stored type")]
    fn values(&self, path: &str) -> Result<Vec<f64>, FormatError> {
        let array = self.file.read_variable_unpacked_masked(path).map_err(|cause| container(self.format, &cause))?;
        let mut values: Vec<f64> = array.iter().copied().collect();
        let variable = self.file.variable(path).map_err(|cause| container(self.format, &cause))?;
        let Some(fill) = default_fill(variable, self.format) else { return Ok(values) };
        if ["scale_factor", "add_offset"].iter().any(|name| variable.attribute(name).is_some()) {
            let stored = self.file.read_variable_as_f64(path).map_err(|cause| container(self.format, &cause))?;
            values
                .iter_mut()
                .zip(&stored)
                .filter(|(_, stored)| **stored == fill)
                .for_each(|(value, _)| *value = f64::NAN);
        } else {
            values.iter_mut().filter(|value| **value == fill).for_each(|value| *value = f64::NAN);
        }
        Ok(values)
    }

    /// Coordinates along x and y.
    ///
    /// They are the variables of the dimensions, or arrays called x and y in the same group.
    fn coordinates(&self, beside: &Beside<'_>) -> Result<Option<[Coordinates; 2]>, FormatError> {
        let Beside { path, dimensions, grid, of_matlab } = *beside;
        let group = path.rsplit_once('/').map_or(String::new(), |(group, _)| format!("{group}/"));
        let lengths = [grid.nx() as u64, grid.ny() as u64];
        let names = |axis: usize| [dimensions[axis], ["x", "y"][axis], ["X", "Y"][axis]];
        let find = |axis: usize, shapes: &[&[u64]]| {
            let paths = names(axis).into_iter().map(|name| format!("{group}{name}"));
            paths.into_iter().find_map(|path| {
                let variable = self.file.variable(&path).ok()?;
                let is_there = is_number(variable.dtype()) && shapes.contains(&variable.shape().as_slice());
                is_there.then(|| (path, unit_name(variable)))
            })
        };
        let vector = |axis: usize| {
            let n = lengths[axis];
            let shapes: [&[u64]; 3] = [&[n], &[1, n], &[n, 1]];
            find(axis, if of_matlab { &shapes } else { &shapes[..1] })
        };
        if let (Some((x, of_x)), Some((y, of_y))) = (vector(0), vector(1)) {
            let x = Coordinates { values: self.values(&x)?, unit: of_x };
            return Ok(Some([x, Coordinates { values: self.values(&y)?, unit: of_y }]));
        }
        let shape = if of_matlab { lengths } else { [lengths[1], lengths[0]] };
        let (Some((x, of_x)), Some((y, of_y))) = (find(0, &[&shape]), find(1, &[&shape])) else { return Ok(None) };
        let mesh = |path: &str| {
            let stored = self.values(path)?;
            Ok::<_, FormatError>(if of_matlab { transposed(&stored, grid) } else { stored })
        };
        let axes = axes::of_meshes(&mesh(&x)?, &mesh(&y)?, grid.nx());
        Ok(axes.map(|[x, y]| [Coordinates { values: x, unit: of_x }, Coordinates { values: y, unit: of_y }]))
    }
}
