//! Opening of files: recognition of the format by the first bytes, and reading within a limit of memory.
//!
//! Only the first bytes of a packed file are unpacked before its format is known.

use std::fs::File;
use std::io::{BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

use flate2::bufread::MultiGzDecoder;

use super::limit::{self, Needed};
use super::params::ReadParams;
use super::{Format, archive, xyz};
use crate::{FormatError, ReadError};

/// Bytes that are enough for a mark, and for the first lines of most texts.
const START: u64 = 4096;

/// Maximum number of bytes that precede the numbers of a text.
const LONGEST_HEADING: u64 = 16 << 20;

/// A file whose format is known.
pub(super) struct Opened {
    pub(super) format: Format,
    /// The first bytes, or all bytes.
    pub(super) start: Vec<u8>,
    /// Source of the other bytes.
    rest: Box<dyn Read>,
    /// Number of bytes of the file. `None` if they are packed.
    length: Option<u64>,
}

impl Opened {
    /// Opens a file that needs at most `max_bytes` of memory.
    pub(super) fn new(path: &Path, max_bytes: u64) -> Result<Self, ReadError> {
        Self::open(path, max_bytes).map_err(|problem| ReadError { path: path.to_owned(), problem })
    }

    fn open(path: &Path, max_bytes: u64) -> Result<Self, FormatError> {
        let mut file = File::open(path).map_err(unreadable)?;
        let metadata = file.metadata().map_err(unreadable)?;
        if metadata.is_dir() {
            return Err(FormatError::Unreadable("it is a folder, not a height map such as .npy or .csv".into()));
        }
        let start = start_of(&mut file, unreadable)?;
        if !start.starts_with(archive::GZIP) {
            return Self::known(path, start, Box::new(file), Some(metadata.len()), max_bytes);
        }
        let mut unpacked = MultiGzDecoder::new(BufReader::new(Cursor::new(start).chain(file)));
        let start = start_of(&mut unpacked, packed)?;
        Self::known(&unpacked_name(path), start, Box::new(unpacked), None, max_bytes)
    }

    /// Determines the format, with as many bytes as it takes.
    fn known(
        name: &Path,
        start: Vec<u8>,
        rest: Box<dyn Read>,
        length: Option<u64>,
        max_bytes: u64,
    ) -> Result<Self, FormatError> {
        // The format of a zip archive follows from its members, which are listed at its end.
        if start.starts_with(archive::ZIP) {
            limit::check(length.unwrap_or(0), max_bytes)?;
            let start = limit::read_within(start, rest, Needed::Numbers(1), max_bytes, invalid(length))?;
            return Ok(Self { format: Format::of(name, &start)?, start, rest: Box::new(std::io::empty()), length });
        }
        let format = Format::of(name, &start)?;
        let mut file = Self { format, start, rest, length };
        // The first numbers of a text determine its layout. Many lines may precede them.
        while matches!(file.format, Format::Csv | Format::Xyz) && !xyz::has_numbers(&file.start) {
            let as_many = (file.start.len() as u64).min(LONGEST_HEADING.saturating_sub(file.start.len() as u64));
            if file.rest.by_ref().take(as_many).read_to_end(&mut file.start).map_err(invalid(length))? == 0 {
                break;
            }
            file.format = Format::of(name, &file.start)?;
        }
        Ok(file)
    }

    /// Memory that reading this file may take.
    pub(super) fn limit(&self, params: &ReadParams) -> u64 {
        if self.length.is_some() { params.max_plain_bytes } else { params.max_bytes }
    }

    /// Reads all bytes, which are of `format`.
    ///
    /// # Errors
    /// [`FormatError::TooLarge`] when they, or the numbers in them, need more memory than `params` allow.
    pub(super) fn whole(mut self, format: Format, params: &ReadParams) -> Result<Vec<u8>, FormatError> {
        let max_bytes = self.limit(params);
        let length = self.length.unwrap_or(0);
        limit::check(length, max_bytes)?;
        self.start.reserve_exact(usize::try_from(length).unwrap_or(0).saturating_sub(self.start.len()));
        limit::read_within(self.start, self.rest, Needed::of(format), max_bytes, invalid(self.length))
    }

    /// All bytes one after the other, and their number. It is unknown, so as large as any, if they are packed.
    pub(super) fn stream(self) -> (impl Read, u64) {
        (BufReader::new(Cursor::new(self.start).chain(self.rest)), self.length.unwrap_or(u64::MAX))
    }
}

/// The first bytes of a file.
fn start_of(file: &mut impl Read, invalid: impl Fn(std::io::Error) -> FormatError) -> Result<Vec<u8>, FormatError> {
    let mut bytes = Vec::new();
    file.take(START).read_to_end(&mut bytes).map_err(invalid)?;
    Ok(bytes)
}

/// The name of the file that is packed in the file at `path`.
fn unpacked_name(path: &Path) -> PathBuf {
    let is_gz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    if is_gz { path.with_extension("") } else { path.to_owned() }
}

/// The error for bytes that cannot be read, from a file of known length or from a packed file.
fn invalid(length: Option<u64>) -> fn(std::io::Error) -> FormatError {
    if length.is_some() { unreadable } else { packed }
}

#[expect(clippy::needless_pass_by_value, reason = "the shape that map_err wants")]
fn packed(cause: std::io::Error) -> FormatError {
    FormatError::Gzip(cause.to_string())
}

#[expect(clippy::needless_pass_by_value, reason = "the shape that map_err wants")]
fn unreadable(cause: std::io::Error) -> FormatError {
    FormatError::Unreadable(cause.to_string())
}
