//! Numbers as text, a row of the map a line.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use rc_core::{Field, Grid};

use super::field::field;
use super::fields::shown;
use crate::FormatError;

/// Numbers with commas between them, or semicolons (then commas may stand for decimal points, as spreadsheets of many countries
/// write them), or blanks; a row of the map a line, which a line feed, a carriage return, or both end. Empty lines and lines that
/// start with `#` are passed over; `NaN` is a missing point.
///
/// # Errors
/// [`FormatError`] with line and value.
pub fn parse(bytes: &[u8]) -> Result<Field, FormatError> {
    let text = String::from_utf8_lossy(bytes);
    let (mut values, mut columns, mut rows) = (Vec::new(), 0, 0);
    for (line, row) in data_lines(&text) {
        let before = values.len();
        for (i, word) in words(row).enumerate() {
            let no_number = || FormatError::NoNumber { line, value: i + 1, text: shown(word) };
            values.push(number(word, row.contains(';')).ok_or_else(no_number)?);
        }
        let found = values.len() - before;
        if rows == 0 {
            columns = found;
        } else if found != columns {
            let expected = format!("the lines before have {columns}");
            return Err(FormatError::Columns { line, found, expected });
        }
        rows += 1;
    }
    Ok(field(Grid::new(columns, rows)?, values))
}

/// Lines with data and their numbers, from 1.
pub(super) fn data_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    // A carriage return before a line feed belongs to it; any other ends a line.
    let lines = text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'));
    lines
        .map(str::trim)
        .enumerate()
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .map(|(n, line)| (n + 1, line))
}

/// The values of a line; nothing between two commas is a value that is no number.
pub(super) fn words(line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    match [';', ','].into_iter().find(|separator| line.contains(*separator)) {
        Some(separator) => Box::new(line.split(separator).map(str::trim)),
        None => Box::new(line.split_ascii_whitespace()),
    }
}

/// A number; with a comma for a decimal point, if that is allowed.
pub(super) fn number(word: &str, comma: bool) -> Option<f64> {
    let parsed = if comma && word.contains(',') { word.replace(',', ".").parse() } else { word.parse() };
    parsed.ok()
}

/// Writes heights as CSV, one row of the map a line, each value multiplied by `factor`; values read back exactly.
///
/// # Errors
/// Those of the file system.
pub fn write(path: &Path, field: &Field, factor: f64) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    for iy in 0..field.grid().ny() {
        for (ix, value) in field.row(iy).iter().enumerate() {
            let comma = if ix == 0 { "" } else { "," };
            write!(out, "{comma}{:e}", value * factor)?;
        }
        writeln!(out)?;
    }
    out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

#[cfg(test)]
mod tests {
    use rc_core::DVec2;

    use super::*;

    #[test]
    fn every_separator_is_read_row_by_row() {
        let texts = [
            "# heights\n1, 2, 3\n4, -5e-1, 6\n",
            "\u{FEFF}1;2;3\r\n4;-0,5;6\r\n",
            "1 2 3\n\n  4\t-0.5 6",
            "1\t2\t3\n4\t-.5\t6\n",
            "1 2 3\r4 -0.5 6\r",
            "1 2 3\r\n\r\n4 -0.5 6\r\n",
        ];
        for text in texts {
            let field = parse(text.as_bytes()).expect(text);
            assert_eq!((field.grid().nx(), field.grid().ny()), (3, 2), "{text:?}");
            assert_eq!(field.values(), [1.0, 2.0, 3.0, 4.0, -0.5, 6.0], "{text:?}");
        }
    }

    #[test]
    fn written_text_reads_back_exactly() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("map.csv");
        let field = Field::from_fn(Grid::new(3, 2).expect("a grid"), |DVec2 { x, y }| (x - 0.3).exp() * y * 1e-7);
        write(&path, &field, 1.0).expect("a written file");
        assert_eq!(crate::read(&path).expect("a map").heights, field);
    }

    #[test]
    fn bad_text_is_refused_with_its_place() {
        let cases = [
            ("1,2\n3\n", "line 2 has 1 values"),
            ("1,2\n3,x\n", "line 2, value 2"),
            ("1,2\r3,x\r", "line 2, value 2"),
            ("1,2\r\n\r\n3,x\r\n", "line 3, value 2"),
            ("1 2 3\n4 5\r6\n", "line 2 has 2 values"),
            ("1,\n3,4\n", "line 1, value 2"),
            ("1;2\n3,5;4,,5\n", "line 2, value 2"),
            ("1,2\n3,inf\n", "row 1, column 1"),
            ("nan,nan\n", "all 2 points"),
            ("", "1 to"),
        ];
        for (text, expected) in cases {
            let error = crate::parse(text.as_bytes(), crate::Format::Csv).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }
}
