//! One solve of a height map by any method, in one form.

use anyhow::{Context, Result};
use rc_core::{DVec2, Field, HeightSource, Kernel, Silent};
use rc_kernel::{Love, PeriodicLove, Spectral};
use rc_solver::{
    AdaptiveParams, Coefficient, Control, GaussSeidelParams, IterationParams, Observables, SolveInfo, solve_adaptive,
    solve_dense, solve_gauss_seidel, solve_uniform,
};

use rc_figures::pressure_field;

/// How a contact is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    Uniform,
    /// The uniform grid with the kernel of waves.
    Spectral,
    Adaptive,
    GaussSeidel,
}

impl Method {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Spectral => "spectral",
            Self::Adaptive => "adaptive",
            Self::GaussSeidel => "gauss-seidel",
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

impl Solved {
    /// Relative rms difference of two pressures.
    pub(crate) fn distance(&self, other: &Field) -> f64 {
        let squares = self.pressure.values().iter().zip(other.values()).map(|(a, b)| (a - b) * (a - b));
        (squares.sum::<f64>() / other.values().iter().map(|b| b * b).sum::<f64>()).sqrt()
    }
}

/// Solves to `tolerance`.
pub(crate) fn solve(heights: &Field, method: Method, control: Control, tolerance: f64) -> Result<Solved> {
    let asked = || format!("{} {control:?} to {tolerance:e}", method.name());
    try_solve(heights, method, control, tolerance).with_context(asked)
}

fn try_solve(heights: &Field, method: Method, control: Control, tolerance: f64) -> Result<Solved> {
    let solve = IterationParams { tolerance, ..IterationParams::certified() };
    match method {
        Method::Uniform | Method::Spectral => {
            let kernel = method.kernel();
            let solution = solve_uniform(heights, kernel, control, &solve, &Silent)?;
            let (observables, stiffness) = (Observables::of(&solution, kernel), solution.contact_stiffness(kernel));
            Ok(Solved { pressure: solution.pressure, info: solution.info, observables, stiffness })
        }
        Method::Adaptive => {
            let params = AdaptiveParams { solve, ..AdaptiveParams::certified() };
            let solution = solve_adaptive(HeightSource::Map(heights), control, &params, &Silent)?;
            let (observables, stiffness) = (solution.observables(), solution.contact_stiffness());
            Ok(Solved { pressure: pressure_field(&solution)?, info: solution.info, observables, stiffness })
        }
        Method::GaussSeidel => {
            let params = GaussSeidelParams { tolerance, uniform_elements: true, ..GaussSeidelParams::paper() };
            let love = PeriodicLove::new();
            let coefficient = |offset: DVec2, half_side: f64| love.coefficient(offset, half_side);
            let coefficient: Coefficient<'_> = &coefficient;
            let solution = solve_gauss_seidel(heights, &Love, coefficient, control, &params, &Silent)?;
            let (observables, stiffness) = (Observables::of(&solution, &Love), solution.contact_stiffness(&Love));
            Ok(Solved { pressure: solution.pressure, info: solution.info, observables, stiffness })
        }
    }
}

/// The pressure under a given penetration by elimination.
pub(crate) fn eliminated(heights: &Field, penetration: f64) -> Result<Field> {
    solve_dense(heights, &Love, penetration)?.context("elimination found no contact")
}
