//! Tables of heights in a text: their rows, and the numbers at their borders that are no heights.

use std::ops::Range;

use rc_core::Grid;

use super::axes::step;
use super::fields::shown;
use super::heading::Heading;
use super::lines::{cell, data_lines, words};
use crate::{FormatError, ReadNote};

/// Rows of numbers with equal lengths.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Table {
    /// Values, row by row.
    pub(super) values: Vec<f64>,
    /// Numbers of columns and rows.
    pub(super) size: [usize; 2],
    /// Steps of the coordinates at the borders along x and y, negative where they decrease.
    pub(super) steps: Option<[f64; 2]>,
    /// What was left out.
    pub(super) notes: Vec<ReadNote>,
    /// Whether the first field of the first row is empty.
    has_empty_corner: bool,
}

/// Fewest rows of a block of lines that may be a map.
const FEWEST_ROWS: usize = 3;

/// Which fields at the ends of rows are empty.
#[derive(Clone, Copy)]
struct Empty {
    first: bool,
    last: bool,
    all: bool,
}

impl Table {
    /// The rows from the first number on.
    ///
    /// # Errors
    /// [`FormatError`] with line and value.
    pub(super) fn of(text: &str, heading: &Heading) -> Result<Self, FormatError> {
        let mut table = Self::default();
        let (mut always, mut measured) = (Empty { first: true, last: true, all: true }, 0);
        // If the numbers of points are known, lines may end anywhere.
        let wraps = heading.counts.iter().all(Option::is_some);
        let mut ragged = None;
        let (mut last, mut gaps) = (None, 0);
        for (line, row) in data_lines(text, heading.first) {
            let before = table.values.len();
            gaps += usize::from(last.is_some_and(|last| line > last + 1));
            last = Some(line);
            let empty = table.read(line, row)?;
            let found = table.values.len() - before;
            match table.size {
                [_, 0] => (table.size[0], table.has_empty_corner) = (found, empty.first),
                [columns, 1] if found == columns + 1 && counts(&table.values[..before], 0.0) => table.add_corner(),
                [columns, _] if found != columns => {
                    let expected = format!("but the lines before have {columns}");
                    ragged = ragged.or(Some(FormatError::Columns { line, found, expected }));
                }
                _ => {}
            }
            if let (Some(error), false) = (&ragged, wraps) {
                return Err(error.clone());
            }
            table.size[1] += 1;
            always = Empty { first: always.first && empty.first, last: always.last && empty.last, all: false };
            measured = if empty.all { measured } else { table.size[1] };
        }
        if table.size[1] == 0 {
            return Err(FormatError::NoNumbers { expected: "give a row of the map in each line, or a point x y z" });
        }
        if wraps {
            table.wrap(heading, ragged)?;
        } else {
            // A spreadsheet writes empty rows below the others.
            table.size[1] = measured.max(1);
            table.values.truncate(table.size[0] * table.size[1]);
        }
        table.without_outer_separators(always);
        let (rows, blocks) = (table.size[1], gaps + 1);
        // Blank lines after every line, or before empty rows at the end, divide nothing.
        if gaps > 0 && !wraps && rows >= FEWEST_ROWS * blocks && rows.is_multiple_of(blocks) {
            table.notes.push(ReadNote::Blocks { blocks, rows: rows / blocks });
        }
        Ok(table)
    }

    /// Reads one row, and says which of its fields are empty.
    fn read(&mut self, line: usize, row: &str) -> Result<Empty, FormatError> {
        let (words, comma) = words(row);
        let mut empty = Empty { first: false, last: false, all: true };
        for (i, word) in words.enumerate() {
            let no_number = || FormatError::NoNumber { line, value: i + 1, text: shown(word) };
            self.values.push(cell(word, comma).ok_or_else(no_number)?);
            empty.last = word.is_empty();
            empty.first |= i == 0 && empty.last;
            empty.all &= empty.last;
        }
        Ok(empty)
    }

    /// Adds the empty corner of a first row with numbers of columns, above rows that begin with their number.
    fn add_corner(&mut self) {
        self.values.insert(0, f64::NAN);
        self.size[0] += 1;
        self.has_empty_corner = true;
    }

    /// Gives the table the size that the heading names, if it has as many numbers.
    fn wrap(&mut self, heading: &Heading, ragged: Option<FormatError>) -> Result<(), FormatError> {
        if let [Some(columns), Some(rows)] = heading.counts
            && columns.checked_mul(rows) == Some(self.values.len())
        {
            self.size = [columns, rows];
            return Ok(());
        }
        ragged.map_or(Ok(()), Err)
    }

    /// Removes a column that is empty because every row begins or ends with a separator.
    fn without_outer_separators(&mut self, always: Empty) {
        if always.last && self.size[0] > 1 {
            self.keep(0..self.size[0] - 1, 0..self.size[1]);
        }
        if always.first && self.size[0] > 1 {
            self.keep(1..self.size[0], 0..self.size[1]);
            self.has_empty_corner = false;
        }
    }

    /// Keeps some columns and rows.
    fn keep(&mut self, columns: Range<usize>, rows: Range<usize>) {
        let row = |iy: usize| &self.values[iy * self.size[0]..][columns.clone()];
        self.values = rows.clone().flat_map(row).copied().collect();
        self.size = [columns.len(), rows.len()];
    }

    fn omit_column(&mut self) {
        self.keep(1..self.size[0], 0..self.size[1]);
        self.notes.push(ReadNote::Counter { what: "column" });
    }

    fn omit_row(&mut self) {
        self.keep(0..self.size[0], 1..self.size[1]);
        self.notes.push(ReadNote::Counter { what: "row" });
    }

    /// The first row, or the first column, without the corner.
    fn border(&self, axis: usize) -> Vec<f64> {
        let [columns, rows] = self.size;
        if axis == 0 {
            self.values[1..columns].to_vec()
        } else {
            (1..rows).map(|iy| self.values[iy * columns]).collect()
        }
    }

    /// The table without numbers of rows and columns, and without coordinates at its borders.
    ///
    /// # Errors
    /// [`FormatError::NoNumber`] when titles are numbers without being coordinates.
    pub(super) fn of_heights(mut self, heading: &Heading) -> Result<Self, FormatError> {
        let titles = &heading.titles;
        if let Some(numbers) = titles.numbers() {
            self.with_titles_of_numbers(heading, numbers)?;
        } else if titles.len() > 0 {
            let column = || (0..self.size[1]).map(|iy| self.values[iy * self.size[0]]);
            let is_omitted = titles.counts_rows() || titles.len() + 1 == self.size[0];
            if self.size[0] > 1 && is_omitted && is_consecutive(column()) {
                self.omit_column();
            }
        } else if self.size[0] > 1 && self.size[1] > 1 {
            self.without_numbers_of_pandas();
        }
        Ok(self)
    }

    /// A title above the first column, and numbers above the others: coordinates, or numbers of columns.
    fn with_titles_of_numbers(&mut self, heading: &Heading, numbers: &[f64]) -> Result<(), FormatError> {
        let left: Vec<f64> = (0..self.size[1]).map(|iy| self.values[iy * self.size[0]]).collect();
        let are_counts = (counts(numbers, 0.0) || counts(numbers, 1.0)) && is_consecutive(left.iter().copied());
        match steps(numbers, &left) {
            _ if numbers.len() + 1 == self.size[0] && are_counts && heading.titles.counts_rows() => {
                self.omit_column();
                self.notes.push(ReadNote::Counter { what: "row" });
            }
            Some(steps) if numbers.len() + 1 == self.size[0] => {
                self.keep(1..self.size[0], 0..self.size[1]);
                self.steps = Some(steps);
            }
            _ => return Err(heading.titles.damaged()),
        }
        Ok(())
    }

    /// Numbers of columns, and perhaps of rows, as pandas and spreadsheets write them, or coordinates below and beside
    /// an empty corner.
    fn without_numbers_of_pandas(&mut self) {
        let [top, left] = [self.border(0), self.border(1)];
        let has_fractions = |table: &Self| {
            let [columns, _] = table.size;
            let inside = table.values.iter().enumerate().filter(|(i, _)| *i >= columns && i % columns > 0);
            inside.map(|(_, value)| value).any(|value| value.is_finite() && value.fract() != 0.0)
        };
        let begins_with_corner = self.values[0] == 0.0 && counts(&top, 1.0) && has_fractions(self);
        if self.has_empty_corner {
            let are_counts = (counts(&top, 0.0) || counts(&top, 1.0)) && is_consecutive(left.iter().copied());
            if are_counts {
                self.omit_column();
                self.omit_row();
            } else if let Some(steps) = steps(&top, &left) {
                self.keep(1..self.size[0], 1..self.size[1]);
                self.steps = Some(steps);
            }
        } else if begins_with_corner {
            if left.len() > 2 && counts(&left, 0.0) {
                self.omit_column();
            }
            self.omit_row();
        }
    }

    /// The grid of the table.
    ///
    /// # Errors
    /// [`FormatError::Grid`] when it has too many points on a side.
    pub(super) fn grid(&self) -> Result<Grid, FormatError> {
        Ok(Grid::new(self.size[0], self.size[1])?)
    }
}

/// The steps of coordinates above and beside a table. A few heights could be even by chance.
fn steps(x: &[f64], y: &[f64]) -> Option<[f64; 2]> {
    const FEWEST: usize = 3;
    let of = |name, coordinates: &[f64]| step(name, coordinates).ok().filter(|_| coordinates.len() >= FEWEST);
    Some([of("x", x)?, of("y", y)?])
}

/// Whether values are the whole numbers from `first` on.
#[expect(clippy::float_cmp, reason = "whole numbers are exact")]
fn counts(values: &[f64], first: f64) -> bool {
    !values.is_empty() && values.iter().enumerate().all(|(i, value)| *value == first + i as f64)
}

/// Whether values are consecutive whole numbers.
#[expect(clippy::float_cmp, reason = "whole numbers are exact")]
fn is_consecutive(mut values: impl Iterator<Item = f64>) -> bool {
    let Some(first) = values.next().filter(|first| first.fract() == 0.0) else { return false };
    values.enumerate().all(|(i, value)| value == first + (i + 1) as f64)
}
