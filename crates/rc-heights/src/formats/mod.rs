//! The formats, and how a file is known.

mod binary;
mod channel;
mod field;
mod fields;
mod format;
mod gsf;
pub mod npy;
mod png;
mod sdf;
mod surfer;
pub mod text;
mod tiff;
mod x3p;
mod xyz;

use std::fs::File;
use std::io::{Cursor, Read as _};
use std::path::Path;

pub use format::Format;

use crate::{FormatError, HeightMap, ReadError};

/// Bytes at the start of a file that say what it is.
const MARKS: [(&[u8], Format); 17] = [
    (b"\x93NUMPY", Format::Npy),
    (b"DSAA", Format::Surfer),
    (b"DSBB", Format::Surfer),
    (b"DSRB", Format::Surfer),
    (gsf::MARK, Format::Gsf),
    (b"aISO-1.0", Format::Sdf),
    (b"bISO-1.0", Format::Sdf),
    (b"aISO-2.0", Format::Sdf),
    (b"bISO-2.0", Format::Sdf),
    (b"aBCR-1.0", Format::Sdf),
    (b"bBCR-1.0", Format::Sdf),
    // What Gwyddion makes of the same.
    (b"aBCR-0.0", Format::Sdf),
    (b"bBCR-0.0", Format::Sdf),
    (b"PK\x03\x04", Format::X3p),
    (b"\x89PNG\r\n\x1a\n", Format::Png),
    (b"II*\0", Format::Tiff),
    (b"MM\0*", Format::Tiff),
];

impl Format {
    /// Whether files of this format say how large the measured rectangle is, or may say it.
    #[must_use]
    pub fn has_sides(self) -> bool {
        matches!(self, Self::Xyz | Self::Surfer | Self::Gsf | Self::Sdf | Self::X3p)
    }

    /// The format of a file that is called `path` and starts with `start`, of which 25 bytes are enough where there
    /// is a mark. The
    /// first bytes count more than the name.
    ///
    /// # Errors
    /// [`FormatError::Mark`] for a name that promises another start, [`FormatError::Unknown`].
    pub fn of(path: &Path, start: &[u8]) -> Result<Self, FormatError> {
        if let Some((_, format)) = MARKS.iter().find(|(mark, _)| start.starts_with(mark)) {
            return Ok(*format);
        }
        let mark = |format, expected| Err(FormatError::Mark { format, expected });
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("xyz") => Ok(Self::Xyz),
            // Three numbers a line are points; no map has only three columns.
            Some("csv" | "txt") => Ok(if xyz::looks_like_points(start) { Self::Xyz } else { Self::Csv }),
            Some("npy") => mark(Self::Npy, "it must begin with \\x93NUMPY; numpy.save writes such files"),
            Some("grd") => mark(Self::Surfer, "it must begin with DSAA, DSBB or DSRB"),
            Some("gsf") => mark(Self::Gsf, "it must begin with the line 'Gwyddion Simple Field 1.0'"),
            Some("sdf") => mark(Self::Sdf, "it must begin with aISO-1.0 or bISO-1.0"),
            Some("x3p") => mark(Self::X3p, "it must be a zip archive"),
            Some("png") => mark(Self::Png, "it must begin with \\x89PNG"),
            Some("tif" | "tiff") => mark(Self::Tiff, "it must begin with II* or MM*; BigTIFF is not read"),
            _ => Err(FormatError::Unknown),
        }
    }
}

/// The format of the file at `path`.
///
/// # Errors
/// As of [`read`], as far as the first bytes tell.
pub fn format_of(path: &Path) -> Result<Format, ReadError> {
    opened(path).map(|(format, ..)| format)
}

/// The file at `path`, its format, and its first bytes.
fn opened(path: &Path) -> Result<(Format, File, Vec<u8>), ReadError> {
    let fail = |problem: FormatError| ReadError { path: path.to_owned(), problem };
    let unreadable = |cause: std::io::Error| fail(FormatError::Unreadable(cause.to_string()));
    let mut file = File::open(path).map_err(unreadable)?;
    if file.metadata().map_err(unreadable)?.is_dir() {
        return Err(fail(FormatError::Unreadable("it is a folder, not a height map such as .npy or .csv".into())));
    }
    let mut bytes = Vec::new();
    // Enough for a mark, and for the first lines of a text.
    file.by_ref().take(4096).read_to_end(&mut bytes).map_err(unreadable)?;
    let format = Format::of(path, &bytes).map_err(fail)?;
    Ok((format, file, bytes))
}

/// Reads the height map at `path`, in the units of the file ([`HeightMap::in_metres`]). Row `iy` of the file is row `iy` of the
/// field; `NaN` is a missing point.
///
/// # Errors
/// [`ReadError`] when the file cannot be read, is of no known format, damaged, without a measured point, or has an infinite
/// height.
pub fn read(path: &Path) -> Result<HeightMap, ReadError> {
    let fail = |problem: FormatError| ReadError { path: path.to_owned(), problem };
    let unreadable = |cause: std::io::Error| fail(FormatError::Unreadable(cause.to_string()));
    let (format, mut file, mut bytes) = opened(path)?;
    if format == Format::Npy {
        // Arrays may be as large as memory: they are not read as bytes first.
        return checked(HeightMap::bare(npy::read(path)?)).map_err(fail);
    }
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    parse(&bytes, format).map_err(fail)
}

/// Reads a height map from the bytes of a file of the given format.
///
/// # Errors
/// [`FormatError`].
pub fn parse(bytes: &[u8], format: Format) -> Result<HeightMap, FormatError> {
    let map = match format {
        Format::Npy => HeightMap::bare(npy::read_from(Cursor::new(bytes), bytes.len() as u64)?),
        Format::Csv => HeightMap::bare(text::parse(bytes)?),
        Format::Xyz => xyz::parse(bytes)?,
        Format::Surfer => surfer::parse(bytes)?,
        Format::Gsf => gsf::parse(bytes)?,
        Format::Sdf => sdf::parse(bytes)?,
        Format::X3p => x3p::parse(bytes)?,
        Format::Png => png::parse(bytes)?,
        Format::Tiff => tiff::parse(bytes)?,
    };
    checked(map)
}

/// Refuses infinite heights and maps without a measured point.
fn checked(map: HeightMap) -> Result<HeightMap, FormatError> {
    let (values, nx) = (map.heights.values(), map.heights.grid().nx());
    if let Some(i) = values.iter().position(|height| height.is_infinite()) {
        return Err(FormatError::Infinite { row: i / nx, column: i % nx, value: values[i] });
    }
    if values.iter().all(|height| height.is_nan()) {
        return Err(FormatError::Empty(values.len()));
    }
    Ok(map)
}
