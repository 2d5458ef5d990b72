//! The elastic response that a solution on a grid keeps for use after the solve.
//!
//! It may outlive the caller's kernel or operator.

use rc_core::{Boundary, EdgeBias, Field, Grid, Operator};

use crate::descent::info::{GridSolution, Status};
use crate::grid::solve_with_operator::stiffness_with_operator;
use crate::grid::uniform_operator::UniformOperator;
use crate::problem::kernel::OwnedKernel;
use crate::problem::support::Support;
use crate::solution::stiffness::contact_stiffness;

/// The half-space that a solution on a grid was found with.
pub(crate) enum Response<'a> {
    /// A kernel.
    Kernel(OwnedKernel<'a>),
    /// The caller's operator.
    Operator(&'a dyn Operator),
    /// The results of an operator that the solution has outlived.
    Outlived {
        /// dσ0/dΔ, in E*/λ.
        stiffness: f64,
        /// v = L p, in λ.
        displacement: Field,
    },
}

impl Response<'_> {
    /// The half-space without a borrow, for one solution.
    ///
    /// The results of an operator are computed now.
    pub(crate) fn into_owned(self, solution: &GridSolution) -> Response<'static> {
        match self {
            Self::Kernel(kernel) => Response::Kernel(kernel.into_owned(solution.pressure.grid())),
            Self::Operator(_) => Response::Outlived {
                // Operators do not have a hardness.
                stiffness: self.stiffness(solution, f64::INFINITY),
                displacement: self.displacement(&solution.pressure),
            },
            Self::Outlived { stiffness, displacement } => Response::Outlived { stiffness, displacement },
        }
    }

    /// The shift of contact edges. For an operator it is the default shift.
    pub(crate) fn edge_bias(&self) -> EdgeBias {
        match self {
            Self::Kernel(kernel) => kernel.get().edge_bias(),
            Self::Operator(_) | Self::Outlived { .. } => EdgeBias::default(),
        }
    }

    /// The boundary of the heights on `grid`.
    pub(crate) fn boundary(&self, grid: Grid) -> Boundary {
        match self {
            Self::Kernel(kernel) => Support::of(kernel.get(), grid).boundary,
            Self::Operator(_) | Self::Outlived { .. } => Boundary::Periodic,
        }
    }

    /// Contact stiffness dσ0/dΔ of `solution`, in E*/λ.
    pub(crate) fn stiffness(&self, solution: &GridSolution, hardness: f64) -> f64 {
        match self {
            Self::Kernel(kernel) => {
                let converged = solution.status != Status::NotConverged;
                contact_stiffness(&solution.pressure, hardness, kernel.get(), converged)
            }
            Self::Operator(operator) => stiffness_with_operator(&solution.pressure, *operator),
            Self::Outlived { stiffness, .. } => *stiffness,
        }
    }

    /// dσ0/dΔ in full contact, in E*/λ. It is infinite unless the solid is on a base.
    pub(crate) fn full_contact_stiffness(&self) -> f64 {
        match self {
            Self::Kernel(kernel) => kernel.get().uniform_displacement().unwrap_or(0.0).recip(),
            Self::Operator(_) | Self::Outlived { .. } => f64::INFINITY,
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
