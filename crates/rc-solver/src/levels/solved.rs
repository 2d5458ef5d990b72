//! A solved finest level on tiles, with the problem that later questions need.

use rc_comm::Ranks;
use rc_core::{Field, Grid};

use crate::descent::contact_element::ContactElement;
use crate::descent::info::{SolveInfo, Status};
use crate::levels::adaptive::AdaptiveProblem;
use crate::solution::gap_part::GapPart;
use crate::solution::observables::Observables;
use crate::solution::rows::{Halted, Receiver, Rows, TakeRows};
use crate::solution::solved::{Counts, Solved};
use crate::tiles::solution::AdaptiveSolution;

/// A solution on tiles, and the problem that was solved, with its heights.
pub(crate) struct TilesSolved<'a> {
    pub(crate) solution: AdaptiveSolution,
    pub(crate) problem: Box<AdaptiveProblem<'a>>,
}

impl Solved for TilesSolved<'_> {
    fn status(&self) -> Status {
        self.solution.status()
    }

    fn info(&self) -> &SolveInfo {
        &self.solution.info
    }

    fn grid(&self) -> Grid {
        self.solution.grid()
    }

    fn finest_grid(&self) -> Grid {
        self.solution.finest_grid()
    }

    fn ranks(&self) -> Ranks {
        self.problem.ranks().clone()
    }

    fn counts(&self) -> Counts {
        let AdaptiveSolution { evaluated, proven, .. } = self.solution;
        let in_contact = self.solution.n_elements();
        Counts { stated: in_contact, in_contact, evaluated, proven }
    }

    fn elements(&self) -> Option<Box<dyn Iterator<Item = ContactElement> + '_>> {
        Some(Box::new(self.solution.elements()))
    }

    fn observables(&self) -> Observables {
        self.solution.observables()
    }

    fn stiffness(&self) -> f64 {
        self.problem.contact_stiffness(&self.solution)
    }

    fn stored(&self) -> Option<[&Field; 2]> {
        None
    }

    fn pressure_rows(&self, receiver: Receiver, take: TakeRows<'_>) -> Result<(), Halted> {
        self.solution.pressure_rows(receiver, take)
    }

    fn gap_rows(&self, part: GapPart, rows: Rows, take: TakeRows<'_>) -> Result<(), Halted> {
        self.problem.gap_rows(&self.solution, part, rows, take)
    }

    fn displacement_rows(&self, take: TakeRows<'_>) -> Result<(), Halted> {
        self.problem.displacement_rows(&self.solution, Receiver::First, take)
    }

    fn into_owned(self: Box<Self>) -> Box<dyn Solved> {
        let Self { solution, problem } = *self;
        Box::new(TilesSolved { solution, problem: Box::new(problem.into_owned()) })
    }
}
