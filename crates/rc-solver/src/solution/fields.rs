//! The fields of a solution and their rows.

use std::convert::Infallible;

use rc_core::{Field, Grid};

use crate::solution::gap_part::GapPart;
use crate::solution::rows::{Receiver, Rows, hand_out};
use crate::solution::whole::Solution;

impl Solution<'_> {
    /// The pressure on the grid, in E*, ≥ 0.
    ///
    /// Where elements are smaller than those of the grid (at a border level), it is their mean.
    #[must_use]
    pub fn pressure(&self) -> &Field {
        match self.solved.stored() {
            Some([pressure, _]) => pressure,
            None => self.computed.pressure.get_or_init(|| self.collect(self.grid(), |take| self.pressure_rows(take))),
        }
    }

    /// The gap on the grid, in λ, with its pressure-weighted mean at zero.
    ///
    /// It is zero in contact within the tolerance. If a hardness is set, it is the gap after plastic flow.
    #[must_use]
    pub fn gap(&self) -> &Field {
        match self.solved.stored() {
            Some([_, gap]) if self.hardness().is_infinite() => gap,
            _ => self.computed.gap.get_or_init(|| self.collect(self.grid(), |take| self.gap_rows(take))),
        }
    }

    /// The gap before plastic flow, on the grid of the smallest elements, in λ.
    ///
    /// It is shifted like [`Solution::gap`], and negative where plastic flow removed an overlap. `None` without a
    /// border level, because the smallest elements are then those of [`Solution::grid`]. Each call takes one
    /// application of L on the grid of the smallest elements.
    #[must_use]
    pub fn finest_gap(&self) -> Option<Field> {
        let (finest, part) = (self.finest_grid(), GapPart::Both);
        (finest != self.grid()).then(|| self.collect(finest, |take| self.part_rows(part, Rows::finest(), take)))
    }

    /// The overlap that plastic flow has removed, on the grid, in λ, ≥ 0.
    ///
    /// It is zero where the pressure is below the hardness, and everywhere without a hardness.
    #[must_use]
    pub fn plastic_gap(&self) -> &Field {
        self.computed.plastic_gap.get_or_init(|| self.collect(self.grid(), |take| self.plastic_gap_rows(take)))
    }

    /// ⟨1/(g + m)⟩ over the nominal area, in 1/λ: the conductance of a gas in the gap g, for conductivity 1.
    ///
    /// The jump distance m > 0 (in λ) stands for the jumps of temperature at both surfaces. In contact g is exactly 0.
    /// The mean is over the elements of the grid. It costs as much as [`Solution::gap_rows`].
    #[must_use]
    pub fn mean_inverse_gap(&self, jump_distance: f64) -> f64 {
        let mut sum = 0.0;
        let Ok(()) = self.part_rows(GapPart::Free, Rows::on_grid(Receiver::First), |_, rows| {
            sum += rows.iter().map(|gap| (gap + jump_distance).recip()).sum::<f64>();
            Ok::<_, Infallible>(())
        });
        // The first rank has all rows.
        self.ranks().concatenate(vec![sum]).iter().sum::<f64>() / self.grid().len() as f64
    }

    /// The displacement v on the grid, in λ. Its mean is zero on the periodic half-space.
    ///
    /// The first call takes one application of L.
    #[must_use]
    pub fn displacement(&self) -> &Field {
        self.computed.displacement.get_or_init(|| {
            self.collect(self.grid(), |take| hand_out(&self.ranks(), take, |take| self.solved.displacement_rows(take)))
        })
    }

    /// Passes the rows of [`Solution::pressure`] to `take`, in order.
    ///
    /// Each call of `take` gets one or more consecutive rows in one slice, and the index of the first of them. Stops at
    /// the first error.
    ///
    /// # Errors
    /// The error that `take` returns.
    pub fn pressure_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match self.computed.pressure.get() {
            Some(pressure) => self.rows_of(pressure, take),
            None => hand_out(&self.ranks(), take, |take| self.solved.pressure_rows(Receiver::First, take)),
        }
    }

    /// Passes the rows of [`Solution::pressure`] that belong to this rank to `take`.
    ///
    /// The rows of a rank follow each other, and the rows of the next rank follow them.
    ///
    /// # Errors
    /// The error that `take` returns.
    pub fn own_pressure_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        hand_out(&self.ranks(), take, |take| self.solved.pressure_rows(Receiver::Each, take))
    }

    /// Passes the rows of [`Solution::gap`] to `take`, as [`Solution::pressure_rows`] does.
    ///
    /// For the adaptive method this costs about one application of L on the whole grid.
    ///
    /// # Errors
    /// The error that `take` returns.
    pub fn gap_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match (self.solved.stored(), self.computed.gap.get()) {
            (Some([_, gap]), _) if self.hardness().is_infinite() => self.rows_of(gap, take),
            (_, Some(gap)) => self.rows_of(gap, take),
            _ => self.part_rows(GapPart::Open, Rows::on_grid(Receiver::First), take),
        }
    }

    /// Passes the rows of [`Solution::plastic_gap`] to `take`, as [`Solution::gap_rows`] does.
    ///
    /// # Errors
    /// The error that `take` returns.
    pub fn plastic_gap_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        match self.computed.plastic_gap.get() {
            Some(gap) => self.rows_of(gap, take),
            None => self.part_rows(GapPart::Plastic, Rows::on_grid(Receiver::First), take),
        }
    }

    /// Passes the rows of [`Solution::gap`] that belong to this rank to `take`.
    ///
    /// The order is that of [`Solution::own_pressure_rows`].
    ///
    /// # Errors
    /// The error that `take` returns.
    pub fn own_gap_rows<E>(&self, take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        self.part_rows(GapPart::Open, Rows::on_grid(Receiver::Each), take)
    }

    /// Passes all rows of a field to `take`, on the first rank.
    fn rows_of<E>(&self, field: &Field, mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        if self.ranks().rank() == 0 { take(0, field.values()) } else { Ok(()) }
    }

    /// A field on `grid` from its rows, which `rows` passes on in order.
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
        // Rows go to the first rank. Fields go to all ranks.
        let values = self.ranks().concatenate(values);
        Field::new(grid, values).expect("as many values as the grid has elements")
    }

    /// Passes the rows of a part of the gap to a function.
    fn part_rows<E>(
        &self,
        part: GapPart,
        rows: Rows,
        take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        hand_out(&self.ranks(), take, |take| self.solved.gap_rows(part, rows, take))
    }
}
