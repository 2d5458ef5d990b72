//! One solve of a height map, with the same types for all methods.

use anyhow::{Context, Result};
use rc_core::{Field, Kernel, Silent};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactProblem, Control, GaussSeidelParams, Observables, SolveInfo, SolveParams};

/// Methods of solving a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    Uniform,
    /// The uniform grid with the kernel of waves.
    Spectral,
    Adaptive,
    GaussSeidel,
}

impl Method {
    pub(crate) const ALL: [Self; 4] = [Self::Uniform, Self::Spectral, Self::Adaptive, Self::GaussSeidel];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Spectral => "spectral",
            Self::Adaptive => "adaptive",
            Self::GaussSeidel => "gauss-seidel",
        }
    }

    /// Upper bound of the median number of iterations on the finest level over all scenes.
    ///
    /// It is a fifth above the measured medians: 10, 10, 8 and 56.
    pub(crate) fn most_iterations(self) -> f64 {
        match self {
            Self::Uniform | Self::Spectral => 12.0,
            Self::Adaptive => 9.6,
            Self::GaussSeidel => 67.0,
        }
    }

    fn of_solver(self) -> rc_solver::Method {
        match self {
            Self::Uniform | Self::Spectral => rc_solver::Method::Uniform,
            Self::Adaptive => rc_solver::Method::Adaptive,
            Self::GaussSeidel => rc_solver::Method::GaussSeidel,
        }
    }

    pub(crate) fn kernel(self) -> &'static dyn Kernel {
        if self == Self::Spectral { &Spectral } else { &Love }
    }
}

/// A solved contact.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub(crate) pressure: Field,
    pub(crate) info: SolveInfo,
    pub(crate) observables: Observables,
    /// dσ0/dΔ, in E*/λ.
    pub(crate) stiffness: f64,
}

/// Solves to the tolerance `tolerance`, relative to the height range.
pub(crate) fn solve(heights: &Field, method: Method, control: Control, tolerance: f64) -> Result<Solved> {
    let params = SolveParams {
        gauss_seidel: GaussSeidelParams { uniform_elements: true, ..GaussSeidelParams::paper() },
        ..SolveParams::to_tolerance(tolerance).by(method.of_solver())
    };
    let solution = ContactProblem::new(heights, control)
        .with_kernel(method.kernel())
        .solve(&params, &Silent)
        .with_context(|| format!("{} {control:?} to {tolerance:e}", method.name()))?;
    Ok(Solved {
        pressure: solution.pressure().clone(),
        info: solution.info().clone(),
        observables: *solution.observables(),
        stiffness: solution.stiffness(),
    })
}
