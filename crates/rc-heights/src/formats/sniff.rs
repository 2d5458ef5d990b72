//! How a file is known: by its first bytes, or by its name where the format has no mark.

use std::path::Path;

use super::{Format, gsf, xyz};
use crate::FormatError;

/// Bytes at the start of a file that say what it is.
const MARKS: &[(&[u8], Format)] = &[
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
