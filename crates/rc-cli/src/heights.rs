//! Height maps from files: `.npy` and `.csv`, checked to be finite and not flat.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use rc_core::{Field, Grid};

use crate::error::CliError;
use crate::npy;

/// Reads a height map, in the unit of the file (m). Row `iy` of the file is row `iy` of the field.
///
/// # Errors
/// [`CliError::Input`] when the file cannot be read, is neither `.npy` nor `.csv`, is not a full 2-D array of real numbers,
/// or holds `NaN` or an infinite value.
pub fn read(path: &Path) -> Result<Field, CliError> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let field = match extension.as_deref() {
        Some("npy") => npy::read(path)?,
        Some("csv" | "txt") => read_csv(path)?,
        _ => return Err(CliError::in_file(path, "a height map is a .npy or a .csv file")),
    };
    check_finite(path, &field)?;
    Ok(field)
}

/// Refuses a field with `NaN` or an infinite value.
///
/// # Errors
/// [`CliError::Input`] with row, column and value.
pub fn check_finite(path: &Path, field: &Field) -> Result<(), CliError> {
    let nx = field.grid().nx();
    match field.values().iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(i) => {
            let (row, column, value) = (i / nx, i % nx, field.values()[i]);
            let place = format_args!("row {row}, column {column} (from 0) is {value}; heights must be finite");
            Err(CliError::in_file(path, place))
        }
    }
}

/// Comma-separated numbers, one row of the map a line; lines that start with `#` are comments.
fn read_csv(path: &Path) -> Result<Field, CliError> {
    let fail = |message: String| CliError::in_file(path, message);
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path)
        .map_err(|cause| fail(format!("cannot read: {cause}")))?;
    let (mut values, mut columns, mut rows) = (Vec::new(), 0, 0);
    for record in reader.records() {
        let record = record.map_err(|cause| fail(cause.to_string()))?;
        let line = record.position().map_or(0, csv::Position::line);
        if rows == 0 {
            columns = record.len();
        } else if record.len() != columns {
            return Err(fail(format!("line {line} has {} values, the lines before have {columns}", record.len())));
        }
        for (i, text) in record.iter().enumerate() {
            let value = text.parse::<f64>();
            values.push(value.map_err(|_| fail(format!("line {line}, value {}: '{text}' is no number", i + 1)))?);
        }
        rows += 1;
    }
    let grid = Grid::new(columns, rows).map_err(|cause| fail(cause.to_string()))?;
    Field::new(grid, values).map_err(|cause| fail(cause.to_string()))
}

/// Writes heights as CSV, one row of the map a line, each value multiplied by `factor`; values read back exactly.
///
/// # Errors
/// Those of the file system.
pub fn write_csv(path: &Path, field: &Field, factor: f64) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    for iy in 0..field.grid().ny() {
        for (ix, value) in field.row(iy).iter().enumerate() {
            let comma = if ix == 0 { "" } else { "," };
            write!(out, "{comma}{:e}", value * factor)?;
        }
        writeln!(out)?;
    }
    out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn csv(text: &str) -> Result<Field, CliError> {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("map.csv");
        std::fs::write(&path, text).expect("a temporary file");
        read(&path)
    }

    #[test]
    fn a_csv_map_is_read_row_by_row() {
        let field = csv("# heights\n1, 2, 3\n4, -5e-1, 6\n").expect("a field");
        assert_eq!((field.grid().nx(), field.grid().ny()), (3, 2));
        assert_eq!(field.values(), [1.0, 2.0, 3.0, 4.0, -0.5, 6.0]);
    }

    #[test]
    fn written_csv_reads_back_exactly() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("map.csv");
        let field = Field::from_fn(Grid::new(3, 2).expect("a grid"), |x, y| (x - 0.3).exp() * y * 1e-7);
        write_csv(&path, &field, 1.0).expect("a written file");
        assert_eq!(read(&path).expect("a field"), field);
    }

    #[test]
    fn bad_csv_is_refused_with_its_place() {
        let cases = [
            ("1,2\n3\n", "line 2 has 1 values"),
            ("1,2\n3,x\n", "line 2, value 2"),
            ("1,\n3,4\n", "line 1, value 2"),
            ("1,2\n3,nan\n", "row 1, column 1"),
            ("1,inf\n3,4\n", "row 0, column 1"),
            ("", "1 to"),
        ];
        for (text, expected) in cases {
            let error = csv(text).expect_err(text).to_string();
            assert!(error.contains(expected) && !error.contains('\n'), "{text:?}: {error}");
        }
    }
}
