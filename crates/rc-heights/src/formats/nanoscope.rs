//! Nanoscope files of Bruker, Veeco and Digital Instruments, from version 4.2 on.
//!
//! The format has a text of lists, then the integers of each image, whose first row has the lowest y. The documentation
//! of Gwyddion describes it.
//!
//! A value is integer / 256^bytes x `Z scale` x the sensitivity that `Z scale` names. It is a length if the unit of the
//! product is a length. Other channels have a unit of the file that the map does not name.

use rc_core::Grid;

use super::binary::Number;
use super::channel::{Channel, Channels, each, is_topography};
use super::fields::{factor, refused};
use super::instrument::{Places, map, metres, scale_measured, sides, text};
use crate::{Format, FormatError, HeightMap};

/// The first line.
pub(super) const MARK: &[u8] = b"\\*File list\r\n";

/// From this version on, integers always have four bytes.
///
/// If `Bytes/pixel` is 2, it only determines the scale.
const FOUR_BYTES: u32 = 0x0920_0000;

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
    let mut values = image.number.values(data, image.grid)?;
    scale_measured(&mut values, scale, |_| false);
    Ok(map(image.grid, values, image.is_height, Some(image.sides)))
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
    let scaled: i32 = if list.get("bytes/pixel").is_some() { list.number("bytes/pixel")? } else { 2 };
    let four = version >= FOUR_BYTES && length >= 4 * grid.len();
    let number = match scaled {
        2 if !four => Number::I16,
        2 | 4 => Number::I32,
        other => return Err(refused(Format::Nanoscope, "Bytes/pixel", &other, "2 or 4")),
    };
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
    Ok(Image { grid, number, scale: unit / 256_f64.powi(scaled), is_height, sides })
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
