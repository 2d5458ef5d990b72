//! Lists on the command line: loads as a range or as single values, and seeds.

use std::str::FromStr;

use rc_core::Dimension;

/// Maximum number of values in a list. A larger number means that a number was mistyped.
const MOST: usize = 100_000;

/// Loads that are positive, finite, and strictly increasing or strictly decreasing.
#[derive(Clone, Debug, PartialEq)]
pub struct Loads(pub Vec<f64>);

/// Spacing of the values of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spacing {
    Geometric,
    Linear,
}

/// A reader of one number.
type Number<'a> = &'a dyn Fn(&str) -> Result<f64, String>;

impl Loads {
    /// Reads loads that may have units, such as `10kPa:1MPa:8`.
    ///
    /// The forms are those of [`Loads::from_str`].
    ///
    /// # Errors
    /// One line that says what is wrong and what would be right.
    pub fn with_units(text: &str, dimension: Dimension) -> Result<Self, String> {
        Self::read(text, &|number| checked(number, dimension.parse(number)?))
    }

    fn read(text: &str, number: Number<'_>) -> Result<Self, String> {
        let values = values(text, number)?;
        let rising = values.windows(2).all(|pair| pair[0] < pair[1]);
        let falling = values.windows(2).all(|pair| pair[0] > pair[1]);
        if rising || falling {
            Ok(Self(values))
        } else {
            Err(format!("values must all rise or all fall; those of '{text}' do not"))
        }
    }
}

impl FromStr for Loads {
    type Err = String;

    /// Reads a geometric range `first:last:count`, a range `first:last:count:linear`, or values with commas between
    /// them.
    fn from_str(text: &str) -> Result<Self, String> {
        Self::read(text, &|number| checked(number, number.trim().parse().unwrap_or(f64::NAN)))
    }
}

fn values(text: &str, number: Number<'_>) -> Result<Vec<f64>, String> {
    if text.contains(':') { range(text, number) } else { text.split(',').map(number).collect() }
}

fn range(text: &str, number: Number<'_>) -> Result<Vec<f64>, String> {
    let shape = || {
        format!("a range is first:last:count, with :linear if it is not geometric, for example 1e4:1e6:8, not '{text}'")
    };
    let parts: Vec<&str> = text.split(':').collect();
    let (first, last, count, spacing) = match parts[..] {
        [first, last, count] | [first, last, count, "geometric"] => (first, last, count, Spacing::Geometric),
        [first, last, count, "linear"] => (first, last, count, Spacing::Linear),
        _ => return Err(shape()),
    };
    let count: usize = count.trim().parse().map_err(|_| shape())?;
    if !(2..=MOST).contains(&count) {
        return Err(format!("a range has from 2 to {MOST} values, not {count}"));
    }
    Ok(spaced(number(first)?, number(last)?, count, spacing))
}

/// A range of `count` ≥ 2 values.
///
/// Both ends are exact, and the other values are rounded to 15 digits. `libm` gives the same values on every machine
/// that takes part in a sweep.
fn spaced(first: f64, last: f64, count: usize, spacing: Spacing) -> Vec<f64> {
    let end = count - 1;
    let value = |i: usize| match (i, spacing) {
        (0, _) => first,
        (i, _) if i == end => last,
        (i, Spacing::Geometric) => rounded(first * libm::pow(last / first, i as f64 / end as f64)),
        (i, Spacing::Linear) => rounded(first + (last - first) * (i as f64 / end as f64)),
    };
    (0..count).map(value).collect()
}

/// The value rounded to 15 digits, such as 0.0001 for 0.00009999999999999998.
fn rounded(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

fn checked(text: &str, value: f64) -> Result<f64, String> {
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(format!("each load is a positive, finite number, not '{text}'"))
    }
}

/// Distinct seeds, in the order in which they were given.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seeds(pub Vec<u64>);

impl FromStr for Seeds {
    type Err = String;

    /// Reads `first..last` (both included), a single seed, or several of these with commas between them.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut seeds = Vec::new();
        for part in text.split(',') {
            let (first, last) = part.split_once("..").unwrap_or((part, part));
            let (first, last) = (seed(first, text)?, seed(last, text)?);
            if first > last {
                return Err(format!("the range {part} is empty; the smaller seed goes first"));
            }
            if last - first >= MOST as u64 {
                return Err(format!("the range {part} has more than {MOST} seeds"));
            }
            seeds.extend(first..=last);
        }
        let mut sorted = seeds.clone();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(format!("seed {} is given twice", pair[0])),
            None => Ok(Self(seeds)),
        }
    }
}

fn seed(text: &str, whole: &str) -> Result<u64, String> {
    text.trim()
        .parse()
        .map_err(|_| format!("seeds are a range 1..7 (both ends included), a list 1,3,5, or both, not '{whole}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_geometric_unless_it_says_linear_and_has_exact_ends() {
        let Loads(values) = "1e-4:1e-2:8".parse().expect("a range");
        assert_eq!((values.len(), values[0], values[7]), (8, 1e-4, 1e-2));
        let ratio = 100_f64.powf(1.0 / 7.0);
        for pair in values.windows(2) {
            let error = pair[1] / pair[0] / ratio - 1.0;
            assert!(error.abs() < 1e-14, "{} to {}: off the ratio by {error:e}", pair[0], pair[1]);
        }
        assert_eq!("1e-6:1e-3:4".parse(), Ok(Loads(vec![1e-6, 1e-5, 1e-4, 1e-3])));
        assert_eq!("0.1:0.4:4:linear".parse(), Ok(Loads(vec![0.1, 0.2, 0.3, 0.4])));
        assert_eq!("1:4:4:linear".parse(), Ok(Loads(vec![1.0, 2.0, 3.0, 4.0])));
        assert_eq!("8:1:4:geometric".parse(), Ok(Loads(vec![8.0, 4.0, 2.0, 1.0])));
        assert_eq!("1e5, 2e5,7e5".parse(), Ok(Loads(vec![1e5, 2e5, 7e5])));
        assert_eq!("3".parse(), Ok(Loads(vec![3.0])));
    }

    #[test]
    fn loads_may_have_units() {
        let pressures = Loads::with_units("10kPa:1MPa:3", Dimension::Pressure);
        assert_eq!(pressures, Ok(Loads(vec![1e4, 1e5, 1e6])));
        assert_eq!(Loads::with_units("1um, 2e-6", Dimension::Length), Ok(Loads(vec![1e-6, 2e-6])));
        for (text, expected) in [("1um", "which is a length"), ("1,x", "must be a pressure"), ("0Pa", "positive")] {
            let error = Loads::with_units(text, Dimension::Pressure).expect_err(text);
            assert!(error.contains(expected), "'{text}': {error}");
        }
    }

    #[test]
    fn loads_that_are_none_empty_or_not_monotonic_are_refused() {
        let cases = [
            ("", "positive"),
            ("1,,2", "positive"),
            ("1,2,2", "must all rise or all fall"),
            ("1,3,2", "must all rise or all fall"),
            ("5:5:3", "must all rise or all fall"),
            ("1:2:0", "from 2 to"),
            ("1:2:1", "from 2 to"),
            ("1:2:9999999", "from 2 to"),
            ("1:2", "first:last:count"),
            ("1:2:3:cubic", "first:last:count"),
            ("1:2:-3", "first:last:count"),
            ("0:1:3", "positive"),
            ("-1:1:3:linear", "positive"),
            ("nan", "positive"),
            ("1,inf", "positive"),
            ("1:1.0000000000000002:9", "must all rise or all fall"),
        ];
        for (text, expected) in cases {
            let error = text.parse::<Loads>().expect_err(text);
            assert!(error.contains(expected), "'{text}': {error}");
        }
    }

    #[test]
    fn seeds_are_ranges_lists_or_both() {
        assert_eq!("1..4".parse(), Ok(Seeds(vec![1, 2, 3, 4])));
        assert_eq!("7, 3,0".parse(), Ok(Seeds(vec![7, 3, 0])));
        assert_eq!("1..3,9".parse(), Ok(Seeds(vec![1, 2, 3, 9])));
        for (text, expected) in [
            ("", "1..7"),
            ("a", "1..7"),
            ("-1", "1..7"),
            ("1..", "1..7"),
            ("5..1", "empty"),
            ("0..18446744073709551615", "more than"),
            ("1..3,2", "seed 2 is given twice"),
        ] {
            let error = text.parse::<Seeds>().expect_err(text);
            assert!(error.contains(expected), "'{text}': {error}");
        }
    }
}
