//! `sweep.csv`: the rows of a sweep in their order.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::content::Rows;
use crate::error::CliError;
use crate::output;

/// The table's name in the folder of a sweep.
pub(crate) const TABLE_FILE: &str = "sweep.csv";

/// Writes the table of `rows`, if there are any.
///
/// # Errors
/// [`CliError::Write`]; an earlier table is left as it was.
pub(super) fn write(folder: &Path, rows: &Rows) -> Result<PathBuf, CliError> {
    let path = folder.join(TABLE_FILE);
    if !rows.is_empty() {
        let text = to_csv(rows).map_err(|cause| CliError::write(&path, cause))?;
        output::write_file(&path, |path| output::write_synced(path, &text))?;
    }
    Ok(path)
}

/// The rows as CSV with a line of column names. Numbers have the digits of the journal.
pub(super) fn to_csv(rows: &Rows) -> Result<Vec<u8>, String> {
    let mut out = csv::Writer::from_writer(Vec::new());
    if let Some(first) = rows.values().next() {
        out.write_record(first.keys()).map_err(|cause| cause.to_string())?;
    }
    for cells in rows.values() {
        out.write_record(cells.values().map(cell)).map_err(|cause| cause.to_string())?;
    }
    out.into_inner().map_err(|cause| cause.to_string())
}

/// A value as one cell: empty for none, a space between the values of a list.
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
    use crate::sweep::content::Cells;

    #[test]
    fn cells_are_numbers_text_lists_or_empty() {
        let value = json!({ "seed": 3, "reason": "a, b", "grid": [4, 8], "stiffness": null, "area": 1.25e-7 });
        let cells: Cells = value.as_object().expect("an object").clone();
        let csv = to_csv(&Rows::from([(0, cells)])).expect("a table");
        let text = String::from_utf8(csv).expect("text");
        assert_eq!(text, "seed,reason,grid,stiffness,area\n3,\"a, b\",4 8,,1.25e-7\n");
    }
}
