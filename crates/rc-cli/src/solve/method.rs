//! Which method solves a scene, and why.

use rc_core::Grid;
use rc_solver::{AdaptiveError, AdaptiveParams, AdaptiveProblem, Estimate};

use super::refusal;
use crate::budget::Budget;
use crate::error::CliError;
use crate::quantity::digits;
use crate::resolve::ContactProblem;
use crate::scene::{KernelName, Method, RunKeys};
use crate::surface::{LoadedSurface, Shape};

/// Bytes that the adaptive method needs for each element of its base grid, at least.
const BYTES_PER_BASE_ELEMENT: f64 = 130.0;

/// What the adaptive method still needs when files are written, relative to its peak.
const KEPT_FOR_FILES: f64 = 1.0 / 3.0;

/// Bytes for each height of a random surface, which `gap.npy` is made with.
const BYTES_PER_HEIGHT: f64 = 8.0;

/// A method, prepared as far as it goes before solving, and why it is this one.
pub(super) struct Choice<'a> {
    pub(super) plan: Plan<'a>,
    pub(super) reason: String,
}

/// A method with what it needs to start.
pub(super) enum Plan<'a> {
    /// Heights are evaluated as they are needed.
    Adaptive(Box<AdaptiveProblem<'a>>),
    /// All heights will be evaluated.
    Uniform,
    /// All heights will be evaluated.
    GaussSeidel,
}

/// Chooses the method: the one that is asked for, else the adaptive one where it can and is cheaper.
///
/// # Errors
/// [`CliError::Input`] when the scene, the method asked for, or the memory there is do not allow it.
pub(super) fn choose<'a>(
    surface: &'a LoadedSurface,
    contact: &ContactProblem,
    side: f64,
    run: &RunKeys,
) -> Result<Choice<'a>, CliError> {
    let chooser = Chooser { surface, contact, side, budget: Budget::new(run.memory_limit), files: run.out.is_some() };
    match contact.method {
        None => chooser.automatic(),
        Some(Method::Adaptive) => {
            let problem = chooser.prepare()?.map_err(|error| chooser.refuse(&error))?;
            chooser.adaptive(problem, "adaptive: asked for".into())
        }
        Some(Method::Uniform) => chooser.on_grid(Plan::Uniform, "uniform: asked for".into()),
        Some(Method::GaussSeidel) => chooser.on_grid(Plan::GaussSeidel, "gauss-seidel: asked for".into()),
    }
}

struct Chooser<'a, 'b> {
    surface: &'a LoadedSurface,
    contact: &'b ContactProblem,
    /// λ in m.
    side: f64,
    budget: Budget,
    /// Whether result files are to be written.
    files: bool,
}

impl<'a> Chooser<'a, '_> {
    fn automatic(&self) -> Result<Choice<'a>, CliError> {
        if self.contact.kernel == KernelName::Spectral {
            return self.on_grid(Plan::Uniform, "uniform: the kernel spectral has no adaptive form".into());
        }
        let problem = match self.prepare()? {
            Ok(problem) => problem,
            Err(error) => match self.obstacle(&error) {
                Some(obstacle) => return self.on_grid(Plan::Uniform, format!("uniform: {obstacle}")),
                None => return Err(self.refuse(&error)),
            },
        };
        let area = problem.estimate().area_fraction;
        let percent = digits(100.0 * area, 2);
        if area <= Estimate::GREATEST_ADAPTIVE_AREA {
            self.adaptive(problem, format!("adaptive: an estimated contact area of {percent} %"))
        } else {
            // Its base grid is memory that the uniform method can use.
            drop(problem);
            let reason = format!("uniform: an estimated contact area of {percent} % is cheaper on the uniform grid");
            self.on_grid(Plan::Uniform, reason)
        }
    }

    /// The outer error ends the command; the inner one only says that the adaptive method does not do for this scene.
    fn prepare(&self) -> Result<Result<AdaptiveProblem<'a>, AdaptiveError>, CliError> {
        self.check_base()?;
        let grid = self.surface.grid;
        if grid.nx() != grid.ny() {
            // Said here, since a surface is handed over with one side.
            return Ok(Err(AdaptiveError::Grid { nx: grid.nx(), ny: grid.ny(), smallest: 128 }));
        }
        let params = AdaptiveParams { solve: self.contact.params, ..AdaptiveParams::certified() };
        Ok(AdaptiveProblem::new(self.surface.source(), self.contact.control, &params))
    }

    /// Refuses a base grid that does not fit, before the solver samples it. Every method needs more than that.
    fn check_base(&self) -> Result<(), CliError> {
        let (Shape::Random(_), Some(waves)) = (&self.surface.shape, self.surface.waves()) else { return Ok(()) };
        let grid = self.surface.grid;
        let needed = (least_base(grid, waves) as f64).powi(2) * BYTES_PER_BASE_ELEMENT;
        self.budget.check(&format!("the base grid of {grid} elements with {waves} waves"), needed, |_| String::new())
    }

    fn adaptive(&self, problem: AdaptiveProblem<'a>, reason: String) -> Result<Choice<'a>, CliError> {
        let Estimate { area_fraction, adaptive_bytes, .. } = problem.estimate();
        let writing = match self.surface.shape {
            Shape::Random(_) if self.files => {
                BYTES_PER_HEIGHT * self.surface.grid.len() as f64 + KEPT_FOR_FILES * adaptive_bytes
            }
            _ => 0.0,
        };
        let (percent, grid) = (digits(100.0 * area_fraction, 2), self.surface.grid);
        let what = format!("the adaptive method on {grid} elements, at an estimated contact area of {percent} %,");
        self.budget.check(&what, adaptive_bytes, |_| String::new())?;
        self.budget.check(&format!("gap.npy of {grid} elements"), writing, |_| "; solve without --out".into())?;
        Ok(Choice { plan: Plan::Adaptive(Box::new(problem)), reason })
    }

    fn on_grid(&self, plan: Plan<'a>, reason: String) -> Result<Choice<'a>, CliError> {
        let name = if matches!(plan, Plan::GaussSeidel) { "gauss-seidel" } else { "uniform" };
        self.budget.check_grid(&format!("the {name} method"), self.surface.grid)?;
        Ok(Choice { plan, reason })
    }

    /// Why the adaptive method does not do for a scene that another method may solve; `None` when none does.
    fn obstacle(&self, error: &AdaptiveError) -> Option<String> {
        let grid = self.surface.grid;
        match error {
            AdaptiveError::Grid { nx, ny, .. } if nx != ny => Some(format!("{grid} elements are not square")),
            AdaptiveError::Grid { .. } | AdaptiveError::Base { .. } => {
                Some(format!("{grid} elements do not divide into adaptive levels"))
            }
            AdaptiveError::Flat => Some("a flat surface has nothing to adapt to".into()),
            AdaptiveError::OperatorError { .. } => {
                Some(format!("the adaptive operator cannot certify a tolerance of {:e}", self.contact.params.tolerance))
            }
            _ => None,
        }
    }

    /// The adaptive method's refusal, in the user's units.
    fn refuse(&self, error: &AdaptiveError) -> CliError {
        match error {
            AdaptiveError::Solve(error) => refusal::in_si(error, self.side, self.contact),
            AdaptiveError::OperatorError { .. } => CliError::input(format_args!(
                "tolerance: {:e} is out of what the adaptive method can certify; give a larger one, or --method uniform",
                self.contact.params.tolerance
            )),
            AdaptiveError::Grid { .. } | AdaptiveError::Base { .. } => {
                CliError::input(format_args!("grid: {error}; --method uniform takes any grid"))
            }
            other => CliError::input(format_args!("method: {other}")),
        }
    }
}

/// Elements per side of the coarsest base grid that the adaptive method may take for a surface with `waves` waves: at least
/// four for the shortest, in whole tiles of eight.
fn least_base(grid: Grid, waves: usize) -> usize {
    let mut side = grid.nx().min(grid.ny());
    while side.is_multiple_of(16) && side / 2 >= waves.saturating_mul(4).max(64) {
        side /= 2;
    }
    // A finest grid that is its own base is halved once more.
    side.min(grid.nx().min(grid.ny()).div_ceil(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_base_grid_follows_the_waves_and_the_divisors() {
        let least = |side, waves| least_base(Grid::square(side).expect("a grid"), waves);
        assert_eq!(least(2048, 64), 256);
        assert_eq!(least(32768, 1024), 4096);
        assert_eq!(least(128, 8), 64);
        assert_eq!(least(1_000_000, 8), 125_000);
        assert_eq!(least(1001, 8), 501);
    }
}
