//! The lines before the numbers of a text, as instruments and Gwyddion write them.
//!
//! They contain sizes, units and titles of columns.

use super::fields::{refused, shown};
use super::lines::{lines, number, words};
use super::unit;
use crate::{Format, FormatError, LengthUnit, Unit};

/// Names of the size along x, in the languages of Gwyddion.
const WIDTHS: [&str; 10] =
    ["width", "breite", "largeur", "larghezza", "ancho", "largura", "šířka", "ширина", "x size", "xreal"];
/// Names of the size along y.
const HEIGHTS: [&str; 10] =
    ["height", "höhe", "hauteur", "altezza", "alto", "altura", "výška", "высота", "y size", "yreal"];
/// Names of the unit of the heights.
const UNITS: [&str; 8] =
    ["value units", "value unit", "z units", "z unit", "zunits", "data unit", "data units", "einheiten der werte"];
/// Names of the channel.
const CHANNELS: [&str; 6] = ["channel", "kanal", "canal", "canale", "kanál", "канал"];
/// Maximum number of lines before the first number.
const MOST_LINES: usize = 200;

/// A length, with the unit that is given beside it.
type Length = (f64, Option<LengthUnit>);

/// Contents of the lines before the numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Heading {
    /// Number of the line with the first number, from 1.
    pub(super) first: usize,
    /// Name of the channel.
    pub(super) channel: String,
    /// Sides along x and y.
    sides: [Option<Length>; 2],
    /// Distance of points along x and y.
    pixel: Option<Length>,
    /// Numbers of points along x and y.
    counts: [Option<usize>; 2],
    /// Unit of the heights, as written.
    unit: Option<String>,
    /// Metres per number in the text. It overrides the unit.
    metres: Option<f64>,
    /// Titles of the columns.
    pub(super) titles: Vec<String>,
}

impl Heading {
    /// Reads the lines before the numbers of `text`.
    ///
    /// # Errors
    /// [`FormatError::NoNumber`] when there are no numbers, or when the first apparent number is not valid.
    pub(super) fn of(text: &str) -> Result<Self, FormatError> {
        let mut heading = Self::default();
        let mut others: Vec<(usize, &str)> = Vec::new();
        for (line, row) in lines(text) {
            if let Some(comment) = row.strip_prefix(['#', '%']) {
                heading.line(comment);
            } else if words(row).0.next().is_some_and(|word| number(word, words(row).1).is_some()) {
                heading.first = line;
                return heading.with_titles(&others, row);
            } else if others.len() < MOST_LINES {
                heading.line(row);
                others.push((line, row));
            } else {
                break;
            }
        }
        let Some((line, row)) = others.first() else { return Ok(heading) };
        let word = words(row).0.next().unwrap_or_default();
        Err(FormatError::NoNumber { line: *line, value: 1, text: shown(word) })
    }

    /// Reads the last line before the first `row` of numbers as titles.
    ///
    /// It must have as many words as the row.
    fn with_titles(mut self, others: &[(usize, &str)], row: &str) -> Result<Self, FormatError> {
        let Some((line, last)) = others.last() else { return Ok(self) };
        let (titles, comma) = words(last);
        let titles: Vec<&str> = titles.collect();
        if titles.len() != words(row).0.count() {
            return Ok(self);
        }
        if titles.len() > 1 && titles[1..].iter().all(|word| number(word, comma).is_some()) {
            // The first number is damaged, or these are numbers of columns, whose rows begin with numbers too.
            return Err(FormatError::NoNumber { line: *line, value: 1, text: shown(titles[0]) });
        }
        self.titles = titles.into_iter().map(str::to_owned).collect();
        Ok(self)
    }

    /// Reads a line of the form `name: value`, `name = value`, or `a=1 b=2`.
    fn line(&mut self, line: &str) {
        if line.matches('=').count() > 1 {
            for (name, value) in line.split_whitespace().filter_map(|pair| pair.split_once('=')) {
                self.pair(name, value);
            }
        } else if let Some((name, value)) = line.split_once(':').or_else(|| line.rsplit_once('=')) {
            self.pair(name, value);
        } else if let Some((name, value)) = line.split_once(['\t', ';', ',']) {
            self.pair(name, value);
        }
    }

    fn pair(&mut self, name: &str, value: &str) {
        let (whole, lower, value) = (name.trim(), name.trim().to_lowercase(), value.trim());
        // A unit may follow the name, as in `Width [µm]`.
        let (name, unit) = match whole.split_once(['[', '(']) {
            Some((before, unit)) if !lower.starts_with("height conversion") => {
                (before.trim().to_lowercase(), unit.trim_end_matches([']', ')']).trim())
            }
            _ => (lower, ""),
        };
        let is = |names: &[&str]| names.contains(&name.as_str());
        let length = || length(value, unit);
        if is(&WIDTHS) {
            self.sides[0] = length();
        } else if is(&HEIGHTS) {
            self.sides[1] = length();
        } else if is(&["pixel size"]) {
            self.pixel = length();
        } else if is(&["w"]) {
            self.counts[0] = value.parse().ok();
        } else if is(&["h"]) {
            self.counts[1] = value.parse().ok();
        } else if is(&UNITS) {
            self.unit = Some(value.to_owned());
        } else if is(&CHANNELS) {
            value.clone_into(&mut self.channel);
        } else if name.starts_with("height conversion factor") && name.contains("> m") {
            self.metres = number(value, true);
        }
    }

    /// Whether the lines contain the size of the map or its number of points.
    ///
    /// The numbers are then rows of a map.
    pub(super) fn is_of_rows(&self) -> bool {
        self.says_sides() || self.counts.iter().all(Option::is_some)
    }

    /// Whether the lines contain the size of the map.
    pub(super) fn says_sides(&self) -> bool {
        self.pixel.is_some() || self.sides.iter().all(Option::is_some)
    }

    /// Sides of a map of `nx` times `ny` points, and their unit.
    ///
    /// # Errors
    /// [`FormatError::Field`] when the lines have other numbers of points, or a size that is not positive.
    pub(super) fn sides(&self, nx: usize, ny: usize) -> Result<(Option<[f64; 2]>, Unit), FormatError> {
        if let [Some(w), Some(h)] = self.counts
            && (w, h) != (nx, ny)
        {
            let expected = "the numbers of columns and rows that are there; the file is truncated";
            return Err(refused(Format::Csv, "w x h", &format!("{w} x {h}, for {nx} x {ny} numbers"), expected));
        }
        let points = [nx as f64, ny as f64];
        // Numbers of points are not lengths.
        let counts = |[x, y]: [Length; 2]| {
            let same = (x.0 - points[0]).abs() + (y.0 - points[1]).abs() < 1e-9;
            same && x.1.is_none() && y.1.is_none()
        };
        let sides = match self.sides {
            [Some(x), Some(y)] if counts([x, y]) => [None; 2],
            sides => sides,
        };
        let lengths = match (sides, self.pixel) {
            ([Some(x), Some(y)], _) => [x, y],
            (_, Some((pixel, unit))) => [(pixel * points[0], unit), (pixel * points[1], unit)],
            _ => return Ok((None, Unit::Unnamed)),
        };
        if lengths.iter().any(|(side, _)| *side <= 0.0 || !side.is_finite()) {
            let found = format!("{:e} x {:e}", lengths[0].0, lengths[1].0);
            return Err(refused(Format::Csv, "width x height", &found, "two positive lengths"));
        }
        // If only one side has a unit, it applies to both.
        let named = lengths.iter().find_map(|(_, unit)| *unit);
        let metres = |(side, unit): Length| side * unit.or(named).map_or(1.0, LengthUnit::metres);
        Ok((Some(lengths.map(metres)), if named.is_some() { Unit::Metre } else { Unit::Unnamed }))
    }

    /// Unit of the numbers, and the factor that converts them to metres.
    ///
    /// # Errors
    /// [`FormatError::Field`] when the factor is not valid.
    pub(super) fn of_heights(&self) -> Result<(Unit, f64), FormatError> {
        match (self.metres, self.unit.as_deref()) {
            (Some(metres), _) => {
                Ok((Unit::Metre, super::fields::factor(Format::Csv, "height conversion factor", metres)?))
            }
            (None, Some(name)) => Ok(unit::of_values(name)),
            (None, None) => Ok((Unit::Unnamed, 1.0)),
        }
    }

    /// The units in titles of three columns, in their order. A single unit applies to all three.
    pub(super) fn units_of_titles(&self) -> [Option<LengthUnit>; 3] {
        let [a, b, c] = self.titles.as_slice() else { return [None; 3] };
        let units = [a, b, c].map(|title| unit_of_title(title));
        let named: Vec<LengthUnit> = units.into_iter().flatten().collect();
        if let [only] = named.as_slice() { [Some(*only); 3] } else { units }
    }
}

/// The unit in a title such as `X_(microns)`, `z [nm]`, `y/µm` or `x in mm`.
///
/// It is the last word of a title of two or more words.
fn unit_of_title(title: &str) -> Option<LengthUnit> {
    let is_letter = |c: char| c.is_alphabetic() || c == '\u{b5}' || c == '\u{3bc}';
    let words: Vec<&str> = title.split(|c: char| !is_letter(c)).filter(|word| !word.is_empty()).collect();
    let (last, before) = words.split_last()?;
    if before.is_empty() { None } else { unit::length(last) }
}

/// A number with the unit that follows it, or else the unit `beside` its name.
///
/// `None` for numbers of points and other quantities.
fn length(text: &str, beside: &str) -> Option<Length> {
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.,eE".contains(c))).unwrap_or(text.len());
    let (digits, unit) = text.split_at(end);
    let name = if unit.trim().is_empty() { beside } else { unit.trim() };
    let unit = if name.is_empty() { None } else { Some(unit::length(name)?) };
    Some((number(digits.trim_end_matches(['e', 'E', ',']), true)?, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Heading {
        Heading::of(text).expect(text)
    }

    #[test]
    fn sizes_and_units_are_read_in_every_way_they_are_written() {
        let texts = [
            "# Channel: h\n# Width: 10 µm\n# Height: 20,0 µm\n# Value units: nm\n1 2\n",
            "# Kanal: h\n# Breite: 1e-5 m\n# Höhe: 0.02 mm\n# Value units: nm\n1 2\n",
            "Channel;h\nWidth [um];10\nHeight [um];20\nZ units;nm\n1;2\n",
            "Kanal: h\nBreite: 10µm\nHöhe: 20000nm\nZ Unit = nm\n\n1\t2\n",
        ];
        for text in texts {
            let heading = of(text);
            let (sides, unit) = heading.sides(2, 1).expect(text);
            let [x, y] = sides.expect("sides");
            assert!((x / 1e-5 - 1.0).abs() < 1e-12 && (y / 2e-5 - 1.0).abs() < 1e-12, "{text}: {x} x {y}");
            assert_eq!(
                (unit, heading.of_heights(), heading.channel.as_str()),
                (Unit::Metre, Ok((Unit::Metre, 1e-9)), "h"),
                "{text}"
            );
            assert!(heading.is_of_rows());
        }
    }

    #[test]
    fn a_pixel_size_and_a_factor_are_those_of_an_interferometer() {
        let text = "h=1 w=2\npixel size=2.5e-007 m\ndata unit=rad\nheight conversion factor (-> m)=4e-008\n1 2\n";
        let heading = of(text);
        assert_eq!(heading.first, 5);
        assert_eq!(heading.sides(2, 1), Ok((Some([5e-7, 2.5e-7]), Unit::Metre)));
        assert_eq!(heading.of_heights(), Ok((Unit::Metre, 4e-8)));
        let error = heading.sides(2, 2).expect_err("cut off").to_string();
        assert!(error.contains("2 x 1, for 2 x 2"), "{error}");
        assert_eq!(of("# Value units: V\n1 2\n").of_heights(), Ok((Unit::NotLength, 1.0)));
        assert_eq!(of("# Height: 10 px\n# Width: 3 px\n1 2\n").sides(2, 1), Ok((None, Unit::Unnamed)));
    }

    #[test]
    fn sizes_are_lengths_in_one_unit_or_numbers_of_points() {
        let both = of("# Width: 10 µm\n# Height: 20\n1 2\n").sides(2, 1).expect("sides");
        assert_eq!(both, (Some([10.0 * 1e-6, 20.0 * 1e-6]), Unit::Metre));
        let text = "# Width: 2\n# Height: 1\n1 2\n";
        assert_eq!(of(text).sides(2, 1), Ok((None, Unit::Unnamed)), "numbers of points");
        assert_eq!(of(text).sides(4, 1), Ok((Some([2.0, 1.0]), Unit::Unnamed)));
        for other in ["Width (px): 2\nHeight (px): 3\n1 2\n", "Width [A]: 2\nHeight [A]: 3\n1 2\n"] {
            assert_eq!(of(other).sides(2, 1), Ok((None, Unit::Unnamed)), "{other}");
        }
    }

    #[test]
    fn titles_name_units() {
        let (um, nm) = (Some(LengthUnit::Micrometre), Some(LengthUnit::Nanometre));
        assert_eq!(of("X_(microns),Y,Z\n0,0,1\n").units_of_titles(), [um; 3]);
        assert_eq!(of("x [µm];y [µm];z [nm]\n0;0;1\n").units_of_titles(), [um, um, nm]);
        assert_eq!(of("x/µm\ty/µm\tz/nm\n0\t0\t1\n").units_of_titles(), [um, um, nm]);
        assert_eq!(of("x,y,z\n0,0,1\n").units_of_titles(), [None; 3]);
    }

    #[test]
    fn a_damaged_first_number_is_not_a_title() {
        for (text, expected) in
            [("l,2,3\n4,5,6\n", "line 1, value 1: 'l'"), ("nothing\nat all\n", "line 1, value 1: 'nothing'")]
        {
            let error = Heading::of(text).expect_err(text).to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
