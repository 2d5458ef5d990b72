//! MATLAB 5 files (The MathWorks, "MAT-File Format").
//!
//! The format has named arrays, stored column by column, each plain or compressed with zlib. Real 2-D arrays are
//! channels, and so are the frames of arrays with more dimensions. Their first index is y, the second x. Vectors or
//! meshes called `x` and `y`, or the like, are coordinates. Single numbers and texts may say the size and the units.
//!
//! Files of version 7.3 are HDF5. Readers on crates.io take memory for any size that a compressed array claims. This
//! reader does not.

use std::borrow::Cow;
use std::io::Read as _;

use flate2::read::ZlibDecoder;
use rc_core::Grid;

use super::binary::Number;
use super::endian::Endian;
use super::field::transposed;
use super::fields::{refused, shown_as_line};
use super::limit::{self, DEFAULT_MAX_BYTES};
use crate::{Format, FormatError};

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
pub(super) struct Array<'a> {
    pub(super) name: String,
    pub(super) rows: usize,
    pub(super) columns: usize,
    /// Number of arrays of rows x columns.
    pub(super) frames: usize,
    pub(super) class: Class,
    order: Endian,
    stored: Stored<'a>,
}

/// What the values of an array are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    Number,
    /// True or false, such as a mask.
    Logical,
    Text,
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
    let is_whole =
        |array: &&Array<'_>| array.rows > 0 && array.columns > 0 && array.frames == 1 && array.class != Class::Text;
    let read = |array: &Array<'_>| {
        let (_, values) = array.stored(0, DEFAULT_MAX_BYTES)?;
        Ok(MatArray { name: array.name.clone(), rows: array.rows, values })
    };
    found.iter().filter(is_whole).map(read).collect()
}

/// The elements of a file that are real arrays of numbers with two dimensions.
pub(super) fn arrays(file: &[u8]) -> Result<Vec<Array<'_>>, FormatError> {
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
        // Bit 11 marks complex numbers, and bit 9 truth values.
        let class = match flags & 0xff {
            _ if flags & 0x800 != 0 => return Ok(None),
            4 => Class::Text,
            6..=15 if flags & 0x200 != 0 => Class::Logical,
            6..=15 => Class::Number,
            _ => return Ok(None),
        };
        let size = |at: usize| usize::try_from(order.i32_at(sizes, 4 * at)).unwrap_or(0);
        let all: Vec<usize> = (0..sizes.len() / 4).map(size).collect();
        // Dimensions of length 1 are no dimensions, except in two.
        let long: Vec<usize> = all.iter().copied().filter(|n| *n != 1).collect();
        let (rows, columns, frames) = match (all.as_slice(), long.as_slice()) {
            ([rows, columns], _) | ([_, _, ..], [rows, columns]) | ([rows, columns, ..], []) => (*rows, *columns, 1),
            (_, [rows, columns, rest @ ..]) => {
                (*rows, *columns, rest.iter().fold(1, |n: usize, m| n.saturating_mul(*m)))
            }
            _ => return Ok(None),
        };
        let name = String::from_utf8_lossy(name).into_owned();
        Ok(Some(Self { name, rows, columns, frames, class, order, stored }))
    }

    /// The values of a frame, row by row.
    pub(super) fn values(&self, frame: usize, max_bytes: u64) -> Result<(Grid, Vec<f64>), FormatError> {
        let (grid, stored) = self.stored(frame, max_bytes)?;
        Ok((grid, transposed(&stored, grid)))
    }

    /// The values of a frame as they are stored, column by column, and the grid of rows.
    fn stored(&self, frame: usize, max_bytes: u64) -> Result<(Grid, Vec<f64>), FormatError> {
        let grid = Grid::new(self.columns, self.rows)?;
        let stored = self.numbers(frame, grid.len(), max_bytes)?;
        if stored.len() < grid.len() {
            return Err(FormatError::CutShort { grid, needed: grid.len() as u64, found: stored.len() as u64 });
        }
        Ok((grid, stored))
    }

    /// `n` values of a frame as they are stored, or fewer if they are not there.
    pub(super) fn numbers(&self, frame: usize, n: usize, max_bytes: u64) -> Result<Vec<f64>, FormatError> {
        // Values may be stored in smaller types than the class says, with at least one byte each.
        let needed = (n as u64).saturating_mul(frame as u64 + 1);
        if self.stored.most() < needed {
            return Ok(Vec::new());
        }
        // The values, those of the file, and their transpose.
        limit::check(needed.saturating_mul(8).saturating_add(16 * n as u64), max_bytes)?;
        let bytes = self.stored.bytes(START + 8 * needed)?;
        let mut elements = Elements { bytes: &bytes, order: self.order };
        let Some((kind, data)) = elements.three().and_then(|_| elements.next()) else { return Ok(Vec::new()) };
        let size = match number(kind) {
            Some(number) => number.size(),
            None if kind == 12 || kind == 13 => 8,
            None => return Err(refused(Format::Mat, "type of values", &kind, "that of real numbers")),
        };
        let data = data.get(frame * n * size..).and_then(|data| data.get(..n * size)).unwrap_or_default();
        Ok(match number(kind) {
            Some(number) => self.order.all(number, data),
            None => data.chunks_exact(size).map(|bytes| long_integer(bytes, kind == 12, self.order)).collect(),
        })
    }

    /// The text of an array of characters, of at most `START` bytes.
    pub(super) fn text(&self) -> Option<String> {
        let bytes = self.stored.bytes(START).ok().filter(|_| self.class == Class::Text)?;
        let mut elements = Elements { bytes: &bytes, order: self.order };
        let (kind, data) = elements.three().and_then(|_| elements.next())?;
        // Characters have 16 bits in older files, of which texts in Latin-1 use the lower eight.
        let units = data.chunks_exact(2).map(|unit| self.order.i16_at(unit, 0).cast_unsigned());
        Some(match kind {
            4 | 17 => char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect(),
            _ => String::from_utf8_lossy(data).into_owned(),
        })
    }

    /// Whether the array has a map.
    pub(super) fn is_map(&self) -> bool {
        self.class != Class::Text && self.rows > 1 && self.columns > 1
    }

    /// The number of values of a vector.
    pub(super) fn length(&self) -> Option<usize> {
        let is_vector = self.class == Class::Number && self.frames == 1 && self.rows.min(self.columns) == 1;
        is_vector.then(|| self.rows.max(self.columns))
    }
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

fn long_integer(bytes: &[u8], signed: bool, order: Endian) -> f64 {
    let value = order.i64_at(bytes, 0);
    if signed { value as f64 } else { value.cast_unsigned() as f64 }
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
