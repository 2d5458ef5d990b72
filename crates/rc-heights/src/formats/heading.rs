//! The lines before the numbers of a text, as instruments and Gwyddion write them.
//!
//! They contain sizes, units and titles of columns.

use super::brackets::{in_brackets, is_unit, name_and_unit, unit_of_heights};
use super::fields::{refused, shown};
use super::lines::{cell, comment, is_row_of_cells, lines, number, unquoted, words};
use super::names::Name;
use super::quantity::{Length, lengths, unit_of};
use super::titles::Titles;
use crate::{Format, FormatError, LengthUnit, Unit};

/// Maximum number of lines before the first number. Those of Nanoscope have several hundred.
const MOST_LINES: usize = 4000;
/// Maximum number of comments whose contents count.
const MOST_COMMENTS: usize = 2000;

/// Characters around a line that are no part of its fields.
const AROUND: [char; 9] = ['"', '\'', '\\', '#', '%', '!', '*', '/', '\t'];

/// Contents of the lines before the numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Heading {
    /// Number of the line with the first number, from 1.
    pub(super) first: usize,
    /// Name of the channel.
    pub(super) channel: String,
    /// Titles of the columns.
    pub(super) titles: Titles,
    /// Numbers that mark missing points.
    pub(super) missing: Vec<f64>,
    /// Numbers of points along x and y.
    pub(super) counts: [Option<usize>; 2],
    /// Sides along x and y.
    sides: [Option<Length>; 2],
    /// One length for both sides, or for the longer of them.
    scan: Option<Length>,
    /// Distances of points along x and y.
    spacing: [Option<Length>; 2],
    /// Unit of the heights, as written.
    unit: Option<String>,
    /// Unit of all lengths that have no other.
    of_all: Option<LengthUnit>,
    /// Metres per number in the text. It overrides the unit.
    metres: Option<f64>,
    /// Number of images that have names.
    images: usize,
}

impl Heading {
    /// Reads the lines before the numbers of `text`.
    ///
    /// # Errors
    /// [`FormatError::NoNumber`] when there are no numbers, or when the first apparent number is not valid.
    pub(super) fn of(text: &str) -> Result<Self, FormatError> {
        let mut heading = Self::default();
        let (mut last, mut first_words, mut count, mut n_comments) = (None, None, 0, 0);
        let mut before_last = None;
        for (line, row) in lines(text) {
            if let Some(comment) = comment(row) {
                n_comments += 1;
                // A file of comments alone ends quickly.
                if n_comments > MOST_COMMENTS {
                    continue;
                }
                heading.line(comment);
                if Titles::name_coordinates(comment) {
                    last = Some((line, comment));
                }
                continue;
            }
            // A line of dashes below titles is no row of missing points.
            let is_rule = count > 0 && row.chars().all(|c| "-+|=_ \t".contains(c));
            if !is_rule && begins_numbers(row) {
                heading.first = line;
                heading.titles = Titles::above(last, row)?.under(before_last);
                return Ok(heading);
            }
            count += 1;
            if count > MOST_LINES {
                break;
            }
            if !is_rule {
                heading.line(row);
                before_last = last.replace((line, row));
                first_words = first_words.or(last);
            }
        }
        let Some((line, row)) = first_words else { return Ok(heading) };
        let word = words(row).0.next().unwrap_or_default();
        Err(FormatError::NoNumber { line, value: 1, text: shown(word) })
    }

    /// Reads a line with one field or several, as `name: value`, `name = value`, `name,value`, `name value`, or
    /// `a=1 b=2`.
    fn line(&mut self, line: &str) {
        let line = line.trim_matches(|c: char| c.is_whitespace() || AROUND.contains(&c));
        if let Some(unit) = unit_of_heights(line) {
            self.unit.get_or_insert_with(|| unit.to_owned());
            return;
        }
        let parts = |separator: &'static str| {
            let parts: Vec<&str> = line.split(separator).collect();
            (parts.len() > 1 && parts.iter().all(|part| part.contains([':', '=']))).then_some(parts)
        };
        if let Some(parts) = [";", ", ", "\t", "|"].into_iter().find_map(parts) {
            for part in parts {
                self.field(part);
            }
        } else if line.matches('=').count() > 1 {
            self.assignments(line);
        } else {
            self.field(line);
        }
    }

    /// Reads `a=1 b=2`. The name is the word before `=`, and the value ends before the next name.
    fn assignments(&mut self, line: &str) {
        let Some((mut name, mut rest)) = line.split_once('=') else { return };
        while let Some((value, after)) = rest.split_once('=') {
            let (value, next) = value.trim().rsplit_once([' ', '\t', ',', ';']).unwrap_or((value, ""));
            self.pair(name, value);
            (name, rest) = (next, after);
        }
        self.pair(name, rest);
    }

    /// Reads one field, whose name and value are separated by any of these characters, or by a blank.
    fn field(&mut self, line: &str) {
        // Nanoscope puts a number before some names.
        let line = line.strip_prefix('@').and_then(|line| line.split_once(':')).map_or(line, |(_, field)| field);
        for separator in [':', '=', '\t', ';', ','] {
            if line.split_once(separator).is_some_and(|(name, value)| self.pair(name, value)) {
                return;
            }
        }
        let is_value = |value: &str| value.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        for (at, _) in line.match_indices(' ').take(4) {
            let (name, value) = line.split_at(at);
            if is_value(value) && self.pair(name, value) {
                return;
            }
        }
    }

    /// Reads a value, and says whether the name is known.
    fn pair(&mut self, name: &str, value: &str) -> bool {
        let (name, beside) = name_and_unit(name);
        let Some(known) = Name::of(&name) else { return false };
        let value = value.trim().trim_start_matches(['=', ':']).trim();
        let plain = value.trim_matches(|c: char| c.is_whitespace() || "\"',;".contains(c));
        match known {
            Name::Side(axis) => self.sides[axis] = one(value, &beside),
            Name::Sides => match lengths(value, &beside).as_deref() {
                Some([x, y]) => self.sides = [Some(*x), Some(*y)],
                Some([both]) => self.scan = Some(*both),
                _ => {}
            },
            Name::Spacing(axis) => self.spacing[axis] = one(value, &beside).filter(|length| is_spacing(&name, *length)),
            Name::Spacings => match lengths(value, &beside).as_deref() {
                Some([x, y]) if is_spacing(&name, *x) => self.spacing = [Some(*x), Some(*y)],
                Some([both]) if is_spacing(&name, *both) => self.spacing = [Some(*both); 2],
                _ => {}
            },
            Name::Count(axis) => self.counts[axis] = count(value).or(self.counts[axis]),
            Name::HeightUnit => self.unit = Some(plain.to_owned()),
            Name::HeightRange => {
                let unit = value.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.,eE ".contains(c));
                self.unit = Some(if unit.is_empty() { beside } else { unit.to_owned() });
            }
            Name::Unit => match unit_of(plain) {
                Some(unit) => self.of_all = Some(unit),
                None => self.unit = self.unit.take().or_else(|| Some(plain.to_owned())),
            },
            Name::Channel => {
                plain.clone_into(&mut self.channel);
                if let Some(unit) = in_brackets(plain).map(|(_, unit)| unit).filter(|unit| is_unit(unit)) {
                    self.unit.get_or_insert_with(|| unit.to_owned());
                }
            }
            Name::ImageData => self.image(value),
            Name::Metres => self.metres = number(value, true),
            Name::Missing => self.missing.extend(number(plain, true).filter(|mark| mark.is_finite())),
        }
        true
    }

    /// Reads the name of an image, which is the last word in quotes. Of several images, none is known to be the one.
    fn image(&mut self, value: &str) {
        self.images += 1;
        let name = value.trim_matches(|c: char| c.is_whitespace() || c == '"').rsplit('"').next().unwrap_or_default();
        self.channel = if self.images == 1 { name.to_owned() } else { String::new() };
    }

    /// Whether the lines contain the size of the map or its number of points.
    ///
    /// The numbers are then rows of a map.
    pub(super) fn is_of_rows(&self) -> bool {
        self.says_sides() || self.counts.iter().all(Option::is_some)
    }

    /// Whether the lines contain both sides of the map or both numbers of points. A profile has a spacing too.
    pub(super) fn says_whole_size(&self) -> bool {
        self.sides.iter().all(Option::is_some) || self.counts.iter().all(Option::is_some)
    }

    /// Whether the lines contain the size of the map.
    pub(super) fn says_sides(&self) -> bool {
        let is_known = |axis: usize| self.sides[axis].is_some() || self.spacing[axis].is_some();
        self.scan.is_some() || is_known(0) && is_known(1)
    }

    /// Sides of a map of `nx` times `ny` points, and their unit.
    ///
    /// # Errors
    /// [`FormatError::Field`] when the lines have other numbers of points, or a size that is not positive.
    pub(super) fn sides(&self, nx: usize, ny: usize) -> Result<(Option<[f64; 2]>, Unit), FormatError> {
        self.check_counts(nx, ny)?;
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
        let of_spacing = |axis: usize| self.spacing[axis].map(|(spacing, unit)| (spacing * points[axis], unit));
        // One size is that along x, of pixels with equal sides.
        let scan = |axis: usize| self.scan.map(|(side, unit)| (side * points[axis] / points[0], unit));
        let side = |axis: usize| sides[axis].or_else(|| of_spacing(axis)).or_else(|| scan(axis));
        let [Some(x), Some(y)] = [side(0), side(1)] else { return Ok((None, Unit::Unnamed)) };
        let lengths = [x, y];
        if lengths.iter().any(|(side, _)| *side <= 0.0 || !side.is_finite()) {
            let found = format!("{:e} x {:e}", lengths[0].0, lengths[1].0);
            return Err(refused(Format::Csv, "width x height", &found, "two positive lengths"));
        }
        // If only one side has a unit, it applies to both.
        let named = lengths.iter().find_map(|(_, unit)| *unit).or(self.of_all);
        let metres = |(side, unit): Length| side * unit.or(named).map_or(1.0, LengthUnit::metres);
        Ok((Some(lengths.map(metres)), if named.is_some() { Unit::Metre } else { Unit::Unnamed }))
    }

    /// Refuses numbers of points that are not those in the lines.
    fn check_counts(&self, nx: usize, ny: usize) -> Result<(), FormatError> {
        let [w, h] = [self.counts[0].unwrap_or(nx), self.counts[1].unwrap_or(ny)];
        if [w, h] == [nx, ny] {
            return Ok(());
        }
        let expected = "the numbers of columns and rows that are there; the file is truncated";
        Err(refused(Format::Csv, "w x h", &format!("{w} x {h}, for {nx} x {ny} numbers"), expected))
    }

    /// Unit of the numbers, and the factor that converts them to metres.
    ///
    /// # Errors
    /// [`FormatError::Field`] when the factor is not valid.
    pub(super) fn of_heights(&self) -> Result<(Unit, f64), FormatError> {
        match (self.metres, self.unit.as_deref().map(str::trim).filter(|name| !name.is_empty())) {
            (Some(metres), _) => {
                Ok((Unit::Metre, super::fields::factor(Format::Csv, "height conversion factor", metres)?))
            }
            (None, Some(name)) => Ok(unit_of(name).map_or((Unit::NotLength, 1.0), |unit| (Unit::Metre, unit.metres()))),
            (None, None) => Ok(self.unit_of_all().map_or((Unit::Unnamed, 1.0), |unit| (Unit::Metre, unit.metres()))),
        }
    }

    /// The unit that the heights have only because the sides have it.
    pub(super) fn unit_of_sides_for_heights(&self) -> Option<LengthUnit> {
        let is_named = self.metres.is_some() || self.unit.is_some() || self.of_all.is_some();
        if is_named { None } else { self.unit_of_all() }
    }

    /// The unit of lengths that have no other: the one that is given for all, or the only one that is named.
    pub(super) fn unit_of_all(&self) -> Option<LengthUnit> {
        let lengths = self.sides.iter().chain(&self.spacing).chain([&self.scan]);
        let mut named = lengths.filter_map(|length| length.and_then(|(_, unit)| unit));
        let first = named.next();
        let only = first.filter(|first| named.all(|unit| unit == *first));
        self.of_all.or(only)
    }
}

/// Whether a line has the first numbers: it begins with a number, or all of its words are numbers or marks.
fn begins_numbers(row: &str) -> bool {
    let (mut words, comma) = words(row);
    let Some(first) = words.next() else { return false };
    let is_digit = |c: char| c.is_ascii_digit() || "+-.".contains(c);
    let is_number = cell(first, comma).is_some_and(|value| !value.is_nan()) && unquoted(first).starts_with(is_digit);
    // A mark and a number alone are the declaration of a mark.
    let is_field = |rest: usize| rest == 1 && Name::of(first) == Some(Name::Missing);
    let rest = words.count();
    is_number || rest > 0 && !is_field(rest) && is_row_of_cells(row)
}

/// The only length of a field.
fn one(value: &str, beside: &str) -> Option<Length> {
    lengths(value, beside).and_then(|lengths| <[Length; 1]>::try_from(lengths).ok()).map(|[length]| length)
}

/// Whether a length is the distance of points. A whole number called resolution, without a unit, counts points.
fn is_spacing(name: &str, (value, unit): Length) -> bool {
    unit.is_some() || value.fract() != 0.0 || !name.to_lowercase().contains("resolution")
}

/// A number of points. Some programs write it once for each direction of the scan.
fn count(value: &str) -> Option<usize> {
    let mut words = value.split([' ', '\t', ',', ';']).map(unquoted).filter(|word| !word.is_empty());
    let first = words.next()?;
    let n = first.parse().ok().filter(|n| *n > 0)?;
    words.all(|word| word == first).then_some(n)
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
    fn a_title_of_the_map_names_the_unit_of_its_heights() {
        for title in ["Height [nm]", "Heights in nm", "z: nm", "Z scale = nm", "# Channel: Topography (nm)"] {
            let heading = of(&format!("Pixel size: 10 um\n{title}\n1 2\n"));
            assert_eq!(heading.of_heights(), Ok((Unit::Metre, 1e-9)), "{title}");
            assert_eq!(heading.unit_of_sides_for_heights(), None);
        }
        for title in ["Z [V]", "Channel: Deflection error (mV)", "Data (deg)"] {
            assert_eq!(of(&format!("{title}\n1 2\n")).of_heights(), Ok((Unit::NotLength, 1.0)), "{title}");
        }
        let heading = of("Pixel size: 10 um\nChannel: Height (measured)\n1 2\n");
        assert_eq!(heading.of_heights(), Ok((Unit::Metre, 1e-6)));
        assert_eq!(heading.unit_of_sides_for_heights(), Some(LengthUnit::Micrometre));
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
