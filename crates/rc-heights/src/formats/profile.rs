//! Profiles: heights at equal steps along a line.
//!
//! A profile is a map of one row. Both sides of its cell are the length of the profile, which is the number of points
//! times their step.

use std::borrow::Cow;

use rc_core::Grid;
use rc_core::quantity::digits;

use super::decode::decoded;
use super::field::{field, transposed};
use super::fields::shown;
use super::heading::Heading;
use super::lines::{cell, data_lines, raw_lines, words};
use super::marks::Marks;
use super::titles::columns;
use crate::{FormatError, HeightMap, ReadNote, Unit};

/// Maximum deviation of a step from the mean step, and of a point from its even place, in steps.
const EVEN: f64 = 0.01;

/// Points from which even places that were rounded when they were written are told from uneven ones.
const ENOUGH: usize = 50;

/// Largest unit of the last digit of such places, in steps.
const COARSEST: f64 = 0.7;

/// Digits behind the point of a number that is not rounded.
const EXACT: usize = 17;

/// Number of lines of a text by which a profile is recognised.
const LOOKED_AT: usize = 4;

/// Whether the first lines of a text are those of a profile: one or two numbers each, or one beside a counter.
pub(super) fn looks_like_profile(start: &[u8]) -> bool {
    let text = decoded(start);
    // The last line may be truncated.
    let whole = text.rsplit_once(['\n', '\r']).map_or("", |(whole, _)| whole);
    let Ok(heading) = Heading::of(whole) else { return false };
    let lines: Vec<usize> = data_lines(whole, heading.first).take(LOOKED_AT).map(|(_, row)| columns(row)).collect();
    let titles = &heading.titles;
    let is_profile_of_three = titles.flag().is_some() || titles.counts_rows() && !titles.are_of_points();
    let is_narrow = |n: &usize| *n <= 2 || *n == 3 && is_profile_of_three;
    lines.len() > 1 && lines.iter().all(is_narrow) && !heading.says_whole_size()
}

/// Reads a profile from a text: lines x and height, or heights alone, one to a line or all in one line.
///
/// `missing` has the marks of missing points that the user gives.
///
/// # Errors
/// [`FormatError::Columns`] for other columns, and [`FormatError::Irregular`] for uneven steps.
pub(super) fn parse(bytes: &[u8], missing: &[f64]) -> Result<HeightMap, FormatError> {
    let text = decoded(bytes);
    let text = without_count(&text).map_or(text, Cow::Owned);
    let heading = Heading::of(&text)?;
    let mut rows = data_lines(&text, heading.first);
    let Some((_, first)) = rows.next() else {
        return Err(FormatError::NoNumbers { expected: "give lines x and height, or a height in each line" });
    };
    let (width, is_one_row) = (columns(first), rows.next().is_none());
    let (x, mut heights, units) = if is_one_row && width > 3 {
        (None, row_of_heights(&text, &heading)?, [None; 2])
    } else if width == 1 {
        (None, of_columns(&text, &heading, (1, [0, 0]))?.1, [None; 2])
    } else {
        let columns = heading.titles.of_profile(width)?;
        let (x, heights) = of_columns(&text, &heading, (width, columns))?;
        (Some(x), heights, heading.titles.units_of_profile(columns)?)
    };
    Marks::new(missing, &heading.missing).erase(&mut heights);
    let mut map = of_points(x, heights)?;
    let [unit_of_x, unit_of_heights] = units.map(|unit| unit.or(heading.unit_of_all()));
    if let (Some(unit), Some(sides)) = (unit_of_x, &mut map.sides) {
        crate::map::scale(sides, unit.metres());
        map.side_unit = Unit::Metre;
    }
    let (unit, factor) =
        unit_of_heights.map_or_else(|| heading.of_heights(), |unit| Ok((Unit::Metre, unit.metres())))?;
    crate::map::scale(map.heights.values_mut(), factor);
    map.height_unit = unit;
    Ok(map)
}

/// A text without the number of its points, which may stand alone in a line before them. The line is blank then.
///
/// `None` if there is no such line.
fn without_count(text: &str) -> Option<String> {
    let heading = Heading::of(text).ok()?;
    let mut rows = data_lines(text, heading.first);
    let ((_, count), (_, row)) = (rows.next()?, rows.next()?);
    // Some programs count the points, others the steps.
    let is_count = columns(count) == 1 && columns(row) > 1 && count.trim().parse::<usize>().is_ok();
    let line = |(n, line): (usize, &str)| if n == heading.first { "\n".to_owned() } else { format!("{line}\n") };
    is_count.then(|| raw_lines(text).map(line).collect())
}

/// Places, each with its number of digits behind the point, and heights.
type Points = (Vec<(f64, usize)>, Vec<f64>);

/// The places and heights of the text, which are in these of `width` columns.
fn of_columns(text: &str, heading: &Heading, (width, columns): (usize, [usize; 2])) -> Result<Points, FormatError> {
    let (mut x, mut heights, flag) = (Vec::new(), Vec::new(), heading.titles.flag());
    for (line, row) in data_lines(text, heading.first) {
        let (words, comma) = words(row);
        let all: Vec<&str> = words.collect();
        let filled = all.iter().rposition(|word| !word.is_empty()).map_or(0, |last| last + 1);
        if all.len() < width || filled > width {
            let expected = format!("but the lines before have {width}");
            return Err(FormatError::Columns { line, found: filled, expected });
        }
        let value = |column: usize| {
            let no_number = || FormatError::NoNumber { line, value: column + 1, text: shown(all[column]) };
            cell(all[column], comma).ok_or_else(no_number)
        };
        let (place, height) = (value(columns[0])?, value(columns[1])?);
        if width > 1 && !place.is_finite() {
            return Err(FormatError::NoNumber { line, value: columns[0] + 1, text: shown(all[columns[0]]) });
        }
        x.push((place, decimals(all[columns[0]])));
        let is_valid = flag.and_then(|flag| all.get(flag)).is_none_or(|word| word.trim() != "0");
        heights.push(if is_valid { height } else { f64::NAN });
    }
    Ok((x, heights))
}

/// The heights of a text of one line.
fn row_of_heights(text: &str, heading: &Heading) -> Result<Vec<f64>, FormatError> {
    let Some((line, row)) = data_lines(text, heading.first).next() else { return Ok(Vec::new()) };
    let (words, comma) = words(row);
    let no_number = |(i, word): (usize, &str)| {
        let error = || FormatError::NoNumber { line, value: i + 1, text: shown(word) };
        cell(word, comma).ok_or_else(error)
    };
    words.take(columns(row)).enumerate().map(no_number).collect()
}

/// Number of digits behind the decimal point of a number. An exponent makes it that of an exact number.
fn decimals(word: &str) -> usize {
    if word.contains(['e', 'E', 'd', 'D']) {
        return EXACT;
    }
    word.rsplit_once(['.', ',']).map_or(0, |(_, digits)| digits.len())
}

/// The profile of heights at these places, which have as many digits behind the point, or at unknown equal steps.
pub(super) fn of_points(x: Option<Vec<(f64, usize)>>, mut heights: Vec<f64>) -> Result<HeightMap, FormatError> {
    let grid = Grid::new(heights.len(), 1)?;
    let Some(x) = x else {
        return Ok(HeightMap::new(field(grid, heights), Unit::Unnamed, None, Unit::Unnamed));
    };
    let digits = x.iter().map(|(_, digits)| *digits).max().unwrap_or(0);
    let places: Vec<f64> = x.into_iter().map(|(place, _)| place).collect();
    let step = even_step(&places, 10_f64.powi(-(digits as i32)))?;
    if step < 0.0 {
        heights.reverse();
    }
    let length = step.abs() * heights.len() as f64;
    let map = HeightMap::new(field(grid, heights), Unit::Unnamed, Some([length; 2]), Unit::Unnamed);
    Ok(if step < 0.0 { map.with_note(ReadNote::PointsReversed) } else { map })
}

/// The step of places that are even to [`EVEN`], or to the rounding by `last_digit` with which they were written.
fn even_step(x: &[f64], last_digit: f64) -> Result<f64, FormatError> {
    let [first, .., last] = x else {
        return Err(FormatError::Irregular(
            "a profile of one point; give two columns x and height, with at least two points".to_owned(),
        ));
    };
    let step = (last - first) / (x.len() - 1) as f64;
    let is_rounded = x.len() >= ENOUGH && last_digit <= COARSEST * step.abs();
    let farthest = if is_rounded { last_digit.max(EVEN * step.abs()) } else { EVEN * step.abs() };
    let off = |i: &usize| {
        let from_place = (x[i + 1] - first - (i + 1) as f64 * step).abs();
        let of_step = (x[i + 1] - x[*i] - step).abs();
        // Rounding errors of the arithmetic come on top.
        from_place.min(of_step) > farthest * (1.0 + 1e-6) || from_place.is_nan()
    };
    if step == 0.0 || !step.is_finite() {
        let ends = format!("x of the profile goes from {first:e} to {last:e}; it must have equal steps");
        return Err(FormatError::Irregular(ends));
    }
    match (0..x.len() - 1).find(off) {
        None => Ok(step),
        Some(i) => Err(FormatError::Irregular(format!(
            "the points of the profile are not equally spaced along x: from point {} to {} it is {}, and in the mean {}; give \
             lines x z with equal steps of x",
            i + 1,
            i + 2,
            digits(x[i + 1] - x[i], 6),
            digits(step, 6)
        ))),
    }
}

/// The profile in an array of one row, one column, or two columns x and height.
pub(super) fn of_array(values: Vec<f64>, [ny, nx]: [u64; 2]) -> Result<HeightMap, FormatError> {
    if nx == 2 && ny > 2 {
        let (pairs, _) = values.as_chunks::<2>();
        if let Some(i) = pairs.iter().position(|[x, _]| !x.is_finite()) {
            return Err(FormatError::Irregular(format!("x of point {i} (from 0) is not finite")));
        }
        let x = pairs.iter().map(|[x, _]| (*x, EXACT)).collect();
        return of_points(Some(x), pairs.iter().map(|[_, height]| *height).collect());
    }
    if nx.min(ny) > 1 {
        return Err(FormatError::Map { columns: nx, rows: ny });
    }
    of_points(None, values)
}

/// A map of one row or one column as a profile.
///
/// # Errors
/// [`FormatError::Map`] for more.
pub(super) fn of_map(map: HeightMap) -> Result<HeightMap, FormatError> {
    let grid = map.heights.grid();
    let (nx, ny) = (grid.nx(), grid.ny());
    let along = match (nx, ny) {
        (_, 1) => 0,
        (1, _) => 1,
        _ => return Err(FormatError::Map { columns: nx as u64, rows: ny as u64 }),
    };
    let sides = map.sides.map(|sides| [sides[along]; 2]);
    let heights = match along {
        0 => map.heights,
        _ => field(Grid::new(ny, 1)?, transposed(map.heights.values(), Grid::new(ny, 1)?)),
    };
    Ok(HeightMap { heights, sides, ..map })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> HeightMap {
        parse(text.as_bytes(), &[]).expect(text)
    }

    #[test]
    fn profiles_are_read_in_every_way_they_are_written() {
        let (x, heights) = ([8e-6; 2], [1e-9, 2e-9, 3e-9, 5e-9]);
        let texts = [
            "x [um],z [nm]\n0,1\n2,2\n4,3\n6,5\n",
            "x (µm)\tz (nm)\n1,5\t1\n3,5\t2\n5,5\t3\n7,5\t5\n",
            "index;x in µm;z in nm\n1;0;1\n2;2;2\n3;4;3\n4;6;5\n",
            "Lateral um,Height nm,\n6.0,5,,\n4.0,3,,\n2.0,2,,\n0.0,1,,\n",
            "µm nm\n0 1\n2.01 2\n4 3\n6 5\n",
        ];
        for text in texts {
            let map = read(text);
            assert_eq!((map.side_unit, map.height_unit), (Unit::Metre, Unit::Metre), "{text}");
            let sides = map.sides.expect("sides");
            assert!((sides[0] / x[0] - 1.0).abs() < 1e-12 && sides[0].to_bits() == sides[1].to_bits(), "{text}");
            for (found, expected) in map.heights.values().iter().zip(heights) {
                assert!((found / expected - 1.0).abs() < 1e-12, "{text}: {found}");
            }
        }
        for text in ["1\n2\n3\n5\n", "1,2,3,5\n", "z\n1\n2\n3\n5\n"] {
            let map = read(text);
            assert_eq!((map.heights.values(), map.sides), (&[1.0, 2.0, 3.0, 5.0][..], None), "{text}");
        }
    }

    #[test]
    fn holes_are_missing_and_uneven_steps_are_refused() {
        let map = read("0 1\n1 NaN\n2 3\n");
        assert_eq!((map.missing(), map.sides), (1, Some([3.0; 2])));
        assert_eq!(parse(b"0,1\n1,-9999\n2,3\n", &[-9999.0]).expect("a profile").missing(), 1);
        for (text, expected) in [
            ("0 1\n1 2\n2.5 1\n3 1\n", "from point 2 to 3 it is 1.5, and in the mean 1"),
            ("0 1\n1.03 2\n2 1\n", "not equally spaced"),
            ("0 1\n0 2\n0 3\n", "equal steps"),
            ("0 1\nnan 2\n2 3\n", "line 2, value 1"),
            ("0 1\n1\n", "line 2 has 1 value"),
            ("0 1 2\n1 2 3\n", "3 columns"),
        ] {
            let error = parse(text.as_bytes(), &[]).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }

    #[test]
    fn names_above_units_flags_and_a_count_of_points_are_known() {
        let flagged = "X;Y;valid\n[mm];[um];[1/0]\n8.0;1.5;1\n8.5;99;0\n9.0;2.5;1\n";
        assert!(looks_like_profile(flagged.as_bytes()));
        let map = read(flagged);
        assert_eq!((map.missing(), map.sides), (1, Some([1.5e-3; 2])));
        assert!((map.heights.values()[2] / 2.5e-6 - 1.0).abs() < 1e-12, "{:?}", map.heights.values());
        for text in ["um nm\n3\n0 1\n2 3\n4 5\n", "um nm\n0 1\n2 3\n4 5\n"] {
            let map = read(text);
            assert_eq!((map.heights.values().len(), map.side_unit), (3, Unit::Metre), "{text}");
            assert!((map.sides.expect("sides")[0] / 6e-6 - 1.0).abs() < 1e-12, "{text}");
        }
        assert!(parse(b"4.5\n0 1\n2 3\n4 5\n", &[]).is_err(), "no number of points");
    }

    /// Steps of 0.156 with one digit behind the point are uneven, and even to their rounding.
    #[test]
    fn rounded_places_are_even() {
        let text = |n: usize| (0..n).map(|i| format!("{:.1} {i}\n", 0.156 * i as f64)).collect::<Vec<_>>().concat();
        let sides = read(&text(400)).sides.expect("sides");
        assert!((sides[0] / (400.0 * 0.156) - 1.0).abs() < 2e-3, "{sides:?}");
        assert!(parse(text(20).as_bytes(), &[]).is_err(), "too few to tell");
    }

    #[test]
    fn a_profile_is_recognised() {
        for text in ["1\n2\n3\n", "x,z\n1,2\n2,3\n", "index,x,z\n1,1,2\n2,2,3\n3,"] {
            assert!(looks_like_profile(text.as_bytes()), "{text}");
        }
        for text in ["1 2 3\n4 5 6\n", "x,y,z\n1,2,3\n2,3,4\n", "# Width: 2 um\n# Height: 2 um\n1 2\n3 4\n", ""] {
            assert!(!looks_like_profile(text.as_bytes()), "{text}");
        }
    }
}
