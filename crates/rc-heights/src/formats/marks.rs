//! Marks of missing points in texts.
//!
//! They are words, or numbers that the user or the file gives.

/// Words that mark a missing point, in lower case.
const WORDS: [&str; 34] = [
    "bad",
    "na",
    "n/a",
    "n.a.",
    "n.d.",
    "nv",
    "<na>",
    "#n/a",
    "#na",
    "#nv",
    "#value!",
    "#div/0!",
    "#num!",
    "#null!",
    "#ref!",
    "null",
    "(null)",
    "none",
    "nil",
    "nan()",
    "nan(ind)",
    "nan(snan)",
    "nodata",
    "no_data",
    "no-data",
    "no data",
    "not measured",
    "missing",
    "invalid",
    "void",
    "undef",
    "undefined",
    "masked",
    "blank",
];

/// Marks of two words.
const PAIRS: [[&str; 3]; 2] = [["no", "data", "no data"], ["not", "measured", "not measured"]];

/// Maximum number of bytes of a word that is a mark.
const LONGEST: usize = 16;

/// Maximum relative deviation of a number from a mark, for numbers that were rounded when they were written.
const SAME: f64 = 1e-6;

/// The value of a word that is not a number but stands for one, or for a missing point.
///
/// An infinite value stays infinite, because it is an overflow of a measured height.
pub(super) fn value(word: &str) -> Option<f64> {
    of_windows(word).or_else(|| is_mark(word).then_some(f64::NAN))
}

fn is_mark(word: &str) -> bool {
    let is_run_of = |byte: u8| word.len() > 1 && word.bytes().all(|other| other == byte);
    if is_run_of(b'-') || is_run_of(b'*') {
        return true;
    }
    if word.len() > LONGEST {
        return false;
    }
    let lower = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
    let joined = lower.split_whitespace().collect::<Vec<_>>().join(" ");
    WORDS.contains(&joined.as_str())
}

/// A number that is not finite, as old C libraries of Windows write it: `-1.#IND`, `1.#QNAN0`, `1.#INF`, `1.#J`.
fn of_windows(word: &str) -> Option<f64> {
    let (sign, digits) = word.strip_prefix('-').map_or((1.0, word), |digits| (-1.0, digits));
    let (_, kind) = digits
        .trim_start_matches('+')
        .split_once(".#")
        .or_else(|| digits.split_once(",#"))
        .filter(|(one, _)| *one == "1")?;
    let is = |name: &str| kind.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
    if is("INF") {
        return Some(sign * f64::INFINITY);
    }
    // Few decimals round these words like digits, to `1.#J`, `1.#R` and `1.#IO`.
    ["IND", "QNAN", "SNAN", "J", "R", "IO", "QO"].iter().any(|name| is(name)).then_some(f64::NAN)
}

/// The mark of two words.
pub(super) fn pair(first: &str, second: &str) -> Option<&'static str> {
    let is = |[a, b, _]: &&[&str; 3]| first.eq_ignore_ascii_case(a) && second.eq_ignore_ascii_case(b);
    PAIRS.iter().find(is).map(|[_, _, both]| *both)
}

/// Numbers that mark missing points.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Marks(Vec<f64>);

impl Marks {
    /// The marks of the user and those that the file declares.
    pub(super) fn new(of_user: &[f64], of_file: &[f64]) -> Self {
        Self([of_user, of_file].concat().into_iter().filter(|mark| mark.is_finite()).collect())
    }

    /// Makes the values missing that have a mark. They must be the numbers of the file, before any unit.
    pub(super) fn erase<'a>(&self, values: impl IntoIterator<Item = &'a mut f64>) {
        self.erase_scaled(values, 1.0);
    }

    /// The same for values that are the numbers of the file times `number`.
    pub(super) fn erase_scaled<'a>(&self, values: impl IntoIterator<Item = &'a mut f64>, number: f64) {
        if self.0.is_empty() {
            return;
        }
        let is = |value: f64, mark: f64| (value - mark * number).abs() <= SAME * (mark * number).abs();
        let is_marked = |value: f64| self.0.iter().any(|mark| is(value, *mark));
        values.into_iter().filter(|value| is_marked(**value)).for_each(|value| *value = f64::NAN);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_every_program_are_missing_points() {
        let words = [
            "Bad",
            "BAD",
            "NA",
            "n/a",
            "#N/A",
            "null",
            "NULL",
            "None",
            "-1.#IND",
            "-1.#IND00",
            "1.#QNAN",
            "1.#QNAN0",
            "-1.#J",
            "No Data",
            "no  data",
            "NoData",
            "***",
            "*****",
            "---",
            "--",
            "-nan(ind)",
            "<NA>",
            "#DIV/0!",
        ];
        for word in words {
            assert!(value(word).is_some_and(f64::is_nan), "{word}");
        }
        for (word, infinite) in [("1.#INF", f64::INFINITY), ("-1.#INF00", f64::NEG_INFINITY)] {
            assert_eq!(value(word), Some(infinite), "{word}");
        }
        for word in ["", "-", "x", "nothing", "1.#X", "2.#IND", "Data", "height"] {
            assert_eq!(value(word), None, "{word}");
        }
    }

    #[test]
    fn numbers_are_marks_as_they_were_written() {
        let mut values = [-9999.0, -9999.001, -9998.0, 3.402_823e38, 0.0];
        Marks::new(&[-9999.0], &[f64::from(f32::MAX), 0.0]).erase(&mut values);
        let missing: Vec<bool> = values.iter().map(|value| value.is_nan()).collect();
        assert_eq!(missing, [true, true, false, true, true]);
    }
}
