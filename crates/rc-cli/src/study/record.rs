//! The results of a study: `study.json`, `study.csv`, and the text on the terminal.

use rc_core::quantity::{count, digits, engineering};
use rc_heights::Treatment;
use rc_sweep::{Cells, MapOrigin, SweepRows};
use serde::Serialize;

use super::ranges::{LoadRanges, Range};
use super::rows::{STEP, TREATMENT};
use super::variants::Variant;

/// A study with all its rows.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct StudyRecord {
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
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TreatmentOf {
    step: &'static str,
    treatment: String,
    steps: Vec<String>,
}

/// A treatment without rows.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Skipped {
    pub(crate) treatment: String,
    pub(crate) reason: String,
}

impl From<&Variant> for TreatmentOf {
    fn from(variant: &Variant) -> Self {
        let steps = variant.treatments.iter().map(Treatment::to_string).collect();
        Self { step: variant.step, treatment: variant.name.clone(), steps }
    }
}

/// The rows with their treatment first, and without a seed.
pub(super) fn lines(rows: &SweepRows) -> SweepRows {
    let line = |row: &Cells| {
        let first = [STEP, TREATMENT].map(|key| (key.to_owned(), row.get(key).cloned().unwrap_or_default()));
        let others = row.iter().filter(|(key, _)| ![STEP, TREATMENT, "seed"].contains(&key.as_str()));
        first.into_iter().chain(others.map(|(key, value)| (key.clone(), value.clone()))).collect()
    };
    rows.iter().map(|(index, row)| (*index, line(row))).collect()
}

/// `value` in the words of a table.
pub(crate) fn words(value: f64, unit: &'static str) -> String {
    if unit.is_empty() { digits(value, 4) } else { engineering(value, unit) }
}

impl StudyRecord {
    /// A table for each load.
    pub(super) fn text(&self) -> String {
        let titles = ["as prepared", "mesh bar", "treatment_low", "treatment_high"];
        let titles = format!("  {:<24}{:<14}{:<14}{:<16}{}\n", "result", titles[0], titles[1], titles[2], titles[3]);
        let table = |load: &LoadRanges| {
            let n = count(load.n_treatments, "treatment");
            let lines: String = load.results.iter().map(line).collect();
            format!("  mean pressure {}, {n}\n{titles}{lines}\n", engineering(load.pressure, "Pa"))
        };
        let text: String = self.loads.iter().map(table).collect();
        let skipped = self.skipped.iter().map(|one| format!("  left out: {} ({})\n", one.treatment, one.reason));
        text + &skipped.collect::<String>()
    }
}

fn line(range: &Range) -> String {
    let of = |value| words(value, range.unit);
    let bar = range.mesh_error.map_or_else(|| "-".to_owned(), of);
    let by = format!("{} to {}", range.low_by, range.high_by);
    let (low, high) = (of(range.treatment_low), of(range.treatment_high));
    format!("  {:<24}{:<14}{bar:<14}{low:<16}{high:<16}{by}\n", range.result, of(range.value))
}
