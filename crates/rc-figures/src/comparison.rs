//! Comparison of a table with an earlier one, by rules for its columns.
//!
//! The code that writes a table states the allowed differences. Processors have different vector instructions, which
//! round sums in another order. A solve to the same tolerance then ends at a slightly different solution. The size of
//! this difference depends on the scale of a column, not on a number itself. For instance, a pressure beside a contact
//! edge moves by a small fraction of the peak pressure, which may be the whole pressure there. Text and the numbers of
//! cells and rows must agree.

/// The allowed difference of a number from its reference.
///
/// A number `b` agrees with the reference `a` when |a - b| ≤ absolute + relative·|a| + of_scale·s. s is the largest
/// magnitude in the column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    absolute: f64,
    relative: f64,
    of_scale: f64,
    /// Fraction of |v|, where v is the number in column `value` of the same row.
    of_value: f64,
    /// Column with a count n behind the number, and the allowed difference over √n.
    ///
    /// Without a column, the number itself is the count.
    count: Option<(Option<&'static str>, f64)>,
}

impl Rule {
    /// The default rule: seven digits, of which the last may differ by rounding.
    pub const STRICT: Self = Self::relative(1e-6);

    const NOTHING: Self = Self { absolute: 0.0, relative: 0.0, of_scale: 0.0, of_value: 0.0, count: None };

    /// A difference of at most `part` times the reference.
    #[must_use]
    pub const fn relative(part: f64) -> Self {
        Self { relative: part, ..Self::NOTHING }
    }

    /// A difference of at most `difference`, in the unit of the number.
    #[must_use]
    pub const fn absolute(difference: f64) -> Self {
        Self { absolute: difference, ..Self::NOTHING }
    }

    /// Allows a further `difference`.
    #[must_use]
    pub const fn plus(self, difference: f64) -> Self {
        Self { absolute: self.absolute + difference, ..self }
    }

    /// A difference of at most `part` times the largest magnitude in the column.
    #[must_use]
    pub const fn of_scale(part: f64) -> Self {
        Self { of_scale: part, ..Self::NOTHING }
    }

    /// A difference of at most `part` times the number in column `value`.
    ///
    /// The number is in the same row. This rule is for standard errors.
    #[must_use]
    pub const fn of_value(part: f64) -> Self {
        Self { of_value: part, ..Self::NOTHING }
    }

    /// A count n of elements, which may differ by 1 + `part`·√n.
    ///
    /// A few elements cross the ends of a bin or the edge of a contact at random.
    #[must_use]
    pub const fn count(part: f64) -> Self {
        Self { count: Some((None, part)), ..Self::NOTHING }
    }

    /// A number in proportion to the count in `column`, to which [`Rule::count`] applies.
    #[must_use]
    pub const fn of_count(column: &'static str, part: f64) -> Self {
        Self { count: Some((Some(column), part)), ..Self::NOTHING }
    }
}

/// The rules of one table.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Rules of rows, by the first cell of a row, and of columns. Rules of rows take precedence.
    rows: Vec<(String, Rule)>,
    columns: Vec<(&'static str, Rule)>,
    /// The rule of all other numbers.
    rest: Rule,
}

impl Default for Comparison {
    fn default() -> Self {
        Self { rows: Vec::new(), columns: Vec::new(), rest: Rule::STRICT }
    }
}

/// The cells of a table, row by row, with the header first.
struct Cells<'a>(Vec<Vec<&'a str>>);

impl<'a> Cells<'a> {
    fn of(csv: &'a str) -> Self {
        Self(csv.trim().lines().map(|line| line.split(',').collect()).collect())
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.0.first()?.iter().position(|cell| *cell == name)
    }

    fn number(&self, row: usize, column: Option<usize>) -> Option<f64> {
        self.0.get(row)?.get(column?)?.parse().ok()
    }

    /// Largest magnitude of the numbers in a column.
    fn scale(&self, column: usize) -> f64 {
        (1..self.0.len())
            .filter_map(|row| self.number(row, Some(column)))
            .fold(0.0, |scale, value| value.abs().max(scale))
    }
}

impl Comparison {
    pub(crate) fn row(&mut self, first: &str, rule: Rule) {
        self.rows.push((first.to_owned(), rule));
    }

    pub(crate) fn column(&mut self, name: &'static str, rule: Rule) {
        self.columns.push((name, rule));
    }

    pub(crate) fn rest(&mut self, rule: Rule) {
        self.rest = rule;
    }

    /// The first difference between two tables, as a sentence; `None` if they agree.
    #[must_use]
    pub fn difference(&self, reference: &str, test: &str) -> Option<String> {
        let (reference, test) = (Cells::of(reference), Cells::of(test));
        if reference.0.len() != test.0.len() {
            return Some(format!("{} lines against {}", reference.0.len(), test.0.len()));
        }
        (0..reference.0.len()).find_map(|row| {
            let (a, b) = (&reference.0[row], &test.0[row]);
            let cell = (0..a.len().min(b.len())).find(|&column| !self.agree(&reference, &test, (row, column)));
            let column = cell.or((a.len() != b.len()).then_some(a.len().min(b.len())))?;
            let shown = |cells: &[&str]| cells.get(column).map_or("nothing".to_owned(), ToString::to_string);
            let name = reference.0[0].get(column).copied().unwrap_or_default();
            Some(format!("line {}, column {} ({name}): {} against {}", row + 1, column + 1, shown(a), shown(b)))
        })
    }

    fn agree(&self, reference: &Cells<'_>, test: &Cells<'_>, (row, column): (usize, usize)) -> bool {
        match (reference.number(row, Some(column)), test.number(row, Some(column))) {
            (Some(a), Some(b)) => (a - b).abs() <= self.allowed(reference, test, (row, column)),
            _ => reference.0[row][column] == test.0[row][column],
        }
    }

    fn rule(&self, reference: &Cells<'_>, (row, column): (usize, usize)) -> Rule {
        let of_row = self.rows.iter().find(|(first, _)| reference.0[row].first() == Some(&first.as_str()));
        let of_column = self.columns.iter().find(|(name, _)| reference.column(name) == Some(column));
        of_row.map(|at| at.1).or(of_column.map(|at| at.1)).unwrap_or(self.rest)
    }

    fn allowed(&self, reference: &Cells<'_>, test: &Cells<'_>, (row, column): (usize, usize)) -> f64 {
        let rule = self.rule(reference, (row, column));
        let number = |cells: &Cells<'_>, column| cells.number(row, column).unwrap_or(0.0).abs();
        let a = number(reference, Some(column));
        let of_count = rule.count.map_or(0.0, |(counted, part)| {
            let counted = counted.map_or(Some(column), |name| reference.column(name));
            let (n, sum) = (number(reference, counted), number(reference, counted) + number(test, counted));
            // The amount that one counted element stands for. It is taken from both tables, since a count may be zero
            // in one of them.
            let one = (a + number(test, Some(column))) / sum.max(1.0);
            one * (1.0 + part * n.sqrt())
        });
        let scaled = if rule.of_scale > 0.0 { rule.of_scale * reference.scale(column) } else { 0.0 };
        let of_value = rule.of_value * number(reference, reference.column("value"));
        rule.absolute + rule.relative * a + scaled + of_value + of_count
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Table;

    const REAL: f64 = 1e-3;

    /// The first real change of `table` that its rules do not notice.
    ///
    /// Rounding cannot cause a real change. The changes are a swapped sign, a row left out, and a change by a
    /// thousandth of the largest number of a column. The last one is twice the resolution of a rule if a count or the
    /// unit of the number is coarser than a thousandth.
    pub(crate) fn unnoticed(table: &Table) -> Option<String> {
        let cells = Cells::of(&table.csv);
        let text = |cells: &[Vec<&str>]| cells.iter().map(|row| row.join(",") + "\n").collect::<String>();
        let noticed = |other: &[Vec<&str>]| table.comparison.difference(&table.csv, &text(other)).is_some();
        if !noticed(&cells.0[..cells.0.len() - 1]) {
            return Some(format!("{}: a row less", table.name));
        }
        scales(&cells).into_iter().find_map(|(row, column, value)| {
            let rule = table.comparison.rule(&cells, (row, column));
            let scale = if rule.of_value > 0.0 { cells.number(row, cells.column("value")) } else { Some(value) };
            let allowed = table.comparison.allowed(&cells, &cells, (row, column));
            let resolution = if rule.count.is_some() || rule.absolute > 0.0 { 2.0 * allowed } else { 0.0 };
            let changed = value + (REAL * scale.unwrap_or(0.0).abs()).max(resolution);
            let mut changes =
                [changed, -value].into_iter().filter(|changed| (changed - value).abs() > 0.99 * resolution);
            let passing = changes.find(|changed| {
                let cell = format!("{changed:e}");
                let mut other = cells.0.clone();
                other[row][column] = &cell;
                !noticed(&other)
            });
            let name = cells.0[0][column];
            passing.map(|changed| format!("{}, line {}: {name} {changed:e} for {value:e}", table.name, row + 1))
        })
    }

    /// Row, column and value of the numbers that are changed.
    ///
    /// They are the largest number of each column. A summary has a column `value`, and its rows are different
    /// quantities, so there they are all numbers.
    fn scales(cells: &Cells<'_>) -> Vec<(usize, usize, f64)> {
        let is_summary = cells.column("value").is_some();
        let of_column = |column: usize| {
            let numbers =
                (1..cells.0.len()).filter_map(move |row| Some((row, column, cells.number(row, Some(column))?)));
            let numbers: Vec<_> = numbers.filter(|number| number.2 != 0.0).collect();
            let largest = numbers.iter().copied().max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()));
            if is_summary { numbers } else { largest.into_iter().collect() }
        };
        (0..cells.0[0].len()).flat_map(of_column).collect()
    }

    fn table() -> Table {
        let rows = [["peak", "10.0", "2.0", "10000", "5.0"], ["edge", "1e-3", "1.0", "4", "2e-3"]];
        let rows = rows.map(|row| row.map(str::to_owned).to_vec());
        Table::new("t", &["name", "value", "error", "n", "density"], rows)
            .column("value", Rule::of_scale(1e-4))
            .column("error", Rule::of_value(1e-4))
            .column("n", Rule::count(0.5))
            .column("density", Rule::of_count("n", 0.5))
    }

    #[test]
    fn each_rule_knows_its_scale() {
        let table = table();
        let difference = |from: &str, to: &str| {
            assert!(table.csv.contains(from), "{from}");
            table.comparison.difference(&table.csv, &table.csv.replacen(from, to, 1))
        };
        for (from, to) in [
            // A number of the column may differ by 1e-4 of the largest one.
            ("10.0", "10.0009"),
            ("1e-3", "2e-3"),
            ("1e-3", "1e-5"),
            ("2.0", "2.0009"),
            // Counts may differ by two of four, and by fifty of ten thousand.
            ("4", "6"),
            ("10000", "10050"),
            ("2e-3", "1.3e-3"),
        ] {
            assert_eq!(difference(from, to), None, "{from} against {to}");
        }
        for (from, to) in [
            ("10.0", "10.0011"),
            ("1e-3", "2.1e-3"),
            ("2.0", "2.0011"),
            ("1.0,4", "1.0001,4"),
            ("4", "7"),
            ("10000", "10060"),
            ("2e-3", "0.5e-3"),
            ("peak", "peaks"),
            ("10.0", "NaN"),
            ("2.0,", ""),
        ] {
            assert!(difference(from, to).is_some(), "{from} against {to}");
        }
    }

    #[test]
    fn rules_that_notice_too_little_are_found() {
        let table = |part: f64| {
            let rows = [["a", "1.0"], ["b", "0.5"]].map(|row| row.map(str::to_owned).to_vec());
            Table::new("t", &["name", "x"], rows).column("x", Rule::of_scale(part))
        };
        assert_eq!(unnoticed(&table(9e-4)), None);
        assert_eq!(unnoticed(&table(2e-3)).as_deref(), Some("t, line 2: x 1.001e0 for 1e0"));
    }

    #[test]
    fn nothing_said_is_strict_and_rows_come_before_columns() {
        let rows = || [["a", "1.000000e0"], ["b", "1.000000e0"]].map(|row| row.map(str::to_owned).to_vec());
        let strict = Table::new("t", &["name", "value"], rows());
        assert!(strict.comparison.difference(&strict.csv, &strict.csv.replace("1.000000", "1.000002")).is_some());
        assert!(strict.comparison.difference(&strict.csv, &strict.csv.replace("1.000000", "1.000001")).is_none());
        let ruled = Table::new("t", &["name", "value"], rows())
            .column("value", Rule::relative(0.1))
            .row("b", Rule::absolute(0.01));
        assert!(ruled.comparison.difference(&ruled.csv, &ruled.csv.replace("a,1.0", "a,1.05")).is_none());
        let difference = ruled.comparison.difference(&ruled.csv, &ruled.csv.replace("b,1.0", "b,1.05"));
        assert_eq!(difference.as_deref(), Some("line 3, column 2 (value): 1.000000e0 against 1.0500000e0"));
    }
}
