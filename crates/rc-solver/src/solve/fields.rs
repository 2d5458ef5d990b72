//! The fields of a solution and their rows.

use std::convert::Infallible;

use rc_core::{Field, Grid};

use super::solution::{Pressures, Solution};
use crate::adaptive::{Receiver, Rows};
use crate::gap_part::GapPart;

impl Solution<'_> {
    /// The pressure on the grid, in E*, ≥ 0. On smaller elements it is their mean.
    #[must_use]
    pub fn pressure(&self) -> &Field {
        match &self.pressures {
            Pressures::Grid { solution, .. } => &solution.pressure,
            Pressures::Tiles { .. } => {
                self.pressure.get_or_init(|| self.collect(self.grid(), |take| self.pressure_rows(take)))
            }
        }
    }

    /// The gap on the grid, in λ, with its pressure-weighted mean at zero; zero in contact within the tolerance. With a
    /// hardness it is that after plastic flow.
    #[must_use]
    pub fn gap(&self) -> &Field {
        match &self.pressures {
            Pressures::Grid { solution, .. } if self.how.hardness.is_infinite() => &solution.gap,
            _ => self.gap.get_or_init(|| self.collect(self.grid(), |take| self.gap_rows(take))),
        }
    }

    /// The gap on the grid of the smallest elements, in λ, as [`Solution::gap`], but less than that of contact where
    /// plastic flow has removed an overlap; `None` where that is [`Solution::grid`], which it is without a border level. Takes one application of L on that grid each time.
    #[must_use]
    pub fn finest_gap(&self) -> Option<Field> {
        match &self.pressures {
            Pressures::Tiles { solution, problem } if self.finest_grid() != self.grid() => {
                Some(self.collect(self.finest_grid(), |take| {
                    problem.gap_rows(solution, GapPart::Both, Rows::finest(), take)
                }))
            }
            _ => None,
        }
    }

    /// The overlap that plastic flow has removed, on the grid, in λ, ≥ 0; zero where the pressure is below the
    /// hardness, and everywhere without one.
    #[must_use]
    pub fn plastic_gap(&self) -> &Field {
        self.plastic_gap.get_or_init(|| self.collect(self.grid(), |take| self.plastic_gap_rows(take)))
    }

    /// The displacement v on the grid, in λ, of mean zero on the periodic half-space. Takes one application of L the
    /// first time.
    #[must_use]
    pub fn displacement(&self) -> &Field {
        self.displacement.get_or_init(|| match &self.pressures {
            Pressures::Grid { solution, response } => response.displacement(&solution.pressure),
            Pressures::Tiles { solution, problem } => {
                self.collect(self.grid(), |take| problem.displacement_rows(solution, Receiver::First, take))
            }
        })
    }

    /// Hands out [`Solution::pressure`] in order, some rows at a time: the index of the first row, and the rows one
    /// after the other. Stops at the first error.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn pressure_rows<E>(&self, mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match (&self.pressures, self.pressure.get()) {
            (Pressures::Grid { solution, .. }, _) => take(0, solution.pressure.values()),
            (_, Some(pressure)) => take(0, pressure.values()),
            (Pressures::Tiles { solution, .. }, None) => solution.pressure_rows(Receiver::First, take),
        }
    }

    /// The same over ranks, with some rows for each rank: those that it takes follow each other, and those of the next
    /// rank follow them.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn own_pressure_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match &self.pressures {
            Pressures::Grid { .. } => self.pressure_rows(take),
            Pressures::Tiles { solution, .. } => solution.pressure_rows(Receiver::Each, take),
        }
    }

    /// Hands out [`Solution::gap`] as [`Solution::pressure_rows`] does the pressure, for the adaptive method at about
    /// the cost of one application of L on the whole grid.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn gap_rows<E>(&self, mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match (&self.pressures, self.gap.get()) {
            (Pressures::Grid { solution, .. }, _) if self.how.hardness.is_infinite() => take(0, solution.gap.values()),
            (_, Some(gap)) => take(0, gap.values()),
            _ => self.part_rows(GapPart::Open, Receiver::First, take),
        }
    }

    /// Hands out [`Solution::plastic_gap`] as [`Solution::gap_rows`] does the gap.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn plastic_gap_rows<E>(&self, mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match self.plastic_gap.get() {
            Some(gap) => take(0, gap.values()),
            None => self.part_rows(GapPart::Plastic, Receiver::First, take),
        }
    }

    /// The same over ranks, as [`Solution::own_pressure_rows`] does it.
    ///
    /// # Errors
    /// What `take` returns.
    pub fn own_gap_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        self.part_rows(GapPart::Open, Receiver::Each, take)
    }

    /// A field on `grid` from its rows, which `rows` hands out in order.
    fn collect(
        &self,
        grid: Grid,
        rows: impl FnOnce(&mut dyn FnMut(usize, &[f64]) -> Result<(), Infallible>) -> Result<(), Infallible>,
    ) -> Field {
        let mut values = Vec::with_capacity(grid.len());
        let Ok(()) = rows(&mut |_, rows| {
            values.extend_from_slice(rows);
            Ok(())
        });
        // Rows go to the first rank, fields to all.
        let values = self.ranks().concatenate(values);
        Field::new(grid, values).expect("as many values as the grid has elements")
    }

    /// Hands out a part of the gap.
    fn part_rows<E>(
        &self,
        part: GapPart,
        receiver: Receiver,
        take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        match &self.pressures {
            Pressures::Grid { solution, .. } => part.rows((&solution.gap, &solution.pressure), self.how.hardness, take),
            Pressures::Tiles { solution, problem } => problem.gap_rows(solution, part, Rows::on_grid(receiver), take),
        }
    }
}
