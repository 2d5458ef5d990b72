//! `sweep.csv`: the rows of a sweep in their order.

use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::content::{Cells, SweepRows};
use crate::error::SweepError;
use crate::files;
use crate::folder::TABLE_FILE;

/// Writes the table of `rows`, if there are any rows.
///
/// # Errors
/// [`SweepError::File`] when it cannot be written. An earlier table is not changed.
pub(crate) fn write(folder: &Path, rows: &SweepRows) -> Result<PathBuf, SweepError> {
    let path = folder.join(TABLE_FILE);
    if !rows.is_empty() {
        let text = to_csv(rows).map_err(|cause| SweepError::table(folder, cause))?;
        files::write_file(&path, |path| files::write_synced(path, &text))?;
    }
    Ok(path)
}

/// The rows as CSV with a line of column names. Numbers have the digits of the journal.
///
/// # Errors
/// The cause, when a row has another number of cells than the first.
pub fn to_csv(rows: &SweepRows) -> Result<Vec<u8>, String> {
    let mut out = csv::Writer::from_writer(Vec::new());
    if let Some(first) = rows.values().next() {
        out.write_record(first.keys()).map_err(|cause| cause.to_string())?;
    }
    for cells in rows.values() {
        out.write_record(cells.values().map(cell)).map_err(|cause| cause.to_string())?;
    }
    out.into_inner().map_err(|cause| cause.to_string())
}

/// Number of rows with the status `not_converged`.
#[must_use]
pub fn n_not_converged(rows: &SweepRows) -> usize {
    let failed = |cells: &&Cells| cells.get("status").is_some_and(|status| status == "not_converged");
    rows.values().filter(failed).count()
}

/// A value as one cell. Null is empty, and the values of a list have spaces between them.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Array(values) => values.iter().map(cell).collect::<Vec<_>>().join(" "),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn cells_are_numbers_text_lists_or_empty() {
        let value = json!({ "seed": 3, "reason": "a, b", "grid": [4, 8], "stiffness": null, "area": 1.25e-7 });
        let cells: Cells = value.as_object().expect("an object").clone();
        let csv = to_csv(&SweepRows::from([(0, cells)])).expect("a table");
        let text = String::from_utf8(csv).expect("text");
        assert_eq!(text, "seed,reason,grid,stiffness,area\n3,\"a, b\",4 8,,1.25e-7\n");
    }
}
