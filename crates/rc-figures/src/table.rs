//! Tables as CSV text, for people, for snapshots and for other programs.

use crate::comparison::{Comparison, Rule};
use crate::fit::Sample;

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

/// Rows of a table that is made column by column.
#[derive(Clone, Debug)]
pub(crate) struct Rows<T> {
    items: Vec<T>,
    header: Vec<&'static str>,
    cells: Vec<Vec<String>>,
    comparison: Comparison,
}

/// A value that a table can show: a number has seven digits, and a missing one is empty.
pub(crate) trait Cell {
    fn text(self) -> String;
}

impl Cell for f64 {
    fn text(self) -> String {
        number(self)
    }
}

impl Cell for usize {
    fn text(self) -> String {
        self.to_string()
    }
}

impl Cell for u64 {
    fn text(self) -> String {
        self.to_string()
    }
}

impl Cell for String {
    fn text(self) -> String {
        self
    }
}

impl<C: Cell> Cell for Option<C> {
    fn text(self) -> String {
        self.map_or_else(String::new, Cell::text)
    }
}

impl<T> Rows<T> {
    /// One row for each of `items`.
    pub(crate) fn of(items: impl IntoIterator<Item = T>) -> Self {
        let items: Vec<T> = items.into_iter().collect();
        let cells = items.iter().map(|_| Vec::new()).collect();
        Self { items, header: Vec::new(), cells, comparison: Comparison::default() }
    }

    /// The rows with one more column.
    pub(crate) fn column<C: Cell>(mut self, name: &'static str, cell: impl Fn(&T) -> C) -> Self {
        self.header.push(name);
        self.cells.iter_mut().zip(&self.items).for_each(|(row, item)| row.push(cell(item).text()));
        self
    }

    /// The rows with one more column, compared by `rule`.
    pub(crate) fn within<C: Cell>(mut self, name: &'static str, rule: Rule, cell: impl Fn(&T) -> C) -> Self {
        self.comparison.column(name, rule);
        self.column(name, cell)
    }

    /// The table of these rows.
    pub(crate) fn table(self, name: &'static str) -> Table {
        Table { comparison: self.comparison, ..Table::new(name, &self.header, self.cells) }
    }
}

/// A number in a summary, with the number of waves N of its surface, its standard error and the paper's number.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    name: String,
    unit: &'static str,
    value: f64,
    waves: Option<usize>,
    error: Option<f64>,
    paper: Option<f64>,
}

/// A quantity of no surface, without error and printed number.
pub(crate) fn quantity(name: impl Into<String>, unit: &'static str, value: f64) -> Quantity {
    Quantity { name: name.into(), unit, value, waves: None, error: None, paper: None }
}

/// The mean of a sample with its standard error.
pub(crate) fn sampled(name: &str, unit: &'static str, sample: Sample) -> Quantity {
    quantity(name, unit, sample.mean).error(sample.error())
}

impl Quantity {
    pub(crate) fn waves(self, waves: usize) -> Self {
        Self { waves: Some(waves), ..self }
    }

    pub(crate) fn error(self, error: f64) -> Self {
        Self { error: Some(error), ..self }
    }

    pub(crate) fn paper(self, paper: Option<f64>) -> Self {
        Self { paper, ..self }
    }
}

/// Summary of `quantities`, which has these columns beside quantity, unit and value.
pub(crate) fn summary(quantities: impl IntoIterator<Item = Quantity>, columns: &[&str]) -> Table {
    let rows =
        Rows::of(quantities).column("quantity", |one| one.name.clone()).column("unit", |one| one.unit.to_owned());
    let has = |name| columns.contains(&name);
    let rows = if has("waves") { rows.column("waves", |one| one.waves) } else { rows };
    let rows = rows.column("value", |one| one.value);
    let rows = if has("standard_error") { rows.column("standard_error", |one| one.error) } else { rows };
    let rows = if has("paper") { rows.column("paper", |one| one.paper) } else { rows };
    rows.table("summary")
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
