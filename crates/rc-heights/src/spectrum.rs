//! Readers and writers of surfaces as Fourier coefficients.
//!
//! A surface is h(x) = Σ c exp(2πi (kx x/λ + ky y/λ)) with integer kx and ky, in waves per cell. A text has a line of
//! `kx ky Re(c) Im(c)` for each wave whose coefficient is not zero. An HDF5 file has arrays of these names, or one
//! array of four columns.
//!
//! Heights are real, so c of -k is the conjugate of c of k. A file may have either of them or both. The readers do not
//! check this. The code that makes a surface from the coefficients does.

use std::fs::File;
use std::io::{self, BufWriter, Read as _, Write as _};
use std::path::Path;

use crate::formats::{
    DEFAULT_MAX_BYTES, check_size, check_text, data_lines, decoded, hdf5_table, is_text, number, shown, words,
};
use crate::{FormatError, ReadError};

/// The first bytes of an HDF5 file.
const HDF5_MARK: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Largest integer up to which all integers are exact floating-point numbers.
///
/// Some programs write integers as floating-point numbers.
const LARGEST_EXACT: f64 = 9_007_199_254_740_992.0;

/// A wave as a file contains it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficient {
    /// Waves per cell along x.
    pub kx: i64,
    /// Waves per cell along y.
    pub ky: i64,
    /// Real part of c, in the unit of the file. It may be infinite or `NaN`.
    pub re: f64,
    /// Imaginary part of c, in the unit of the file.
    pub im: f64,
}

/// Reads the coefficients at `path`, in their order.
///
/// The first bytes determine the format, for any name.
///
/// # Errors
/// [`ReadError`] when the file cannot be read, or when a value is wrong. The error contains its line and value.
pub fn read(path: &Path) -> Result<Vec<Coefficient>, ReadError> {
    read_within(path, DEFAULT_MAX_BYTES)
}

/// Reads the coefficients at `path` with at most `max_bytes` of memory, as [`read`].
///
/// # Errors
/// Those of [`read`], and [`FormatError::TooLarge`].
pub fn read_within(path: &Path, max_bytes: u64) -> Result<Vec<Coefficient>, ReadError> {
    let fail = |problem: FormatError| ReadError { path: path.to_owned(), problem };
    let unreadable = |cause: io::Error| fail(FormatError::Unreadable(cause.to_string()));
    let mut file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(fail(FormatError::Unreadable("it is a folder, not a file of Fourier coefficients".into())));
    }
    check_size(metadata.len(), max_bytes).map_err(fail)?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    parse_within(&bytes, max_bytes).map_err(fail)
}

/// Reads coefficients from the bytes of a file.
///
/// # Errors
/// [`FormatError`] when the bytes are not valid.
pub fn parse(bytes: &[u8]) -> Result<Vec<Coefficient>, FormatError> {
    parse_within(bytes, DEFAULT_MAX_BYTES)
}

fn parse_within(bytes: &[u8], max_bytes: u64) -> Result<Vec<Coefficient>, FormatError> {
    if bytes.starts_with(HDF5_MARK) { parse_hdf5(bytes, max_bytes) } else { parse_text(bytes, max_bytes) }
}

/// Reads arrays kx, ky, Re and Im, or one array of these columns.
fn parse_hdf5(bytes: &[u8], max_bytes: u64) -> Result<Vec<Coefficient>, FormatError> {
    let rows = hdf5_table(bytes, ["kx", "ky", "Re", "Im"], max_bytes)?;
    let of_row = |(i, [kx, ky, re, im]): (usize, [f64; 4])| {
        Ok(Coefficient { kx: wave_number(i + 1, kx)?, ky: wave_number(i + 1, ky)?, re, im })
    };
    rows.into_iter().enumerate().map(of_row).collect()
}

/// Reads lines of kx, ky, Re, Im with commas, semicolons or blanks between them.
///
/// Empty lines and lines that start with `#` are ignored.
fn parse_text(bytes: &[u8], max_bytes: u64) -> Result<Vec<Coefficient>, FormatError> {
    if !is_text(bytes) {
        return Err(FormatError::ZeroBytes);
    }
    check_text(bytes, max_bytes)?;
    let waves: Vec<Coefficient> =
        data_lines(&decoded(bytes), 1).map(|(line, row)| coefficient(line, row)).collect::<Result<_, _>>()?;
    if waves.is_empty() {
        return Err(FormatError::NoNumbers { expected: "give a line kx ky Re Im for each wave" });
    }
    Ok(waves)
}

fn coefficient(line: usize, row: &str) -> Result<Coefficient, FormatError> {
    let (mut values, mut found) = ([0.0; 4], 0);
    let (words, comma) = words(row.trim());
    for word in words {
        if let Some(value) = values.get_mut(found) {
            let no_number = || FormatError::NoNumber { line, value: found + 1, text: shown(word) };
            *value = number(word, comma).ok_or_else(no_number)?;
        }
        found += 1;
    }
    if found != values.len() {
        let expected = "but a wave has four: kx, ky, Re and Im".to_owned();
        return Err(FormatError::Columns { line, found, expected });
    }
    let [kx, ky, re, im] = values;
    Ok(Coefficient { kx: wave_number(line, kx)?, ky: wave_number(line, ky)?, re, im })
}

fn wave_number(line: usize, value: f64) -> Result<i64, FormatError> {
    let is_whole = value.trunc().total_cmp(&value).is_eq() && value.abs() <= LARGEST_EXACT;
    if is_whole { Ok(value as i64) } else { Err(FormatError::WaveNumber { line, value }) }
}

/// Writes coefficients as text, which reads back exactly.
///
/// # Errors
/// Errors of the file system.
pub fn write(path: &Path, coefficients: &[Coefficient]) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    writeln!(
        out,
        "# h(x) = sum of (Re + i Im) exp(2 pi i (kx x + ky y) / side of the cell), kx and ky in waves per cell"
    )?;
    writeln!(out, "# kx ky Re Im")?;
    for Coefficient { kx, ky, re, im } in coefficients {
        writeln!(out, "{kx} {ky} {re:e} {im:e}")?;
    }
    out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(kx: i64, ky: i64, re: f64, im: f64) -> Coefficient {
        Coefficient { kx, ky, re, im }
    }

    #[test]
    fn every_separator_is_read_line_by_line() {
        let expected = [wave(1, -2, 0.5, -1e-7), wave(0, 3, 0.0, 2.0)];
        let texts = [
            "# qX, qY, Re, Im\n1, -2, 0.5, -1e-7\n0, 3, 0, 2\n",
            "1 -2 0.5 -1e-7\n\n0\t3\t0\t2",
            "\u{FEFF}1;-2;0,5;-1e-7\r\n0;3;0;2\r\n",
            // As numpy.savetxt writes an array.
            "1.000000000000000000e+00 -2.000000000000000000e+00 5e-01 -1e-07\n-0 3 0 2",
        ];
        for text in texts {
            assert_eq!(parse(text.as_bytes()), Ok(expected.to_vec()), "{text:?}");
        }
    }

    #[test]
    fn hdf5_has_arrays_of_these_names_or_four_columns() {
        let expected = [wave(1, -2, 0.5, -1e-7), wave(0, 3, 0.0, 2.0)];
        let file = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/formats").join(name);
        for name in ["h5py-waves.h5", "h5py-waves-columns.h5"] {
            assert_eq!(read(&file(name)), Ok(expected.to_vec()), "{name}");
            let bytes = std::fs::read(file(name)).expect("a file");
            for part in 1..64 {
                let cut = parse(&bytes[..bytes.len() * part / 64]);
                assert!(cut.is_err() || cut == Ok(expected.to_vec()), "{name}, {part}/64: {cut:?}");
            }
        }
        let error = read(&file("h5py-cycle.h5")).expect_err("no waves").to_string();
        assert!(error.contains("h5py-cycle.h5: ") && !error.contains('\n'), "{error}");
        let error = read(&file("h5py-contiguous.h5")).expect_err("no waves").to_string();
        assert!(error.contains("neither arrays kx, ky, Re, Im of one length in one group"), "{error}");
    }

    #[test]
    fn written_coefficients_read_back_exactly() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("waves.txt");
        let coefficients: Vec<_> =
            (-50..50).map(|k| wave(k, 3 - k, (k as f64).exp(), 1.0 / (3.0 + k as f64))).collect();
        write(&path, &coefficients).expect("a written file");
        let read = read(&path).expect("coefficients");
        for (read, written) in read.iter().zip(&coefficients) {
            assert_eq!([read.re, read.im].map(f64::to_bits), [written.re, written.im].map(f64::to_bits));
            assert_eq!((read.kx, read.ky), (written.kx, written.ky));
        }
        assert_eq!(read.len(), coefficients.len());
    }

    #[test]
    fn bad_lines_are_refused_with_their_place() {
        let cases: [(&[u8], &str); 10] = [
            (b"1 2 3\n", "line 1 has 3 values, but a wave has four: kx, ky, Re and Im"),
            (b"1 2 3 4\n1 2 3 4 5\n", "line 2 has 5 values"),
            (b"1 2 3 4\n# end\n1 2 x 4\n", "line 3, value 3: 'x'"),
            (b"1.5 2 3 4\n", "line 1: wave number 1.5 is not an integer"),
            (b"1 nan 3 4\n", "line 1: wave number NaN is not an integer"),
            (b"1 1e300 3 4\n", "line 1: wave number 1"),
            (b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', }\n", "not a text file"),
            (b"# no wave\n", "it has no numbers; give a line kx ky Re Im for each wave"),
            (b"1,2,,4\n", "line 1, value 3"),
            (b"\x89HDF\r\n\x1a\n\0\0", "not a valid HDF5 file"),
        ];
        for (bytes, expected) in cases {
            let error = parse(bytes).expect_err(expected).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{error}");
        }
        let folder = read(Path::new(".")).expect_err("a folder").to_string();
        assert!(folder.contains("it is a folder"), "{folder}");
    }
}
