//! Texts of Zygo: XYZ data files and ASCII data files.
//!
//! Both begin with 13 or 14 lines, which end at a line `#`. Then an XYZ file has a line for each pixel: column, row and
//! height in µm, or `No Data`. An ASCII file has intensities, a line `#`, phases, and again `#`. The first row is at
//! the top.

use rc_core::Grid;

use super::channel::{Channel, only};
use super::decode::decoded;
use super::field::{field, flip};
use super::fields::{factor, refused, shown};
use super::instrument::sides;
use super::lines::{number, raw_lines};
use super::marks::Marks;
use crate::{Format, FormatError, HeightMap, LengthUnit, ReadNote, Unit};

/// First words of an XYZ data file.
pub(super) const XYZ: &str = "Zygo XYZ Data File";
/// First words of an ASCII data file.
pub(super) const ASCII: &str = "Zygo ASCII Data File";

/// Minimum of the values that mark a missing phase.
const MISSING: f64 = 2_147_483_640.0;

/// A text whose header is read.
struct Zygo<'a> {
    /// The lines before the first `#`.
    header: Vec<&'a str>,
    /// The lines after it, with their numbers.
    data: Vec<(usize, &'a str)>,
}

impl<'a> Zygo<'a> {
    fn of(text: &'a str) -> Result<Self, FormatError> {
        let mut lines = raw_lines(text).map(|(n, line)| (n, line.trim()));
        let header: Vec<&str> = lines.by_ref().map(|(_, line)| line).take_while(|line| *line != "#").collect();
        let data: Vec<_> = lines.filter(|(_, line)| !line.is_empty()).collect();
        if data.is_empty() || header.len() < 13 {
            return Err(FormatError::HeaderCutShort { format: Format::Zygo });
        }
        Ok(Self { header, data })
    }

    /// The number at a place of a line of the header, both from 1.
    fn number(&self, field: &'static str, line: usize, place: usize) -> Result<f64, FormatError> {
        let words = self.header.get(line - 1).copied().unwrap_or_default();
        let word =
            words.split_whitespace().nth(place - 1).ok_or(FormatError::Missing { format: Format::Zygo, field })?;
        let value = number(word, false).filter(|value| value.is_finite());
        value.ok_or_else(|| refused(Format::Zygo, field, word, "a number"))
    }

    /// A number of pixels in line 4, which has the place and size of the phases.
    fn pixels(&self, field: &'static str, place: usize) -> Result<usize, FormatError> {
        let value = self.number(field, 4, place)?;
        let is_count = value.fract() == 0.0 && (0.0..=Grid::MAX_SIDE as f64).contains(&value);
        if is_count { Ok(value as usize) } else { Err(refused(Format::Zygo, field, &value, "a number of pixels")) }
    }

    fn grid(&self) -> Result<Grid, FormatError> {
        Ok(Grid::new(self.pixels("width of phases", 3)?, self.pixels("height of phases", 4)?)?)
    }
}

/// The heights of a text. `missing` has the marks of missing points that the user gives.
pub(super) fn channels<'a>(bytes: &'a [u8], missing: &[f64]) -> Vec<Channel<'a>> {
    let text = decoded(bytes);
    let marks = Marks::new(missing, &[]);
    only(move || {
        let zygo = Zygo::of(&text)?;
        let grid = zygo.grid()?;
        let (mut values, scale) =
            if text.trim_start().starts_with(ASCII) { phases(&zygo, grid)? } else { points(&zygo, grid)? };
        marks.erase(&mut values);
        crate::map::scale(&mut values, scale);
        flip(&mut values, grid, [false, true]);
        // A value of 0 means that the instrument was not calibrated along x and y.
        let pixel = zygo.number("side of a pixel", 8, 7)?;
        let sides =
            if pixel == 0.0 { None } else { Some(sides(Format::Zygo, ["side of a pixel"; 2], grid, [pixel; 2])?) };
        let side_unit = if sides.is_some() { Unit::Metre } else { Unit::Unnamed };
        let map = HeightMap::new(field(grid, values), Unit::Metre, sides, side_unit);
        Ok(map.with_note(ReadNote::RowsReversed))
    })
}

/// Heights of the pixels of an XYZ file, and their unit in m.
fn points(zygo: &Zygo<'_>, grid: Grid) -> Result<(Vec<f64>, f64), FormatError> {
    let origin = [zygo.pixels("left of phases", 1)?, zygo.pixels("top of phases", 2)?];
    let mut pixels = Vec::new();
    for &(line, row) in zygo.data.iter().take_while(|(_, line)| *line != "#") {
        let mut words = row.splitn(3, char::is_whitespace).map(str::trim);
        let mut word = || words.next().unwrap_or_default();
        let no_number = |value, text| FormatError::NoNumber { line, value, text: shown(text) };
        let mut pixel = |value| {
            let word = word();
            word.parse::<usize>().map_err(|_| no_number(value, word))
        };
        let at = [pixel(1)?, pixel(2)?];
        let height = word();
        pixels.push((line, at, number(height, false).ok_or_else(|| no_number(3, height))?));
    }
    check_points(grid, pixels.len())?;
    let mut values = vec![f64::NAN; grid.len()];
    // Pixels are counted from the corner of the camera, but some programs count them from the corner of the phases.
    let is_inside = |[x, y]: [usize; 2], [left, top]: [usize; 2]| {
        (left..left + grid.nx()).contains(&x) && (top..top + grid.ny()).contains(&y)
    };
    let is_of_camera = pixels.iter().all(|(_, at, _)| is_inside(*at, origin));
    let origin = if is_of_camera { origin } else { [0, 0] };
    for (line, at, height) in pixels {
        if !is_inside(at, origin) {
            let found = format!("{} {} in line {line}", at[0], at[1]);
            return Err(refused(Format::Zygo, "a pixel", &found, "inside of the phases, which line 4 gives"));
        }
        values[grid.index(at[0] - origin[0], at[1] - origin[1])] = height;
    }
    Ok((values, LengthUnit::Micrometre.metres()))
}

/// Refuses a file that is much shorter than its header says, before memory is taken for the map.
fn check_points(grid: Grid, there: usize) -> Result<(), FormatError> {
    const MOST_MISSING: usize = 64;
    if grid.len() <= MOST_MISSING * there.max(1) {
        return Ok(());
    }
    let expected = "the number of pixels that are there; the file is truncated";
    Err(refused(Format::Zygo, "size of phases", &format!("{grid}, for {there} pixels"), expected))
}

/// Phases of an ASCII file, and the height (m) of one.
fn phases(zygo: &Zygo<'_>, grid: Grid) -> Result<(Vec<f64>, f64), FormatError> {
    let of_phase = match zygo.number("resolution of phases", 11, 1)? {
        0.0 => 4096.0,
        1.0 => 32768.0,
        2.0 => 131_072.0,
        other => return Err(refused(Format::Zygo, "resolution of phases", &other, "0, 1 or 2")),
    };
    let number_8 = |field, place| zygo.number(field, 8, place);
    let (interferometric, wavelength, obliquity) =
        (number_8("scale factor", 2)?, number_8("wavelength", 3)?, number_8("obliquity factor", 5)?);
    let scale = factor(Format::Zygo, "scale of heights", interferometric * wavelength * obliquity / of_phase)?;
    let sign = if zygo.number("sign of phases", 11, 8).unwrap_or(0.0) == 0.0 { 1.0 } else { -1.0 };
    let after_intensities = zygo.data.iter().skip_while(|(_, line)| *line != "#").skip(1);
    let mut values = Vec::new();
    for (line, row) in after_intensities.take_while(|(_, line)| *line != "#") {
        for (i, word) in row.split_whitespace().enumerate() {
            let no_number = || FormatError::NoNumber { line: *line, value: i + 1, text: shown(word) };
            let phase = number(word, false).ok_or_else(no_number)?;
            values.push(if phase >= MISSING { f64::NAN } else { phase });
        }
    }
    if values.len() != grid.len() {
        let expected = "the number of phases that are there; the file is truncated";
        let found = format!("{grid}, for {} phases", values.len());
        return Err(refused(Format::Zygo, "size of phases", &found, expected));
    }
    Ok((values, sign * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A header for phases of `left top width height`.
    fn header(kind: &str, rect: &str, pixel: &str) -> String {
        format!(
            "{kind} - Format 1\r\n0 3 0 0 \"Tue Aug 25 16:59:23 2026\"\r\n0 0 3 2 1 255\r\n{rect}\r\n\"\"\r\n\r\n\"\"\r\n\
             0 0.5 6.328e-07 0 1 0 {pixel} 1787677163\r\n3 2 0 0 0 666666 0 \"\"\r\n0 0 1 33 0 0 0.1 60.4318 2 50\r\n\
             1 1 100 0 0 0 0 0 0 0\r\n0 \"\"\r\n1.5 0\r\n#\r\n"
        )
    }

    fn read(text: &str) -> Result<HeightMap, FormatError> {
        crate::parse(text.as_bytes(), Format::Zygo)
    }

    #[test]
    fn pixels_of_a_list_are_heights_in_micrometres_with_the_first_row_at_the_top() {
        let body = "0 0 4\r\n1 0 No Data\r\n2 0 6\r\n0 1 1\r\n1 1 2\r\n2 1 3\r\n#\r\n";
        let moved = "10 20 4\r\n11 20 No Data\r\n12 20 6\r\n10 21 1\r\n11 21 2\r\n12 21 3\r\n#\r\n";
        for (rect, body) in [("0 0 3 2", body), ("10 20 3 2", moved), ("10 20 3 2", body)] {
            let map = read(&(header(XYZ, rect, "2e-6") + body)).expect("a map");
            assert_eq!(map.heights.values()[..4], [1e-6, 2e-6, 3e-6, 4e-6].map(|z: f64| z * 1e6 * 1e-6));
            assert!(map.heights.at(1, 1).is_nan());
            assert_eq!((map.sides, map.side_unit, map.height_unit), (Some([6e-6, 4e-6]), Unit::Metre, Unit::Metre));
            assert_eq!(map.notes, [ReadNote::RowsReversed]);
        }
        assert_eq!(read(&(header(XYZ, "0 0 3 2", "0") + body)).expect("a map").sides, None);
    }

    #[test]
    fn phases_are_heights_by_the_wavelength() {
        let body = "7 7 7\n7 7 7\n#\n32768 65536 98304 4\n 2147483640\n-32768\n#\n";
        let map = read(&(header(ASCII, "0 0 3 2", "2e-6") + body)).expect("a map");
        let fringe = 0.5 * 6.328e-7;
        let near = |value: f64, expected: f64| (value / expected - 1.0).abs() < 1e-12;
        assert!(near(map.heights.at(0, 1), fringe) && near(map.heights.at(2, 0), -fringe), "{:?}", map.heights);
        assert!(map.heights.at(1, 0).is_nan());
        let without_intensities = "#\n1 2 3 4 5 6\n#\n";
        assert!(read(&(header(ASCII, "0 0 3 2", "0") + without_intensities)).is_ok());
    }

    #[test]
    fn damaged_texts_are_refused() {
        let cases = [
            (header(XYZ, "0 0 3 2", "2e-6"), "shorter than the header"),
            (header(XYZ, "0 0 3 2", "2e-6") + "3 0 1\n", "a pixel is '3 0 in line 15'"),
            (header(XYZ, "0 0 3 2", "2e-6") + "0 x 1\n", "line 15, value 2: 'x'"),
            (header(XYZ, "0 0 3 2", "2e-6") + "0 1 high\n", "line 15, value 3: 'high'"),
            (header(XYZ, "0 0 90000 90000", "2e-6") + "0 1 1\n", "for 1 pixels"),
            (header(XYZ, "0 0 wide 2", "2e-6") + "0 1 1\n", "width of phases is 'wide'"),
            (header(ASCII, "0 0 3 2", "2e-6") + "#\n1 2 3\n#\n", "3 x 2, for 3 phases"),
            ("Zygo XYZ Data File - Format 1\n#\n1 2 3\n".to_owned(), "shorter than the header"),
        ];
        for (text, expected) in cases {
            let error = read(&text).expect_err(expected).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{error}");
        }
    }
}
