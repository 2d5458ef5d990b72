//! Lines, words and numbers of a text.

use std::str::SplitWhitespace;

use super::marks;

/// The lines of a text that are not empty, with their numbers from 1.
///
/// Blanks around them are removed, but tabs stay, because they may separate empty fields.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_blank = |c: char| c != '\t' && c.is_whitespace();
    raw_lines(text).map(move |(n, line)| (n, line.trim_matches(is_blank))).filter(|(_, line)| !line.trim().is_empty())
}

/// All lines of a text, with their numbers from 1.
pub(super) fn raw_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    // A carriage return before a line feed belongs to it. Any other carriage return ends a line.
    let lines = text.split('\n').flat_map(|line| line.trim_end_matches('\r').split('\r'));
    lines.enumerate().map(|(n, line)| (n + 1, line))
}

/// The lines with data from line `first` on, with their numbers.
pub(crate) fn data_lines(text: &str, first: usize) -> impl Iterator<Item = (usize, &str)> {
    lines(text).filter(move |(n, line)| *n >= first && comment(line).is_none())
}

/// The text of a comment, which begins with `#` or `%`.
pub(super) fn comment(line: &str) -> Option<&str> {
    let text = line.trim_start().strip_prefix(['#', '%'])?;
    // A row may begin with a mark such as `#N/A`.
    let is_row = || is_row_of_cells(line);
    if text.starts_with(|c: char| c.is_ascii_alphabetic()) && is_row() { None } else { Some(text) }
}

/// Whether all words of a line are numbers, marks or empty, and not all are empty.
pub(super) fn is_row_of_cells(line: &str) -> bool {
    let (mut words, comma) = words(line);
    !line.trim_matches([' ', '\t', ',', ';']).is_empty() && words.all(|word| cell(word, comma).is_some())
}

/// The values of a line, and whether a comma may be a decimal point in them.
///
/// An empty field between two separators is an empty word.
pub(crate) fn words(line: &str) -> (Box<dyn Iterator<Item = &str> + '_>, bool) {
    let separator = separator(line);
    if line.contains('"') {
        // Fields between quotes may contain the separator, as decimal commas in a table with commas.
        return (Box::new(Quoted { rest: Some(line), separator }), true);
    }
    match separator {
        Some(separator) => (Box::new(line.split(separator).map(str::trim)), separator != ','),
        None => (Box::new(Blanks { words: line.split_whitespace() }), true),
    }
}

/// The character between the values of a line. `None` means blanks.
fn separator(line: &str) -> Option<char> {
    if line.contains(';') {
        Some(';')
    } else if line.contains('\t') && is_of_tabs(line) {
        Some('\t')
    } else if line.contains(',') && !has_decimal_commas(line) {
        Some(',')
    } else {
        None
    }
}

/// Whether tabs alone separate the values of a line.
///
/// Otherwise they stand beside commas, or among blanks.
fn is_of_tabs(line: &str) -> bool {
    if !line.contains(' ') && !line.contains(',') {
        return true;
    }
    let is_one = |field: &str| {
        let field = field.trim();
        let commas = field.bytes().filter(|byte| *byte == b',').count();
        let is_list = field.contains(' ') && field.split_whitespace().all(|word| number(word, true).is_some());
        !is_list && !field.ends_with(',') && commas < 2
    };
    line.split('\t').all(is_one)
}

/// Whether the commas of a line are decimal points.
///
/// The line must have several words between blanks, all of them numbers with at most one comma, inside the word.
fn has_decimal_commas(line: &str) -> bool {
    let is_inside = |word: &str| {
        word.bytes().filter(|byte| *byte == b',').count() <= 1 && !word.starts_with(',') && !word.ends_with(',')
    };
    let several = line.split_whitespace().nth(1).is_some();
    several && Blanks { words: line.split_whitespace() }.all(|word| is_inside(word) && number(word, true).is_some())
}

/// Words between blanks, where a mark of two words is one.
struct Blanks<'a> {
    words: SplitWhitespace<'a>,
}

impl<'a> Iterator for Blanks<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let word = self.words.next()?;
        if word.as_bytes()[0].is_ascii_alphabetic()
            && let Some(pair) = self.words.clone().next().and_then(|second| marks::pair(word, second))
        {
            self.words.next();
            return Some(pair);
        }
        Some(word)
    }
}

/// Words of a line with quotes. Separators between quotes do not count.
struct Quoted<'a> {
    rest: Option<&'a str>,
    separator: Option<char>,
}

impl<'a> Iterator for Quoted<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let mut line = self.rest?;
        if self.separator.is_none() {
            line = line.trim_start();
            if line.is_empty() {
                return None;
            }
        }
        let mut is_inside = false;
        let is_end = |c: char| {
            is_inside ^= c == '"';
            !is_inside && self.separator.map_or(c.is_whitespace(), |separator| c == separator)
        };
        let (word, rest) = line.find(is_end).map_or((line, None), |end| {
            let (word, rest) = line.split_at(end);
            (word, Some(&rest[self.separator.map_or(0, char::len_utf8)..]))
        });
        self.rest = rest;
        Some(word.trim())
    }
}

/// A word without quotes around it.
pub(super) fn unquoted(word: &str) -> &str {
    let word = word.trim();
    let inside = |quote: char| word.strip_prefix(quote).and_then(|word| word.strip_suffix(quote));
    inside('"').or_else(|| inside('\'')).unwrap_or(word).trim()
}

/// A number, or `NaN` for a mark of a missing point.
///
/// `comma` says whether a comma may be the decimal point.
pub(crate) fn number(word: &str, comma: bool) -> Option<f64> {
    plain(word, comma).or_else(|| unusual(word, comma))
}

/// A number, or `NaN` for a mark of a missing point and for an empty field.
pub(super) fn cell(word: &str, comma: bool) -> Option<f64> {
    if word.is_empty() { Some(f64::NAN) } else { number(word, comma) }
}

fn plain(word: &str, comma: bool) -> Option<f64> {
    if comma && word.contains(',') { word.replacen(',', ".", 1).parse().ok() } else { word.parse().ok() }
}

/// A number between quotes, with a long minus, or with an exponent of Fortran (`1.5D-06`), or a mark.
#[cold]
fn unusual(word: &str, comma: bool) -> Option<f64> {
    let inside = unquoted(word);
    if inside.is_empty() {
        // Nothing between quotes is an empty field.
        return (inside.len() < word.len()).then_some(f64::NAN);
    }
    let is_fortran = inside.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c))
        && inside.bytes().all(|byte| byte.is_ascii_digit() || b"+-.,dD".contains(&byte));
    let written = if is_fortran { inside.replace(['d', 'D'], "e") } else { inside.replacen('\u{2212}', "-", 2) };
    plain(&written, comma).or_else(|| marks::value(inside))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(line: &str) -> Vec<Option<f64>> {
        let (words, comma) = words(line);
        words.map(|word| cell(word, comma)).collect()
    }

    #[test]
    fn empty_fields_quotes_and_marks_are_cells() {
        let (one, none) = (Some(1.5), Some(f64::NAN));
        let cases = [
            ("1.5,,1.5", vec![one, none, one]),
            ("1,5;;1.5", vec![one, none, one]),
            ("1.5\t\t1,5", vec![one, none, one]),
            ("\t1.5\t", vec![none, one, none]),
            ("\"1.5\",'1.5',\"\"", vec![one, one, none]),
            ("\"1,5\",\"1,5\",1.5", vec![one, one, one]),
            ("\"1,5\" \"1.5\"", vec![one, one]),
            ("1.5 No Data 1.5 not  measured", vec![one, none, one, none]),
            ("1,5 No Data 1,5", vec![one, none, one]),
            ("1.5\tNo Data\t1.5", vec![one, none, one]),
            ("1.5,No Data,1.5", vec![one, none, one]),
            ("1.5D+00 15d-1", vec![one, one]),
            ("\u{2212}1.5", vec![Some(-1.5)]),
            ("-nan +NaN", vec![none, none]),
            ("1.5,x", vec![one, None]),
        ];
        for (line, expected) in cases {
            let same = |(a, b): (&Option<f64>, &Option<f64>)| match (a, b) {
                (Some(a), Some(b)) => a.total_cmp(b).is_eq() || a.is_nan() && b.is_nan(),
                (a, b) => a == b,
            };
            let found = cells(line);
            assert!(found.len() == expected.len() && found.iter().zip(&expected).all(same), "{line:?}: {found:?}");
        }
        assert_eq!(number("", true), None, "nothing is no number");
    }

    #[test]
    fn a_row_may_begin_with_a_mark_of_a_spreadsheet() {
        assert_eq!(comment("#N/A,1,2"), None);
        assert_eq!(comment("#NA 1 2"), None);
        assert_eq!(comment("# N/A means nothing"), Some(" N/A means nothing"));
        assert_eq!(comment("#N/A means nothing"), Some("N/A means nothing"));
        assert_eq!(comment("#1,2"), Some("1,2"));
    }
}
