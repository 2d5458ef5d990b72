//! A solved level, as a solution asks it.

use rc_comm::Ranks;
use rc_core::{Field, Grid};

use crate::descent::contact_element::ContactElement;
use crate::descent::info::{SolveInfo, Status};
use crate::problem::capabilities::Feature;
use crate::solution::gap_part::GapPart;
use crate::solution::gradient_error::GradientError;
use crate::solution::observables::Observables;
use crate::solution::rows::{Halted, Receiver, Rows, TakeRows};

/// Numbers of elements.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Counts {
    /// Elements on which the solution states a pressure.
    pub(crate) stated: usize,
    /// Elements in contact.
    pub(crate) in_contact: usize,
    /// Elements whose gap the certificate computed.
    pub(crate) evaluated: usize,
    /// Elements of the smallest size that are proven to be out of contact.
    pub(crate) proven: usize,
}

/// A solved finest level with everything that later questions need: a grid, or tiles.
///
/// Rows are passed on in order. With several ranks, all of them call a function together.
pub(crate) trait Solved: Send + Sync {
    /// How the solve ended.
    fn status(&self) -> Status;

    /// How the solution was found.
    fn info(&self) -> &SolveInfo;

    /// The grid of the fields.
    fn grid(&self) -> Grid;

    /// The grid of the smallest elements.
    fn finest_grid(&self) -> Grid {
        self.grid()
    }

    /// The ranks that share the level.
    fn ranks(&self) -> Ranks {
        Ranks::alone()
    }

    /// Numbers of elements.
    fn counts(&self) -> Counts;

    /// The elements in contact of this rank, if the mesh is not the grid.
    fn elements(&self) -> Option<Box<dyn Iterator<Item = ContactElement> + '_>>;

    /// The observables.
    fn observables(&self) -> Observables;

    /// Contact stiffness, in E*/λ.
    fn stiffness(&self) -> f64;

    /// The smallest dp/dσ0 of an elastic contact at rest, if its response is known.
    fn least_rise(&self) -> Option<f64>;

    /// dσ0/dΔ if a half-space is held down by all contact spots, in E*/λ; `None` where that is the contact stiffness.
    ///
    /// Plastic elements are part of the spots, and a layer is replaced by the half-space. It is infinite in full contact.
    fn conductance(&self) -> Option<f64>;

    /// The features of its solid that exclude a gradient.
    fn features(&self) -> Vec<Feature> {
        Vec::new()
    }

    /// The highest element of the grid, if it is known.
    fn highest(&self) -> Option<usize> {
        None
    }

    /// The pressure on the contact that displaces it by these values, and zero elsewhere.
    ///
    /// If it `is_balanced`, its mean is zero, and the values count up to a constant.
    fn displaced_by(&self, _displacement: &[f64], _is_balanced: bool) -> Result<Vec<f64>, GradientError> {
        Err(GradientError::NoKernel)
    }

    /// Pressure and gap before plastic flow, if they are stored whole.
    fn stored(&self) -> Option<[&Field; 2]>;

    /// Passes on the rows of the pressure.
    fn pressure_rows(&self, receiver: Receiver, take: TakeRows<'_>) -> Result<(), Halted>;

    /// Passes on the rows of a part of the gap.
    fn gap_rows(&self, part: GapPart, rows: Rows, take: TakeRows<'_>) -> Result<(), Halted>;

    /// Passes on the rows of the displacement.
    fn displacement_rows(&self, take: TakeRows<'_>) -> Result<(), Halted>;

    /// The same without a borrow.
    fn into_owned(self: Box<Self>) -> Box<dyn Solved>;
}
