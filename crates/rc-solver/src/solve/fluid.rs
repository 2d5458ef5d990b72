//! Contact under a fluid: the pressure is at least that of the fluid, p ≥ f.
//!
//! With p = f + q, the energy ½⟨p L p⟩ - ⟨h p⟩ is that of q ≥ 0 on the heights h - L f, plus a constant. The load that is
//! left to q is σ0 - ⟨f⟩. This is the elastic problem again, with the same gap and the same certificate.

use std::sync::Arc;

use rc_core::{Boundary, Field, HeightSource, Observer, Operator};

use crate::grid::uniform_operator::UniformOperator;
use crate::problem::capabilities::Feature;
use crate::problem::contact_problem::ContactProblem;
use crate::problem::control::Control;
use crate::problem::error::ProblemError;
use crate::problem::summit::Summit;
use crate::problem::support::Support;
use crate::solution::whole::Solution;
use crate::solve::error::SolveError;
use crate::solve::features::{features, refusal_of};
use crate::solve::history::combined;
use crate::solve::params::SolveParams;
use crate::solve::plan::Plan;

/// Relative rounding of a printed penetration of full contact.
const ROUNDED: f64 = 1e-6;

/// A contact problem under a fluid, as the problem of the contact pressure q = p - f.
#[derive(Debug)]
pub struct FluidProblem<'a> {
    /// The problem of q: the heights that the fluid leaves, and the load or penetration that is left.
    contact: ContactProblem<'a>,
    params: SolveParams,
    /// f, in E*.
    pressure: Field,
    /// L f less its mean, in λ. `None` for a uniform f, which deforms nothing.
    bent: Option<Field>,
    /// Mean of L f, in λ.
    mean_displacement: f64,
    /// Height of the maximum of the heights above that of the heights of `contact`, in λ.
    rise: f64,
    /// Estimated summit of the heights above their highest sample, in λ; `None` where it is that of `contact`.
    summit_excess: Option<f64>,
}

/// Results of both pressures together.
///
/// The others of a solution are those of the contact pressure q. The gap is that of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnderFluid {
    /// Mean pressure σ0 of fluid and contact, in E*.
    pub mean_pressure: f64,
    /// Mean pressure ⟨f⟩ of the fluid, in E*.
    pub mean_fluid_pressure: f64,
    /// Penetration Δ into the undeformed heights, in λ.
    pub penetration: f64,
    /// Estimated discretisation error of the penetration, in λ.
    pub penetration_error: f64,
    /// Penetration of full contact, h_max - ⟨h⟩, in λ.
    pub penetration_full_contact: f64,
    /// Maximum height, in λ.
    pub h_max: f64,
    /// Elastic energy ½⟨p L p⟩ per nominal area, in E* λ.
    pub elastic_energy: f64,
}

impl<'a> ContactProblem<'a> {
    /// The same problem with a pressure that is nowhere below that of a fluid, p ≥ `pressure` (in E*).
    ///
    /// The surfaces touch where p exceeds it. It is given on the elements of the heights, as a solver of the flow has
    /// found it, and presses everywhere, also in contact. The load remains that of fluid and contact together.
    ///
    /// ```
    /// use rc_core::{Field, Grid, Silent};
    /// use rc_solver::{ContactProblem, Control, SolveParams};
    ///
    /// // A uniform pressure deforms nothing. The contact bears what is left of the load.
    /// let wave = Field::from_fn(Grid::square(64)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
    /// let fluid = Field::from_fn(wave.grid(), |_| 5e-4);
    /// let problem = ContactProblem::new(&wave, Control::MeanPressure(1e-3));
    /// let problem = problem.with_fluid_pressure(fluid, &SolveParams::default())?;
    /// let solution = problem.solve(&Silent)?;
    /// assert!((solution.pressure().mean() / 5e-4 - 1.0).abs() < 1e-9);
    /// assert!((problem.of(&solution).mean_pressure / 1e-3 - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`SolveError::Unsupported`], as the table says. [`ProblemError`] for another grid, a negative pressure or one that
    /// is not finite, and where the fluid bears the load or keeps the bodies apart.
    pub fn with_fluid_pressure(self, pressure: Field, params: &SolveParams) -> Result<FluidProblem<'a>, SolveError> {
        let asked: Vec<_> = features(&self, params).into_iter().chain([Feature::FluidPressure]).collect();
        if let Some(refused) = refusal_of(&self, &asked, params.method) {
            return Err(refused.into());
        }
        check(&pressure, &self)?;
        // The waves of a surface, on which the tolerance may depend, are lost in the map of the heights that are left.
        let bound = params.tolerance.bound(self.heights.elements_per_wave());
        let params = SolveParams { tolerance: bound.into(), ..*params };
        let support = Support::of(self.kernel.get(), self.heights.grid());
        let is_uniform = pressure.min() >= pressure.max() && support.boundary == Boundary::Periodic;
        let problem = if is_uniform || pressure.max() == 0.0 {
            let mean_displacement = support.compliance * pressure.values()[0];
            let (bent, rise, summit_excess) = (None, 0.0, None);
            FluidProblem { contact: self, params, pressure, bent, mean_displacement, rise, summit_excess }
        } else {
            FluidProblem::bent(self, params, pressure, support.boundary)
        };
        problem.with_load_left(support)
    }
}

impl<'a> FluidProblem<'a> {
    /// The problem on the heights that a pressure leaves, still under the whole load.
    fn bent(contact: ContactProblem<'a>, params: SolveParams, pressure: Field, boundary: Boundary) -> Self {
        let mut bent = Field::zeros(pressure.grid());
        UniformOperator::new(pressure.grid(), contact.kernel.get()).apply(
            pressure.values(),
            bent.values_mut(),
            &mut [],
        );
        let mean_displacement = bent.mean();
        bent.values_mut().iter_mut().for_each(|u| *u -= mean_displacement);
        let heights = contact.heights.heights();
        let summit = Summit::on_grid(contact.heights.surface(), (&heights, heights.max()), boundary);
        let left = combined(heights.into_owned(), &bent, -1.0);
        let (rise, summit_excess) = (summit.sampled - left.max(), Some(summit.excess));
        let contact = ContactProblem { heights: HeightSource::SharedMap(Arc::new(left)), ..contact };
        Self { contact, params, pressure, bent: Some(bent), mean_displacement, rise, summit_excess }
    }

    /// The problem under the load or penetration that the fluid leaves.
    fn with_load_left(self, support: Support) -> Result<Self, SolveError> {
        let fluid = self.pressure.mean();
        let control = match self.contact.control {
            Control::MeanPressure(value) if value.is_finite() && value <= fluid => {
                return Err(ProblemError::FluidBears { value, fluid }.into());
            }
            Control::MeanPressure(value) => Control::MeanPressure(value - fluid),
            Control::Penetration(value) => {
                let touching = self.rise + self.mean_displacement;
                let heights = self.contact.heights.heights();
                let full_contact = heights.max() + self.rise - heights.mean();
                if support.is_none() && value > full_contact * (1.0 + ROUNDED) {
                    return Err(ProblemError::Penetration { value, full_contact }.into());
                }
                // NaN is refused as any penetration is.
                if value <= touching && value > 0.0 {
                    return Err(ProblemError::FluidParts { value, touching }.into());
                }
                Control::Penetration(value - touching)
            }
        };
        Ok(Self { contact: ContactProblem { control, ..self.contact }, ..self })
    }

    /// Checks the problem of the contact pressure and chooses its method.
    ///
    /// # Errors
    /// Those of [`ContactProblem::plan`].
    pub fn plan(&self) -> Result<Plan<'a>, SolveError> {
        self.contact.clone().plan(&self.params)
    }

    /// Solves for the contact pressure: [`FluidProblem::plan`] and [`Plan::solve`].
    ///
    /// # Errors
    /// [`SolveError`].
    pub fn solve(&self, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        self.plan()?.solve(observer)
    }

    /// The pressure of the fluid, in E*.
    #[must_use]
    pub fn fluid_pressure(&self) -> &Field {
        &self.pressure
    }

    /// The results of both pressures, where `solution` is that of this problem.
    #[must_use]
    pub fn of(&self, solution: &Solution<'_>) -> UnderFluid {
        let (info, mean_fluid_pressure) = (solution.info(), self.pressure.mean());
        let summit_excess = self.summit_excess.unwrap_or_else(|| solution.summit_excess());
        UnderFluid {
            mean_pressure: info.mean_pressure + mean_fluid_pressure,
            mean_fluid_pressure,
            penetration: info.penetration + self.rise + self.mean_displacement,
            penetration_error: solution.penetration_error() - solution.summit_excess() + summit_excess,
            penetration_full_contact: info.penetration_full_contact + self.rise,
            h_max: solution.h_max() + self.rise,
            elastic_energy: info.elastic_energy + self.energy_beside(solution, mean_fluid_pressure),
        }
    }

    /// ⟨(q + f/2) L f⟩, the energy of both pressures without that of q.
    fn energy_beside(&self, solution: &Solution<'_>, mean_fluid_pressure: f64) -> f64 {
        let uniform = self.mean_displacement * (solution.info().mean_pressure + 0.5 * mean_fluid_pressure);
        let Some(bent) = &self.bent else { return uniform };
        let nx = bent.grid().nx();
        let rows = solution.pressure().values().chunks(nx).zip(self.pressure.values().chunks(nx));
        let sums = rows
            .zip(bent.values().chunks(nx))
            .map(|((q, f), u)| q.iter().zip(f).zip(u).map(|((q, f), u)| (q + 0.5 * f) * u).sum::<f64>());
        uniform + sums.sum::<f64>() / bent.values().len() as f64
    }
}

fn check(pressure: &Field, problem: &ContactProblem<'_>) -> Result<(), ProblemError> {
    let grid = problem.heights.grid();
    if pressure.grid() != grid {
        return Err(ProblemError::FluidGrid { grid, given: pressure.grid() });
    }
    match pressure.values().iter().position(|f| !(*f >= 0.0 && f.is_finite())) {
        Some(i) => {
            let (ix, iy) = (i % grid.nx(), i / grid.nx());
            Err(ProblemError::FluidPressure { ix, iy, value: pressure.values()[i] })
        }
        None => Ok(()),
    }
}
