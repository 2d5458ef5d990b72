//! NumPy files: readers of two-dimensional real arrays, and writers of `f64` arrays.

use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

use npyz::{DType, Deserialize, NpyFile, NpyHeader, Order, TypeChar};
use rc_core::{Field, Grid};

mod write;

pub use self::write::{Precision, RowWriter, write};
use super::channel::{Channel, only};
use super::field::{field, transposed};
use super::fields::shown_as_line;
use super::layout::Layout;
use super::limit;
use super::params::ReadParams;
use super::points::{self, Kind};
use super::profile;
use super::records::{self, Record};
use crate::{Format, FormatError, HeightMap, ReadError, Unit};

/// Maximum length of a header that is read.
///
/// A 2-D array has a header of about 120 bytes. The parser of headers recurses once for each bracket.
const LONGEST_HEADER: u32 = 4096;

/// Reads a two-dimensional array of real numbers as a field.
///
/// Any float or integer type, byte order, and C or Fortran order are read. The first index is y, the second x. Values
/// may be `NaN` or infinite.
///
/// # Errors
/// [`ReadError`] when the file cannot be read, is not an npy file, is shorter than its header says, or is not 2-D and
/// real.
pub fn read(path: &Path) -> Result<Field, ReadError> {
    let field = || {
        let file = File::open(path).map_err(unreadable)?;
        let bytes = file.metadata().map_err(unreadable)?.len();
        read_from(BufReader::new(file), bytes)
    };
    field().map_err(|problem| ReadError { path: path.to_owned(), problem })
}

/// Reads the contents of a file of `bytes` bytes, as [`read()`].
///
/// # Errors
/// [`FormatError`] when the contents are not valid.
pub fn read_from(file: impl Read, bytes: u64) -> Result<Field, FormatError> {
    let npy = Array::open(file, bytes)?;
    let (order, grid) = (npy.header.order(), npy.grid()?);
    let stored = npy.values()?;
    Ok(field(grid, if order == Order::C { stored } else { transposed(&stored, grid) }))
}

/// The channel of a file, read when it is asked for.
pub(super) fn channels<'a>(bytes: &'a [u8], params: &'a ReadParams) -> Vec<Channel<'a>> {
    only(move || map(bytes, bytes.len() as u64, params, params.max_bytes))
}

/// Reads a map, or points on a regular grid, from a file of `bytes` bytes.
///
/// Points are the rows or columns of an array of three columns or rows, or records with fields x, y and z.
///
/// # Errors
/// [`FormatError`] when the contents are neither, or need more than `max_bytes` of memory.
pub(super) fn map(file: impl Read, bytes: u64, params: &ReadParams, max_bytes: u64) -> Result<HeightMap, FormatError> {
    let npy = Array::open(file, bytes)?;
    if let DType::Record(_) = npy.header.dtype() {
        return npy.points(max_bytes).map(of_array);
    }
    if params.is_profile {
        return npy.profile(max_bytes);
    }
    let shape = npy.sides()?;
    let (order, kind) = (npy.header.order(), Kind::of(Format::Npy, shape, params.layout_of(shape))?);
    if kind == Kind::Map {
        let grid = npy.grid()?;
        npy.count(real_type(&npy.header.dtype())?.1)?;
        // In Fortran order, the values are there twice.
        limit::check_map(grid, if order == Order::C { 0 } else { 8 }, 0, max_bytes)?;
        let stored = npy.values()?;
        return Ok(HeightMap::bare(field(grid, if order == Order::C { stored } else { transposed(&stored, grid) })));
    }
    points::check(shape[0].max(shape[1]), max_bytes)?;
    // The columns of an array in Fortran order follow one another as the rows of its transpose do.
    let kind = match (kind, order) {
        (kind, Order::C) => kind,
        (Kind::Rows, Order::Fortran) => Kind::Columns,
        (_, Order::Fortran) => Kind::Rows,
    };
    points::map(&npy.values()?, kind, shape).map(of_array)
}

/// Whether the header at the start of a file is that of points.
pub(super) fn has_points(start: &[u8], layout: Option<Layout>) -> bool {
    Array::open(start, u64::MAX).is_ok_and(|npy| match npy.header.dtype() {
        DType::Record(_) => true,
        _ => npy.sides().and_then(|shape| Kind::of(Format::Npy, shape, layout)).is_ok_and(|kind| kind != Kind::Map),
    })
}

/// Whether the header at the start of a file is that of a profile: one row, or one or two columns.
pub(super) fn has_profile(start: &[u8]) -> bool {
    Array::open(start, u64::MAX).is_ok_and(|npy| match *npy.header.shape() {
        [_] => true,
        [ny, nx] => ny.min(nx) == 1 || nx == 2 && ny > FEW,
        _ => false,
    })
}

/// The map whose numbers are those of an array, so metres by definition.
fn of_array(map: HeightMap) -> HeightMap {
    HeightMap { height_unit: Unit::Array, side_unit: Unit::Array, ..map }
}

/// Bytes for a point of a profile: its numbers, its place and its height.
const PROFILE_POINT: u64 = 16 + 16 + 8;

/// Rows above which two columns are not those of a map.
const FEW: u64 = 8;

/// An array whose header is read.
struct Array<R> {
    header: NpyHeader,
    file: R,
    /// Number of bytes of the file.
    bytes: u64,
}

impl<R: Read> Array<io::Chain<io::Cursor<Vec<u8>>, R>> {
    fn open(mut file: R, bytes: u64) -> Result<Self, FormatError> {
        let mut start = Vec::new();
        file.by_ref().take(12).read_to_end(&mut start).map_err(unreadable)?;
        if let [0x93, b'N', b'U', b'M', b'P', b'Y', version, _, a, b, more @ ..] = start.as_slice() {
            // Version 1 has two bytes for the length of the header. Later versions have four.
            let (c, d) = if *version > 1 { more.first_chunk().map_or((0, 0), |[c, d]| (*c, *d)) } else { (0, 0) };
            let length = u32::from_le_bytes([*a, *b, c, d]);
            if length > LONGEST_HEADER {
                return Err(header("length", &length, "the length of the header of a 2-D array, at most 4096"));
            }
        }
        let invalid = |cause: io::Error| FormatError::Container {
            format: Format::Npy,
            reason: shown_as_line(&cause.to_string()),
        };
        let mut file = io::Cursor::new(start).chain(file);
        Ok(Self { header: NpyHeader::from_reader(&mut file).map_err(invalid)?, file, bytes })
    }
}

impl<R: Read> Array<R> {
    /// Numbers of rows and columns.
    fn sides(&self) -> Result<[u64; 2], FormatError> {
        match *self.header.shape() {
            [ny, nx] => Ok([ny, nx]),
            [n] => Err(FormatError::profile_in_array(&n.to_string(), "")),
            ref shape => {
                let found = format!("{shape:?}, {} dimensions", shape.len());
                Err(header("shape", &found, "that of a 2-D array"))
            }
        }
    }

    fn grid(&self) -> Result<Grid, FormatError> {
        let [ny, nx] = self.sides()?.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        Ok(Grid::new(nx, ny)?)
    }

    /// Number of values of `size` bytes each.
    ///
    /// It is checked before memory is taken, because a damaged header may claim any size.
    fn count(&self, size: u64) -> Result<usize, FormatError> {
        let n = self.header.shape().iter().try_fold(1, |n: u64, side| n.checked_mul(*side));
        let needed = n.unwrap_or(u64::MAX).saturating_mul(size);
        if self.bytes < needed {
            return Err(self.cut_short(needed));
        }
        Ok(n.and_then(|n| usize::try_from(n).ok()).unwrap_or(usize::MAX))
    }

    fn cut_short(&self, needed: u64) -> FormatError {
        let found = self.bytes;
        self.grid().map_or_else(
            |_| {
                let reason = format!("its numbers need {needed} bytes, but the file has {found}; it is truncated");
                FormatError::Container { format: Format::Npy, reason }
            },
            |grid| FormatError::CutShort { grid, needed, found },
        )
    }

    fn failed(&self, cause: io::Error, needed: u64) -> FormatError {
        if cause.kind() == io::ErrorKind::UnexpectedEof { self.cut_short(needed) } else { unreadable(cause) }
    }

    /// The values in the order of the file.
    fn values(mut self) -> Result<Vec<f64>, FormatError> {
        let size = real_type(&self.header.dtype())?.1;
        let n = self.count(size)?;
        let read = match self.header.dtype() {
            DType::Plain(plain) if plain.to_string() == "<f8" => doubles(&mut self.file, n),
            _ => to_f64(NpyFile::with_header(self.header.clone(), &mut self.file), n),
        };
        let values = read.map_err(|cause| self.failed(cause, size * n as u64))?;
        if self.file.read(&mut [0]).map_err(unreadable)? > 0 {
            return Err(header("length", "longer than its array", "that of one array; the file is damaged"));
        }
        Ok(values)
    }

    /// The profile of an array of one row, or of one or two columns.
    fn profile(self, max_bytes: u64) -> Result<HeightMap, FormatError> {
        let shape = if let [n] = *self.header.shape() { [1, n] } else { self.sides()? };
        let n = self.count(real_type(&self.header.dtype())?.1)? as u64;
        limit::check(n.saturating_mul(PROFILE_POINT), max_bytes)?;
        let order = self.header.order();
        let values = self.values()?;
        if order == Order::Fortran && shape[0].min(shape[1]) > 1 {
            let grid = Grid::new(shape[1] as usize, shape[0] as usize)?;
            return profile::of_array(transposed(&values, grid), shape).map(of_array);
        }
        profile::of_array(values, shape).map(of_array)
    }

    /// The map of records.
    fn points(mut self, max_bytes: u64) -> Result<HeightMap, FormatError> {
        let DType::Record(fields) = self.header.dtype() else { return Err(records::refused("no records".into())) };
        let record = Record::of(&fields).map_err(records::refused)?;
        let n = self.count(record.size as u64)?;
        points::check(n as u64, max_bytes)?;
        let read = records::points(&record, &mut self.file, n);
        let points = read.map_err(|cause| self.failed(cause, record.size as u64 * n as u64))?;
        points::map_of(&points, [n as u64, 3])
    }
}

#[expect(clippy::needless_pass_by_value, reason = "the shape that map_err wants")]
fn unreadable(cause: io::Error) -> FormatError {
    FormatError::Unreadable(cause.to_string())
}

fn header(field: &'static str, found: &(impl ToString + ?Sized), expected: &'static str) -> FormatError {
    FormatError::Field { format: Format::Npy, field, found: found.to_string(), expected }
}

/// Kind and size in bytes of a real type.
fn real_type(dtype: &DType) -> Result<(TypeChar, u64), FormatError> {
    let DType::Plain(plain) = dtype else { return Err(records::refused("records".to_owned())) };
    match (plain.type_char(), plain.size_field()) {
        (TypeChar::Float, size @ (2 | 4 | 8)) => Ok((TypeChar::Float, size)),
        (kind @ (TypeChar::Int | TypeChar::Uint), size @ (1 | 2 | 4 | 8)) => Ok((kind, size)),
        _ => Err(records::refused(plain.to_string())),
    }
}

fn to_f64(npy: NpyFile<impl Read>, n: usize) -> io::Result<Vec<f64>> {
    match real_type(&npy.dtype()).map_err(io::Error::other)? {
        (TypeChar::Float, 2) => collect(npy, n, npyz::half::f16::to_f64),
        (TypeChar::Float, 4) => collect(npy, n, |v: f32| f64::from(v)),
        (TypeChar::Int, 1) => collect(npy, n, |v: i8| f64::from(v)),
        (TypeChar::Int, 2) => collect(npy, n, |v: i16| f64::from(v)),
        (TypeChar::Int, 4) => collect(npy, n, |v: i32| f64::from(v)),
        (TypeChar::Int, _) => collect(npy, n, |v: i64| v as f64),
        (TypeChar::Uint, 1) => collect(npy, n, |v: u8| f64::from(v)),
        (TypeChar::Uint, 2) => collect(npy, n, |v: u16| f64::from(v)),
        (TypeChar::Uint, 4) => collect(npy, n, |v: u32| f64::from(v)),
        (TypeChar::Uint, _) => collect(npy, n, |v: u64| v as f64),
        _ => collect(npy, n, |v: f64| v),
    }
}

/// The next `n` values of the usual type.
///
/// In a large map, reading them one by one would take as long as a solve.
fn doubles(mut file: impl Read, n: usize) -> io::Result<Vec<f64>> {
    let (mut values, mut bytes) = (vec![0.0; n], [[0; 8]; 1 << 11]);
    for values in values.chunks_mut(bytes.len()) {
        let bytes = &mut bytes[..values.len()];
        file.read_exact(bytes.as_flattened_mut())?;
        for (value, bytes) in values.iter_mut().zip(bytes) {
            *value = f64::from_le_bytes(*bytes);
        }
    }
    Ok(values)
}

/// The next `n` values. Memory for all of them is taken once.
fn collect<T: Deserialize>(npy: NpyFile<impl Read>, n: usize, to_f64: impl Fn(T) -> f64) -> io::Result<Vec<f64>> {
    let mut values = Vec::with_capacity(n);
    for value in npy.data::<T>().map_err(io::Error::other)?.take(n) {
        values.push(to_f64(value?));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use rc_core::DVec2;

    use super::*;

    fn write_raw(dir: &Path, dtype: &str, order: bool, data: &[u8]) -> std::path::PathBuf {
        let order = if order { "True" } else { "False" };
        let mut header = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': (2, 3), }}");
        let padding = 64 - (10 + header.len() + 1) % 64;
        header.push_str(&" ".repeat(padding));
        header.push('\n');
        let length = u16::try_from(header.len()).expect("short header");
        let bytes = [b"\x93NUMPY\x01\x00".as_slice(), &length.to_le_bytes(), header.as_bytes(), data].concat();
        let path = dir.join("array.npy");
        std::fs::write(&path, bytes).expect("a temporary file");
        path
    }

    #[test]
    fn every_real_type_and_byte_order_reads_as_the_same_field() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let values = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0];
        let f16 = |v: f64| npyz::half::f16::from_f64(v);
        let cases: Vec<(&str, Vec<u8>)> = vec![
            ("<f8", values.iter().flat_map(|v: &f64| v.to_le_bytes()).collect()),
            (">f8", values.iter().flat_map(|v: &f64| v.to_be_bytes()).collect()),
            ("<f4", values.iter().flat_map(|v| (*v as f32).to_le_bytes()).collect()),
            (">f4", values.iter().flat_map(|v| (*v as f32).to_be_bytes()).collect()),
            ("<f2", values.iter().flat_map(|v| f16(*v).to_le_bytes()).collect()),
            (">f2", values.iter().flat_map(|v| f16(*v).to_be_bytes()).collect()),
            ("|u1", values.iter().map(|v| *v as u8).collect()),
            (">i4", values.iter().flat_map(|v| (*v as i32).to_be_bytes()).collect()),
            ("<i8", values.iter().flat_map(|v| (*v as i64).to_le_bytes()).collect()),
        ];
        for (dtype, data) in cases {
            let field = read(&write_raw(dir.path(), dtype, false, &data)).expect(dtype);
            assert_eq!((field.grid().nx(), field.grid().ny()), (3, 2), "{dtype}");
            assert_eq!(field.values(), values, "{dtype}");
        }
    }

    #[test]
    fn fortran_order_is_transposed() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let columns = [0.0, 3.0, 1.0, 4.0, 2.0, 5.0_f64];
        let data: Vec<u8> = columns.iter().flat_map(|v| v.to_le_bytes()).collect();
        let field = read(&write_raw(dir.path(), "<f8", true, &data)).expect("a field");
        assert_eq!(field.values(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn what_is_not_real_or_cut_short_is_refused() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        for (dtype, bytes) in [("<c16", 96), ("|b1", 6), ("<U4", 96), ("<f8", 47), ("<f8", 49), ("<M8[s]", 48)] {
            let error = read(&write_raw(dir.path(), dtype, false, &vec![0; bytes])).expect_err(dtype);
            assert!(error.to_string().contains("array.npy: "), "{dtype}: {error}");
        }
    }

    #[test]
    fn a_file_of_rows_has_all_of_them_or_is_an_error() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let (path, grid) = (dir.path().join("rows.npy"), Grid::new(3, 2).expect("a grid"));
        let mut out = RowWriter::create(&path, grid, 2.0, Precision::Double).expect("a file");
        out.write(&[1.0, 2.0, 3.0]).expect("a row");
        out.write(&[4.0, 5.0, 6.0]).expect("a row");
        assert!(out.write(&[7.0]).is_err(), "a value too many");
        let mut out = RowWriter::create(&path, grid, 2.0, Precision::Double).expect("a file");
        out.write(&[1.0, 2.0, 3.0]).expect("a row");
        assert!(out.finish().is_err(), "a row too few");
    }

    #[test]
    fn a_field_reads_back_bit_for_bit() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("field.npy");
        let grid = Grid::new(3, 2).expect("a grid");
        let field = Field::from_fn(grid, |DVec2 { x, y }| (x - 0.3).exp() * y);
        write(&path, &field, 1.0).expect("a written file");
        assert_eq!(read(&path).expect("a field"), field);
    }
}
