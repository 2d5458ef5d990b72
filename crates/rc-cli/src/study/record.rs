//! The results of a study: `study.json`, `study.csv`, and the text on the terminal.

use std::path::Path;

use rc_core::quantity::{Scale, count, digits, engineering};
use rc_heights::Treatment;
use rc_sweep::{Cells, MapOrigin, SweepRows};
use serde::{Deserialize, Serialize};

use super::ranges::{LoadRanges, Range};
use super::rows::{SAME_AS, STEP, TREATMENT};
use super::variants::Variant;
use crate::error::CliError;
use crate::files::names::STUDY_FILE;

/// A study with all its rows.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct StudyRecord {
    /// The command that repeats the study.
    pub(crate) command: String,
    /// The file of the map.
    pub(crate) source: MapOrigin,
    /// The treatments, the unchanged ones first.
    pub(crate) treatments: Vec<TreatmentOf>,
    /// Treatments that this map or contact does not allow.
    pub(crate) skipped: Vec<Skipped>,
    /// The range of each result at each load.
    pub(crate) loads: Vec<LoadRanges>,
    /// The lines of `study.csv`.
    pub(crate) rows: Vec<Cells>,
}

/// A treatment of the study.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct TreatmentOf {
    step: String,
    pub(crate) treatment: String,
    steps: Vec<String>,
    /// An earlier treatment that gives the same map, so that its results are those of this one.
    pub(crate) same_as: Option<String>,
}

/// A treatment without rows.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Skipped {
    pub(crate) treatment: String,
    pub(crate) reason: String,
}

impl TreatmentOf {
    /// The treatment of `variant`, which has the same map as `same_as`.
    pub(super) fn new(variant: &Variant, same_as: Option<&str>) -> Self {
        let steps = variant.treatments.iter().map(Treatment::to_string).collect();
        let (step, treatment) = (variant.step.to_owned(), variant.name.clone());
        Self { step, treatment, steps, same_as: same_as.map(Into::into) }
    }
}

/// The rows with their treatment first, and without a seed.
pub(super) fn lines(rows: &SweepRows) -> SweepRows {
    const FIRST: [&str; 3] = [STEP, TREATMENT, SAME_AS];
    let line = |row: &Cells| {
        let first = FIRST.map(|key| (key.to_owned(), row.get(key).cloned().unwrap_or_default()));
        let others = row.iter().filter(|(key, _)| !FIRST.contains(&key.as_str()) && key.as_str() != "seed");
        first.into_iter().chain(others.map(|(key, value)| (key.clone(), value.clone()))).collect()
    };
    rows.iter().map(|(index, row)| (*index, line(row))).collect()
}

/// Whether a prefix before the unit means what it says. It would belong to the metre, and not to its power.
pub(crate) fn takes_prefix(unit: &str) -> bool {
    !["1/m", "m³", "m³/s", "W/(m² K) or S/m²"].contains(&unit)
}

/// `value` in the words of a table.
pub(crate) fn words(value: f64, unit: &'static str) -> String {
    match unit {
        "" => digits(value, 4),
        _ if takes_prefix(unit) => engineering(value, unit),
        _ => format!("{} {unit}", digits(value, 4)),
    }
}

/// Relative error below which a value has only errors of rounding.
const ROUNDING: f64 = 1e-12;

/// `value` and `error` in the words of a table, in one unit: `178.6 ± 1.1 µm`, `(1.2 ± 0.3)e-20 m³`.
///
/// The error has two digits, and the value ends at the same place. An error of rounding is called so.
pub(crate) fn words_with_error(value: f64, error: f64, unit: &'static str) -> String {
    if !error.is_finite() || !value.is_finite() {
        return words(value, unit);
    }
    if error <= ROUNDING * value.abs() {
        return format!("{} ± rounding", words(value, unit));
    }
    let largest = value.abs().max(error);
    let has_prefix = !unit.is_empty() && takes_prefix(unit);
    let power = if has_prefix || (1e-3..1e6).contains(&largest) { 0 } else { largest.log10().floor() as i32 };
    let scale = Scale::of(largest, unit);
    let (factor, shown) = if has_prefix { (scale.factor, scale.unit()) } else { (10_f64.powi(power), unit.to_owned()) };
    // The digits of the error after rounding, and the place of the last one, from 10^0 down.
    let two = format!("{:.1e}", error / factor);
    let exponent: i32 = two.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    let place = 1 - exponent;
    let text = |value: f64| {
        let step = 10_f64.powi(-place.min(0));
        let whole = if place < 0 { (value / factor / step).round() * step } else { value / factor };
        format!("{whole:.*}", place.max(0) as usize)
    };
    let both = format!("{} ± {}", text(value), text(error));
    let both = if power != 0 { format!("({both})e{power}") } else { both };
    format!("{both} {shown}").trim_end().to_owned()
}

impl StudyRecord {
    /// The record in `folder`; `None` if there is none.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is no record of a study.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, CliError> {
        let path = folder.join(STUDY_FILE);
        let Ok(text) = std::fs::read_to_string(&path) else { return Ok(None) };
        let record = serde_json::from_str(&text);
        record.map(Some).map_err(|cause| {
            CliError::in_file(
                &path,
                format_args!("not a record of this version of rc study: {cause}; give rc study --resume"),
            )
        })
    }

    /// A table for each load.
    pub(crate) fn text(&self) -> String {
        let titles = ["as prepared", "mesh bar", "treatment_low", "treatment_high"];
        let titles = format!("  {:<24}{:<14}{:<14}{:<16}{}\n", "result", titles[0], titles[1], titles[2], titles[3]);
        let table = |load: &LoadRanges| {
            let n = count(load.n_treatments, "treatment");
            let lines: String = load.results.iter().map(line).collect();
            format!("  mean pressure {}, {n}\n{titles}{lines}\n", engineering(load.pressure, "Pa"))
        };
        let text: String = self.loads.iter().map(table).collect();
        let skipped = self.skipped.iter().map(|one| format!("  left out: {} ({})\n", one.treatment, one.reason));
        let same = self.treatments.iter().filter_map(|one| {
            let other = one.same_as.as_ref()?;
            Some(format!("  solved once: '{}' gives the map of '{other}'\n", one.treatment))
        });
        text + &skipped.chain(same).collect::<String>()
    }
}

fn line(range: &Range) -> String {
    let of = |value| words(value, range.si_unit());
    let bar = range.mesh_error.map_or_else(|| "-".to_owned(), of);
    let by = format!("{} to {}", range.low_by, range.high_by);
    let (low, high) = (of(range.treatment_low), of(range.treatment_high));
    format!("  {:<24}{:<14}{bar:<14}{low:<16}{high:<16}{by}\n", range.result, of(range.value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_ends_where_its_error_does() {
        for (value, error, unit, expected) in [
            (178.64e-6, 10.96e-6, "m", "179 ± 11 µm"),
            (6.16e9, 0.83e9, "Pa/m", "6.16 ± 0.83 GPa/m"),
            (25.86e-6, 2.5e-6, "m", "25.9 ± 2.5 µm"),
            (188.3e-6, 12e-9, "m", "188.300 ± 0.012 µm"),
            (0.5, 0.03, "", "0.500 ± 0.030"),
            (0.007_555, 0.000_94, "", "0.00756 ± 0.00094"),
            (599.2, 129.0, "1/m", "600 ± 130 1/m"),
            (1.234e-20, 3.4e-21, "m³", "(1.23 ± 0.34)e-20 m³"),
            (4.7e-9, 13.8e-9, "m", "5 ± 14 nm"),
            (0.999, 0.0996, "", "1.00 ± 0.10"),
            (1e5, 5.9e-12, "Pa", "100 kPa ± rounding"),
            (1e5, 0.0, "Pa", "100 kPa ± rounding"),
            (1e5, f64::NAN, "Pa", "100 kPa"),
        ] {
            assert_eq!(words_with_error(value, error, unit), expected);
        }
    }
}
