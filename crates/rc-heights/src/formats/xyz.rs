//! Lists of points on a regular grid, with `x y z` in each line.
//!
//! Points may have any order, and points may be missing.

use super::channel::{Channel, only};
use super::cloud::on_grid;
use super::decode::decoded;
use super::fields::shown;
use super::heading::Heading;
use super::lines::{cell, data_lines, number, words};
use super::marks::Marks;
use super::titles::{Columns, columns};
use crate::{FormatError, HeightMap, ReadNote, Unit};

/// Columns of points without titles.
const PLAIN: Columns = Columns { xyz: [0, 1, 2], all: 3, has_counter: false };

/// Whether a text looks like a list of points.
///
/// The first lines must have titles of points, or three numbers each without a line before them that says that they are
/// rows of a map.
pub(super) fn looks_like_points(start: &[u8]) -> bool {
    let text = decoded(start);
    // The last line may be truncated.
    let whole = text.rsplit_once(['\n', '\r']).map_or("", |(whole, _)| whole);
    let Ok(heading) = Heading::of(whole) else { return false };
    let mut lines = data_lines(whole, heading.first).peekable();
    let Some((_, first)) = lines.peek().copied() else { return false };
    if heading.titles.are_of_points() {
        return true;
    }
    if heading.is_of_rows() || heading.titles.numbers().is_some() {
        return false;
    }
    let is_headed = has_numbers_of_columns(first);
    let width = if is_headed { PLAIN.all + 1 } else { PLAIN.all };
    let least = if heading.titles.len() > 0 || is_headed { 2 } else { 3 };
    let lines: Vec<bool> = lines.skip(usize::from(is_headed)).map(|(_, line)| is_point(line, width)).collect();
    lines.len() >= least && lines.iter().all(|is_point| *is_point)
}

/// Whether the last three values of a line are a point, of `width` values.
fn is_point(line: &str, width: usize) -> bool {
    let (words, comma) = words(line);
    let mut words: Vec<&str> = words.take(width + 2).collect();
    if words.len() == width + 1 && words.last().is_some_and(|word| word.is_empty()) {
        words.pop();
    }
    let is_coordinate = |word: &&str| number(word, comma).is_some_and(f64::is_finite);
    words.len() == width
        && words[width - 3..width - 1].iter().all(is_coordinate)
        && cell(words[width - 1], comma).is_some()
}

/// Whether the first line has an empty field and the numbers of three columns, as pandas writes them.
fn has_numbers_of_columns(line: &str) -> bool {
    words(line).0.eq(["", "0", "1", "2"])
}

/// Whether the first lines of a text have enough numbers to show its layout.
pub(super) fn has_numbers(start: &[u8]) -> bool {
    const ENOUGH: usize = 4;
    let text = decoded(start);
    let whole = text.rsplit_once(['\n', '\r']).map_or("", |(whole, _)| whole);
    Heading::of(whole).is_ok_and(|heading| data_lines(whole, heading.first).take(ENOUGH).count() == ENOUGH)
}

/// The heights of a list of points. `missing` has the marks of missing points that the user gives.
pub(super) fn channels<'a>(bytes: &'a [u8], missing: &[f64]) -> Vec<Channel<'a>> {
    let missing = missing.to_vec();
    only(move || parse(bytes, &missing))
}

/// Reads a list of points. `missing` has the marks of missing points that the user gives.
fn parse(bytes: &[u8], missing: &[f64]) -> Result<HeightMap, FormatError> {
    let text = decoded(bytes);
    let heading = Heading::of(&text)?;
    let first = data_lines(&text, heading.first).next().map_or("", |(_, row)| row);
    let is_headed = has_numbers_of_columns(first);
    let columns = order(&heading, first, is_headed)?;
    let mut points = points(&text, heading.first, columns, usize::from(is_headed))?;
    if points.is_empty() {
        return Err(FormatError::NoNumbers { expected: "give a point x y z in each line" });
    }
    Marks::new(missing, &heading.missing).erase(points.iter_mut().map(|point| &mut point[2]));
    let mut notes = if columns.has_counter { vec![ReadNote::Counter { what: "column" }] } else { Vec::new() };
    let mut on = on_grid(&points);
    if let (Err(_), Some([0.0, 1.0, 2.0])) = (&on, points.first()) {
        // Numbers of the columns, as pandas writes them above an array.
        on = on_grid(&points[1..]).or(on);
        notes.push(ReadNote::Counter { what: "row" });
    }
    let mut map = on?;
    map.notes.splice(0..0, notes);
    in_units(map, &heading, columns)
}

/// The map in the units that the lines before the numbers name.
fn in_units(mut map: HeightMap, heading: &Heading, columns: Columns) -> Result<HeightMap, FormatError> {
    let units = heading.titles.units(columns.xyz)?;
    // If only one of them has a unit, it applies to both.
    let one = units[0].or(units[1]).or(heading.unit_of_all());
    if let (Some(one), Some(sides)) = (one, &mut map.sides) {
        let [x, y] = [units[0].unwrap_or(one), units[1].unwrap_or(one)];
        *sides = [sides[0] * x.metres(), sides[1] * y.metres()];
        map.side_unit = Unit::Metre;
    }
    let (unit, factor) = units[2].map_or_else(|| heading.of_heights(), |unit| Ok((Unit::Metre, unit.metres())))?;
    crate::map::scale(map.heights.values_mut(), factor);
    map.height_unit = unit;
    Ok(map)
}

/// The columns of x, y and height, of a text whose first row of numbers is `first`.
///
/// # Errors
/// [`FormatError::Field`] when titles belong to other columns.
fn order(heading: &Heading, first: &str, is_headed: bool) -> Result<Columns, FormatError> {
    let found = heading.titles.columns()?.unwrap_or(PLAIN);
    // Rows may begin with their number, which has no title.
    let is_counted = found.all + 1 == columns(first) && heading.titles.len() > 0 || is_headed;
    let moved = |columns: Columns| Columns { xyz: columns.xyz.map(|i| i + 1), all: columns.all + 1, has_counter: true };
    Ok(if is_counted { moved(found) } else { found })
}

/// The points from line `first` on, without some lines.
fn points(text: &str, first: usize, columns: Columns, without: usize) -> Result<Vec<[f64; 3]>, FormatError> {
    let mut points = Vec::new();
    for (line, row) in data_lines(text, first).skip(without) {
        let (words, comma) = words(row);
        let mut words: Vec<&str> = words.take(columns.all + 2).collect();
        if words.len() == columns.all + 1 && words.last().is_some_and(|word| word.is_empty()) {
            words.pop();
        }
        if words.len() != columns.all {
            let expected = match columns.all {
                3 => "but a point has three: x, y, z".to_owned(),
                all => format!("but the titles are {all}"),
            };
            return Err(FormatError::Columns { line, found: words.len(), expected });
        }
        let mut point = [0.0; 3];
        for (i, (to, at)) in point.iter_mut().zip(columns.xyz).enumerate() {
            let no_number = || FormatError::NoNumber { line, value: at + 1, text: shown(words[at]) };
            let value = cell(words[at], comma).filter(|value| i == 2 || value.is_finite());
            *to = value.ok_or_else(no_number)?;
        }
        points.push(point);
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_any_order_become_rows_and_gaps_stay_gaps() {
        let texts = [
            "0.333 2 6\n0 0 1\n0.667 0 3\n0 2 5\n0.333 0 2\n",
            "X,Y,Z\n# nothing\n0.333,2,6\n0,0,1\n0.667,0,3\n0,2,5\n0.333,0,2\n",
            "0,333;2;6\n0;0;1\n0,667;0;3\n0;2;5\n0,333;0;2\n",
        ];
        for text in texts {
            let map = parse(text.as_bytes(), &[]).expect(text);
            assert_eq!((map.heights.grid().nx(), map.heights.grid().ny()), (3, 2), "{text:?}");
            assert_eq!(map.heights.values()[..5], [1.0, 2.0, 3.0, 5.0, 6.0], "{text:?}");
            assert!(map.heights.values()[5].is_nan(), "{text:?}");
            let [x, y] = map.sides.expect("sides");
            assert!((x - 1.0005).abs() < 1e-12 && (y - 4.0).abs() < 1e-12, "{x} x {y}");
        }
    }

    #[test]
    fn points_that_make_no_grid_are_refused() {
        let scattered: Vec<String> = (0..40).map(|i| format!("{i} {} 1", i * 7 % 41)).collect();
        let scattered = scattered.join("\n");
        let cases = [
            ("l 0 1\n1 0 2\n", "line 1, value 1: 'l'"),
            ("0 0 1\n1 0\n", "line 2 has 2 values"),
            ("0 0 1\n1 x 2\n", "line 2, value 2"),
            ("0 0 1\nnan 1 2\n", "line 2, value 1"),
            ("0 0 1\n1 0 2\n0 0 3\n0 1 3\n", "two points"),
            ("0 0 1\n1 0 2\n1.4 1 3\n", "values of x are up to"),
            ("0 0 1\n1 0 2\n", "one y is a profile"),
            ("", "no numbers"),
            (&scattered, "one in 16"),
        ];
        for (text, expected) in cases {
            let error = parse(text.as_bytes(), &[]).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }

    #[test]
    fn titles_give_units_and_the_order_of_columns() {
        let map = parse(b"Z_(nm),X_(mm),Y_(mm)\n1,0,0\n2,1,0\n3,0,2\n4,1,2\n", &[]).expect("a map");
        assert_eq!((map.sides, map.side_unit, map.height_unit), (Some([2e-3, 4e-3]), Unit::Metre, Unit::Metre));
        assert_eq!(map.heights.values(), [1.0, 2.0, 3.0, 4.0].map(|nm| nm * 1e-9));
        let map = parse(b"X,Y,Z\n0,0,1\n1,0,2\n0,2,3\n1,2,4\n", &[]).expect("a map");
        assert_eq!((map.side_unit, map.height_unit), (Unit::Unnamed, Unit::Unnamed));
    }

    #[test]
    fn titles_of_x_and_y_leave_the_height_and_titles_of_counts_are_refused() {
        let map = parse(b"Y,X,Height\n0,0,1\n0,1,2\n2,0,3\n2,1,4\n", &[]).expect("a map");
        assert_eq!((map.sides, map.heights.values()), (Some([2.0, 4.0]), &[1.0, 2.0, 3.0, 4.0][..]));
        for titles in ["X,Y,index", "Index,x,height", "row,column,height", "time,x,z"] {
            let error = parse(format!("{titles}\n0,0,1\n1,0,2\n0,2,3\n1,2,4\n").as_bytes(), &[]).expect_err(titles);
            assert!(error.to_string().contains("titles of columns"), "{titles}: {error}");
        }
        let map = parse(b"x [mm];y;z [nm]\n0;0;1\n1;0;2\n0;2;3\n1;2;4\n", &[]).expect("a map");
        assert_eq!((map.sides, map.side_unit), (Some([2e-3, 4e-3]), Unit::Metre));
    }

    #[test]
    fn a_text_of_points_is_told_from_a_text_of_rows() {
        assert!(looks_like_points(b"x y z\n0 0 1\n0 1 2\n1 0"));
        assert!(looks_like_points(b"X_(microns),Y,Z\n0,0,1\n0,1,2\n1,0"));
        assert!(!looks_like_points("# Width: 3 µm\n# Height: 3 µm\n0 0 1\n0 1 2\n1 0 3\n".as_bytes()));
        assert!(!looks_like_points(b"0 0 1 4\n0 1 2 4\n1 0 4 4\n"));
    }
}
