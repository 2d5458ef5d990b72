//! Limits of the memory that a file may take.
//!
//! Packed files and headers may claim any size. Each reader compares what it needs with the limit of the user before it
//! takes memory.

use std::io::Read;

use rc_core::Grid;

use super::Format;
use crate::FormatError;

/// Default of [`super::ReadParams::max_bytes`]: a map of 16384² points, twice.
///
/// A program that knows its machine gives its own.
pub const DEFAULT_MAX_BYTES: u64 = 4 << 30;

/// Bytes that are read between two checks.
const CHUNK: u64 = 1 << 20;

/// Maximum length of a word of a text. Texts before the numbers may have a picture in one word.
const LONGEST_WORD: usize = 16 << 20;

/// Bytes of a height in memory.
const HEIGHT: u64 = 8;

/// Refuses what needs more than `max_bytes` of memory.
pub(crate) fn check(needed: u64, max_bytes: u64) -> Result<(), FormatError> {
    if needed > max_bytes { Err(FormatError::TooLarge { needed, limit: max_bytes }) } else { Ok(()) }
}

/// Refuses a map whose heights, with `stored` bytes a point beside them and `others` in all, need more than
/// `max_bytes`.
pub(super) fn check_map(grid: Grid, stored: u64, others: u64, max_bytes: u64) -> Result<(), FormatError> {
    check((grid.len() as u64).saturating_mul(HEIGHT + stored).saturating_add(others), max_bytes)
}

/// Memory of a file while it is read, from the bytes that are there so far.
#[derive(Debug)]
pub(super) enum Needed {
    /// A text.
    Text(Text),
    /// Bytes that are numbers, times the factor that reading them needs.
    Numbers(u64),
}

impl Needed {
    pub(super) fn of(format: Format) -> Self {
        Self::Numbers(match format {
            Format::Csv => return Self::Text(Text::new(HEIGHT)),
            // Lines may end anywhere.
            Format::EsriGrid => return Self::Text(Text { wraps: true, ..Text::new(HEIGHT) }),
            // A point has three numbers: its list, an axis to sort, and its place on the grid.
            Format::Xyz => return Self::Text(Text::new(2 * HEIGHT)),
            Format::Zygo => return Self::Text(Text { wraps: true, ..Text::new(2 * HEIGHT) }),
            // Their readers check what they unpack.
            Format::Hdf5
            | Format::Mat
            | Format::NetCdf
            | Format::Npy
            | Format::Plux
            | Format::Png
            | Format::Sur
            | Format::Tiff
            | Format::X3p => 1,
            // Numbers of 64 bits, and the heights.
            Format::Gwy => 2,
            // Numbers of 32, 16 and 8 bits.
            Format::Al3d | Format::Gsf | Format::Opdx | Format::Plu => 3,
            Format::Bcr
            | Format::Frt
            | Format::MetroPro
            | Format::Nanoscope
            | Format::Sdf
            | Format::Surfer
            | Format::Wsxm => 5,
            Format::Ibw | Format::Nid | Format::Opd | Format::Vk4 => 9,
        })
    }

    /// Memory for `bytes` bytes, of which `new` were added last.
    fn after(&mut self, bytes: u64, new: &[u8]) -> Result<u64, FormatError> {
        match self {
            Self::Text(text) => {
                text.add(new)?;
                Ok(text.needed())
            }
            Self::Numbers(factor) => Ok(bytes.saturating_mul(*factor)),
        }
    }
}

/// Memory of a text: its bytes, its characters if they are other bytes, and its numbers.
#[derive(Debug)]
pub(super) struct Text {
    /// Bytes that a number takes.
    number: u64,
    bytes: u64,
    /// Bytes above 127.
    high: u64,
    zeros: u64,
    values: u64,
    /// Values in the line so far.
    in_line: usize,
    in_word: usize,
    line: usize,
    after_separator: bool,
    /// Whether a line may have any number of values.
    wraps: bool,
}

impl Text {
    fn new(number: u64) -> Self {
        Self {
            number,
            bytes: 0,
            high: 0,
            zeros: 0,
            values: 0,
            in_line: 0,
            in_word: 0,
            line: 1,
            after_separator: true,
            wraps: false,
        }
    }

    /// Counts the values in the next bytes.
    ///
    /// # Errors
    /// [`FormatError::Columns`] for a line with more values than a map can have.
    fn add(&mut self, bytes: &[u8]) -> Result<(), FormatError> {
        for byte in bytes {
            match byte {
                b'\n' | b'\r' => {
                    self.line += usize::from(*byte == b'\n');
                    (self.in_line, self.after_separator) = (0, true);
                }
                b' ' => self.after_separator = true,
                // Nothing between two of them may be a missing point.
                b',' | b';' | b'\t' => {
                    self.values += u64::from(self.after_separator);
                    self.in_line += usize::from(self.after_separator);
                    self.after_separator = true;
                }
                // The other half of a character of UTF-16.
                0 => self.zeros += 1,
                byte => {
                    self.high += u64::from(*byte > 127);
                    self.values += u64::from(self.after_separator);
                    self.in_line += usize::from(self.after_separator);
                    self.in_word = if self.after_separator { 1 } else { self.in_word + 1 };
                    self.after_separator = false;
                    if self.in_line > Grid::MAX_SIDE && !self.wraps || self.in_word > LONGEST_WORD {
                        return Err(self.endless());
                    }
                }
            }
        }
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    fn endless(&self) -> FormatError {
        if self.in_word > LONGEST_WORD {
            let text = format!("a word of more than {LONGEST_WORD} characters");
            return FormatError::NoNumber { line: self.line, value: self.in_line, text };
        }
        let expected = format!("or more, but a row has at most {}", Grid::MAX_SIDE);
        FormatError::Columns { line: self.line, found: self.in_line, expected }
    }

    fn needed(&self) -> u64 {
        // UTF-8 without other characters is not copied.
        let copy = if self.high + self.zeros > 0 { self.bytes + self.high } else { 0 };
        self.bytes.saturating_add(copy).saturating_add(self.number.saturating_mul(self.values))
    }
}

/// Refuses a text whose characters and numbers need more than `max_bytes` of memory.
pub(crate) fn check_text(bytes: &[u8], max_bytes: u64) -> Result<(), FormatError> {
    let mut text = Text::new(HEIGHT);
    text.add(bytes)?;
    check(text.needed(), max_bytes)
}

/// Reads all of `source` behind the bytes that are there, as long as the memory for it is at most `max_bytes`.
///
/// # Errors
/// [`FormatError::TooLarge`] as soon as more is needed, and the errors of `source`, converted by `invalid`.
pub(super) fn read_within(
    mut bytes: Vec<u8>,
    mut source: impl Read,
    mut needed: Needed,
    max_bytes: u64,
    invalid: impl Fn(std::io::Error) -> FormatError,
) -> Result<Vec<u8>, FormatError> {
    let mut counted = 0;
    loop {
        check(needed.after(bytes.len() as u64, &bytes[counted..])?, max_bytes)?;
        counted = bytes.len();
        if source.by_ref().take(CHUNK).read_to_end(&mut bytes).map_err(&invalid)? == 0 {
            return Ok(bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &[u8]) -> Text {
        let mut counted = Text::new(8);
        counted.add(text).expect("short lines");
        counted
    }

    #[test]
    fn values_of_a_text_are_counted() {
        for (given, values) in [
            (&b"1 2 3\n4 5 6\n"[..], 6),
            (b"1, 2, 3\r\n4, 5, 6", 6),
            (b"1,,3\n,5,6\n", 6),
            (b"\n\n 1\t2 \n", 2),
            (b"1\x002\x00 \x003\x00", 2),
        ] {
            assert_eq!(text(given).values, values, "{given:?}");
        }
        assert_eq!(text(b"1 2\n").needed(), 4 + 16);
        assert_eq!(text(b"\xb5 2\n").needed(), 4 + 5 + 16);
    }

    #[test]
    fn reading_stops_at_the_limit() {
        let endless = || std::io::repeat(b'0');
        let read =
            |format, limit| read_within(Vec::new(), endless(), Needed::of(format), limit, |_| FormatError::Unknown);
        assert!(matches!(read(Format::Csv, 3 << 20), Err(FormatError::TooLarge { limit: 3145728, .. })));
        assert!(matches!(read(Format::Opd, 10 << 20), Err(FormatError::TooLarge { needed: 18874368, .. })));
        let line = std::io::repeat(b'0').take(1000).chain(&b" 1"[..]);
        let read = read_within(b"2 ".to_vec(), line, Needed::of(Format::Csv), 3000, |_| FormatError::Unknown);
        assert_eq!(read.map(|bytes| bytes.len()), Ok(1004));
        let words = b" 1".repeat(Grid::MAX_SIDE + 1);
        assert!(Text::new(8).add(&words).is_err_and(|error| error.to_string().contains("line 1 has 1048577 values")));
    }
}
