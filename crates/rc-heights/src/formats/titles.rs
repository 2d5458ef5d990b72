//! Titles of the columns of a text.

use super::fields::{refused, shown};
use super::lines::{cell, unquoted, words};
use super::quantity::unit_of;
use crate::{Format, FormatError, LengthUnit};

/// First words of titles that count points, lines or columns.
const COUNTS: [&str; 18] = [
    "index", "idx", "id", "no", "nr", "num", "number", "point", "points", "row", "rows", "line", "lines", "col",
    "column", "columns", "dataline", "i",
];

/// Titles of the columns. They are empty if there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Titles {
    /// The title of each column.
    names: Vec<String>,
    /// Number of the line with the titles, from 1.
    line: usize,
    /// Numbers in the titles of all columns but the first.
    numbers: Option<Vec<f64>>,
}

/// The columns of a list of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Columns {
    /// Columns of x, y and height.
    pub(super) xyz: [usize; 3],
    /// Number of columns.
    pub(super) all: usize,
    /// Whether a column with a title of counts is omitted.
    pub(super) has_counter: bool,
}

impl Titles {
    /// The titles in the line `above` the first `row` of numbers, if it has as many words, or one fewer.
    ///
    /// # Errors
    /// [`FormatError::NoNumber`] when the line is a row of numbers whose first is damaged.
    pub(super) fn above(above: Option<(usize, &str)>, row: &str) -> Result<Self, FormatError> {
        let Some((line, text)) = above else { return Ok(Self::default()) };
        let names = split(text);
        let n = columns(row);
        // A table of R has no title above the names of rows.
        let is_field = names.first().is_some_and(|name| name.ends_with([':', '=']));
        let has_names_of_rows = names.len() + 1 == n && row.trim_start().starts_with('"');
        if is_field || names.len() != n && !has_names_of_rows {
            return Ok(Self::default());
        }
        let of_title = |name: &String| cell(name, false).filter(|number| number.is_finite());
        let numbers: Option<Vec<f64>> = names.get(1..).unwrap_or_default().iter().map(of_title).collect();
        let numbers = numbers.filter(|numbers| !numbers.is_empty());
        let titles = Self { names, line, numbers };
        // The first number is damaged, or these are numbers of columns.
        let may_be_damaged = titles.numbers.as_ref().is_some_and(|numbers| numbers.len() < 3) && !titles.counts_rows();
        if may_be_damaged { Err(titles.damaged()) } else { Ok(titles) }
    }

    /// The titles with those of the line above, if these are units alone.
    pub(super) fn under(self, above: Option<(usize, &str)>) -> Self {
        let is_unit = |name: &String| name.starts_with(['[', '(']) && name.ends_with([']', ')']);
        let names = above.map_or_else(Vec::new, |(_, text)| split(text));
        if self.names.is_empty() || names.len() != self.names.len() || !self.names.iter().all(is_unit) {
            return self;
        }
        let names = names.iter().zip(&self.names).map(|(name, unit)| format!("{name} {unit}")).collect();
        Self { names, ..self }
    }

    /// The column that says which points of a profile are measured: the third, after x and y, called valid.
    pub(super) fn flag(&self) -> Option<usize> {
        let words: Vec<String> = self.names.iter().map(|name| first_word(name)).collect();
        (words == ["x", "y", "valid"]).then_some(2)
    }

    /// The error for titles that are numbers without being titles.
    pub(super) fn damaged(&self) -> FormatError {
        FormatError::NoNumber { line: self.line, value: 1, text: shown(self.names.first().map_or("", String::as_str)) }
    }

    /// Whether a comment looks like titles of coordinates and heights.
    pub(super) fn name_coordinates(comment: &str) -> bool {
        let names = split(comment);
        let has = |letter: &str| names.iter().any(|name| first_word(name) == letter);
        names.len() >= 3 && has("x") && has("y")
    }

    /// Number of titles.
    pub(super) fn len(&self) -> usize {
        self.names.len()
    }

    /// The numbers in the titles of all columns but the first, if all are numbers.
    pub(super) fn numbers(&self) -> Option<&[f64]> {
        self.numbers.as_deref()
    }

    /// The unit in the first title, which is the corner of a table with coordinates at its borders.
    pub(super) fn unit_of_corner(&self) -> Option<LengthUnit> {
        self.names.first().and_then(|name| unit_of_title(name).ok().flatten())
    }

    /// Whether the first title counts rows.
    pub(super) fn counts_rows(&self) -> bool {
        self.names.first().is_some_and(|name| name.is_empty() || is_count(name))
    }

    /// Whether titles are those of points x, y and height.
    pub(super) fn are_of_points(&self) -> bool {
        let has = |letter| self.at(letter).is_some();
        has("x") && has("y") && self.columns().is_ok_and(|columns| columns.is_some())
    }

    /// Column of the title that is a letter or a word, or else of the first that begins with it.
    fn at(&self, word: &str) -> Option<usize> {
        let place = |is: &dyn Fn(&String) -> bool| self.names.iter().position(is);
        place(&|name| is_only(name, word))
            .or_else(|| place(&|name| first_word(name) == word))
            .or_else(|| place(&|name| name.to_lowercase().starts_with(word)))
    }

    /// Refuses two titles of the same coordinate, as `x_px` and `x_um`.
    fn check_twice(&self) -> Result<(), FormatError> {
        for letter in ["x", "y", "z"] {
            let same: Vec<&str> =
                self.names.iter().filter(|name| first_word(name) == letter).map(String::as_str).collect();
            if same.len() > 1 && !same.iter().any(|name| is_only(name, letter)) {
                let expected = "one column of each coordinate; remove the others";
                return Err(refused(Format::Xyz, "titles of columns", &same.join(", "), expected));
            }
        }
        Ok(())
    }

    /// The columns of x, y and height. `None` if there are no titles of points.
    ///
    /// The columns of x and y have titles that begin with these letters. Of three columns, the other is the height. Of
    /// more, it begins with z or is called height, and the others are ignored.
    ///
    /// # Errors
    /// [`FormatError::Field`] when titles belong to other columns, and [`FormatError::Profile`] when there are two
    /// beside a counter.
    pub(super) fn columns(&self) -> Result<Option<Columns>, FormatError> {
        let all = self.names.len();
        if all < 3 {
            return Ok(None);
        }
        if self.flag().is_some() {
            return Err(FormatError::profile_in_text("a text of x and height beside a flag"));
        }
        let (x, y) = (self.at("x"), self.at("y"));
        let z = self.at("z").or_else(|| self.at("height")).or_else(|| self.at("depth"));
        let has_counter = self.names.iter().any(|name| name.is_empty() || is_count(name));
        let found = |xyz, has_counter| Ok(Some(Columns { xyz, all, has_counter }));
        // Words before the numbers may also be a remark.
        let in_place = x.is_none_or(|x| x == 0) && y.is_none_or(|y| y == 1);
        match (x, y, z) {
            (Some(x), Some(y), Some(z)) if all > 3 => {
                self.check_twice()?;
                return found([x, y, z], has_counter);
            }
            _ if all > 3 => return Ok(None),
            (Some(1), Some(2), None) if has_counter => {
                return Err(FormatError::profile_in_text("a text of two columns beside a counter"));
            }
            _ if has_counter => {}
            (Some(x), Some(y), _) => return found([x, y, 3 - x - y], false),
            _ if in_place => return found([0, 1, 2], false),
            _ => {}
        }
        let expected = "x, y and height in any order, without other columns";
        Err(refused(Format::Xyz, "titles of columns", &self.names.join(", "), expected))
    }

    /// The columns of x and height of a profile of `width` columns.
    ///
    /// # Errors
    /// [`FormatError::Field`] when titles do not say which of more than two columns they are.
    pub(super) fn of_profile(&self, width: usize) -> Result<[usize; 2], FormatError> {
        if self.flag().is_some() {
            return Ok([0, 1]);
        }
        let is_counter = |i: &usize| self.names.get(*i).is_some_and(|name| name.is_empty() || is_count(name));
        let columns: Vec<usize> = (0..width).filter(|i| !is_counter(i)).collect();
        let named = |words: &[&str], other: Option<usize>| {
            let is = |i: &usize| self.names.get(*i).is_some_and(|name| words.contains(&first_word(name).as_str()));
            columns.iter().copied().filter(|i| Some(*i) != other).find(is)
        };
        let x = named(&["x", "lateral", "position", "distance", "length"], None);
        let height = named(&["z", "height", "heights", "depth", "profile", "raw"], x);
        let rest = |other: Option<usize>| columns.iter().copied().find(|i| Some(*i) != other);
        match (x, height) {
            (Some(x), Some(height)) => Ok([x, height]),
            _ if columns.len() != 2 => {
                let found = if self.names.is_empty() { format!("{width} columns") } else { self.names.join(", ") };
                let expected = "x and height, with titles if there are other columns";
                Err(refused(Format::Csv, "columns of a profile", &found, expected))
            }
            (x, Some(height)) => Ok([x.or(rest(Some(height))).unwrap_or(0), height]),
            (x, None) => {
                let x = x.or(rest(None));
                Ok([x.unwrap_or(0), rest(x).unwrap_or(1)])
            }
        }
    }

    /// The units of x and height of a profile. If only one unit is named, it is that of both.
    ///
    /// # Errors
    /// [`FormatError::Field`] for a unit in brackets that is none of length.
    pub(super) fn units_of_profile(&self, [x, height]: [usize; 2]) -> Result<[Option<LengthUnit>; 2], FormatError> {
        // A title may be a unit alone.
        let alone = |column: usize| self.names.get(column).and_then(|name| unit_of(name));
        let [of_x, of_heights, _] = self.units([x, height, height])?;
        Ok([of_x.or(alone(x)), of_heights.or(alone(height))])
    }

    /// The units of three columns. If only one unit is named, it is that of all three.
    ///
    /// # Errors
    /// [`FormatError::Field`] for a unit in brackets that is none of length.
    pub(super) fn units(&self, columns: [usize; 3]) -> Result<[Option<LengthUnit>; 3], FormatError> {
        let mut units = [None; 3];
        for (unit, column) in units.iter_mut().zip(columns) {
            let Some(title) = self.names.get(column) else { continue };
            let refused = |found: &str| {
                let expected = "a unit of length, as in z [um]";
                refused(Format::Xyz, "unit in a title", &format!("{found} ({title})"), expected)
            };
            *unit = unit_of_title(title).map_err(refused)?;
        }
        let mut named = units.into_iter().flatten();
        let first = named.next();
        Ok(if first.is_some() && named.all(|unit| Some(unit) == first) { [first; 3] } else { units })
    }
}

/// Number of values of a row, without empty fields at its end.
pub(super) fn columns(row: &str) -> usize {
    let words: Vec<&str> = words(row).0.collect();
    words.len() - words.iter().rev().take_while(|word| word.is_empty()).count()
}

/// The titles of a line. A unit in brackets belongs to the title before it.
fn split(text: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let is_list = text.contains([',', ';', '\t']);
    for word in words(text.trim_matches(' ')).0.map(unquoted) {
        let belongs = !is_list
            && (word.starts_with(['[', '(', '/']) || names.last().is_some_and(|name| name.ends_with(['/', '_'])));
        match names.last_mut().filter(|_| belongs) {
            Some(name) => *name = format!("{name} {word}"),
            None => names.push(word.to_owned()),
        }
    }
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    names
}

fn first_word(title: &str) -> String {
    let lower = title.to_lowercase();
    lower.split(|c: char| !c.is_alphabetic()).find(|word| !word.is_empty()).unwrap_or_default().to_owned()
}

fn is_count(title: &str) -> bool {
    title == "#" || COUNTS.contains(&first_word(title).as_str())
}

/// Whether a title is a word, with or without a unit in brackets.
fn is_only(title: &str, word: &str) -> bool {
    let name = title.split(['[', '(']).next().unwrap_or_default();
    name.trim_matches(|c: char| !c.is_alphanumeric()).eq_ignore_ascii_case(word)
}

/// Words in brackets that are no units.
const NO_UNITS: [&str; 9] = ["height", "heights", "depth", "x", "y", "z", "row", "column", "raw"];

/// The unit in a title such as `X_(microns)`, `z [nm]`, `y/µm` or `x in mm`.
///
/// It is in brackets, or the last word of a title of two or more words.
///
/// # Errors
/// What is in brackets, if it is no unit of length.
fn unit_of_title(title: &str) -> Result<Option<LengthUnit>, &str> {
    if let Some((_, inside)) = title.rsplit_once(['[', '(']) {
        let inside = inside.trim_end_matches(|c: char| "]) _".contains(c)).trim();
        if !inside.is_empty() && !NO_UNITS.contains(&inside.to_lowercase().as_str()) {
            return unit_of(inside).map(Some).ok_or(inside);
        }
    }
    let is_letter = |c: char| c.is_alphabetic() || "\u{b5}\u{3bc}~".contains(c);
    let words: Vec<&str> = title.split(|c: char| !is_letter(c)).filter(|word| !word.is_empty()).collect();
    Ok(words.split_last().filter(|(_, before)| !before.is_empty()).and_then(|(last, _)| unit_of(last)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn units(titles: &str) -> [Option<LengthUnit>; 3] {
        let titles = Titles::above(Some((1, titles)), "0 0 1").expect("titles");
        titles.units([0, 1, 2]).expect("units")
    }

    #[test]
    fn titles_name_units() {
        let (um, nm, mm) = (Some(LengthUnit::Micrometre), Some(LengthUnit::Nanometre), Some(LengthUnit::Millimetre));
        let cases = [
            ("X_(microns),Y,Z", [um; 3]),
            ("x [µm];y [µm];z [nm]", [um, um, nm]),
            ("x/µm\ty/µm\tz/nm", [um, um, nm]),
            ("X[nm]\tY[nm]\tZ[nm]", [nm; 3]),
            ("x [um]  y [um]  z [nm]", [um, um, nm]),
            (" X(mm),Y(mm),Z(um)", [mm, mm, um]),
            ("\"X (MM)\",\"Y (MM)\",\"Z (UM)\"", [mm, mm, um]),
            ("x / mm y / mm z / um", [mm, mm, um]),
            ("x,y,z", [None; 3]),
        ];
        for (titles, expected) in cases {
            assert_eq!(units(titles), expected, "{titles}");
        }
        for (titles, expected) in [
            ("x [um],y [um],z [V]", "'V (z [V])'"),
            ("x,y,z [10 nm]", "10 nm"),
            ("x (px),y (px),z (um)", "'px (x (px))'"),
        ] {
            let titles = Titles::above(Some((1, titles)), "0 0 1").expect("titles");
            let error = titles.units([0, 1, 2]).expect_err("no length").to_string();
            assert!(error.contains(expected), "{error}");
        }
    }

    #[test]
    fn a_comment_has_titles_if_it_names_x_and_y() {
        for comment in [" x [um]  y [um]  z [nm]", " X(mm),Y(mm),Z(um)", "X\tY\tHeight", "index x y z"] {
            assert!(Titles::name_coordinates(comment), "{comment}");
        }
        for comment in [" x z", " three words here", " Width: 3 um"] {
            assert!(!Titles::name_coordinates(comment), "{comment}");
        }
    }

    #[test]
    fn a_counter_and_other_columns_are_left_out() {
        let columns = |titles: &str| {
            let row = vec!["1"; split(titles).len()].join(",");
            Titles::above(Some((1, titles)), &row).expect("titles").columns()
        };
        let of = |xyz, all, has_counter| Ok(Some(Columns { xyz, all, has_counter }));
        assert_eq!(columns("index,X,Y,Z"), of([1, 2, 3], 4, true));
        assert_eq!(columns(",x,y,z"), of([1, 2, 3], 4, true));
        assert_eq!(columns("x,y,z,intensity"), of([0, 1, 2], 4, false));
        assert_eq!(columns("a,b,c,d"), Ok(None));
        assert_eq!(columns("Y,X,Height"), of([1, 0, 2], 3, false));
        assert_eq!(columns("x,y,z,x velocity"), of([0, 1, 2], 4, false));
        let error = columns("x_px,y_px,x_um,y_um,z_um").expect_err("two of x").to_string();
        assert!(error.contains("x_px, x_um"), "{error}");
    }
}
