//! `rc inspect` of a sweep: means over its seeds as text, JSON and `means.csv`.

use std::path::Path;

use rc_sweep::files::{self, write_synced};
use rc_sweep::{Cells, to_json};
use serde_json::{Value, json};

use super::columns::{PRESSURE, QUANTITIES, Quantity, bar_of, is_result, number};
use super::means::{AtLoad, Mean};
use super::sealing::Sealing;
use super::table::{Row, SweepTable};
use crate::error::CliError;
use crate::study::record::{words, words_with_error};

/// File of the means in the folder of `--out`.
const MEANS_FILE: &str = "means.csv";

/// The text about the sweep in `folder`, or its JSON. With `out`, the means are also written to this folder.
///
/// # Errors
/// [`CliError`].
pub(crate) fn of_sweep(folder: &Path, json: bool, out: Option<&Path>) -> Result<String, CliError> {
    let table = SweepTable::read(folder)?;
    let records = records(&table);
    let sealing = Sealing::read(folder)?;
    let mut written = String::new();
    if let Some(out) = out {
        files::check_folder(out)?;
        let path = out.join(MEANS_FILE);
        files::write_file(&path, |path| write_synced(path, csv(&records).as_bytes()))?;
        written = format!("\nwritten to {}\n", path.display());
    }
    if json {
        let mut record = json!({ "control": table.rows[0].control, "means": records });
        if let Some(sealing) = &sealing {
            record["sealing"] = json!(sealing);
        }
        return Ok(to_json(&record));
    }
    let sealing = sealing.map_or_else(String::new, |sealing| sealing.lines());
    Ok(table.scenes().into_iter().map(scene).collect::<String>() + &sealing + &written)
}

/// The means of all numbers that are results, a record for each scene and load, with the columns of `means.csv`.
fn records(table: &SweepTable) -> Vec<Cells> {
    let scenes = table.scenes();
    let several = scenes.len() > 1;
    let has = |key: &&String| table.rows.iter().any(|row| number(&row.cells, key).is_some());
    let keys: Vec<&String> = table.rows[0].cells.keys().filter(|key| is_result(key)).filter(has).collect();
    let record = |at: &AtLoad<'_>| {
        let mut cells = Cells::new();
        if several {
            cells.insert("scene".to_owned(), at.rows[0].scene.clone().into());
        }
        let load = if table.against == PRESSURE { "load" } else { table.against.name };
        cells.insert(load.to_owned(), at.load.into());
        cells.insert("seeds".to_owned(), at.rows.len().into());
        for key in &keys {
            let value = |row: &Row| Some([number(&row.cells, key)?, bar_of(&row.cells, key).unwrap_or(0.0)]);
            let mean = at.mean_of(value);
            cells.insert((*key).clone(), json!(mean.map(|mean| mean.value)));
            cells.insert(format!("{key}_standard_error"), json!(mean.and_then(|mean| mean.standard_error)));
        }
        cells
    };
    scenes.iter().flat_map(|rows| AtLoad::all(rows)).map(|at| record(&at)).collect()
}

fn csv(records: &[Cells]) -> String {
    let cell = |value: &Value| match value {
        Value::Null => String::new(),
        Value::String(text) if text.contains([',', '"', '\n']) => format!("\"{}\"", text.replace('"', "\"\"")),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    let heads: Vec<String> = records.first().map(|record| record.keys().cloned().collect()).unwrap_or_default();
    let lines = records.iter().map(|record| record.values().map(cell).collect::<Vec<_>>().join(","));
    std::iter::once(heads.join(",")).chain(lines).fold(String::new(), |text, line| text + &line + "\n")
}

/// The table of a scene: a line for each load.
fn scene(rows: &[Row]) -> String {
    let loads = AtLoad::all(rows);
    let has = |quantity: &&Quantity| loads.iter().any(|at| at.mean(**quantity).is_some());
    let shown: Vec<&Quantity> = QUANTITIES.iter().filter(has).collect();
    let control = if rows[0].control == "pressure" { PRESSURE.key() } else { &rows[0].control };
    let mut lines = vec![vec![control.replace('_', " "), "seeds".to_owned()]];
    let others = shown.iter().filter(|quantity| quantity.key() != control);
    let others: Vec<&Quantity> =
        (control == "penetration").then_some(&PRESSURE).into_iter().chain(others.copied()).collect();
    lines[0].extend(others.iter().map(|quantity| quantity.words.to_owned()));
    for at in &loads {
        let mut line = vec![at.rows[0].load_in_words(), at.rows.len().to_string()];
        line.extend(
            others.iter().map(|quantity| at.mean(**quantity).map_or_else(|| "-".to_owned(), |m| cell(quantity, m))),
        );
        lines.push(line);
    }
    let label = if rows[0].label.is_empty() { String::new() } else { format!("{}\n", rows[0].label) };
    label + &aligned(&lines) + "\n"
}

/// A mean with its standard error, such as `15.10 ± 0.20 µm`.
pub(crate) fn cell(quantity: &Quantity, mean: Mean) -> String {
    let unit = quantity.unit;
    // What is given is the same for all seeds.
    let error = mean.standard_error.filter(|error| *error > 1e-12 * mean.value.abs());
    error.map_or_else(|| words(mean.value, unit), |error| words_with_error(mean.value, error, unit))
}

/// Lines of cells in columns as wide as their longest cell.
pub(crate) fn aligned(lines: &[Vec<String>]) -> String {
    let n = lines.iter().map(Vec::len).max().unwrap_or(0);
    let length = |text: &String| text.chars().count();
    let width = |i: usize| lines.iter().filter_map(|line| line.get(i)).map(length).max().unwrap_or(0) + 2;
    let widths: Vec<usize> = (0..n).map(width).collect();
    let line = |cells: &Vec<String>| {
        let padded = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("  {}\n", padded.collect::<String>().trim_end())
    };
    lines.iter().map(line).collect()
}
