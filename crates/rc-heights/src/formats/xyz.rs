//! Lists of points, `x y z` a line, in any order, on a regular grid; points may be missing.

use super::field::field;
use super::fields::shown;
use super::text::{data_lines, number, words};
use crate::{FormatError, HeightMap, Unit};

use rc_core::Grid;

/// Most grid points for each point of the list; scattered points would otherwise make a grid of any size.
const MOST_MISSING: usize = 16;

/// Coordinates that differ by less than this part of their range are the same grid line; a grid has fewer lines.
const SAME_LINE: f64 = 2e-7;

/// Whether the first lines of a text have three numbers each.
pub(super) fn looks_like_points(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    // The last line may be cut off.
    let whole = text.rsplit_once(['\n', '\r']).map_or("", |(whole, _)| whole);
    let three = |(_, line): (usize, &str)| words(line).filter(|word| number(word, true).is_some()).count() == 3;
    let lines: Vec<bool> = data_lines(whole).map(three).collect();
    // One line of a title may come first.
    lines.len() > 2 && lines[1..].iter().all(|three| *three)
}

pub(super) fn parse(bytes: &[u8]) -> Result<HeightMap, FormatError> {
    let points = points(&String::from_utf8_lossy(bytes))?;
    let axes = [Axis::of("x", &points, |point| point[0])?, Axis::of("y", &points, |point| point[1])?];
    let grid = Grid::new(axes[0].n, axes[1].n)?;
    if grid.len() > MOST_MISSING * points.len() {
        let message =
            format!("{} points on {grid} grid lines; fewer than one in {MOST_MISSING} is there", points.len());
        return Err(FormatError::Irregular(message));
    }
    let mut values = vec![f64::NAN; grid.len()];
    let mut seen = vec![false; grid.len()];
    for [x, y, z] in points {
        let i = grid.index(axes[0].line(x)?, axes[1].line(y)?);
        if std::mem::replace(&mut seen[i], true) {
            return Err(FormatError::Irregular(format!("two points are at x = {x}, y = {y}")));
        }
        values[i] = z;
    }
    let sides = Some([axes[0].step * grid.nx() as f64, axes[1].step * grid.ny() as f64]);
    Ok(HeightMap { heights: field(grid, values), height_unit: Unit::Unnamed, sides, side_unit: Unit::Unnamed })
}

fn points(text: &str) -> Result<Vec<[f64; 3]>, FormatError> {
    let mut points = Vec::new();
    for (line, row) in data_lines(text) {
        let words: Vec<&str> = words(row).take(4).collect();
        let parsed: Vec<Option<f64>> = words.iter().map(|word| number(word, row.contains(';'))).collect();
        if points.is_empty() && parsed.iter().all(Option::is_none) {
            continue; // A line of titles.
        }
        if words.len() != 3 {
            let expected = "a point has three: x, y, z".to_owned();
            return Err(FormatError::Columns { line, found: words.len(), expected });
        }
        let mut point = [0.0; 3];
        for (i, (to, value)) in point.iter_mut().zip(&parsed).enumerate() {
            let no_number = || FormatError::NoNumber { line, value: i + 1, text: shown(words[i]) };
            *to = value.filter(|value| i == 2 || value.is_finite()).ok_or_else(no_number)?;
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
            return Err(FormatError::Irregular(format!("{n} different values of {name}; two at least make a grid")));
        }
        Ok(Self { name, first, step, n })
    }

    /// The grid line that `coordinate` is on.
    fn line(&self, coordinate: f64) -> Result<usize, FormatError> {
        let at = (coordinate - self.first) / self.step;
        let line = at.round();
        if (at - line).abs() > 0.1 {
            let Self { name, first, step, n } = self;
            let message = format!("{name} = {coordinate} is none of {n} values from {first} in steps of {step}");
            return Err(FormatError::Irregular(message));
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
            ("0 0 1\n1 0\n", "line 2 has 2 values"),
            ("0 0 1\n1 x 2\n", "line 2, value 2"),
            ("0 0 1\nnan 1 2\n", "line 2, value 1"),
            ("0 0 1\n1 0 2\n0 0 3\n0 1 3\n", "two points"),
            ("0 0 1\n1 0 2\n1.4 1 3\n", "none of 3 values"),
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
    fn a_text_of_points_is_told_from_a_text_of_rows() {
        assert!(looks_like_points(b"x y z\n0 0 1\n0 1 2\n1 0"));
        assert!(!looks_like_points(b"0 0 1 4\n0 1 2 4\n1 0 4 4\n"));
    }
}
