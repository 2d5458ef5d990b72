//! Tables as CSV text, for people, for snapshots and for other programs.

use crate::comparison::{Comparison, Rule};

/// A table with a name and the rules of its comparison with an earlier table.
///
/// The name is also the end of its file's name.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Name of the table and end of its file's name.
    pub name: &'static str,
    /// Header and rows as CSV text.
    pub csv: String,
    /// Rules of the comparison with an earlier table.
    pub comparison: Comparison,
}

impl Table {
    /// A table from its header and rows. Cells must not contain commas, since nothing is quoted.
    #[must_use]
    pub fn new(name: &'static str, header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> Self {
        let rows = rows.into_iter().map(|row| row.join(","));
        let lines = [header.join(",")].into_iter().chain(rows);
        Self { name, csv: lines.map(|line| line + "\n").collect(), comparison: Comparison::default() }
    }

    /// The table with `rule` as the rule of a column.
    ///
    /// # Panics
    /// When no column has this name.
    #[must_use]
    pub fn column(mut self, name: &'static str, rule: Rule) -> Self {
        let header = self.csv.lines().next().unwrap_or_default();
        assert!(header.split(',').any(|cell| cell == name), "table {} has no column {name}: {header}", self.name);
        self.comparison.column(name, rule);
        self
    }

    /// The table with `rule` as the rule of all rows that begin with `first`.
    ///
    /// The rule holds in every column.
    #[must_use]
    pub fn row(mut self, first: &str, rule: Rule) -> Self {
        self.comparison.row(first, rule);
        self
    }

    /// The table with `rule` for everything that has no other rule.
    #[must_use]
    pub fn rest(mut self, rule: Rule) -> Self {
        self.comparison.rest(rule);
        self
    }

    /// The table with its columns aligned, for the terminal.
    #[must_use]
    pub fn aligned(&self) -> String {
        let rows: Vec<Vec<&str>> = self.csv.lines().map(|line| line.split(',').collect()).collect();
        let n_columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let width =
            |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.len()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..n_columns).map(width).collect();
        let line = |row: &Vec<&str>| {
            let cells = row.iter().zip(&widths).map(|(cell, width)| format!("{cell:>width$}"));
            cells.collect::<Vec<_>>().join("  ") + "\n"
        };
        rows.iter().map(line).collect()
    }
}

/// A number with seven digits, as in all tables of this project.
#[must_use]
pub fn number(value: f64) -> String {
    format!("{value:.6e}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_csv_and_aligns() {
        let table =
            Table::new("t", &["name", "x"], [vec!["a".to_owned(), number(0.5)], vec!["bc".to_owned(), "-".to_owned()]]);
        assert_eq!(table.csv, "name,x\na,5.000000e-1\nbc,-\n");
        assert_eq!(table.aligned(), "name            x\n   a  5.000000e-1\n  bc            -\n");
    }
}
