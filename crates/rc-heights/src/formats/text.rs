//! Numbers as text, with one row of the map in each line.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use rc_core::Field;

use super::channel::{Channel, Channels};
use super::decode::decoded;
use super::field::{field, flip};
use super::heading::Heading;
use super::layout::Layout;
use super::lines::{data_lines, words};
use super::marks::Marks;
use super::table::Table;
use crate::{FormatError, HeightMap, LengthUnit, ReadNote, Unit};

/// Reads the numbers of a text with one row of the map in each line.
///
/// A line feed, a carriage return, or both end a line. Commas, semicolons, tabs or blanks separate numbers. If the
/// separator is a semicolon, a tab or a blank, a comma may be the decimal point, as in many countries. Lines before the
/// first number, empty lines and lines that start with `#` or `%` are ignored. Empty fields and words such as `NaN`,
/// `Bad`, `No Data`, `#N/A`, `***` and `---` are missing points.
///
/// # Errors
/// [`FormatError`] with line and value.
pub fn parse(bytes: &[u8]) -> Result<Field, FormatError> {
    let text = decoded(bytes);
    let heading = Heading::of(&text)?;
    let table = Table::of(&text, &heading)?.of_heights(&heading)?;
    Ok(field(table.grid()?, table.values))
}

/// Whether the first lines of a text have the size of the map, or may have coordinates at its borders.
pub(super) fn may_have_sides(start: &[u8]) -> bool {
    let text = decoded(start);
    let Ok(heading) = Heading::of(&text) else { return false };
    let first = data_lines(&text, heading.first).next();
    let has_corner = first.is_some_and(|(_, row)| words(row).0.next().is_some_and(str::is_empty));
    heading.says_sides() || heading.titles.numbers().is_some() || has_corner
}

/// The channel of a text. Its name is in the lines before the numbers.
///
/// `missing` has the marks of missing points that the user gives.
pub(super) fn channels<'a>(bytes: &'a [u8], layout: Option<Layout>, missing: &[f64]) -> Channels<'a> {
    let text = decoded(bytes);
    let heading = Heading::of(&text)?;
    let name = heading.channel.clone();
    let marks = Marks::new(missing, &heading.missing);
    // The only channel counts as heights even if it has another quantity.
    Ok(vec![Channel { name, is_height: true, read: Box::new(move || map(&text, &heading, layout, &marks)) }])
}

fn map(text: &str, heading: &Heading, layout: Option<Layout>, marks: &Marks) -> Result<HeightMap, FormatError> {
    let mut table = Table::of(text, heading)?.of_heights(heading)?;
    let [nx, ny] = table.size;
    let filled = filled_columns(&table.values, nx);
    if let (Some(what), None) = (profile(filled, ny, heading), layout) {
        return Err(FormatError::profile_in_text(what));
    }
    marks.erase(&mut table.values);
    let grid = table.grid()?;
    let (mut sides, mut side_unit) = heading.sides(nx, ny)?;
    let (mut height_unit, mut factor) = heading.of_heights()?;
    let mut notes = table.notes;
    notes.extend(heading.unit_of_sides_for_heights().map(|unit| ReadNote::HeightsLikeSides { unit }));
    if let Some(steps) = table.steps {
        let unit = heading.titles.unit_of_corner().or(heading.unit_of_all());
        let metres = unit.map_or(1.0, LengthUnit::metres);
        sides = Some([steps[0].abs() * nx as f64 * metres, steps[1].abs() * ny as f64 * metres]);
        side_unit = if unit.is_some() { Unit::Metre } else { Unit::Unnamed };
        if let (Unit::Unnamed, Some(unit)) = (height_unit, unit) {
            (height_unit, factor) = (Unit::Metre, unit.metres());
        }
        flip(&mut table.values, grid, steps.map(|step| step < 0.0));
        notes.extend((steps[1] < 0.0).then_some(ReadNote::RowsReversed));
    }
    crate::map::scale(&mut table.values, factor);
    let mut map = HeightMap::new(field(grid, table.values), height_unit, sides, side_unit);
    map.notes = notes;
    Ok(map)
}

/// Number of columns up to the last one that has a number.
///
/// Programs end their rows with separators of columns that have nothing.
fn filled_columns(values: &[f64], nx: usize) -> usize {
    let is_filled = |ix: &usize| values[*ix..].iter().step_by(nx).any(|value| !value.is_nan());
    (0..nx).rev().find(is_filled).map_or(0, |ix| ix + 1)
}

/// What a table of so few columns or rows is, if it is a profile.
fn profile(nx: usize, ny: usize, heading: &Heading) -> Option<&'static str> {
    match (nx, ny) {
        (1, _) => Some("a text of one column"),
        // A map may be narrow if its size is known.
        (2, _) if !heading.says_whole_size() => Some("a text of two columns, as position and height,"),
        (_, 1) => Some("a text of one row"),
        _ => None,
    }
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
    use rc_core::{DVec2, Grid};

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
            ("1,\n3,4\n", "two columns"),
            ("1,2,3,\n3,4,5\n", "line 2 has 3 values, but the lines before have 4"),
            ("1;2\n3,5;4,,5\n", "line 2, value 2"),
            ("x,z\n1,2\n3,4\n", "is a profile"),
            ("1,2,3\n3,inf,5\n", "row 1, column 1"),
            ("nan,nan,nan\nbad,NA,\n", "all 6 points"),
            ("1,2\n3,4\n", "is a profile"),
            ("1\n2\n", "is a profile"),
            ("1,2,3\n", "is a profile"),
            ("", "it has no numbers"),
            ("# a remark\n", "it has no numbers"),
        ];
        for (text, expected) in cases {
            let error = crate::parse(text.as_bytes(), crate::Format::Csv).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }
}
