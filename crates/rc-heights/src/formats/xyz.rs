//! Lists of points on a regular grid, with `x y z` in each line.
//!
//! Points may have any order, and points may be missing.

use super::decode::decoded;
use super::field::field;
use super::fields::{refused, shown};
use super::heading::Heading;
use super::lines::{data_lines, number, words};
use crate::{Format, FormatError, HeightMap, Unit};

use rc_core::Grid;
use rc_core::quantity::digits;

/// Maximum number of grid points for each point of the list.
///
/// Scattered points would otherwise make a grid of any size.
const MOST_MISSING: usize = 16;

/// Maximum difference of coordinates on one grid line, relative to their range. The lines of a grid are further apart.
const SAME_LINE: f64 = 2e-7;

/// Whether a text looks like a list of points.
///
/// The first lines must have three numbers each, and no line before them may say that they are rows of a map.
pub(super) fn looks_like_points(start: &[u8]) -> bool {
    let text = decoded(start);
    // The last line may be truncated.
    let whole = text.rsplit_once(['\n', '\r']).map_or("", |(whole, _)| whole);
    let Ok(heading) = Heading::of(whole) else { return false };
    let three = |(_, line): (usize, &str)| {
        let (words, comma) = words(line);
        words.filter(|word| number(word, comma).is_some()).count() == 3
    };
    let lines: Vec<bool> = data_lines(whole, heading.first).map(three).collect();
    !heading.is_of_rows() && lines.len() + heading.titles.len().min(1) > 2 && lines.iter().all(|three| *three)
}

/// Whether the first lines of a text have enough numbers to show its layout.
pub(super) fn has_numbers(start: &[u8]) -> bool {
    const ENOUGH: usize = 4;
    let text = decoded(start);
    let whole = text.rsplit_once(['\n', '\r']).map_or("", |(whole, _)| whole);
    Heading::of(whole).is_ok_and(|heading| data_lines(whole, heading.first).take(ENOUGH).count() == ENOUGH)
}

pub(super) fn parse(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let text = decoded(bytes);
    let heading = Heading::of(&text)?;
    let order = order(&heading.titles)?;
    let points = points(&text, heading.first, order)?;
    let mut map = on_grid(points)?;
    let units = order.map(|i| heading.units_of_titles()[i]);
    // If only one of them has a unit, it applies to both.
    let both = units[0].or(units[1]).zip(units[1].or(units[0]));
    if let (Some((x, y)), Some(sides)) = (both, &mut map.sides) {
        *sides = [sides[0] * x.metres(), sides[1] * y.metres()];
        map.side_unit = Unit::Metre;
    }
    let (unit, factor) = units[2].map_or_else(|| heading.of_heights(), |unit| Ok((Unit::Metre, unit.metres())))?;
    crate::map::scale(map.heights.values_mut(), factor);
    map.height_unit = unit;
    Ok(map)
}

/// First words of titles that count points.
const COUNTS: [&str; 12] = ["index", "idx", "id", "no", "nr", "num", "number", "point", "row", "line", "col", "column"];

/// The columns of x, y and height.
///
/// The columns of x and y have titles that begin with these letters, and the third is the height. Without such titles
/// they are the first three columns.
///
/// # Errors
/// [`FormatError::Field`] when titles belong to other columns.
fn order(titles: &[String]) -> Result<[usize; 3], FormatError> {
    let [a, b, c] = titles else { return Ok([0, 1, 2]) };
    let at = |letter: &str| titles.iter().position(|title| title.to_lowercase().starts_with(letter));
    let is_count = |title: &String| {
        let title = title.to_lowercase();
        let word = title.split(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
        COUNTS.contains(&word)
    };
    let (x, y) = (at("x"), at("y"));
    // Words before the numbers may also be a remark.
    let in_place = x.is_none_or(|x| x == 0) && y.is_none_or(|y| y == 1);
    match (x, y) {
        _ if titles.iter().any(is_count) => {}
        (Some(x), Some(y)) => return Ok([x, y, 3 - x - y]),
        _ if in_place => return Ok([0, 1, 2]),
        _ => {}
    }
    let found = format!("{a}, {b}, {c}");
    Err(refused(Format::Xyz, "titles of columns", &found, "x, y and height in any order, without other columns"))
}

fn irregular(message: String) -> FormatError {
    FormatError::Irregular(message + "; layout = matrix reads each line as a row of the map")
}

pub(super) fn on_grid(points: Vec<[f64; 3]>) -> Result<HeightMap, FormatError> {
    let axes = [Axis::of("x", &points, |point| point[0])?, Axis::of("y", &points, |point| point[1])?];
    let grid = Grid::new(axes[0].n, axes[1].n)?;
    if grid.len() > MOST_MISSING * points.len() {
        let message =
            format!("{} points on {grid} grid lines; fewer than one in {MOST_MISSING} is present", points.len());
        return Err(irregular(message));
    }
    let mut values = vec![f64::NAN; grid.len()];
    let mut seen = vec![false; grid.len()];
    for [x, y, z] in points {
        let i = grid.index(axes[0].line(x)?, axes[1].line(y)?);
        if std::mem::replace(&mut seen[i], true) {
            return Err(irregular(format!("two points are at x = {}, y = {}", digits(x, 9), digits(y, 9))));
        }
        values[i] = z;
    }
    let sides = Some([axes[0].step * grid.nx() as f64, axes[1].step * grid.ny() as f64]);
    Ok(HeightMap::new(field(grid, values), Unit::Unnamed, sides, Unit::Unnamed))
}

/// The points from line `first` on. `order` has the columns of x, y and height.
fn points(text: &str, first: usize, order: [usize; 3]) -> Result<Vec<[f64; 3]>, FormatError> {
    let mut points = Vec::new();
    for (line, row) in data_lines(text, first) {
        let (words, comma) = words(row);
        let words: Vec<&str> = words.take(4).collect();
        if words.len() != 3 {
            let expected = "but a point has three: x, y, z".to_owned();
            return Err(FormatError::Columns { line, found: words.len(), expected });
        }
        let mut point = [0.0; 3];
        for (i, (to, at)) in point.iter_mut().zip(order).enumerate() {
            let no_number = || FormatError::NoNumber { line, value: at + 1, text: shown(words[at]) };
            *to = number(words[at], comma).filter(|value| i == 2 || value.is_finite()).ok_or_else(no_number)?;
        }
        points.push(point);
    }
    Ok(points)
}

/// Evenly spaced grid lines.
struct Axis {
    name: &'static str,
    first: f64,
    step: f64,
    n: usize,
}

impl Axis {
    fn of(name: &'static str, points: &[[f64; 3]], coordinate: impl Fn(&[f64; 3]) -> f64) -> Result<Self, FormatError> {
        let mut all: Vec<f64> = points.iter().map(coordinate).collect();
        all.sort_by(f64::total_cmp);
        let (first, last) = (all.first().copied().unwrap_or(0.0), all.last().copied().unwrap_or(0.0));
        let same = SAME_LINE * (last - first);
        let n = 1 + all.windows(2).filter(|pair| pair[1] - pair[0] > same).count();
        let step = (last - first) / (n.max(2) - 1) as f64;
        if n < 2 || !step.is_finite() {
            return Err(irregular(format!("{n} different values of {name}; a grid needs at least two")));
        }
        Ok(Self { name, first, step, n })
    }

    /// The grid line of `coordinate`.
    fn line(&self, coordinate: f64) -> Result<usize, FormatError> {
        let at = (coordinate - self.first) / self.step;
        let line = at.round();
        if (at - line).abs() > 0.1 {
            let Self { name, first, step, n } = self;
            let [coordinate, first, step] = [coordinate, *first, *step].map(|x| digits(x, 9));
            return Err(irregular(format!(
                "{name} = {coordinate} is not one of the {n} values from {first} in steps of {step}"
            )));
        }
        Ok((line as usize).min(self.n - 1))
    }
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
            let map = parse(text.as_bytes()).expect(text);
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
            ("0 0 1\n1 0 2\n1.4 1 3\n", "not one of the 3 values"),
            ("0 0 1\n1 0 2\n", "of y"),
            ("", "of x"),
            (&scattered, "one in 16"),
        ];
        for (text, expected) in cases {
            let error = parse(text.as_bytes()).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }

    #[test]
    fn titles_give_units_and_the_order_of_columns() {
        let map = parse("Z_(nm),X_(mm),Y_(mm)\n1,0,0\n2,1,0\n3,0,2\n4,1,2\n".as_bytes()).expect("a map");
        assert_eq!((map.sides, map.side_unit, map.height_unit), (Some([2e-3, 4e-3]), Unit::Metre, Unit::Metre));
        assert_eq!(map.heights.values(), [1.0, 2.0, 3.0, 4.0].map(|nm| nm * 1e-9));
        let map = parse(b"X,Y,Z\n0,0,1\n1,0,2\n0,2,3\n1,2,4\n").expect("a map");
        assert_eq!((map.side_unit, map.height_unit), (Unit::Unnamed, Unit::Unnamed));
    }

    #[test]
    fn titles_of_x_and_y_leave_the_height_and_titles_of_counts_are_refused() {
        let map = parse(b"Y,X,Height\n0,0,1\n0,1,2\n2,0,3\n2,1,4\n").expect("a map");
        assert_eq!((map.sides, map.heights.values()), (Some([2.0, 4.0]), &[1.0, 2.0, 3.0, 4.0][..]));
        for titles in ["X,Y,index", "Index,x,height", "row,column,height", "time,x,z"] {
            let error = parse(format!("{titles}\n0,0,1\n1,0,2\n0,2,3\n1,2,4\n").as_bytes()).expect_err(titles);
            assert!(error.to_string().contains("titles of columns"), "{titles}: {error}");
        }
        let map = parse(b"x [mm];y;z [nm]\n0;0;1\n1;0;2\n0;2;3\n1;2;4\n").expect("a map");
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
