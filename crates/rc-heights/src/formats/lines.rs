//! Lines, words and numbers of a text.

/// The lines of a text that are not empty, with their numbers from 1.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    // A carriage return before a line feed belongs to it. Any other carriage return ends a line.
    let lines = text.split('\n').flat_map(|line| line.trim_end_matches('\r').split('\r'));
    lines.map(str::trim).enumerate().filter(|(_, line)| !line.is_empty()).map(|(n, line)| (n + 1, line))
}

/// The lines with data from line `first` on, with their numbers.
pub(crate) fn data_lines(text: &str, first: usize) -> impl Iterator<Item = (usize, &str)> {
    lines(text).filter(move |(n, line)| *n >= first && !line.starts_with(['#', '%']))
}

/// The values of a line, and whether a comma is a decimal point in them.
///
/// Nothing between two separators counts as a value that is not a number.
pub(crate) fn words(line: &str) -> (Box<dyn Iterator<Item = &str> + '_>, bool) {
    if line.contains(';') {
        (Box::new(line.split(';').map(str::trim)), true)
    } else if line.contains(',') && !has_decimal_commas(line) {
        (Box::new(line.split(',').map(str::trim)), false)
    } else {
        (Box::new(line.split_whitespace()), true)
    }
}

/// Whether the commas of a line are decimal points.
///
/// The line must have several words between blanks, all of them numbers with at most one comma, inside the word.
fn has_decimal_commas(line: &str) -> bool {
    let is_inside = |word: &str| {
        word.bytes().filter(|byte| *byte == b',').count() <= 1 && !word.starts_with(',') && !word.ends_with(',')
    };
    let mut words = line.split_whitespace();
    let several = words.clone().nth(1).is_some();
    several && words.all(|word| is_inside(word) && number(word, true).is_some())
}

/// A number, or `NaN` for a mark of a missing point.
///
/// `comma` says whether a comma may be the decimal point.
pub(crate) fn number(word: &str, comma: bool) -> Option<f64> {
    let parsed = if comma && word.contains(',') { word.replacen(',', ".", 1).parse() } else { word.parse() };
    parsed.ok().or_else(|| ["BAD", "***", "---"].contains(&word).then_some(f64::NAN))
}
