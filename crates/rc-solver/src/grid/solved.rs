//! A solved grid, with the elastic response that later questions need.
//!
//! It may outlive the caller's kernel or operator.

use rayon::prelude::*;
use rc_core::{Boundary, EdgeBias, Field, Grid, Kernel, Operator};
use rc_kernel::Spectral;

use crate::descent::contact_element::ContactElement;
use crate::descent::contact_system::solve_on_contact;
use crate::descent::info::{GridSolution, SolveInfo, Status};
use crate::grid::operators::uniform_operators;
use crate::grid::solve_with_operator::stiffness_with_operator;
use crate::grid::stiffness::{contact_stiffness, least_rise};
use crate::grid::uniform_operator::UniformOperator;
use crate::problem::capabilities::Feature;
use crate::problem::kernel::OwnedKernel;
use crate::problem::support::Support;
use crate::solution::contact_area::sliding_edges::SlidingEdges;
use crate::solution::gap_part::GapPart;
use crate::solution::gradient_error::GradientError;
use crate::solution::observables::Observables;
use crate::solution::rows::{Halted, Receiver, Rows, TakeRows};
use crate::solution::solved::{Counts, Solved};

/// The half-space that a solution on a grid was found with.
pub(crate) enum Response<'a> {
    /// A kernel.
    Kernel(OwnedKernel<'a>),
    /// The caller's operator.
    Operator(&'a dyn Operator),
    /// The results of a kernel or an operator that the solution has outlived.
    Outlived {
        /// dσ0/dΔ, in E*/λ.
        stiffness: f64,
        /// That of the contact spots, as [`Solved::conductance`].
        conductance: f64,
        /// v = L p, in λ.
        displacement: Field,
        /// The shift of contact edges.
        bias: EdgeBias,
        /// The boundary of the heights.
        boundary: Boundary,
        /// The edges under a sliding surface.
        edges: Option<SlidingEdges>,
    },
}

impl Response<'_> {
    /// The half-space without a borrow, for one solution with this `hardness`.
    ///
    /// The results of an operator, and of a kernel that makes no copy of itself, are computed now.
    pub(crate) fn into_owned(self, solution: &GridSolution, hardness: f64) -> Response<'static> {
        let shared = match &self {
            Self::Kernel(kernel) => kernel.to_shared(),
            Self::Operator(_) | Self::Outlived { .. } => None,
        };
        match (self, shared) {
            (_, Some(kernel)) => Response::Kernel(OwnedKernel::Shared(kernel)),
            (Self::Outlived { stiffness, conductance, displacement, bias, boundary, edges }, _) => {
                Response::Outlived { stiffness, conductance, displacement, bias, boundary, edges }
            }
            (response, _) => Response::Outlived {
                stiffness: response.stiffness(solution, hardness),
                conductance: response.conductance(solution),
                displacement: response.displacement(&solution.pressure),
                bias: response.edge_bias(solution.pressure.grid()),
                boundary: response.boundary(solution.pressure.grid()),
                edges: response.sliding_edges(&solution.pressure),
            },
        }
    }

    /// The shift of contact edges. For an operator it is the default shift.
    pub(crate) fn edge_bias(&self, grid: Grid) -> EdgeBias {
        match self {
            Self::Kernel(kernel) => kernel.get().edge_bias(grid),
            Self::Operator(_) => EdgeBias::default(),
            Self::Outlived { bias, .. } => *bias,
        }
    }

    /// The edges of contacts under a sliding surface.
    fn sliding_edges(&self, pressure: &Field) -> Option<SlidingEdges> {
        match self {
            Self::Kernel(kernel) => SlidingEdges::of(kernel.get(), pressure),
            Self::Operator(_) => None,
            Self::Outlived { edges, .. } => *edges,
        }
    }

    /// The boundary of the heights on `grid`.
    pub(crate) fn boundary(&self, grid: Grid) -> Boundary {
        match self {
            Self::Kernel(kernel) => Support::of(kernel.get(), grid).boundary,
            Self::Operator(_) => Boundary::Periodic,
            Self::Outlived { boundary, .. } => *boundary,
        }
    }

    /// Contact stiffness dσ0/dΔ of `solution`, in E*/λ.
    ///
    /// In full contact it is infinite, unless the solid is on a base.
    pub(crate) fn stiffness(&self, solution: &GridSolution, hardness: f64) -> f64 {
        let is_full = solution.status == Status::FullContact;
        match self {
            Self::Kernel(kernel) => {
                let converged = solution.status != Status::NotConverged;
                contact_stiffness(&solution.pressure, hardness, kernel.get(), converged)
            }
            Self::Operator(_) if is_full => f64::INFINITY,
            Self::Operator(operator) => stiffness_with_operator(&solution.pressure, *operator),
            Self::Outlived { stiffness, .. } => *stiffness,
        }
    }

    /// dσ0/dΔ if a half-space is held down by all contact spots of `solution`, in E*/λ. It is infinite in full contact.
    pub(crate) fn conductance(&self, solution: &GridSolution) -> f64 {
        let of_spots = |kernel: &dyn Kernel| {
            let converged = solution.status != Status::NotConverged;
            contact_stiffness(&solution.pressure, f64::INFINITY, kernel.half_space().unwrap_or(kernel), converged)
        };
        match self {
            Self::Kernel(kernel) => of_spots(kernel.get()),
            Self::Operator(_) => of_spots(&Spectral),
            Self::Outlived { conductance, .. } => *conductance,
        }
    }

    /// v = L p, in λ.
    pub(crate) fn displacement(&self, pressure: &Field) -> Field {
        let apply = |operator: &dyn Operator| {
            let (mut displacement, mut scratch) = (Field::zeros(pressure.grid()), vec![0.0; operator.scratch_len()]);
            operator.apply(pressure.values(), displacement.values_mut(), &mut scratch);
            displacement
        };
        match self {
            Self::Kernel(kernel) => apply(&UniformOperator::new(pressure.grid(), kernel.get())),
            Self::Operator(operator) => apply(*operator),
            Self::Outlived { displacement, .. } => displacement.clone(),
        }
    }
}

/// A solution on a grid, with the half-space that it was found with.
pub(crate) struct GridSolved<'a> {
    pub(crate) solution: GridSolution,
    pub(crate) response: Response<'a>,
    /// The limit of the pressure. Infinite for an elastic contact.
    pub(crate) hardness: f64,
    /// The highest element. It is the first of several.
    highest: usize,
}

impl<'a> GridSolved<'a> {
    /// The solution for the caller, of these heights. In an elastic contact, overlaps that the tolerance has left become
    /// gaps of zero.
    ///
    /// The certificate holds their size.
    pub(crate) fn new(mut solution: GridSolution, heights: &Field, response: Response<'a>, hardness: f64) -> Self {
        if hardness.is_infinite() {
            solution.gap.values_mut().par_iter_mut().for_each(|gap| *gap = gap.max(0.0));
        }
        // As on tiles, full contact may have been found by the iteration, and may be plastic.
        let is_periodic = response.boundary(solution.pressure.grid()) == Boundary::Periodic;
        if solution.status == Status::Converged && is_periodic && solution.pressure.min() > 0.0 {
            solution.status = Status::FullContact;
        }
        let heights = heights.values();
        let highest = (0..heights.len()).reduce(|best, i| if heights[i] > heights[best] { i } else { best });
        Self { solution, response, hardness, highest: highest.unwrap_or_default() }
    }
}

impl Solved for GridSolved<'_> {
    fn status(&self) -> Status {
        self.solution.status
    }

    fn info(&self) -> &SolveInfo {
        &self.solution.info
    }

    fn grid(&self) -> Grid {
        self.solution.pressure.grid()
    }

    fn counts(&self) -> Counts {
        Counts {
            stated: self.solution.n_elements(),
            in_contact: self.solution.n_in_contact(),
            evaluated: self.grid().len(),
            proven: 0,
        }
    }

    fn elements(&self) -> Option<Box<dyn Iterator<Item = ContactElement> + '_>> {
        self.solution.elements.as_ref().map(|mesh| Box::new(mesh.elements()) as _)
    }

    fn observables(&self) -> Observables {
        let boundary = self.response.boundary(self.grid());
        let edges = self.response.sliding_edges(&self.solution.pressure);
        Observables::of(&self.solution, self.hardness, self.response.edge_bias(self.grid()), boundary, edges)
    }

    fn stiffness(&self) -> f64 {
        self.response.stiffness(&self.solution, self.hardness)
    }

    fn least_rise(&self) -> Option<f64> {
        match &self.response {
            Response::Kernel(kernel) => Some(least_rise(&self.solution.pressure, kernel.get())),
            Response::Operator(_) | Response::Outlived { .. } => None,
        }
    }

    fn conductance(&self) -> Option<f64> {
        let is_half_space = matches!(&self.response, Response::Kernel(kernel) if kernel.get().half_space().is_none());
        let is_stiffness = is_half_space && self.solution.pressure.max() < self.hardness;
        (!is_stiffness).then(|| self.response.conductance(&self.solution))
    }

    fn features(&self) -> Vec<Feature> {
        let of_solid = match &self.response {
            Response::Kernel(kernel) if kernel.get().sliding_velocity().is_some() => Some(Feature::Sliding),
            Response::Operator(_) => Some(Feature::OwnOperator),
            Response::Kernel(_) | Response::Outlived { .. } => None,
        };
        let is_free = self.response.boundary(self.grid()) == Boundary::Free;
        of_solid.into_iter().chain(is_free.then_some(Feature::FreeBorders)).collect()
    }

    fn highest(&self) -> Option<usize> {
        Some(self.highest)
    }

    fn displaced_by(&self, displacement: &[f64], is_balanced: bool) -> Result<Vec<f64>, GradientError> {
        let Response::Kernel(kernel) = &self.response else { return Err(GradientError::NoKernel) };
        let mut operators = uniform_operators(self.grid(), kernel.get());
        let pressure = self.solution.pressure.values();
        solve_on_contact(pressure, displacement, is_balanced, &mut operators).map_err(GradientError::Inexact)
    }

    fn stored(&self) -> Option<[&Field; 2]> {
        Some([&self.solution.pressure, &self.solution.gap])
    }

    fn pressure_rows(&self, _receiver: Receiver, take: TakeRows<'_>) -> Result<(), Halted> {
        take(0, self.solution.pressure.values())
    }

    fn gap_rows(&self, part: GapPart, _rows: Rows, take: TakeRows<'_>) -> Result<(), Halted> {
        part.rows((&self.solution.gap, &self.solution.pressure), self.hardness, take)
    }

    fn displacement_rows(&self, take: TakeRows<'_>) -> Result<(), Halted> {
        take(0, self.response.displacement(&self.solution.pressure).values())
    }

    fn into_owned(self: Box<Self>) -> Box<dyn Solved> {
        let Self { solution, response, hardness, highest } = *self;
        let response = response.into_owned(&solution, hardness);
        Box::new(GridSolved { solution, response, hardness, highest })
    }
}
