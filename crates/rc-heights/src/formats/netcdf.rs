//! HDF5 and NetCDF (classic, 64-bit, NetCDF-4), read with the crate netcdf-reader.
//!
//! `scale_factor`, `add_offset`, `_FillValue`, `missing_value` and ranges of valid values are applied. Module
//! `netcdf_maps` says which arrays are maps.

use std::sync::Arc;

use hdf5_reader::group::Group;
use hdf5_reader::storage::BytesStorage;
use hdf5_reader::{Hdf5File, OpenOptions};
use netcdf_reader::{NcFile, NcGroup, NcMetadataMode, NcOpenOptions, NcSliceInfo, NcSliceInfoElem, NcType, NcVariable};

use rc_core::Grid;

use super::limit;
use crate::{Format, FormatError};

/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: usize = 1032;

/// The value of NetCDF where nothing was written, as 32-bit and as 64-bit float.
///
/// Each integer type has a value of its own.
const NEVER_WRITTEN: f64 = 9.969209968386869e36;

/// Maximum number of bytes of unpacked chunks that are kept.
const CHUNK_CACHE: usize = 64 << 20;

/// Maximum depth of groups.
const DEEPEST: usize = 32;

/// Maximum number of groups in a file.
const MOST_GROUPS: usize = 1024;

/// An open file.
pub(super) struct Arrays {
    pub(super) file: NcFile,
    pub(super) format: Format,
    /// Number of bytes of the file.
    bytes: u64,
    max_bytes: u64,
}

/// The rows of a table of four columns in an HDF5 file.
///
/// The table is the first array of n × 4 numbers, or the first group with four vectors of equal length and these names.
///
/// # Errors
/// [`FormatError::NoTable`] when there is no such table.
pub(crate) fn hdf5_table(bytes: &[u8], names: [&str; 4], max_bytes: u64) -> Result<Vec<[f64; 4]>, FormatError> {
    let arrays = open(bytes, Format::Hdf5, max_bytes)?;
    match table_in(arrays.root()?, "", names).ok_or(FormatError::NoTable { names: names.join(", ") })? {
        Table::Array(path) => Ok(arrays.values(&path, None)?.as_chunks::<4>().0.to_vec()),
        Table::Vectors(paths) => {
            let [a, b, c, d] = paths.map(|path| arrays.values(&path, None));
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
pub(super) fn open(bytes: &[u8], format: Format, max_bytes: u64) -> Result<Arrays, FormatError> {
    let length = bytes.len();
    // The file is there twice, since an open file owns its bytes.
    limit::check(2 * length as u64, max_bytes)?;
    let bytes: Arc<[u8]> = Arc::from(bytes);
    let most = length.saturating_mul(MOST_INFLATION).min(usize::try_from(max_bytes).unwrap_or(usize::MAX));
    let options = NcOpenOptions {
        metadata_mode: NcMetadataMode::Lossy,
        chunk_cache_bytes: most.min(CHUNK_CACHE),
        max_chunk_bytes: most,
        max_read_bytes: most,
        max_object_header_bytes: length.max(1 << 12),
        ..NcOpenOptions::default()
    };
    if format == Format::Hdf5 {
        check_groups(bytes.clone(), most)?;
    }
    let file = NcFile::from_owner(bytes, options).map_err(|cause| container(format, &cause))?;
    Ok(Arrays { file, format, bytes: length as u64, max_bytes })
}

/// Refuses groups that contain themselves. netcdf-reader would follow them without an end.
fn check_groups(bytes: Arc<[u8]>, most: usize) -> Result<(), FormatError> {
    let options = OpenOptions {
        max_chunk_bytes: most,
        max_read_bytes: most,
        max_object_header_bytes: bytes.len().max(1 << 12),
        ..OpenOptions::default()
    };
    let storage = Arc::new(BytesStorage::from_owner(bytes));
    let file = Hdf5File::from_storage_with_options(storage, options).and_then(|file| file.root_group());
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

/// Whether the values of a type are real numbers.
pub(super) fn is_number(kind: &NcType) -> bool {
    use NcType::{Byte, Double, Float, Int, Int64, Short, UByte, UInt, UInt64, UShort};
    matches!(kind, Byte | Double | Float | Int | Int64 | Short | UByte | UInt | UInt64 | UShort)
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

pub(super) fn container(format: Format, cause: &netcdf_reader::Error) -> FormatError {
    // Messages are one short line.
    FormatError::Container { format, reason: super::fields::shown_as_line(&cause.to_string()) }
}

impl Arrays {
    pub(super) fn root(&self) -> Result<&NcGroup, FormatError> {
        self.file.root_group().map_err(|cause| container(self.format, &cause))
    }

    pub(super) fn variable(&self, path: &str) -> Result<&NcVariable, FormatError> {
        self.file.variable(path).map_err(|cause| container(self.format, &cause))
    }

    /// Refuses `n` values of a variable if the file is too short for them, or if they need too much memory.
    fn check(&self, variable: &NcVariable, n: u64) -> Result<(), FormatError> {
        let size = variable.dtype().size().unwrap_or(8) as u64;
        let (needed, found) = (size.saturating_mul(n), self.bytes.saturating_mul(MOST_INFLATION as u64));
        if found < needed {
            let sides = variable.shape().into_iter().filter(|side| *side != 1).map(|side| side as usize);
            let (nx, ny) = match sides.collect::<Vec<_>>()[..] {
                [ny, nx] => (nx, ny),
                _ => (usize::try_from(n).unwrap_or(usize::MAX), 1),
            };
            return Err(FormatError::CutShort { grid: Grid::new(nx, ny)?, needed, found });
        }
        // As stored, as numbers, and as the map that is made of them.
        limit::check((size + 16).saturating_mul(n).saturating_add(2 * self.bytes), self.max_bytes)
    }

    /// The values of a variable or of a part of it, unpacked. Values that are marked as missing are `NaN`.
    #[expect(clippy::float_cmp, reason = "the mark of a missing value is one value of the stored type")]
    pub(super) fn values(&self, path: &str, part: Option<&NcSliceInfo>) -> Result<Vec<f64>, FormatError> {
        let invalid = |cause: netcdf_reader::Error| container(self.format, &cause);
        let variable = self.variable(path)?;
        self.check(variable, count_of(variable, part))?;
        let array = match part {
            None => self.file.read_variable_unpacked_masked(path),
            Some(part) => self.file.read_variable_slice_unpacked_masked(path, part),
        };
        let array = array.map_err(invalid)?;
        let is_row_by_row = array.is_standard_layout();
        let mut values =
            if is_row_by_row { array.into_raw_vec_and_offset().0 } else { array.iter().copied().collect() };
        let Some(fill) = default_fill(variable, self.format) else { return Ok(values) };
        if ["scale_factor", "add_offset"].iter().any(|name| variable.attribute(name).is_some()) {
            let stored = match part {
                None => self.file.read_variable_as_f64(path),
                Some(part) => self.file.read_variable_slice_as_f64(path, part),
            };
            let stored = stored.map_err(invalid)?;
            let pairs = values.iter_mut().zip(&stored);
            pairs.filter(|(_, stored)| **stored == fill).for_each(|(value, _)| *value = f64::NAN);
        } else {
            values.iter_mut().filter(|value| **value == fill).for_each(|value| *value = f64::NAN);
        }
        Ok(values)
    }
}

/// The number of values of a variable, or of the part with one index in each dimension that it selects.
fn count_of(variable: &NcVariable, part: Option<&NcSliceInfo>) -> u64 {
    let is_whole = |i: usize| {
        let selected = part.and_then(|part| part.selections.get(i));
        !matches!(selected, Some(NcSliceInfoElem::Index(_)))
    };
    let sides = variable.shape().into_iter().enumerate().filter(|(i, _)| is_whole(*i));
    sides.fold(1, |n: u64, (_, side)| n.saturating_mul(side))
}
