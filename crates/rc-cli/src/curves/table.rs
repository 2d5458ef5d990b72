//! `sweep.csv` read back.

use std::path::Path;

use rc_core::quantity::engineering;
use rc_sweep::{Cells, RowPlace, TABLE_FILE, rows_in, settings_in};
use serde_json::Value;

use super::columns;
use crate::error::CliError;

/// Units of keys that may be varied.
const UNITS: [(&str, &str); 12] = [
    ("hardness", "Pa"),
    ("e_star", "Pa"),
    ("young", "Pa"),
    ("young2", "Pa"),
    ("force", "N"),
    ("cell", "m"),
    ("cell_y", "m"),
    ("rms", "m"),
    ("layer_thickness", "m"),
    ("radius", "m"),
    ("wavelength", "m"),
    ("wave_amplitude", "m"),
];

/// Columns that every row has a number in.
const NEEDED: [&str; 4] = ["control_value", "mean_pressure", "penetration", "area_fraction"];

/// A row of a sweep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    /// Name of the scene, with the varied keys and their values; empty if there is only one.
    pub(crate) scene: String,
    /// The same in the words of the page.
    pub(crate) label: String,
    pub(crate) seed: Option<u64>,
    /// Prescribed pressure (Pa) or penetration (m).
    pub(crate) load: f64,
    /// `pressure` or `penetration`.
    pub(crate) control: String,
    pub(crate) status: String,
    /// Codes of the warnings, with blanks between them.
    pub(crate) warnings: String,
    /// The numbers of the row by their columns, in SI units. Empty fields are null.
    pub(crate) cells: Cells,
    /// Where the row comes from, if the journal says so.
    pub(crate) place: Option<RowPlace>,
}

impl Row {
    /// The number in a column.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        columns::number(&self.cells, key)
    }

    /// The name of scene and seed, if there is any.
    pub(crate) fn surface(&self) -> String {
        let seed = self.seed.map(|seed| format!("seed {seed}"));
        let parts = [self.label.clone(), seed.unwrap_or_default()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

/// The rows of a sweep, with the settings in its journal.
#[derive(Clone, Debug)]
pub(crate) struct SweepTable {
    /// At least one row, ordered by scene, seed and load.
    pub(crate) rows: Vec<Row>,
    pub(crate) settings: Option<Value>,
}

impl SweepTable {
    /// Reads the table in `folder`.
    ///
    /// # Errors
    /// [`CliError::Input`] when it does not have the format of a sweep, or has no rows.
    pub(crate) fn read(folder: &Path) -> Result<Self, CliError> {
        let path = folder.join(TABLE_FILE);
        let fail = |cause: String| CliError::in_file(&path, format_args!("not a table of rc sweep: {cause}"));
        let mut reader = csv::Reader::from_path(&path).map_err(|cause| fail(cause.to_string()))?;
        let heads = reader.headers().map_err(|cause| fail(cause.to_string()))?.clone();
        let mut rows = Vec::new();
        for (number, record) in (2..).zip(reader.records()) {
            let record = record.map_err(|cause| fail(cause.to_string()))?;
            rows.push(row(&heads, &record).map_err(|message| fail(format!("line {number}: {message}")))?);
        }
        if rows.is_empty() {
            return Err(CliError::in_file(&path, "has no rows"));
        }
        // A journal with more rows belongs to a sweep that goes on.
        let places = rows_in(folder).filter(|places| places.len() == rows.len()).unwrap_or_default();
        for (row, place) in rows.iter_mut().zip(places) {
            row.place = Some(place);
        }
        Ok(Self { rows, settings: settings_in(folder) })
    }

    /// Runs of rows of the same scene.
    pub(crate) fn scenes(&self) -> Vec<&[Row]> {
        self.rows.chunk_by(|a, b| a.scene == b.scene).collect()
    }

    /// Runs of rows of the same scene and seed.
    pub(crate) fn surfaces(&self) -> Vec<&[Row]> {
        self.rows.chunk_by(|a, b| (&a.scene, a.seed) == (&b.scene, b.seed)).collect()
    }

    /// Whether a constant ratio is between the loads, of which there are at least three.
    pub(crate) fn is_geometric(&self) -> bool {
        let mut loads: Vec<f64> = self.rows.iter().map(|row| row.load).collect();
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        let ratios: Vec<f64> = loads.windows(2).map(|pair| pair[1] / pair[0]).collect();
        // Loads over decades may be round numbers, such as 1e5,2e5,5e5,1e6.
        let spread = if loads[loads.len() - 1] >= 9.9 * loads[0] { 0.35 } else { 0.02 };
        let is_equal = |ratio: &f64| (ratio.ln() / ratios[0].ln() - 1.0).abs() < spread;
        ratios.len() >= 2 && ratios[0].is_finite() && loads[0] > 0.0 && ratios.iter().all(is_equal)
    }
}

fn row(heads: &csv::StringRecord, record: &csv::StringRecord) -> Result<Row, String> {
    let text = |key: &str| heads.iter().position(|head| head == key).and_then(|i| record.get(i)).unwrap_or_default();
    let value = |text: &str| text.parse::<f64>().map_or(Value::Null, Value::from);
    let cells: Cells = heads.iter().zip(record).map(|(head, text)| (head.to_owned(), value(text))).collect();
    if let Some(key) = NEEDED.iter().find(|key| columns::number(&cells, key).is_none()) {
        return Err(format!("no number in the column {key}"));
    }
    let varied = varied(heads, record);
    let named = |words: fn(&str, &str) -> String| {
        let parts = varied.iter().map(|(key, value)| words(key, value));
        let scene = text("scene").to_owned();
        [scene].into_iter().chain(parts).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    };
    let is_varied = |key: &String| varied.iter().any(|(name, _)| name == key);
    let load = columns::number(&cells, "control_value").unwrap_or_default();
    Ok(Row {
        scene: named(|key, value| format!("{key} {value}")),
        label: named(in_words),
        seed: text("seed").parse().ok(),
        load,
        control: text("control").to_owned(),
        status: text("status").to_owned(),
        warnings: text("warnings").to_owned(),
        cells: cells
            .iter()
            .filter(|(key, _)| !is_varied(key))
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect(),
        place: None,
    })
}

/// The varied keys of a row with their values. They are between load and status.
fn varied<'a>(heads: &'a csv::StringRecord, record: &'a csv::StringRecord) -> Vec<(&'a str, &'a str)> {
    let cells = heads.iter().zip(record).skip_while(|(head, _)| *head != "control_value").skip(1);
    cells.take_while(|(head, _)| *head != "status").collect()
}

/// A varied key with its value, such as `hardness = 5 MPa`.
fn in_words(key: &str, value: &str) -> String {
    let unit = UNITS.iter().find(|(name, _)| *name == key).map(|(_, unit)| *unit);
    let value = match (value.parse::<f64>(), unit) {
        (Ok(number), Some(unit)) => engineering(number, unit),
        (Ok(number), None) => number.to_string(),
        (Err(_), _) => value.to_owned(),
    };
    format!("{} = {value}", key.replace('_', " "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_of_a_constant_ratio_are_geometric() {
        let table = |loads: &[f64]| {
            let rows = loads.iter().map(|&load| Row { load, ..Row::default() }).collect();
            SweepTable { rows, settings: None }
        };
        for loads in [&[1e4, 1e5, 1e6][..], &[1e5, 2e5, 5e5, 1e6], &[1.0, 2.0, 4.0, 1.0, 2.0, 4.0]] {
            assert!(table(loads).is_geometric(), "{loads:?}");
        }
        for loads in [&[1e4, 1e5][..], &[1.0, 2.0, 3.0, 4.0], &[2.0, 3.0, 4.0], &[0.0, 1.0, 2.0], &[3.0]] {
            assert!(!table(loads).is_geometric(), "{loads:?}");
        }
    }
}
