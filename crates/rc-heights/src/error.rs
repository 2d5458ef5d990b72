//! Errors of files that are not height maps.
//!
//! Each message is one line that says what is wrong, where, and what would be right.

use std::path::PathBuf;

use rc_core::quantity::{count, engineering};
use rc_core::{Grid, GridError};
use thiserror::Error;

use crate::Format;

/// A file that cannot be read.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}: {problem}", path.display())]
pub struct ReadError {
    /// Path of the file.
    pub path: PathBuf,
    /// The problem of the file.
    pub problem: FormatError,
}

/// A problem of the bytes of a file.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FormatError {
    /// The file does not exist or cannot be read.
    #[error("cannot read: {0}")]
    Unreadable(String),
    /// Neither the first bytes nor the extension determine the format.
    #[error(
        "its format is not known, neither from its first bytes nor from its name; a height map is a text file (.csv, .txt, .dat, .asc, .xyz), an array (.npy, \
         .mat, .h5, .nc), a file from a program (.gwy, .gsf, .grd, .ibw, .sdf, .x3p) or from an instrument (.sur, .spm, .opd, .dat of \
         MetroPro, .al3d, .plu, .plux, .vk4, .vk6, .nid, .stp, .opdx, .frt, .bcrf), or an image (.png, .tif)"
    )]
    Unknown,
    /// The file is an archive, or belongs to a program, and is not a height map.
    #[error("it is {what}")]
    Other {
        /// Kind of the file, and what to do.
        what: String,
    },
    /// The file has the heights along a line.
    #[error("{what} is a profile, not a map; {cure}")]
    Profile {
        /// What the file has.
        what: String,
        /// What a map has.
        cure: String,
    },
    /// The file has a map, and a profile is needed.
    #[error(
        "a map of {columns} x {rows} points, not a profile; a profile has one row, or lines x and height; omit --line for a map"
    )]
    Map {
        /// Points along x.
        columns: u64,
        /// Points along y.
        rows: u64,
    },
    /// The name is that of a text file, but the bytes are not.
    #[error("it contains NUL bytes, so it is not a text file; save it as UTF-8, or UTF-16 with a byte-order mark")]
    ZeroBytes,
    /// The file is compressed with gzip and cannot be decompressed.
    #[error("cannot be unpacked by gzip: {0}; the file is damaged or truncated")]
    Gzip(String),
    /// Reading the file needs more memory than the user allows.
    #[error(
        "{}, more than the {} that --memory-limit allows; give more, or a smaller map",
        about(*needed, *limit),
        engineering(*limit as f64, "B")
    )]
    TooLarge {
        /// Bytes that reading needs, or those that were needed when the limit was reached.
        needed: u64,
        /// Bytes that the user allows.
        limit: u64,
    },
    /// An array has a list of points, and they cannot be a map.
    #[error(
        "an array of {rows} x {columns} numbers is taken as a list of points x y z, not as a map: {problem}; --layout matrix says \
         otherwise"
    )]
    Points {
        /// Number of rows.
        rows: u64,
        /// Number of columns.
        columns: u64,
        /// Why the points are no map.
        problem: Box<FormatError>,
    },
    /// The first bytes do not fit the format of the extension.
    #[error("not a valid {format} file: {expected}")]
    Mark {
        /// The format of the extension.
        format: Format,
        /// How a file of this format begins.
        expected: &'static str,
    },
    /// A library that opens containers has refused the file.
    #[error("not a valid {format} file: {reason}")]
    Container {
        /// The format.
        format: Format,
        /// Reason that the library gives.
        reason: String,
    },
    /// A field of a header has an invalid value.
    #[error("{format} header: {field} is '{found}'; it must be {expected}")]
    Field {
        /// The format.
        format: Format,
        /// Name of the field.
        field: &'static str,
        /// Value of the field.
        found: String,
        /// Description of a valid value.
        expected: &'static str,
    },
    /// A header does not have a required field.
    #[error("{format} header: {field} is missing; the header is truncated or of another kind")]
    Missing {
        /// The format.
        format: Format,
        /// Name of the field.
        field: &'static str,
    },
    /// The file uses a part of the format that rc does not read.
    #[error("{format}: {what} cannot be read here; {cure}")]
    Unsupported {
        /// The format.
        format: Format,
        /// What the file contains.
        what: String,
        /// What to do.
        cure: &'static str,
    },
    /// The file has fewer bytes than its header requires.
    #[error(
        "shorter than its header says: {grid} heights need {needed} bytes, but the file has {found}; it is truncated"
    )]
    CutShort {
        /// Number of points along x and y.
        grid: Grid,
        /// Minimum number of bytes for the heights.
        needed: u64,
        /// Number of bytes in the file.
        found: u64,
    },
    /// The file has more bytes than its header requires.
    #[error(
        "longer than its header says: {grid} heights need {needed} bytes, but the file has {found}; the header is that of another map"
    )]
    Surplus {
        /// Number of points along x and y.
        grid: Grid,
        /// Number of bytes for the heights.
        needed: u64,
        /// Number of bytes in the file.
        found: u64,
    },
    /// The file is shorter than any header of its format.
    #[error("shorter than the header of a {format} file; the file is truncated")]
    HeaderCutShort {
        /// The format.
        format: Format,
    },
    /// A text file has no numbers.
    #[error("it has no numbers; {expected}")]
    NoNumbers {
        /// Description of a valid file.
        expected: &'static str,
    },
    /// A word of a text is not a number.
    #[error("line {line}, value {value}: '{text}' is not a number")]
    NoNumber {
        /// Number of the line, from 1.
        line: usize,
        /// Number of the value in the line, from 1.
        value: usize,
        /// The word.
        text: String,
    },
    /// A line of a text has a wrong number of values.
    #[error("line {line} has {}, {expected}", count(*found, "value"))]
    Columns {
        /// Number of the line, from 1.
        line: usize,
        /// Number of values in the line.
        found: usize,
        /// Description of a valid number.
        expected: String,
    },
    /// A wave vector does not belong to a periodic surface.
    #[error("line {line}: wave number {value} is not an integer; kx and ky are waves per cell")]
    WaveNumber {
        /// Number of the line, from 1.
        line: usize,
        /// The wavenumber as read.
        value: f64,
    },
    /// An HDF5 file does not contain the required table.
    #[error("the HDF5 file has neither arrays {names} of one length in one group nor an array of four columns")]
    NoTable {
        /// Names of the columns.
        names: String,
    },
    /// The points are not on a regular grid.
    #[error("the points are not on a regular grid: {0}")]
    Irregular(String),
    /// A height is infinite.
    #[error(
        "row {row}, column {column} (from 0) is {value}; heights must be finite, or NaN where nothing was measured"
    )]
    Infinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The height.
        value: f64,
    },
    /// The map has no measured point.
    #[error("all {0} points are missing; nothing was measured")]
    Empty(usize),
    /// No channel has the requested name.
    #[error("no channel is called '{name}'; {}", names(channels))]
    NoChannel {
        /// The requested name.
        name: String,
        /// Names of the channels in the file.
        channels: Vec<String>,
    },
    /// The values of no channel are lengths.
    #[error("{}", no_heights(channels))]
    NoHeights {
        /// Names of the channels in the file.
        channels: Vec<String>,
    },
    /// The number of points is not valid for a grid.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// Says how much memory is needed. A file that is not read to its end needs an unknown amount.
fn about(needed: u64, limit: u64) -> String {
    if needed as f64 > 1.1 * limit as f64 {
        format!("it needs about {} of memory", engineering(needed as f64, "B"))
    } else {
        "it needs too much memory".to_owned()
    }
}

impl FormatError {
    /// The error for a text with a profile, which has `what`.
    pub(crate) fn profile_in_text(what: &str) -> Self {
        let cure =
            "a map has a row of heights in each line, or a point x y z; give --line for the contact of a profile"
                .to_owned();
        Self::Profile { what: what.to_owned(), cure }
    }

    /// The error for an array with a profile. `or` says how to read it as a map all the same, or nothing.
    pub(crate) fn profile_in_array(shape: &str, or: &str) -> Self {
        let cure = format!("a map is a 2-D array of heights{or}");
        Self::Profile { what: format!("an array of {shape} numbers"), cure }
    }
}

/// Says why no channel is read, and how to read one.
fn no_heights(channels: &[String]) -> String {
    match channels {
        [] => "the file has no 2-D array of numbers".to_owned(),
        [only] if only.is_empty() => {
            "no channel has heights: the values of the only one, which has no name, are not lengths; to read them, give \
             channel = 1 and height_scale, the height (m) of the value 1"
                .to_owned()
        }
        _ => format!(
            "no channel has heights; {}; to read one, give channel = NAME and height_scale, the height (m) of the value 1",
            names(channels)
        ),
    }
}

/// Lists the names of channels, as many as fit a line.
fn names(channels: &[String]) -> String {
    const MOST: usize = 20;
    match channels {
        [] => "the file has none".to_owned(),
        [only] if only.is_empty() => "the file has one channel without a name; omit channel".to_owned(),
        _ => {
            let more =
                if channels.len() > MOST { format!(" and {} more", channels.len() - MOST) } else { String::new() };
            let first = channels[..channels.len().min(MOST)].join(", ");
            format!("the file has {first}{more}")
        }
    }
}
