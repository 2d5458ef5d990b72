//! MATLAB 5 files (The MathWorks, "MAT-File Format").
//!
//! The format has named arrays, stored column by column, each plain or compressed with zlib. Real 2-D arrays are
//! channels. Their first index is y, the second x. Vectors or meshes called `x` and `y` are coordinates.
//!
//! Files of version 7.3 are HDF5. Readers on crates.io take memory for any size that a compressed array claims. This
//! reader does not.

use std::borrow::Cow;
use std::io::Read as _;
use std::rc::Rc;

use flate2::read::ZlibDecoder;
use rc_core::Grid;

use super::axes;
use super::binary::Number;
use super::channel::{Channel, Channels};
use super::endian::Endian;
use super::field::{field, flip, transposed};
use super::fields::{refused, shown_as_line};
use crate::{Format, FormatError, HeightMap, Unit};

/// The first bytes.
pub(super) const MARK: &[u8] = b"MATLAB 5.0 MAT-file";
/// Length of the header.
const HEADER: usize = 128;
/// Type of an array.
const MATRIX: u32 = 14;
/// Type of an element that is compressed with zlib.
const COMPRESSED: u32 = 15;
/// Number of bytes that are decompressed at once. An array without its values is shorter.
const START: u64 = 512;
/// Maximum number of bytes that deflate makes of one byte. Claims beyond that are false.
const MOST_INFLATION: u64 = 1032;

/// An array in the file, which is decompressed when it is read.
struct Array<'a> {
    name: String,
    rows: usize,
    columns: usize,
    order: Endian,
    stored: Stored<'a>,
}

#[derive(Clone, Copy)]
enum Stored<'a> {
    Plain(&'a [u8]),
    Deflated(&'a [u8]),
}

/// An array of a MATLAB 5 file.
#[derive(Clone, Debug, PartialEq)]
pub struct MatArray {
    /// Name of the array.
    pub name: String,
    /// Number of rows, at least 1.
    pub rows: usize,
    /// Values, column by column.
    pub values: Vec<f64>,
}

impl MatArray {
    /// The columns.
    pub fn columns(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks(self.rows)
    }
}

/// All real arrays of numbers with two dimensions in a MATLAB 5 file.
///
/// Vectors are included. Arrays without a value are omitted.
///
/// # Errors
/// [`FormatError`] when the file is not valid.
pub fn mat_arrays(bytes: &[u8]) -> Result<Vec<MatArray>, FormatError> {
    let found = arrays(bytes)?;
    let whole = found.iter().filter(|array| array.rows > 0 && array.columns > 0);
    whole.map(|array| Ok(MatArray { name: array.name.clone(), rows: array.rows, values: array.stored()?.1 })).collect()
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let arrays = Rc::new(arrays(bytes)?);
    let is_map = |array: &Array<'_>| array.rows > 1 && array.columns > 1 && array.coordinate().is_none();
    let maps = (0..arrays.len()).filter(|i| is_map(&arrays[*i]));
    let channel = |i: usize| {
        let arrays = arrays.clone();
        Channel { name: arrays[i].name.clone(), is_height: true, read: Box::new(move || map(&arrays, i)) }
    };
    Ok(maps.map(channel).collect())
}

/// The elements of a file that are real arrays of numbers with two dimensions.
fn arrays(file: &[u8]) -> Result<Vec<Array<'_>>, FormatError> {
    let order = match file.get(126..HEADER) {
        Some(b"IM") => Endian::Little,
        Some(b"MI") => Endian::Big,
        Some(_) => return Err(refused(Format::Mat, "byte order", "another mark", "IM or MI")),
        None => return Err(FormatError::HeaderCutShort { format: Format::Mat }),
    };
    let (mut bytes, mut arrays) = (&file[HEADER..], Vec::new());
    while !bytes.is_empty() {
        if bytes.len() < 8 {
            let reason = format!("it ends after {} of the 8 bytes before an array", bytes.len());
            return Err(FormatError::Container { format: Format::Mat, reason });
        }
        let (kind, size) = (order.u32_at(bytes, 0), order.u32_at(bytes, 4) as usize);
        let content = bytes.get(8..).and_then(|rest| rest.get(..size));
        let Some(content) = content else {
            let reason = format!("an element of {size} bytes, of which {} are there", bytes.len() - 8);
            return Err(FormatError::Container { format: Format::Mat, reason });
        };
        let stored = match kind {
            MATRIX => Some(Stored::Plain(content)),
            COMPRESSED => Some(Stored::Deflated(content)),
            _ => None,
        };
        if let Some(stored) = stored {
            arrays.extend(Array::of(stored, order)?);
        }
        // Elements begin at multiples of eight bytes, except after compressed ones.
        let padded = if kind == COMPRESSED { size } else { size.next_multiple_of(8) };
        bytes = bytes.get(8 + padded..).unwrap_or_default();
    }
    Ok(arrays)
}

impl Stored<'_> {
    /// At most the first `most` bytes of the array.
    fn bytes(&self, most: u64) -> Result<Cow<'_, [u8]>, FormatError> {
        let stored = match self {
            Self::Plain(bytes) => {
                return Ok(Cow::Borrowed(&bytes[..bytes.len().min(usize::try_from(most).unwrap_or(usize::MAX))]));
            }
            Self::Deflated(stored) => stored,
        };
        let mut bytes = Vec::new();
        let read = ZlibDecoder::new(*stored).take(most.saturating_add(8)).read_to_end(&mut bytes);
        read.map_err(|cause| FormatError::Container {
            format: Format::Mat,
            reason: shown_as_line(&cause.to_string()),
        })?;
        // The tag of the array comes first.
        bytes.drain(..bytes.len().min(8));
        Ok(Cow::Owned(bytes))
    }

    /// Maximum number of bytes that the array can have.
    fn most(&self) -> u64 {
        match self {
            Self::Plain(bytes) => bytes.len() as u64,
            Self::Deflated(bytes) => (bytes.len() as u64).saturating_mul(MOST_INFLATION),
        }
    }
}

impl<'a> Array<'a> {
    /// Reads flags, dimensions and name. `None` if this is not a real 2-D array of numbers.
    fn of(stored: Stored<'a>, order: Endian) -> Result<Option<Self>, FormatError> {
        let start = stored.bytes(START)?;
        let mut elements = Elements { bytes: &start, order };
        let Some([(_, flags), (_, sizes), (_, name)]) = elements.three() else { return Ok(None) };
        let flags = order.u32_at(flags, 0);
        // Classes 6 to 15 are numbers. Bit 11 marks complex numbers.
        let is_real = (6..=15).contains(&(flags & 0xff)) && flags & 0x800 == 0;
        if !is_real || sizes.len() != 8 {
            return Ok(None);
        }
        let size = |at| usize::try_from(order.i32_at(sizes, at)).unwrap_or(0);
        let (rows, columns, name) = (size(0), size(4), String::from_utf8_lossy(name).into_owned());
        Ok(Some(Self { name, rows, columns, order, stored }))
    }

    /// The values, row by row.
    fn values(&self) -> Result<(Grid, Vec<f64>), FormatError> {
        let (grid, stored) = self.stored()?;
        Ok((grid, transposed(&stored, grid)))
    }

    /// The values as they are stored, column by column, and the grid of rows.
    fn stored(&self) -> Result<(Grid, Vec<f64>), FormatError> {
        let grid = Grid::new(self.columns, self.rows)?;
        // Values may be stored in smaller types than the class says, with at least one byte each.
        let (needed, found) = (grid.len() as u64, self.stored.most());
        if found < needed {
            return Err(FormatError::CutShort { grid, needed, found });
        }
        let bytes = self.stored.bytes(START + 8 * needed)?;
        let mut elements = Elements { bytes: &bytes, order: self.order };
        let parts = elements.three().and_then(|_| elements.next());
        let Some((kind, data)) = parts else {
            return Err(FormatError::CutShort { grid, needed, found: bytes.len() as u64 });
        };
        let stored = match number(kind) {
            Some(number) => self.order.values(number, data, grid)?,
            None if kind == 12 || kind == 13 => long_integers(data, kind == 12, self.order, grid)?,
            None => return Err(refused(Format::Mat, "type of values", &kind, "that of real numbers")),
        };
        Ok((grid, stored))
    }

    /// The axis whose coordinates are in the array, by its name.
    fn coordinate(&self) -> Option<usize> {
        ["x", "y"].iter().position(|name| self.name.eq_ignore_ascii_case(name))
    }
}

/// Array `i` as a map, with sides if there are coordinates.
fn map(arrays: &[Array<'_>], i: usize) -> Result<HeightMap, FormatError> {
    let (grid, mut values) = arrays[i].values()?;
    let mut sides = None;
    if let Some([x, y]) = coordinates(arrays, i)? {
        let steps = [axes::step("x", &x)?, axes::step("y", &y)?];
        flip(&mut values, grid, steps.map(|step| step < 0.0));
        sides = Some([steps[0].abs() * grid.nx() as f64, steps[1].abs() * grid.ny() as f64]);
    }
    Ok(HeightMap::new(field(grid, values), Unit::Unnamed, sides, Unit::Unnamed))
}

/// Coordinates of array `i` along x and y.
///
/// `None` unless there are arrays with these names and of the right lengths.
fn coordinates(arrays: &[Array<'_>], i: usize) -> Result<Option<[Vec<f64>; 2]>, FormatError> {
    let of = |axis| arrays.iter().enumerate().find(|(j, array)| *j != i && array.coordinate() == Some(axis));
    let (map, Some((_, x)), Some((_, y))) = (&arrays[i], of(0), of(1)) else { return Ok(None) };
    let is_vector = |array: &Array<'_>, n| array.rows.min(array.columns) == 1 && array.rows.max(array.columns) == n;
    let is_mesh = |array: &Array<'_>| (array.rows, array.columns) == (map.rows, map.columns);
    if is_vector(x, map.columns) && is_vector(y, map.rows) {
        return Ok(Some([x.values()?.1, y.values()?.1]));
    }
    if is_mesh(x) && is_mesh(y) {
        return Ok(axes::of_meshes(&x.values()?.1, &y.values()?.1, map.columns));
    }
    Ok(None)
}

/// The elements of an array.
struct Elements<'a> {
    bytes: &'a [u8],
    order: Endian,
}

impl<'a> Elements<'a> {
    /// Type and content of the next element, up to the end of the file.
    fn next(&mut self) -> Option<(u32, &'a [u8])> {
        let tag = self.bytes.get(..8).map(|_| self.order.u32_at(self.bytes, 0))?;
        // A small element has its length in the upper half of the type, and its content in the tag.
        let (kind, at, size) = match tag >> 16 {
            0 => (tag, 8, self.order.u32_at(self.bytes, 4) as usize),
            size => (tag & 0xffff, 4, (size as usize).min(4)),
        };
        let rest = &self.bytes[at..];
        let content = &rest[..size.min(rest.len())];
        let whole = if at == 8 { size.next_multiple_of(8) } else { 4 };
        self.bytes = rest.get(whole..).unwrap_or_default();
        Some((kind, content))
    }

    fn three(&mut self) -> Option<[(u32, &'a [u8]); 3]> {
        Some([self.next()?, self.next()?, self.next()?])
    }
}

fn number(kind: u32) -> Option<Number> {
    Some(match kind {
        1 => Number::I8,
        2 => Number::U8,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::I32,
        6 => Number::U32,
        7 => Number::F32,
        9 => Number::F64,
        _ => return None,
    })
}

fn long_integers(data: &[u8], signed: bool, order: Endian, grid: Grid) -> Result<Vec<f64>, FormatError> {
    let (needed, found) = (8 * grid.len() as u64, data.len() as u64);
    if found < needed {
        return Err(FormatError::CutShort { grid, needed, found });
    }
    let value = |at| if signed { order.i64_at(data, at) as f64 } else { order.i64_at(data, at).cast_unsigned() as f64 };
    Ok((0..grid.len()).map(|i| value(8 * i)).collect())
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use flate2::Compression;
    use flate2::write::ZlibEncoder;

    use super::*;

    fn tagged(kind: u32, data: &[u8]) -> Vec<u8> {
        let mut bytes = [kind.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    }

    /// A file with compressed arrays of doubles.
    fn file(arrays: &[(&str, usize, &[f64])]) -> Vec<u8> {
        let mut bytes = vec![b' '; 124];
        bytes.extend(b"\0\x01IM");
        for (name, rows, values) in arrays {
            let dimensions: Vec<u8> =
                [*rows as i32, (values.len() / rows) as i32].iter().flat_map(|n| n.to_le_bytes()).collect();
            let values: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            let parts = [
                tagged(6, &[6, 0, 0, 0, 0, 0, 0, 0]),
                tagged(5, &dimensions),
                tagged(1, name.as_bytes()),
                tagged(9, &values),
            ];
            let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(&tagged(MATRIX, &parts.concat())).expect("memory");
            let packed = encoder.finish().expect("memory");
            bytes.extend([COMPRESSED.to_le_bytes(), (packed.len() as u32).to_le_bytes()].concat());
            bytes.extend(packed);
        }
        bytes
    }

    #[test]
    fn arrays_are_read_by_name() {
        let bytes = file(&[("p_bar", 2, &[1.0, 2.5]), ("table", 2, &[1.0, 2.0, 3.0, 4.0])]);
        let [p_bar, table] = mat_arrays(&bytes).expect("a file").try_into().expect("two arrays");
        assert_eq!((p_bar.name.as_str(), table.name.as_str()), ("p_bar", "table"));
        assert_eq!(p_bar.values, [1.0, 2.5]);
        assert_eq!(table.columns().collect::<Vec<_>>(), [&[1.0, 2.0], &[3.0, 4.0]]);
    }

    #[test]
    fn small_elements_stand_in_their_tag() {
        let mut parts = tagged(6, &[6, 0, 0, 0, 0, 0, 0, 0]);
        parts.extend(tagged(5, &[3, 0, 0, 0, 1, 0, 0, 0]));
        parts.extend([1, 0, 1, 0, b'x', 0, 0, 0]);
        parts.extend([2, 0, 3, 0, 7, 8, 9, 0]);
        let bytes = [vec![0; 126], b"IM".to_vec(), tagged(MATRIX, &parts)].concat();
        let expected = MatArray { name: "x".into(), rows: 3, values: vec![7.0, 8.0, 9.0] };
        assert_eq!(mat_arrays(&bytes), Ok(vec![expected]));
    }

    #[test]
    fn what_is_cut_off_is_an_error() {
        let whole = file(&[("p_bar", 2, &[1.0, 2.5])]);
        for length in (0..whole.len()).filter(|length| *length != HEADER) {
            assert!(mat_arrays(&whole[..length]).is_err(), "{length} of {} bytes", whole.len());
        }
    }
}
