//! Numbers as text, a row of the map a line.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use rc_core::{Field, Grid};

use super::channel::{Channel, Channels};
use super::decode::decoded;
use super::field::field;
use super::fields::shown;
use super::heading::Heading;
use crate::{FormatError, HeightMap};

/// The numbers of a text, a row of the map a line, which a line feed, a carriage return, or both end. Between numbers are commas,
/// semicolons, tabs or blanks; where it is none of the first two, or a semicolon, commas may stand for decimal points, as many countries
/// write them. Lines before the first number, empty lines and lines that start with `#` or `%` are passed over; `NaN`, `BAD`, `***` and
/// `---` are missing points.
///
/// # Errors
/// [`FormatError`] with line and value.
pub fn parse(bytes: &[u8]) -> Result<Field, FormatError> {
    let text = decoded(bytes);
    rows(&text, Heading::of(&text)?.first)
}

/// The channel of a text, whose lines before the numbers say what it is called.
pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let text = decoded(bytes);
    let heading = Heading::of(&text)?;
    let name = heading.channel.clone();
    Ok(vec![Channel { name, is_height: true, read: Box::new(move || map(&text, &heading)) }])
}

fn map(text: &str, heading: &Heading) -> Result<HeightMap, FormatError> {
    if let [_, _] = heading.titles.as_slice() {
        let expected = "a map has titles of three columns, x, y and height, or none".to_owned();
        return Err(FormatError::Columns { line: heading.first.saturating_sub(1), found: 2, expected });
    }
    let mut heights = rows(text, heading.first)?;
    let (sides, side_unit) = heading.sides(heights.grid().nx(), heights.grid().ny())?;
    let (height_unit, factor) = heading.of_heights()?;
    crate::map::scale(heights.values_mut(), factor);
    Ok(HeightMap { heights, height_unit, sides, side_unit })
}

/// The numbers from line `first` on.
fn rows(text: &str, first: usize) -> Result<Field, FormatError> {
    let (mut values, mut columns, mut rows) = (Vec::new(), 0, 0);
    for (line, row) in data_lines(text, first) {
        let before = values.len();
        let (words, comma) = words(row);
        for (i, word) in words.enumerate() {
            let no_number = || FormatError::NoNumber { line, value: i + 1, text: shown(word) };
            values.push(number(word, comma).ok_or_else(no_number)?);
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

/// Lines that are not empty and their numbers, from 1.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    // A carriage return before a line feed belongs to it; any other ends a line.
    let lines = text.split('\n').flat_map(|line| line.trim_end_matches('\r').split('\r'));
    lines.map(str::trim).enumerate().filter(|(_, line)| !line.is_empty()).map(|(n, line)| (n + 1, line))
}

/// Lines with data from line `first` on, and their numbers.
pub(super) fn data_lines(text: &str, first: usize) -> impl Iterator<Item = (usize, &str)> {
    lines(text).filter(move |(n, line)| *n >= first && !line.starts_with(['#', '%']))
}

/// The values of a line, and whether a comma is a decimal point in them. Nothing between two separators is a value that is not a
/// number.
pub(super) fn words(line: &str) -> (Box<dyn Iterator<Item = &str> + '_>, bool) {
    if line.contains(';') {
        (Box::new(line.split(';').map(str::trim)), true)
    } else if line.contains(',') && !has_decimal_commas(line) {
        (Box::new(line.split(',').map(str::trim)), false)
    } else {
        (Box::new(line.split_whitespace()), true)
    }
}

/// Whether a line with commas has several words between blanks, all of them numbers with a comma at most, which is inside.
fn has_decimal_commas(line: &str) -> bool {
    let is_inside = |word: &str| word.bytes().filter(|byte| *byte == b',').count() <= 1 && !word.ends_with(',');
    let mut words = line.split_whitespace();
    let several = words.clone().nth(1).is_some();
    several && words.all(|word| is_inside(word) && number(word, true).is_some())
}

/// A number, or `NaN` for the marks of a missing point; with a comma for a decimal point, if that is allowed.
pub(super) fn number(word: &str, comma: bool) -> Option<f64> {
    let parsed = if comma && word.contains(',') { word.replacen(',', ".", 1).parse() } else { word.parse() };
    parsed.ok().or_else(|| ["BAD", "***", "---"].contains(&word).then_some(f64::NAN))
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
            "1\t2,0\t3\n4\t-0,5\t6\n",
            "1,0 2,0 3,0\n4 -0,5 6\n",
            "rows\n1,\t2,\t3\n4,\t-0.5,\t6\n",
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
            ("x,z\n1,2\n3,4\n", "three columns"),
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
