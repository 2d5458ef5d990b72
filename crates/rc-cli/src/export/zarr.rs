//! Writer of Zarr groups.
//!
//! A group has a folder for each array, a file for each compressed chunk, and descriptions as JSON.
//!
//! Format: *Zarr storage specification version 2*, <https://zarr-specs.readthedocs.io/en/latest/v2/v2.0.html>, which
//! every reader knows. The names of dimensions are in `_ARRAY_DIMENSIONS`, as xarray expects. The code is written by
//! hand, since it is short. The crate `zarrs` (0.23, default features off) would add more than 70 packages and need a
//! newer compiler than ours.

use std::borrow::Cow;
use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::error::CliError;
use rc_sweep::files::write_synced;

/// Maximum number of values of a chunk along each dimension.
///
/// A chunk has at most 8 MiB of `f64`. So there are few files, and still each fits anywhere.
const CHUNK: usize = 1024;

/// Name of the file that marks a group.
const GROUP_FILE: &str = ".zgroup";

/// Level of compression.
///
/// Higher levels take three times as long for 1 % of the size, since digits of fields are noise.
const LEVEL: u32 = 1;

/// Arrays with common attributes.
pub(super) struct Group<'a> {
    pub(super) attributes: Value,
    pub(super) arrays: Vec<Array<'a>>,
}

/// An array of one or two dimensions, row-major.
pub(super) struct Array<'a> {
    pub(super) name: &'static str,
    pub(super) dimensions: &'static [&'static str],
    pub(super) shape: Vec<usize>,
    pub(super) units: &'static str,
    pub(super) meaning: &'static str,
    pub(super) values: Values<'a>,
}

/// The values of an array.
pub(super) enum Values<'a> {
    Float64(Cow<'a, [f64]>),
    UInt8(Vec<u8>),
}

/// Refuses a folder at `path` that is not a group, since writing would remove it.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn check_place(path: &Path) -> Result<(), CliError> {
    if path.is_dir() && !path.join(GROUP_FILE).is_file() {
        return Err(CliError::in_file(
            path,
            "this folder exists and is not a Zarr group; move it, or choose another --out",
        ));
    }
    Ok(())
}

/// Makes the folder `path` and writes a group into it.
///
/// # Errors
/// Those of the file system.
pub(super) fn write(path: &Path, group: &Group<'_>) -> io::Result<()> {
    let arrays = group.arrays.iter().map(|array| (array.name, array.description(), array.attributes()));
    write_metadata(path, &group.attributes, arrays)?;
    group.arrays.iter().try_for_each(|array| array.write_chunks(&path.join(array.name)))
}

/// Makes the folders of a group and of its arrays, with their metadata.
///
/// Each array is given by its name, description and attributes. The chunks are written later.
///
/// # Errors
/// Those of the file system.
pub(crate) fn write_metadata<'a>(
    path: &Path,
    attributes: &Value,
    arrays: impl Iterator<Item = (&'a str, Value, Value)>,
) -> io::Result<()> {
    fs::create_dir(path)?;
    // One more file has all metadata, so that readers need not search for arrays. Over a network they could not.
    let mut all = serde_json::Map::new();
    let mut describe = |name: String, value: Value| {
        write_synced(&path.join(&name), format!("{value:#}\n").as_bytes())?;
        all.insert(name, value);
        Ok::<_, io::Error>(())
    };
    describe(GROUP_FILE.to_owned(), json!({ "zarr_format": 2 }))?;
    describe(".zattrs".to_owned(), attributes.clone())?;
    for (name, description, attributes) in arrays {
        fs::create_dir(path.join(name))?;
        describe(format!("{name}/.zarray"), description)?;
        describe(format!("{name}/.zattrs"), attributes)?;
    }
    let consolidated = json!({ "zarr_consolidated_format": 1, "metadata": all });
    write_synced(&path.join(".zmetadata"), format!("{consolidated:#}\n").as_bytes())
}

/// The description of an array from its type, shape and shape of chunks.
pub(crate) fn description(kind: &str, shape: &[usize], chunks: &[usize]) -> Value {
    json!({
        "zarr_format": 2,
        "shape": shape,
        "chunks": chunks,
        "dtype": kind,
        "compressor": { "id": "zlib", "level": LEVEL },
        // No value stands for a missing one. Otherwise xarray would read zero pressure as missing.
        "fill_value": null,
        "order": "C",
        "filters": null,
    })
}

/// The attributes of an array with these dimensions.
pub(crate) fn attributes(dimensions: &[&str], units: &str, meaning: &str) -> Value {
    json!({ "_ARRAY_DIMENSIONS": dimensions, "units": units, "long_name": meaning })
}

/// Writes the bytes of a chunk.
///
/// # Errors
/// Those of the file system.
pub(crate) fn write_chunk(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut chunk = ZlibEncoder::new(Vec::new(), Compression::new(LEVEL));
    chunk.write_all(bytes)?;
    write_synced(path, &chunk.finish()?)
}

impl Array<'_> {
    fn description(&self) -> Value {
        let kind = match self.values {
            Values::Float64(_) => "<f8",
            Values::UInt8(_) => "|u1",
        };
        description(kind, &self.shape, &self.chunk_shape())
    }

    fn attributes(&self) -> Value {
        attributes(self.dimensions, self.units, self.meaning)
    }

    fn chunk_shape(&self) -> Vec<usize> {
        self.shape.iter().map(|&n| n.min(CHUNK)).collect()
    }

    /// Writes all chunks. The name of a chunk is its place.
    fn write_chunks(&self, folder: &Path) -> io::Result<()> {
        let [ny, nx] = rows_and_columns(&self.shape);
        let [height, width] = rows_and_columns(&self.chunk_shape());
        let (down, across) = (ny.div_ceil(height), nx.div_ceil(width));
        (0..down * across).into_par_iter().try_for_each(|i| {
            let (row, column) = (i / across, i % across);
            let name = if self.shape.len() == 1 { column.to_string() } else { format!("{row}.{column}") };
            write_chunk(&folder.join(name), &self.chunk([row * height, column * width], [height, width]))
        })
    }

    /// The bytes of the chunk that begins at this row and column.
    ///
    /// All chunks have the same size, so values beyond the array are zero.
    fn chunk(&self, [first_row, first_column]: [usize; 2], [height, width]: [usize; 2]) -> Vec<u8> {
        let [ny, nx] = rows_and_columns(&self.shape);
        let size = match self.values {
            Values::Float64(_) => 8,
            Values::UInt8(_) => 1,
        };
        let mut bytes = Vec::with_capacity(height * width * size);
        for row in first_row..(first_row + height).min(ny) {
            let values = row * nx + first_column..row * nx + (first_column + width).min(nx);
            let end = bytes.len() + width * size;
            match &self.values {
                Values::Float64(all) => bytes.extend(all[values].iter().flat_map(|value| value.to_le_bytes())),
                Values::UInt8(all) => bytes.extend_from_slice(&all[values]),
            }
            bytes.resize(end, 0);
        }
        bytes.resize(height * width * size, 0);
        bytes
    }
}

/// Numbers of rows and columns. A list is one row.
fn rows_and_columns(shape: &[usize]) -> [usize; 2] {
    match *shape {
        [n] => [1, n],
        [ny, nx] => [ny, nx],
        _ => unreachable!("arrays here have one or two dimensions"),
    }
}
