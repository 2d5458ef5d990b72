//! The elastic response that a solution on a grid keeps for use after the solve.
//!
//! It may outlive the caller's kernel or operator.

use rc_core::{Boundary, EdgeBias, Field, Grid, Operator};

use crate::descent::info::{GridSolution, Status};
use crate::grid::solve_with_operator::stiffness_with_operator;
use crate::grid::stiffness::contact_stiffness;
use crate::grid::uniform_operator::UniformOperator;
use crate::problem::kernel::OwnedKernel;
use crate::problem::support::Support;

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
        /// v = L p, in λ.
        displacement: Field,
        /// The shift of contact edges.
        bias: EdgeBias,
        /// The boundary of the heights.
        boundary: Boundary,
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
            (Self::Outlived { stiffness, displacement, bias, boundary }, _) => {
                Response::Outlived { stiffness, displacement, bias, boundary }
            }
            (response, _) => Response::Outlived {
                stiffness: response.stiffness(solution, hardness),
                displacement: response.displacement(&solution.pressure),
                bias: response.edge_bias(),
                boundary: response.boundary(solution.pressure.grid()),
            },
        }
    }

    /// The shift of contact edges. For an operator it is the default shift.
    pub(crate) fn edge_bias(&self) -> EdgeBias {
        match self {
            Self::Kernel(kernel) => kernel.get().edge_bias(),
            Self::Operator(_) => EdgeBias::default(),
            Self::Outlived { bias, .. } => *bias,
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
            Self::Kernel(kernel) if is_full => kernel.get().uniform_displacement().unwrap_or(0.0).recip(),
            Self::Kernel(kernel) => {
                let converged = solution.status != Status::NotConverged;
                contact_stiffness(&solution.pressure, hardness, kernel.get(), converged)
            }
            Self::Operator(_) if is_full => f64::INFINITY,
            Self::Operator(operator) => stiffness_with_operator(&solution.pressure, *operator),
            Self::Outlived { stiffness, .. } => *stiffness,
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
