//! Why a file is not a height map. Each message is one line: what, where, and what would be right.

use std::path::PathBuf;

use rc_core::{Grid, GridError};
use thiserror::Error;

use crate::Format;

/// A file that cannot be read.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}: {problem}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: FormatError,
}

/// What is wrong with the bytes of a file.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FormatError {
    /// The file system has no such file, or does not give it.
    #[error("cannot read: {0}")]
    Unreadable(String),
    /// Neither the first bytes nor the extension say what it is.
    #[error(
        "its format is not known, neither from its first bytes nor from its name; a height map is a text (.csv, .txt, .dat, .asc, .xyz), an array (.npy, \
         .mat, .h5, .nc), a file of a program (.gwy, .gsf, .grd, .ibw, .sdf, .x3p) or of an instrument (.sur, .spm, .opd, .dat of \
         MetroPro, .al3d, .plu, .plux, .vk4), a .png or a .tif file"
    )]
    Unknown,
    /// An archive that is not a height map.
    #[error("it is {what}")]
    Archive {
        /// What it is, and what to do.
        what: String,
    },
    /// A text by its name that is not one by its bytes.
    #[error("it contains zero bytes, so it is not a text; save it as UTF-8, or UTF-16 with a byte-order mark")]
    ZeroBytes,
    /// A file that gzip has packed and that cannot be unpacked.
    #[error("cannot be unpacked by gzip: {0}; the file is damaged or truncated")]
    Gzip(String),
    /// The extension promises a format that the first bytes are not of.
    #[error("not a valid {format} file: {expected}")]
    Mark {
        /// The format of the extension.
        format: Format,
        /// How such a file begins.
        expected: &'static str,
    },
    /// A library that opens containers says no.
    #[error("not a valid {format} file: {reason}")]
    Container {
        /// The format.
        format: Format,
        /// The library's reason.
        reason: String,
    },
    /// A field of a header has a value that it must not have.
    #[error("{format} header: {field} is '{found}'; it must be {expected}")]
    Field {
        /// The format.
        format: Format,
        /// The field.
        field: &'static str,
        /// Its value.
        found: String,
        /// What it must be.
        expected: &'static str,
    },
    /// A header without a field that it must have.
    #[error("{format} header: {field} is missing; the header is truncated or of another kind")]
    Missing {
        /// The format.
        format: Format,
        /// The field.
        field: &'static str,
    },
    /// A part of the format that rc does not read.
    #[error("{format}: {what} cannot be read here; {cure}")]
    Unsupported {
        /// The format.
        format: Format,
        /// What the file has.
        what: String,
        /// What to do.
        cure: &'static str,
    },
    /// Fewer bytes than the header promises.
    #[error(
        "shorter than its header says: {grid} heights need {needed} bytes, {found} are there; the file is truncated"
    )]
    CutShort {
        /// Points along x and y.
        grid: Grid,
        /// Bytes that the heights need, at least.
        needed: u64,
        /// Bytes that are there.
        found: u64,
    },
    /// More bytes than the header promises.
    #[error(
        "longer than its header says: {grid} heights need {needed} bytes, {found} are there; the header is of another map"
    )]
    Surplus {
        /// Points along x and y.
        grid: Grid,
        /// Bytes that the heights need.
        needed: u64,
        /// Bytes that are there.
        found: u64,
    },
    /// Fewer bytes than any header has.
    #[error("shorter than the header of a {format} file; the file is truncated")]
    HeaderCutShort {
        /// The format.
        format: Format,
    },
    /// A word of a text that is not a number.
    #[error("line {line}, value {value}: '{text}' is not a number")]
    NoNumber {
        /// Line, from 1.
        line: usize,
        /// Value in the line, from 1.
        value: usize,
        /// The word.
        text: String,
    },
    /// A line of a text with another number of values.
    #[error("line {line} has {found} values, {expected}")]
    Columns {
        /// Line, from 1.
        line: usize,
        /// Values in it.
        found: usize,
        /// What would be right.
        expected: String,
    },
    /// A wave vector that is not of a periodic surface.
    #[error("line {line}: wave number {value} is not an integer; kx and ky are waves per cell")]
    WaveNumber {
        /// Line, from 1.
        line: usize,
        /// As read.
        value: f64,
    },
    /// An HDF5 file without the table that is looked for.
    #[error("the HDF5 file has neither arrays {names} of one length in one group nor an array of four columns")]
    NoTable {
        /// Names of the columns.
        names: String,
    },
    /// Points that are not on a regular grid.
    #[error("the points are not on a regular grid: {0}")]
    Irregular(String),
    /// A height that is infinite.
    #[error(
        "row {row}, column {column} (from 0) is {value}; heights must be finite, and NaN where nothing was measured"
    )]
    Infinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The height.
        value: f64,
    },
    /// No point was measured.
    #[error("all {0} points are missing; nothing was measured")]
    Empty(usize),
    /// No channel has the name that was asked for.
    #[error("no channel is called '{name}'; {}", names(channels))]
    NoChannel {
        /// As asked for.
        name: String,
        /// The names that there are.
        channels: Vec<String>,
    },
    /// No channel has values that are lengths.
    #[error("{}", no_heights(channels))]
    NoHeights {
        /// The names that there are.
        channels: Vec<String>,
    },
    /// A number of points that no grid has.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// Why no channel is read, and how one is.
fn no_heights(channels: &[String]) -> String {
    match channels {
        [] => "the file has no 2-D array of numbers".to_owned(),
        [only] if only.is_empty() => {
            "no channel has heights: the values of the only one, which has no name, are not lengths; channel = 1 with height_scale (m), \
             the height of one, reads them"
                .to_owned()
        }
        _ => format!(
            "no channel has heights; {}; channel = NAME with height_scale (m), the height of one, reads a channel",
            names(channels)
        ),
    }
}

/// Names of channels, at most as many as a line can have.
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
