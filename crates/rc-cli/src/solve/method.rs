//! Which method solves a scene, and why.

use rc_solver::{AdaptiveError, AdaptiveParams, AdaptiveProblem, Estimate};

use super::refusal;
use crate::error::CliError;
use crate::resolve::ContactProblem;
use crate::scene::{KernelName, Method, RunKeys};
use crate::surface::LoadedSurface;
use rc_core::quantity::digits;
use rc_sweep::memory::Budget;

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
    let chooser = Chooser { surface, contact, side, budget: Budget::new(run.memory_limit) };
    match contact.method {
        None => chooser.automatic(),
        Some(Method::Adaptive) => {
            let problem = chooser.prepare().map_err(|error| chooser.refuse(&error))?;
            Ok(adaptive(problem, "adaptive: asked for".into()))
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
}

impl<'a> Chooser<'a, '_> {
    fn automatic(&self) -> Result<Choice<'a>, CliError> {
        if self.contact.kernel == KernelName::Spectral {
            return self.on_grid(Plan::Uniform, "uniform: the kernel spectral has no adaptive form".into());
        }
        let problem = match self.prepare() {
            Ok(problem) => problem,
            Err(error) if self.contact.border_level() > 0 => return Err(self.refuse(&error)),
            Err(error) => return self.without_adaptive(&error),
        };
        if self.contact.border_level() > 0 {
            return Ok(adaptive(problem, "adaptive: a border level is asked for".into()));
        }
        let area = problem.estimate().area_fraction;
        let percent = digits(100.0 * area, 2);
        if area <= Estimate::GREATEST_ADAPTIVE_AREA {
            return Ok(adaptive(problem, format!("adaptive: an estimated contact area of {percent} %")));
        }
        match self.on_grid(Plan::Uniform, cheaper_on_grid(100.0 * area)) {
            // The adaptive method fits, or it would not be prepared.
            Err(_) if !self.contact.is_one_of_many => {
                let why = "the uniform grid is cheaper but does not fit into memory";
                Ok(adaptive(problem, format!("adaptive: at an estimated contact area of {percent} % {why}")))
            }
            choice => choice,
        }
    }

    /// Prepares the adaptive method, if it does for this scene and fits into memory.
    fn prepare(&self) -> Result<AdaptiveProblem<'a>, AdaptiveError> {
        let grid = self.surface.grid;
        if grid.has_square_cell() && grid.nx() != grid.ny() {
            // Said here, since a surface is handed over with one side.
            return Err(AdaptiveError::Grid { nx: grid.nx(), ny: grid.ny(), smallest: 128 });
        }
        let memory_limit = self.budget.available();
        let params = AdaptiveParams {
            solve: self.contact.params,
            border_level: self.contact.border_level(),
            memory_limit,
            ..AdaptiveParams::certified()
        };
        AdaptiveProblem::new(self.surface.source(), self.contact.control, &params)
    }

    /// The uniform grid instead of the adaptive method, where that helps.
    fn without_adaptive(&self, error: &AdaptiveError) -> Result<Choice<'a>, CliError> {
        if let AdaptiveError::Memory { area_percent, .. } = error {
            let reason = match area_percent.filter(|percent| *percent > 100.0 * Estimate::GREATEST_ADAPTIVE_AREA) {
                Some(percent) => cheaper_on_grid(percent),
                None if self.contact.is_one_of_many => return Err(self.refuse(error)),
                None => "uniform: the adaptive method does not fit into memory".into(),
            };
            return self.on_grid(Plan::Uniform, reason).map_err(|_| self.refuse(error));
        }
        match self.obstacle(error) {
            Some(obstacle) => self.on_grid(Plan::Uniform, format!("uniform: {obstacle}")),
            None => Err(self.refuse(error)),
        }
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
            AdaptiveError::RectangularCell => Some("the cell is not a square".into()),
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
            AdaptiveError::RectangularCell => CliError::input(format_args!(
                "cell_y: {error}; rc surface --repeat square makes one of copies, --method uniform takes any"
            )),
            AdaptiveError::Memory { needed, area_percent, .. } => {
                let grid = self.surface.grid;
                let part = match area_percent {
                    Some(percent) => format!(", at an estimated contact area of {} %,", digits(*percent, 2)),
                    None => " for its base grid alone".into(),
                };
                let what = format!("the adaptive method on {grid} elements{part}");
                let refused = self.budget.check(&what, 1e6 * *needed as f64, |_| String::new());
                refused.err().map_or_else(|| CliError::input(format_args!("memory_limit: {error}")), CliError::from)
            }
            AdaptiveError::BorderLevel { .. } | AdaptiveError::BorderOfMap => {
                CliError::input(format_args!("border_level: {error}"))
            }
            other => CliError::input(format_args!("method: {other}")),
        }
    }
}

fn adaptive(problem: AdaptiveProblem<'_>, reason: String) -> Choice<'_> {
    Choice { plan: Plan::Adaptive(Box::new(problem)), reason }
}

/// Why the uniform method solves a scene with this estimated contact area, in percent.
fn cheaper_on_grid(percent: f64) -> String {
    format!("uniform: an estimated contact area of {} % is cheaper on the uniform grid", digits(percent, 2))
}
