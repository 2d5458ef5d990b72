//! Lengths in the lines before the numbers of a text.

use super::lines::number;
use super::unit;
use crate::LengthUnit;

/// A length, with the unit that is given beside it.
pub(super) type Length = (f64, Option<LengthUnit>);

/// Maximum number of lengths of one field.
const MOST: usize = 3;

/// The unit of length with this name, as instruments write it: `~m` and `UM` are µm.
pub(super) fn unit_of(name: &str) -> Option<LengthUnit> {
    let name = name.trim().trim_start_matches("in ").trim();
    // A length for each point.
    let name = name.split_once(['/', '*']).filter(|(_, each)| is_point(each)).map_or(name, |(unit, _)| unit.trim());
    let is_capital = name.len() == 2 && name.bytes().all(|byte| byte.is_ascii_uppercase());
    match name {
        "~m" | "æm" | "?m" => Some(LengthUnit::Micrometre),
        _ if is_capital => unit::length(&name.to_ascii_lowercase()),
        _ => unit::length(name),
    }
}

fn is_point(name: &str) -> bool {
    let name = name.trim().trim_end_matches('.').to_ascii_lowercase();
    ["px", "pix", "pixel", "pixels", "point", "pt", "sample"].contains(&name.as_str())
}

/// The lengths of a field such as `10 µm`, `10 x 20 um`, `5.00 5.00 ~m` or `"0.28","um"`.
///
/// A length without a unit has that of the next one, or the unit `beside` the name of the field. `None` for other
/// quantities, such as numbers of points.
pub(super) fn lengths(text: &str, beside: &str) -> Option<Vec<Length>> {
    let beside = if beside.trim().is_empty() { None } else { Some(unit_of(beside)?) };
    let text = text.replace(['"', '\''], "");
    let mut rest = text.as_str();
    let mut found: Vec<Length> = Vec::new();
    while found.len() < MOST {
        rest = rest.trim_start_matches(|c: char| c.is_whitespace() || ",;:x×*".contains(c));
        let end = rest.find(|c: char| !(c.is_ascii_digit() || "+-.,eE".contains(c))).unwrap_or(rest.len());
        let digits = rest[..end].trim_end_matches(['e', 'E', ',', '.']);
        if digits.is_empty() {
            break;
        }
        let value = number(digits, true).filter(|value| value.is_finite())?;
        rest = &rest[digits.len()..];
        let (unit, after) = unit_after(rest)?;
        rest = after;
        found.push((value, unit));
    }
    let mut unit = None;
    for length in found.iter_mut().rev() {
        unit = length.1.or(unit).or(beside);
        length.1 = unit;
    }
    if found.is_empty() || !rest.trim_matches([' ', ',', ';', '\t', ')']).is_empty() { None } else { Some(found) }
}

/// The unit that follows a number, and the text after it. `None` if a word follows that is not a unit of length.
fn unit_after(text: &str) -> Option<(Option<LengthUnit>, &str)> {
    let start = text.trim_start_matches([' ', '\t', ',', ';', '[', '(']);
    let is_part = |c: char| c.is_alphabetic() || "µμ~?/".contains(c);
    let end = start.find(|c: char| !is_part(c)).unwrap_or(start.len());
    match &start[..end] {
        "" => Some((None, text)),
        "x" | "by" | "X" => Some((None, &start[end..])),
        // The number may be followed by the next one without a blank, as in `10x20`.
        word if word.starts_with('x') && unit_of(word).is_none() => Some((None, &start[1..])),
        word => Some((Some(unit_of(word)?), start[end..].trim_start_matches([']', ')']))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_read_as_instruments_write_them() {
        let (um, nm) = (Some(LengthUnit::Micrometre), Some(LengthUnit::Nanometre));
        let cases = [
            ("10 µm", "", vec![(10.0, um)]),
            ("10µm", "", vec![(10.0, um)]),
            ("0,5", "um", vec![(0.5, um)]),
            ("5.00 5.00 ~m", "", vec![(5.0, um); 2]),
            ("10 x 20 µm", "", vec![(10.0, um), (20.0, um)]),
            ("10x20 um", "", vec![(10.0, um), (20.0, um)]),
            ("10 um × 20 nm", "", vec![(10.0, um), (20.0, nm)]),
            ("\"0.277\",\"um\"", "", vec![(0.277, um)]),
            ("2.5e-007 um/px", "", vec![(2.5e-7, um)]),
            ("3", "UM/pixel", vec![(3.0, um)]),
            ("3", "", vec![(3.0, None)]),
        ];
        for (text, beside, expected) in cases {
            assert_eq!(lengths(text, beside), Some(expected), "{text}");
        }
        for (text, beside) in
            [("10 px", ""), ("2", "A"), ("2", "px"), ("", ""), ("fast", ""), ("3 of 5", ""), ("2 V", "")]
        {
            assert_eq!(lengths(text, beside), None, "{text} {beside}");
        }
    }
}
