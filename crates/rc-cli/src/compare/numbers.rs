//! The numbers of two summaries.

use rc_core::quantity::digits;
use rc_sweep::{Cells, Summary};
use serde::Serialize;

use crate::curves::columns::{bar_of, is_result, number, unit_of};
use crate::study::record::{words, words_with_error};

/// Ratio of a bar or a difference to its value below which it is rounding.
const ROUNDING: f64 = 1e-12;

/// A number of both results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Compared {
    /// Key of the summary.
    pub(super) key: String,
    /// SI unit.
    unit: &'static str,
    /// The values; null where a result does not have it.
    a: Option<f64>,
    b: Option<f64>,
    /// Error bars of the mesh, where they are known.
    a_bar: Option<f64>,
    b_bar: Option<f64>,
    /// b - a.
    difference: Option<f64>,
    /// The difference divided by the root of the sum of the squares of both bars.
    bars: Option<f64>,
}

/// All numbers that are results of either summary.
pub(super) fn all(a: &Summary, b: &Summary) -> Vec<Compared> {
    let [a, b] = [a.cells(), b.cells()];
    let only_b = b.keys().filter(|key| !a.contains_key(*key));
    let keys = a.keys().chain(only_b).filter(|key| is_result(key));
    let has_number = |key: &&String| number(&a, key).is_some() || number(&b, key).is_some();
    keys.filter(has_number).map(|key| Compared::of(key, &a, &b)).collect()
}

impl Compared {
    fn of(key: &str, a: &Cells, b: &Cells) -> Self {
        let [value_a, value_b] = [a, b].map(|cells| number(cells, key));
        let [a_bar, b_bar] = [a, b].map(|cells| bar_of(cells, key));
        let difference = value_a.zip(value_b).map(|(a, b)| b - a);
        let largest = value_a.unwrap_or(0.0).abs().max(value_b.unwrap_or(0.0).abs());
        let width = a_bar.unwrap_or(0.0).hypot(b_bar.unwrap_or(0.0));
        let bars = difference.filter(|_| width > ROUNDING * largest).map(|difference| difference / width);
        Self { key: key.to_owned(), unit: unit_of(key), a: value_a, b: value_b, a_bar, b_bar, difference, bars }
    }

    /// The cells of a line of the table.
    pub(super) fn line(&self) -> Vec<String> {
        let dash = || "-".to_owned();
        let of = |value: f64| words(value, self.unit);
        let with_bar = |value: Option<f64>, bar: Option<f64>| {
            let Some(value) = value else { return dash() };
            match bar.filter(|bar| *bar > ROUNDING * value.abs()) {
                Some(bar) => words_with_error(value, bar, self.unit),
                None => of(value),
            }
        };
        let relative = self.difference.zip(self.a).filter(|(_, a)| *a != 0.0);
        let percent = relative.map_or_else(dash, |(difference, a)| format!("{} %", digits(100.0 * difference / a, 3)));
        vec![
            self.key.replace('_', " "),
            with_bar(self.a, self.a_bar),
            with_bar(self.b, self.b_bar),
            self.difference.map_or_else(dash, of),
            percent,
            self.bars.map_or_else(dash, |bars| digits(bars, 2)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_difference_is_measured_in_both_bars() {
        let cells = |area: f64| -> Cells {
            let cells = json!({ "area_fraction": area, "area_fraction_error": 0.3 * area, "max_pressure": 2e6 });
            cells.as_object().expect("an object").clone()
        };
        let (a, b) = (cells(1.0), cells(0.75));
        let area = Compared::of("area_fraction", &a, &b);
        let bars = 0.25 / f64::hypot(0.3, 0.225);
        assert!((area.bars.expect("bars") + bars).abs() < 1e-12, "{area:?}");
        // 0.3 times 0.75 is a little less than 0.225.
        assert_eq!(area.line(), ["area fraction", "1.00 ± 0.30", "0.75 ± 0.22", "-0.25", "-25 %", "-0.67"]);
        let pressure = Compared::of("max_pressure", &a, &b);
        assert_eq!(pressure.line(), ["max pressure", "2 MPa", "2 MPa", "0 Pa", "0 %", "-"]);
        assert_eq!(Compared::of("hardness", &a, &b).line()[1..], ["-"; 5]);
    }
}
