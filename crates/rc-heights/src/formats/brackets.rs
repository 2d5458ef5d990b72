//! Units in the lines before the numbers of a text, in brackets or after a title.

use super::quantity::unit_of;

/// The unit in a title of the whole map: `Height [nm]`, `Heights in nm`, `z: nm` or `Z scale = nm`.
pub(super) fn unit_of_heights(line: &str) -> Option<&str> {
    let separated = || line.split_once([':', '=']).or_else(|| line.rsplit_once(" in "));
    let (name, unit) = in_brackets(line).or_else(separated)?;
    let (name, unit) = (name.trim().to_lowercase(), unit.trim());
    let mut words = name.split([' ', '_']);
    let is_height = words.next().is_some_and(|first| HEIGHTS.contains(&first));
    (is_height && words.all(|word| OF_HEIGHTS.contains(&word)) && is_unit(unit)).then_some(unit)
}

/// Words that begin a title of heights.
const HEIGHTS: [&str; 8] = ["height", "heights", "z", "höhe", "höhen", "hoehe", "topography", "data"];

/// Words that may follow them.
const OF_HEIGHTS: [&str; 5] = ["data", "scale", "values", "map", "unit"];

/// Units of other quantities that instruments measure beside heights.
const OTHER_UNITS: [&str; 17] =
    ["V", "mV", "uV", "A", "mA", "nA", "pA", "deg", "°", "rad", "N", "nN", "pN", "Hz", "kHz", "K", "a.u."];

/// Whether a word is a unit of any quantity.
pub(super) fn is_unit(word: &str) -> bool {
    unit_of(word).is_some() || ["inch", "in", "mil", "µin", "uin"].contains(&word) || OTHER_UNITS.contains(&word)
}

/// What is before brackets at the end of a text, and in them.
pub(super) fn in_brackets(text: &str) -> Option<(&str, &str)> {
    let (name, inside) = text.strip_suffix([']', ')'])?.rsplit_once(['[', '('])?;
    Some((name, inside.trim()))
}

/// The name of a field without what is in brackets: an axis, which belongs to the name, or a unit.
pub(super) fn name_and_unit(name: &str) -> (String, String) {
    let (mut whole, mut unit) = (String::new(), String::new());
    if name.contains("->") {
        return (name.to_owned(), unit);
    }
    for (i, part) in name.split(['[', '(']).enumerate() {
        let (inside, outside) = if i == 0 { ("", part) } else { part.split_once([']', ')']).unwrap_or((part, "")) };
        let is_axis = ["x", "y"].contains(&inside.trim().to_ascii_lowercase().as_str());
        if is_axis {
            whole.push_str(inside);
        } else if !inside.trim().is_empty() {
            inside.trim().clone_into(&mut unit);
        }
        whole.push_str(outside);
    }
    (whole, unit)
}
