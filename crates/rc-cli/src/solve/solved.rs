//! A problem with its surface and memory, and its solution.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use rc_core::{Boundary, Field, HeightSource, Kernel, Observer};
use rc_solver::{ContactProblem, Cost, FluidProblem, History, Plan, Solution, SolveError, SolveParams};
use rc_sweep::memory::Budget;
use rc_sweep::{PathDifference, RowProblem, SolvedRow, Summary, Warning};

use super::failure::Failure;
use super::fluid::SolvedFluid;
use super::leakage::{self, SolvedFlow};
use super::messages;
use super::path;
use super::result_files::{MapHeights, ResultFiles};
use super::shear::SolvedShear;
use crate::error::CliError;
use crate::files::checkpoint::CheckpointFile;
use crate::files::coarsen::check_factor;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::{self, ContactSetup, Place};
use crate::scene::values::Fraction;
use crate::warnings;

/// A problem: a surface, a contact, and the available memory.
#[derive(Clone, Copy)]
pub struct ProblemSetup<'a> {
    /// The surface.
    pub surface: &'a LoadedSurface,
    /// Half-space, load and method.
    pub contact: &'a ContactSetup,
    /// The response of the solid, which is that of the contact or another one.
    pub kernel: &'a dyn Kernel,
    /// The memory that the solve may use.
    pub budget: Budget,
}

/// A solved problem.
pub struct Solved<'a> {
    problem: ProblemSetup<'a>,
    solution: Solution<'a>,
    failure: Option<Failure>,
    /// The unloaded surface after a history of loads (λ), if it converged.
    residual: Option<Field>,
    /// What the steps of the history change, if they were asked for.
    path: Option<PathDifference>,
    /// The fluid that presses on the surfaces, if there is one.
    fluid: Option<SolvedFluid>,
    /// The flow through the gap, if it was asked for.
    flow: Option<SolvedFlow>,
    /// The shear of the contact, if it was asked for.
    shear: Option<SolvedShear>,
    /// The warnings that were known before the solve.
    warnings: Vec<Warning>,
    wall: Duration,
}

/// A solved problem without its surface and contact.
#[derive(Debug)]
pub struct SolvedParts<'a> {
    /// The solution.
    pub solution: Solution<'a>,
    /// What did not converge, if anything.
    pub failure: Option<Failure>,
    /// The unloaded surface after a history of loads (λ), if it converged.
    pub residual: Option<Field>,
    /// What the steps of the history change, if they were asked for.
    pub path: Option<PathDifference>,
    /// The fluid that presses on the surfaces, if there is one.
    pub fluid: Option<SolvedFluid>,
    /// The flow through the gap, if it was asked for and converged.
    pub flow: Option<SolvedFlow>,
    /// The shear of the contact, if it was asked for and solved.
    pub shear: Option<SolvedShear>,
    /// The warnings that were known before the solve.
    pub warnings: Vec<Warning>,
    /// Time to the certified solution.
    pub wall: Duration,
}

/// A problem under a fluid, with the pressure of the fluid (Pa).
type Fluid<'a> = (FluidProblem<'a>, Field);

impl<'a> ProblemSetup<'a> {
    /// Checks the problem and chooses the method.
    ///
    /// # Errors
    /// [`CliError::Input`] when the scene, the requested method or the available memory does not allow it.
    pub(crate) fn plan(&self) -> Result<Plan<'a>, CliError> {
        self.check_grid()?;
        self.plan_under(self.fluid()?.as_ref())
    }

    /// [`ProblemSetup::plan`] under a fluid, if there is one.
    fn plan_under(&self, fluid: Option<&Fluid<'a>>) -> Result<Plan<'a>, CliError> {
        let plan = match fluid {
            None => self.contact_problem().plan(&self.params()),
            Some((problem, _)) => problem.plan(),
        };
        let plan = plan.map_err(|error| self.refuse(&error))?;
        self.check_flow(&plan)?;
        Ok(plan)
    }

    /// The problem under a fluid, if there is one.
    fn fluid(&self) -> Result<Option<Fluid<'a>>, CliError> {
        let Some(source) = &self.contact.fluid else { return Ok(None) };
        let pascals = source.load(self.surface.grid)?;
        let mut pressure = pascals.clone();
        pressure.values_mut().iter_mut().for_each(|value| *value = self.contact.units.pressure(*value));
        let problem = self.contact_problem().with_fluid_pressure(pressure, &self.params());
        Ok(Some((problem.map_err(|error| self.refuse(&error))?, pascals)))
    }

    /// Solves the problem; nothing is written.
    ///
    /// `wall_seconds` counts from `started`.
    ///
    /// # Errors
    /// [`CliError::Input`]. A solution that did not converge is not an error, see [`Solved::failure`].
    pub fn solve(self, started: Instant, observer: &dyn Observer) -> Result<Solved<'a>, CliError> {
        self.check_grid()?;
        let fluid = self.fluid()?;
        let plan = self.plan_under(fluid.as_ref())?;
        if let Some((problem, pressure)) = fluid {
            let solved = self.solved(plan.solve(observer), started)?;
            let both = problem.of(&solved.solution);
            return Ok(Solved { fluid: Some(SolvedFluid { pressure, both }), ..solved });
        }
        if !self.contact.history.is_empty() {
            drop(plan);
            return self.solve_history(started, observer);
        }
        let Some(shear) = &self.contact.shear else { return self.solved(plan.solve(observer), started) };
        let again = plan.under(self.contact.control).map_err(|error| self.refuse(&error))?;
        let solved = self.solved(plan.solve(observer), started)?;
        if solved.failure.is_some() {
            return Ok(solved);
        }
        let (shear, failure) = {
            let refuse = |error: &SolveError| self.refuse(error);
            SolvedShear::of((&again, &solved.solution), (shear, self.contact.units), observer, &refuse)?
        };
        Ok(Solved { shear, failure, wall: started.elapsed(), ..solved })
    }

    /// Solves the loads of a history, one after the other. With steps, also without them.
    fn solve_history(self, started: Instant, observer: &dyn Observer) -> Result<Solved<'a>, CliError> {
        let follow = |loads: &[f64]| self.contact_problem().solve_history(loads, &self.params(), observer);
        let found = match follow(&self.contact.history) {
            Ok(found) => found,
            Err(error) => return self.solved(Err(error), started),
        };
        let (mut path, mut failure) = (None, None);
        if let Some(steps) = self.contact.keys.history_steps {
            match follow(&self.contact.loads_of_history()) {
                Ok(one) => path = Some(path::difference(steps, &*self.surface.heights()?, [&one, &found])),
                Err(SolveError::NotConverged { grid, iterations, solution, .. }) => {
                    let of_one = messages::not_converged(&solution, grid, iterations, self.contact);
                    failure = Some(Failure { what: format!("history in one step: {}", of_one.what), ..of_one });
                }
                Err(error) => return Err(self.refuse(&error)),
            }
        }
        let History { solution, residual } = found;
        let solved = self.solved(Ok(solution), started)?;
        let failure = solved.failure.or(failure);
        Ok(Solved { residual: Some(residual), path, failure, ..solved })
    }

    /// The problem as a row of a sweep, with `kernel`, which is the kernel of this problem.
    ///
    /// # Errors
    /// [`CliError::Input`] when contact and grid do not go together.
    pub(crate) fn of_row(&self, kernel: Arc<dyn Kernel + Send + Sync>) -> Result<RowProblem, CliError> {
        self.check_grid()?;
        Ok(RowProblem {
            heights: self.source(),
            kernel: Some(kernel),
            control: self.contact.control,
            hardness: self.contact.hardness,
            params: self.params(),
        })
    }

    /// The problem with the solution of its row.
    ///
    /// [`Solved::failure`] then tells of the flow only. The status of the solution says whether it converged.
    pub(crate) fn solved_row(self, SolvedRow { solution, wall }: SolvedRow) -> Solved<'a> {
        self.with_flow(solution, None, wall)
    }

    /// Solves on the coarsest grid that is fine enough for the contact area.
    ///
    /// The relative error of the area is then at most `wanted`.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn solve_to_area_error(
        self,
        Fraction(wanted): Fraction,
        started: Instant,
        observer: &dyn Observer,
    ) -> Result<Solved<'a>, CliError> {
        let problem = self.contact_problem();
        if let Some(spec) = self.contact.keys.output_grid {
            // All grids are multiples of the first.
            check_factor(problem.coarsest_grid().map_err(|error| self.refuse(&error))?, spec)?;
        }
        let result = problem.solve_to_area_error(wanted, &self.params(), observer);
        self.solved(result, started)
    }

    /// The warnings that are known before the solve.
    #[must_use]
    pub fn warnings(&self) -> Vec<Warning> {
        warnings::contact::before(self.surface, self.contact)
    }

    /// The cost of the solve by `plan`, with the flow if it is asked for.
    pub(crate) fn cost(&self, plan: &Plan<'_>) -> Cost {
        let cost = plan.cost();
        // Loads of 0 take nothing.
        let one = self.contact.keys.history_steps.map(|_| self.contact.loads_of_history());
        let loads = self.contact.history.iter().chain(one.iter().flatten());
        let n_loads = loads.filter(|load| **load > 0.0).count().max(1) as f64;
        let cost = Cost { cpu_seconds: cost.cpu_seconds.map(|seconds| n_loads * seconds), ..cost };
        if !self.contact.keys.leakage {
            return cost;
        }
        let elements = self.elements_of_flow();
        Cost {
            bytes: cost.bytes.map(|bytes| bytes + rc_leakage::BYTES_PER_ELEMENT * elements),
            cpu_seconds: cost.cpu_seconds.map(|seconds| seconds + rc_leakage::SECONDS_PER_ELEMENT * elements),
            ..cost
        }
    }

    /// Number of elements that the flow is solved on.
    fn elements_of_flow(&self) -> f64 {
        leakage::images(self.contact.boundary) * self.surface.grid.len() as f64
    }

    /// Refuses a flow that does not fit into memory.
    pub(crate) fn check_flow(&self, plan: &Plan<'_>) -> Result<(), CliError> {
        if !self.contact.keys.leakage {
            return Ok(());
        }
        let what = format!("leakage on {} elements, with the contact,", self.surface.grid);
        let flow = rc_leakage::BYTES_PER_ELEMENT * self.elements_of_flow();
        Ok(self.budget.check(&what, self.cost(plan).bytes.unwrap_or(flow), |_| String::new())?)
    }

    /// Checks that depend on the grid of the surface.
    fn check_grid(&self) -> Result<(), CliError> {
        let ContactSetup { layer, kernel, units, sliding, .. } = self.contact;
        resolve::check_thickness(*layer, *kernel, self.surface.grid, units.cell().side())?;
        sliding.as_ref().map_or(Ok(()), |sliding| sliding.check_on(self.surface.grid))?;
        if self.contact.keys.leakage && self.contact.boundary == Boundary::Free {
            rc_leakage::images(self.surface.grid).map_err(|cause| CliError::input(format_args!("leakage: {cause}")))?;
        }
        self.contact.keys.output_grid.map_or(Ok(()), |spec| check_factor(self.surface.grid, spec))
    }

    fn source(&self) -> HeightSource<'static> {
        self.surface.source(self.contact.params.border_level, self.contact.boundary)
    }

    fn contact_problem(&self) -> ContactProblem<'a> {
        let problem = ContactProblem::new(self.source(), self.contact.control);
        let problem = problem.with_hardness(self.contact.hardness).with_kernel(self.kernel);
        let Place { ranks, checkpoint } = &self.contact.place;
        let problem = problem.over(ranks.clone());
        match checkpoint {
            Some(file) => problem.kept_in(Arc::<CheckpointFile>::clone(file)),
            None => problem,
        }
    }

    fn params(&self) -> SolveParams {
        // If one of the machines does not have the memory, all ranks must refuse.
        let available = self.budget.available().map(|bytes| self.contact.place.ranks.minimum(bytes));
        SolveParams { memory_limit: available, ..self.contact.params }
    }

    fn solved(self, result: Result<Solution<'a>, SolveError>, started: Instant) -> Result<Solved<'a>, CliError> {
        let (solution, failure) = match result {
            Ok(solution) => (solution, None),
            Err(SolveError::NotConverged { grid, iterations, solution, .. }) => {
                let failure = messages::not_converged(&solution, grid, iterations, self.contact);
                (*solution, Some(failure))
            }
            Err(error) => return Err(self.refuse(&error)),
        };
        Ok(self.with_flow(solution, failure, started.elapsed()))
    }

    /// Computes the flow, if it is asked for.
    fn with_flow(self, solution: Solution<'a>, failure: Option<Failure>, wall: Duration) -> Solved<'a> {
        let (flow, failure) = match self.contact.keys.leakage.then(|| SolvedFlow::of(&solution, self.contact)) {
            Some(Ok(flow)) => (Some(flow), failure),
            Some(Err(error)) => {
                (None, failure.or_else(|| Some(Failure { what: format!("leakage: {error}"), remedy: "" })))
            }
            None => (None, failure),
        };
        let warnings = self.warnings();
        let (residual, path, fluid, shear) = (None, None, None, None);
        Solved { problem: self, solution, failure, residual, path, fluid, flow, shear, warnings, wall }
    }

    /// The solver's refusal in SI units.
    pub(crate) fn refuse(&self, error: &SolveError) -> CliError {
        messages::in_si(error, self.surface, self.contact, self.budget)
    }
}

impl<'a> Solved<'a> {
    /// The parts of the solution, without the problem.
    #[must_use]
    pub fn into_parts(self) -> SolvedParts<'a> {
        let Self { solution, failure, residual, path, fluid, flow, shear, warnings, wall, .. } = self;
        SolvedParts { solution, failure, residual, path, fluid, flow, shear, warnings, wall }
    }

    /// Number of warnings that were known before the solve.
    pub(crate) fn n_early_warnings(&self) -> usize {
        self.warnings.len()
    }

    /// What did not converge, if anything.
    #[must_use]
    pub fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    /// Whether the method has elements of its own.
    pub(crate) fn has_elements(&self) -> bool {
        self.solution.elements().is_some()
    }

    /// The summary in SI units, with the number `threads`.
    pub(crate) fn summary(&self, threads: usize) -> Summary {
        // This is computed only now, so that the time to the certified solution does not include it.
        let height_and_slope = self.problem.surface.height_and_slope(self.problem.contact.boundary);
        self.files().summary(height_and_slope, self.wall, threads)
    }

    /// Writes the result folder.
    ///
    /// The first rank writes, and all ranks call this together.
    ///
    /// # Errors
    /// [`CliError::Write`].
    pub(crate) fn write(&self, folder: &Path, summary: &Summary) -> Result<(), CliError> {
        self.files().write(folder, summary)
    }

    /// Writes the result folder, with pressure and gap as a Zarr group.
    ///
    /// All ranks write the group.
    ///
    /// # Errors
    /// [`CliError::Write`].
    pub(crate) fn write_shared(&self, folder: &Path, summary: &Summary) -> Result<(), CliError> {
        self.files().write_shared(folder, summary)
    }

    fn files(&self) -> ResultFiles<'_> {
        let ProblemSetup { surface, contact, .. } = self.problem;
        let map = surface.map().map(|(heights, as_read)| MapHeights::InCell { heights, as_read });
        let waves = surface.wave_file().map(AsRef::as_ref);
        let (flow, shear) = (self.flow.as_ref(), self.shear.as_ref());
        let (warnings, origin) = (&self.warnings[..], surface.origin.as_ref());
        let (surface, solution, residual) = (&surface.keys, &self.solution, self.residual.as_ref());
        let (path, fluid) = (self.path, self.fluid.as_ref());
        ResultFiles { surface, map, waves, contact, solution, residual, path, fluid, flow, shear, warnings, origin }
    }
}

impl std::fmt::Debug for ProblemSetup<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("ProblemSetup");
        out.field("surface", &self.surface.keys).field("contact", &self.contact.keys).finish_non_exhaustive()
    }
}

impl std::fmt::Debug for Solved<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("Solved");
        out.field("problem", &self.problem).field("solution", &self.solution).finish_non_exhaustive()
    }
}
