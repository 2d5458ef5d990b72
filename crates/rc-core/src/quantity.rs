//! Formatting of numbers with units, such as `446.4 kPa` and `13 µm`, and round tick marks.

/// A unit with a decimal prefix.
///
/// Related numbers, such as the tick marks of an axis, share a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Value of one prefixed unit. Divide a value by it to get the number that is written.
    pub factor: f64,
    prefix: &'static str,
    unit: &'static str,
}

const PREFIXES: [(f64, &str); 9] =
    [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];

impl Scale {
    /// The prefix that writes `largest` as a number from 1 to 1000, where possible.
    #[must_use]
    pub fn of(largest: f64, unit: &'static str) -> Self {
        let magnitude = largest.abs();
        // A value that rounds to 1000 at four digits gets the next larger prefix.
        let fits = |(factor, _): &&(f64, &str)| magnitude >= factor * 0.999_95;
        let smallest = if magnitude > 0.0 { PREFIXES[PREFIXES.len() - 1] } else { (1.0, "") };
        let (factor, prefix) = PREFIXES.iter().find(fits).copied().unwrap_or(smallest);
        Self { factor, prefix, unit }
    }

    /// The unit with its prefix, such as `MPa`.
    #[must_use]
    pub fn unit(&self) -> String {
        format!("{}{}", self.prefix, self.unit)
    }
}

/// Text of `value` in `unit`, with four significant digits and a decimal prefix: `446.4 kPa`.
#[must_use]
pub fn engineering(value: f64, unit: &'static str) -> String {
    let scale = Scale::of(value, unit);
    format!("{} {}", digits(value / scale.factor, 4), scale.unit()).trim_end().to_owned()
}

/// Text of `value` with `n` significant digits.
///
/// It is plain between 1e-4 and 1e6, and has an exponent elsewhere. Plain text has no trailing zeros after the point,
/// and an integer part of more than `n` digits is written in full.
#[must_use]
pub fn digits(value: f64, n: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&exponent) {
        return format!("{value:.*e}", n.saturating_sub(1));
    }
    let decimals = (n as i32 - 1 - exponent).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Text of a number of things, such as `1 row` or `3 rows`.
#[must_use]
pub fn count(n: usize, thing: &str) -> String {
    format!("{n} {thing}{}", if n == 1 { "" } else { "s" })
}

/// Text of `value` for pictures, with four significant digits and a true minus sign: `1.5`, `2e−17`.
#[must_use]
pub fn label(value: f64) -> String {
    let text = digits(value, 4);
    let text = match text.split_once('e') {
        Some((mantissa, exponent)) if mantissa.contains('.') => {
            format!("{}e{exponent}", mantissa.trim_end_matches('0').trim_end_matches('.'))
        }
        _ => text,
    };
    text.replace('-', "\u{2212}")
}

/// Rounds `limit` down to 1, 2 or 5 times a power of ten.
///
/// `limit` must be positive.
#[must_use]
pub fn round_below(limit: f64) -> f64 {
    let power = 10_f64.powf(limit.log10().floor());
    // The logarithm of a power of ten may have a rounding error, and the comparison too.
    let fits = |digit: &f64| digit * power <= limit * (1.0 + 1e-12);
    [10.0, 5.0, 2.0, 1.0].into_iter().find(fits).unwrap_or(0.5) * power
}

/// About `n` tick marks in [`low`, `high`], at multiples of a round step.
#[must_use]
pub fn ticks(low: f64, high: f64, n: usize) -> Vec<f64> {
    let span = high - low;
    if !(span.is_finite() && span > 0.0) {
        return vec![low];
    }
    let step = round_below(span / n.max(1) as f64 * 1.5);
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_thing_has_no_plural() {
        assert_eq!([0, 1, 2].map(|n| count(n, "row")), ["0 rows", "1 row", "2 rows"]);
    }

    #[test]
    fn quantities_are_written_with_prefix_and_four_digits() {
        let cases = [
            (446_394.98, "Pa", "446.4 kPa"),
            (13e-6, "m", "13 µm"),
            (999_960.0, "Pa", "1 MPa"),
            (0.0, "Pa", "0 Pa"),
            (2.5e15, "Pa", "2500 TPa"),
            (-1.5e-3, "m", "-1.5 mm"),
            (0.071_234, "", "71.23 m"),
        ];
        for (value, unit, expected) in cases {
            assert_eq!(engineering(value, unit), expected);
        }
    }

    #[test]
    fn labels_have_no_needless_zeros() {
        let cases = [(1e-17, "1e\u{2212}17"), (2.5e7, "2.5e7"), (-0.5, "\u{2212}0.5"), (1.234e-9, "1.234e\u{2212}9")];
        for (value, expected) in cases {
            assert_eq!(label(value), expected);
        }
    }

    #[test]
    fn round_numbers_are_round() {
        for (limit, expected) in [(1.0, 1.0), (0.99, 0.5), (2.5e-3, 2e-3), (5.0, 5.0), (1000.0, 1000.0), (9.9, 5.0)] {
            assert!((round_below(limit) / expected - 1.0).abs() < 1e-9, "{limit}: {}", round_below(limit));
        }
        assert_eq!(ticks(0.0, 10.0, 5), [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(ticks(3.0, 3.0, 5), [3.0]);
    }
}
