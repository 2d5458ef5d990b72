//! Numbers as text, with one row of the map in each line.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use rc_core::{Field, Grid};

use super::channel::{Channel, Channels};
use super::decode::decoded;
use super::field::field;
use super::fields::shown;
use super::heading::Heading;
use super::layout::Layout;
use super::lines::{data_lines, number, words};
use crate::{Format, FormatError, HeightMap};

/// Reads the numbers of a text with one row of the map in each line.
///
/// A line feed, a carriage return, or both end a line. Commas, semicolons, tabs or blanks separate numbers. If the
/// separator is a semicolon, a tab or a blank, a comma may be the decimal point, as in many countries. Lines before the
/// first number, empty lines and lines that start with `#` or `%` are ignored. `NaN`, `BAD`, `***` and `---` are
/// missing points.
///
/// # Errors
/// [`FormatError`] with line and value.
pub fn parse(bytes: &[u8]) -> Result<Field, FormatError> {
    let text = decoded(bytes);
    rows(&text, Heading::of(&text)?.first)
}

/// The channel of a text. Its name is in the lines before the numbers.
pub(super) fn channels(bytes: &[u8], layout: Option<Layout>) -> Channels<'_> {
    let text = decoded(bytes);
    let heading = Heading::of(&text)?;
    let name = heading.channel.clone();
    // The only channel counts as heights even if it has another quantity.
    Ok(vec![Channel { name, is_height: true, read: Box::new(move || map(&text, &heading, layout)) }])
}

fn map(text: &str, heading: &Heading, layout: Option<Layout>) -> Result<HeightMap, FormatError> {
    if let ([_, _], None) = (heading.titles.as_slice(), layout) {
        let expected =
            "like titles of columns; titles are read only above columns x, y and height, so remove the line, or give layout = matrix"
                .to_owned();
        return Err(FormatError::Columns { line: heading.first.saturating_sub(1), found: 2, expected });
    }
    let mut heights = rows(text, heading.first)?;
    if heights.grid().nx() <= 2 && layout.is_none() && !heading.is_of_rows() {
        let columns = if heights.grid().nx() == 1 { "one column" } else { "two columns" };
        let (what, cure) =
            (format!("a text file with {columns}, which is a profile,"), "layout = matrix reads it as a map");
        return Err(FormatError::Unsupported { format: Format::Csv, what, cure });
    }
    let (sides, side_unit) = heading.sides(heights.grid().nx(), heights.grid().ny())?;
    let (height_unit, factor) = heading.of_heights()?;
    crate::map::scale(heights.values_mut(), factor);
    Ok(HeightMap::new(heights, height_unit, sides, side_unit))
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
            let expected = format!("but the lines before have {columns}");
            return Err(FormatError::Columns { line, found, expected });
        }
        rows += 1;
    }
    if rows == 0 {
        return Err(FormatError::NoNumbers { expected: "give a row of the map in each line, or a point x y z" });
    }
    Ok(field(Grid::new(columns, rows)?, values))
}

/// Writes heights as CSV, one row of the map in each line, multiplied by `factor`.
///
/// Values read back exactly.
///
/// # Errors
/// Errors of the file system.
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
            "1 ,2 ,3\n4 ,-0.5 ,6\n",
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
            ("1,2\n3\n", "line 2 has 1 value, but the lines before have 2"),
            ("1,2\n3,x\n", "line 2, value 2"),
            ("1,2\r3,x\r", "line 2, value 2"),
            ("1,2\r\n\r\n3,x\r\n", "line 3, value 2"),
            ("1 2 3\n4 5\r6\n", "line 2 has 2 values"),
            ("1,\n3,4\n", "line 1, value 2"),
            ("1;2\n3,5;4,,5\n", "line 2, value 2"),
            ("x,z\n1,2\n3,4\n", "line 1 has 2 values, like titles of columns"),
            ("1,2,3\n3,inf,5\n", "row 1, column 1"),
            ("nan,nan,nan\n", "all 3 points"),
            ("1,2\n3,4\n", "two columns, which is a profile"),
            ("1\n2\n", "layout = matrix"),
            ("", "it has no numbers"),
            ("# a remark\n", "it has no numbers"),
        ];
        for (text, expected) in cases {
            let error = crate::parse(text.as_bytes(), crate::Format::Csv).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }
}
