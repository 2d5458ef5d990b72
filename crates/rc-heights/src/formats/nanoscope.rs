//! Nanoscope files of Bruker, Veeco and Digital Instruments, from version 4.2 on.
//!
//! The format has a text of lists, then the integers of each image, whose first row has the lowest y. The documentation
//! of Gwyddion describes it.
//!
//! A value is integer / 256^bytes x `Z scale` x the sensitivity that `Z scale` names. It is a length if the unit of the
//! product is a length. Other channels have a unit of the file that the map does not name.
//!
//! A scan that was stopped has `Valid data` of fewer lines, or fewer lines in the file. The other lines are missing.

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels, each, is_topography};
use super::fields::{factor, refused};
use super::instrument::{Places, map, metres, scale_measured, sides, text};
use crate::{Format, FormatError, HeightMap, ReadNote};

/// The first line.
pub(super) const MARK: &[u8] = b"\\*File list\r\n";

/// From this version on, integers always have four bytes.
///
/// If `Bytes/pixel` is 2, it only determines the scale.
const FOUR_BYTES: u32 = 0x0920_0000;

/// Most points of an image for each point that was measured before the scan was stopped.
const MOST_MISSING: usize = 1024;

/// A list of the header: `\*name`, then lines of `\key: value`. Names and keys are in lower case.
struct List {
    name: String,
    pairs: Vec<(String, String)>,
}

impl List {
    fn get(&self, key: &str) -> Option<&str> {
        self.pairs.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    fn number<T: std::str::FromStr>(&self, key: &'static str) -> Result<T, FormatError> {
        let text = self.get(key).ok_or(FormatError::Missing { format: Format::Nanoscope, field: key })?;
        text.parse().map_err(|_| refused(Format::Nanoscope, key, text, "a number"))
    }
}

/// Place and form of a stored image.
struct Image {
    grid: Grid,
    number: Number,
    /// The value of an integer of 1, in m if the image has heights.
    scale: f64,
    is_height: bool,
    sides: [f64; 2],
    stored: Stored,
}

/// The part of an image that was measured, and how it is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stored {
    /// First column and line of what was measured, from 0.
    start: [usize; 2],
    /// Columns and lines of what was measured.
    length: [usize; 2],
    /// First column and line, and columns and lines of the integers in the file.
    block: [[usize; 2]; 2],
}

pub(super) fn channels(bytes: &[u8]) -> Channels<'_> {
    let lists = lists(bytes);
    let named = |name: &str| lists.iter().filter(|list| list.name == name).collect::<Vec<_>>();
    // Force curves are stored as images, but are not maps.
    if lists.iter().any(|list| list.get("operating mode") == Some("Force") || list.get("start context") == Some("FOL"))
    {
        let (what, cure) = ("a file of force curves".to_owned(), "choose a file with an image");
        return Err(FormatError::Unsupported { format: Format::Nanoscope, what, cure });
    }
    let version = named("file list").first().and_then(|list| list.get("version")).unwrap_or_default();
    let version = u32::from_str_radix(version.trim_start_matches("0x"), 16).unwrap_or(0);
    let mut globals = named("scanner list");
    for name in ["microscope list", "ciao scan list", "afm list", "stm list", "nc afm list"] {
        globals.extend(named(name));
    }
    let images = lists.iter().filter(|list| list.name.ends_with("image list"));
    let mut found: Vec<_> = images.map(|list| (name(list), channel(list, &globals, version, bytes))).collect();
    // Errors of the feedback loop are in nm too.
    let is_topography = |(name, channel): &(String, Result<Channel<'_>, _>)| {
        channel.as_ref().is_ok_and(|c| c.is_height) && is_topography(name)
    };
    if found.iter().any(is_topography) {
        let others = found.iter_mut().filter(|found| !is_topography(found));
        others.filter_map(|(_, channel)| channel.as_mut().ok()).for_each(|channel| channel.is_height = false);
    }
    Ok(each(found))
}

fn channel<'a>(list: &List, globals: &[&List], version: u32, bytes: &'a [u8]) -> Result<Channel<'a>, FormatError> {
    let image = image(list, globals, version)?;
    let data = Places::new(bytes, Format::Nanoscope).rest(list.number("data offset")?);
    Ok(Channel { name: name(list), is_height: image.is_height, read: Box::new(move || read(data, &image)) })
}

fn read(data: &[u8], image: &Image) -> Result<HeightMap, FormatError> {
    let scale = factor(Format::Nanoscope, "Z scale", image.scale)?;
    let (grid, stored) = (image.grid, image.stored);
    let (mut values, lines) = if stored == Stored::whole(grid) {
        (image.number.values(data, grid)?, grid.ny())
    } else {
        (stored.placed(data, image.number, grid)?, stored.length[1])
    };
    scale_measured(&mut values, scale, |_| false);
    let map = map(grid, values, image.is_height, Some(image.sides)).of_numbers(scale);
    let unfinished = ReadNote::Unfinished { rows: lines, all: grid.ny() };
    Ok(if lines < grid.ny() { map.with_note(unfinished) } else { map })
}

impl Stored {
    /// An image that was measured completely.
    fn whole(grid: Grid) -> Self {
        let length = [grid.nx(), grid.ny()];
        Self { start: [0; 2], length, block: [[0; 2], length] }
    }

    /// What a list says of an image of `grid` whose integers of `size` bytes have `bytes` bytes.
    fn of(list: &List, grid: Grid, size: usize, bytes: usize) -> Self {
        let all = [grid.nx(), grid.ny()];
        let number = |key| list.get(key).and_then(|text| text.parse::<usize>().ok());
        let keys = [("valid data start x", "valid data len x"), ("valid data start y", "valid data len y")];
        let (mut start, mut length) = ([0; 2], all);
        for (i, (of_start, of_length)) in keys.into_iter().enumerate() {
            // Images that a program has cropped or resampled may keep the numbers of the scan.
            if let (first, Some(n)) = (number(of_start).unwrap_or(0), number(of_length))
                && first < all[i]
                && n > 0
            {
                (start[i], length[i]) = (first, n.min(all[i] - first));
            }
        }
        let lines = bytes / size / all[0].max(1);
        let block = if lines >= all[1] {
            [[0; 2], all]
        } else if bytes == size * length[0] * length[1] {
            // Only what was measured is stored.
            [start, length]
        } else {
            // Lines from the measured ones on, or else from the first on.
            let first = if lines <= length[1] { start[1] } else { 0 };
            [[0, first], [all[0], lines.min(all[1] - first)]]
        };
        let end = (start[1] + length[1]).min(block[0][1] + block[1][1]);
        length[1] = end.saturating_sub(start[1]);
        Self { start, length, block }
    }

    /// The integers of `grid`, `NaN` where nothing was measured.
    fn placed(self, data: &[u8], number: Number, grid: Grid) -> Result<Vec<f64>, FormatError> {
        let [[bx, by], [columns, rows]] = self.block;
        // A promise of many more lines than there are is damage. It is refused before memory is taken.
        if columns * rows < grid.len() / MOST_MISSING || rows == 0 {
            let (needed, found) = (number.bytes_of(grid), (number.size() * columns * rows) as u64);
            return Err(FormatError::CutShort { grid, needed, found });
        }
        let stored = number.values(data, Grid::new(columns, rows)?)?;
        let mut values = vec![f64::NAN; grid.len()];
        let [x, y] = self.start;
        for iy in y..y + self.length[1] {
            let row = &stored[(iy - by) * columns..][..columns];
            let at = iy * grid.nx() + x;
            values[at..at + self.length[0]].copy_from_slice(&row[x - bx..][..self.length[0]]);
        }
        Ok(values)
    }
}

/// The lists at the start of the file. Only their lines begin with a backslash.
fn lists(bytes: &[u8]) -> Vec<List> {
    let mut lists: Vec<List> = Vec::new();
    for line in bytes.split(|byte| *byte == b'\n') {
        let Some(line) = line.strip_prefix(b"\\") else { break };
        let line = text(line);
        if let Some(name) = line.strip_prefix('*') {
            let name = name.to_ascii_lowercase();
            if name == "file list end" {
                break;
            }
            lists.push(List { name, pairs: Vec::new() });
        } else if let Some(list) = lists.last_mut() {
            let (key, value) = line.split_once(": ").unwrap_or((line.trim_end_matches(':'), ""));
            list.pairs.push((key.to_ascii_lowercase(), value.trim().to_owned()));
        }
    }
    lists
}

/// The name of an image from `S [Internal] "Shown"`.
///
/// It is the name that users see, with the direction of its lines if they run backwards.
fn name(list: &List) -> String {
    let text = value_of(list, "image data").unwrap_or_default();
    let shown = text.split('"').nth(1).filter(|name| !name.is_empty());
    let internal = || text.split(['[', ']']).nth(1).unwrap_or(text);
    let direction = list.get("line direction").filter(|direction| direction.eq_ignore_ascii_case("retrace"));
    let name = shown.unwrap_or_else(internal);
    direction.map_or_else(|| name.to_owned(), |direction| format!("{name} {direction}"))
}

/// The value of `key`.
///
/// In all but the oldest versions the number of a channel precedes it: `@2:Z scale`.
fn value_of<'a>(list: &'a List, key: &str) -> Option<&'a str> {
    ["@4:", "@3:", "@2:", "@1:", ""].iter().find_map(|number| list.get(&format!("{number}{key}")))
}

fn image(list: &List, globals: &[&List], version: u32) -> Result<Image, FormatError> {
    let mut grid = Grid::new(list.number("samps/line")?, list.number("number of lines")?)?;
    let length: usize = list.number("data length")?;
    let number = number(list, version, length, grid)?;
    let mut size = size(list, globals, grid)?;
    // Some images have a wrong size in their list. The size of the scan is then right.
    if let Some(whole) = whole(globals).filter(|whole| *whole != grid)
        && length == number.size() * whole.len()
    {
        size = [size[0] / grid.nx() as f64 * whole.nx() as f64, size[1] / grid.ny() as f64 * whole.ny() as f64];
        grid = whole;
    }
    let spacing = [size[0] / grid.nx() as f64, size[1] / grid.ny() as f64];
    let sides = sides(Format::Nanoscope, ["Scan size along x", "Scan size along y"], grid, spacing)?;
    let z = value_of(list, "z scale").ok_or(FormatError::Missing { format: Format::Nanoscope, field: "Z scale" })?;
    let (unit, is_height) =
        scale(z, globals).ok_or_else(|| refused(Format::Nanoscope, "Z scale", z, "a number and a unit"))?;
    let scaled: i32 = if list.get("bytes/pixel").is_some() { list.number("bytes/pixel")? } else { 2 };
    let stored = Stored::of(list, grid, number.size(), length);
    Ok(Image { grid, number, scale: unit / 256_f64.powi(scaled), is_height, sides, stored })
}

/// The type of the integers of an image with `length` bytes.
fn number(list: &List, version: u32, length: usize, grid: Grid) -> Result<Number, FormatError> {
    let scaled: i32 = if list.get("bytes/pixel").is_some() { list.number("bytes/pixel")? } else { 2 };
    // Some files of a newer version keep two bytes. Their length is that of all points, or of the measured ones.
    let two =
        [grid.ny(), list.number("valid data len y").unwrap_or(0)].map(|lines| (2 * grid.nx()).saturating_mul(lines));
    let four = version >= FOUR_BYTES && !two.contains(&length);
    match scaled {
        2 if !four => Ok(Number::I16),
        2 | 4 => Ok(Number::I32),
        other => Err(refused(Format::Nanoscope, "Bytes/pixel", &other, "2 or 4")),
    }
}

fn global<'a>(globals: &[&'a List], key: &str) -> Option<&'a str> {
    globals.iter().find_map(|list| list.get(key))
}

/// The grid of the whole scan. An image may be a part of it.
fn whole(globals: &[&List]) -> Option<Grid> {
    let count = |key| global(globals, key).and_then(|text| text.parse().ok());
    Grid::new(count("samps/line")?, count("lines")?).ok()
}

/// Sides (m) of an image.
fn size(list: &List, globals: &[&List], grid: Grid) -> Result<[f64; 2], FormatError> {
    let text = list.get("scan size").ok_or(FormatError::Missing { format: Format::Nanoscope, field: "Scan size" })?;
    let size = lengths(text).ok_or_else(|| refused(Format::Nanoscope, "Scan size", text, "lengths along x and y"))?;
    // If the scan has the length of its slow axis, the second length of the image may be wrong.
    let scan = |key| global(globals, key).and_then(lengths).map(|[length, _]| length);
    let [x, y] = scan("scan size").zip(scan("slow axis size")).map_or(size, |(x, y)| [x, y]);
    let aspect = list.get("aspect ratio").is_some_and(|aspect| aspect != "1:1");
    // A scan that was stopped has fewer lines, but the length of all lines.
    let share = whole(globals)
        .filter(|whole| aspect && grid.ny() < whole.ny())
        .map(|whole| grid.ny() as f64 / whole.ny() as f64);
    Ok([x, y * share.unwrap_or(1.0)])
}

/// Lengths in m from a text such as `10 5 ~m`, or `10 ~m` for both.
fn lengths(text: &str) -> Option<[f64; 2]> {
    let mut words = text.split_ascii_whitespace();
    let x: f64 = words.next()?.parse().ok()?;
    let word = words.next()?;
    let (y, unit) = word.parse().map_or((x, Some(word)), |y: f64| (y, words.next()));
    let unit = metres(unit?)?;
    Some([x * unit, y * unit])
}

/// The value of 256^bytes for a scale such as `V [Sens. Zsens] (0.006 V/LSB) 2.9 V`.
///
/// Also whether it is a length, and then it is in m.
fn scale(text: &str, globals: &[&List]) -> Option<(f64, bool)> {
    let (sensitivity, hard, hard_unit) = quantity(text)?;
    let soft = sensitivity.and_then(|name| global(globals, &format!("@{}", name.to_ascii_lowercase())));
    let (soft, soft_unit) = match soft {
        Some(soft) => quantity(soft).map(|(_, number, unit)| (number, unit))?,
        None => (1.0, ""),
    };
    let length = match soft_unit.split_once('/') {
        // Metres per V, and V of the hard unit, which may be mV.
        Some((length, per)) => metres(length).zip(ratio(hard_unit, per)).map(|(length, ratio)| length * ratio),
        None => metres(hard_unit),
    };
    Some((hard * soft * length.unwrap_or(1.0), length.is_some()))
}

/// Name, number and unit in `V [name] (…) number unit`.
///
/// The name is optional, and the unit may be empty.
fn quantity(text: &str) -> Option<(Option<&str>, f64, &str)> {
    let text = text.trim_start_matches(['V', 'C']).trim_start();
    let (name, text) = match text.strip_prefix('[').and_then(|text| text.split_once(']')) {
        Some((name, text)) => (Some(name.trim()), text.trim_start()),
        None => (None, text),
    };
    let mut depth = 0_usize;
    // Units may contain brackets too: (0.0005 log(Arb)/LSB).
    let text = text.trim_start_matches(|c| {
        let inside = depth > 0 || c == '(';
        depth = match c {
            '(' => depth + 1,
            ')' => depth.saturating_sub(1),
            _ => depth,
        };
        inside
    });
    let (number, unit) = text.trim().split_once(char::is_whitespace).unwrap_or((text.trim(), ""));
    Some((name, number.parse().ok()?, unit.trim()))
}

/// The ratio of `unit` to `other`, if they differ only in a prefix.
fn ratio(unit: &str, other: &str) -> Option<f64> {
    let prefix = |whole: &str, base: &str| match whole.strip_suffix(base)? {
        "" => Some(1.0),
        "k" => Some(1e3),
        "m" => Some(1e-3),
        "u" | "µ" | "~" => Some(1e-6),
        "n" => Some(1e-9),
        "p" => Some(1e-12),
        _ => None,
    };
    prefix(unit, other).or_else(|| prefix(other, unit).map(f64::recip))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_chains_of_a_number_and_a_sensitivity() {
        let list = |name: &str, pairs: &[(&str, &str)]| List {
            name: name.to_owned(),
            pairs: pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect(),
        };
        let scanner = list("scanner list", &[("@sens. zsens", "V 20.0 nm/V"), ("@sens. phase", "V 1.000000")]);
        let scan = list("ciao scan list", &[("@sens. log", "V 2 log(Pa)/log(Arb)")]);
        let globals = [&scanner, &scan];
        let cases = [
            ("V [Sens. Zsens] (0.005035400 V/LSB) 2.5 V", Some((50e-9, true))),
            ("V [Sens. Zsens] (0.005 mV/LSB) 2.5 mV", Some((50e-12, true))),
            ("V [Sens. Phase] (0.005493164 º/LSB) 360 º", Some((360.0, false))),
            ("V [Sens. Log] (0.0004882813 log(Arb)/LSB) 32.0 log(Arb)", Some((64.0, false))),
            ("V [Sens. None] (0.1 V/LSB) 3 V", Some((3.0, false))),
            ("V (0.1 nm/LSB) 300 nm", Some((300e-9, true))),
            ("100 nm", Some((100e-9, true))),
            ("V [Sens. Zsens] (0.1 V/LSB", None),
        ];
        for (text, expected) in cases {
            match (scale(text, &globals), expected) {
                (Some((found, length)), Some((value, is_length))) => {
                    assert!((found / value - 1.0).abs() < 1e-14 && length == is_length, "{text}: {found} {length}");
                }
                (found, expected) => assert_eq!(found, expected, "{text}"),
            }
        }
    }

    #[test]
    fn sizes_are_one_length_or_two() {
        for (text, expected) in
            [("500 250 nm", Some([500e-9, 250e-9])), ("2 ~m", Some([2e-6; 2])), ("2 V", None), ("2", None)]
        {
            let close = |(a, b): (&f64, &f64)| (a / b - 1.0).abs() < 1e-14;
            let found = lengths(text);
            assert_eq!(found.is_some(), expected.is_some(), "{text}");
            assert!(found.iter().flatten().zip(expected.iter().flatten()).all(close), "{text}: {found:?}");
        }
    }
}
