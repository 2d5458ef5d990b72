//! The choice of the method.
//!
//! If the caller asks for a method, it is used. Otherwise the adaptive method is chosen, if it fits and is cheaper.

use std::sync::Arc;

use rc_core::{Boundary, Grid, HeightField, HeightSource, SplitByScale};

use crate::grid::response::padded_side;
use crate::levels::adaptive::AdaptiveProblem;
use crate::levels::estimate::Estimate;
use crate::levels::split::check_split;
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::checked::{check_load, check_tolerance};
use crate::problem::contact_problem::ContactProblem;
use crate::problem::contract::check_kernel;
use crate::problem::method::{Method, MethodReason};
use crate::problem::tolerance::ErrorBound;
use crate::solve::error::SolveError;
use crate::solve::memory::{bytes_per_element, check_uniform};
use crate::solve::params::SolveParams;
use crate::solve::plan::ChosenMethod;
use crate::solve::plan::Plan;
use crate::solve::shared::Shared;

/// Checks the problem and chooses its method.
pub(super) fn plan<'a>(
    problem: ContactProblem<'a>,
    params: &SolveParams,
    shared: Arc<Shared<'a>>,
) -> Result<Plan<'a>, SolveError> {
    let bound = params.tolerance.bound(problem.heights.elements_per_wave());
    check_load(problem.bounds())?;
    check_tolerance(bound)?;
    check_grid(&problem.heights)?;
    check_kernel(problem.kernel.get(), problem.heights.grid())?;
    if problem.boundary() == Boundary::Free {
        check_padded(problem.heights.grid())?;
    }
    let choice = Choice { problem: &problem, params, bound, shared: &shared };
    let (chosen, reason) = match params.method {
        None => choice.automatic(),
        Some(method) => {
            choice.check_asked_for(method)?;
            let chosen = match method {
                Method::Adaptive => {
                    let split = choice.split().ok_or_else(|| choice.not_the_half_space(method))?;
                    ChosenMethod::Adaptive(Box::new(choice.prepare(split)?))
                }
                Method::Uniform | Method::GaussSeidel => choice.on_grid(method)?,
            };
            Ok((chosen, MethodReason::AskedFor(method)))
        }
    }?;
    if problem.place.is_shared() && !matches!(chosen, ChosenMethod::Adaptive(_)) {
        return Err(SolveError::OneRank { reason });
    }
    Ok(Plan { problem, params: *params, bound, chosen, reason, shared })
}

struct Choice<'a, 'b> {
    problem: &'b ContactProblem<'a>,
    params: &'b SolveParams,
    bound: ErrorBound,
    shared: &'b Shared<'a>,
}

type Chosen<'a> = Result<(ChosenMethod<'a>, MethodReason), SolveError>;

impl<'a> Choice<'a, '_> {
    /// Refuses a method that cannot solve with this kernel, border level, hardness or boundary.
    fn check_asked_for(&self, method: Method) -> Result<(), SolveError> {
        match method {
            Method::GaussSeidel if self.problem.hardness.is_finite() => Err(SolveError::Hardness { method }),
            Method::GaussSeidel if self.is_free() => Err(SolveError::FreeBorders { method }),
            Method::GaussSeidel => self.check_half_space(method).and_then(|()| self.check_border(method)),
            Method::Uniform => self.check_border(method),
            Method::Adaptive => Ok(()),
        }
    }

    fn check_border(&self, method: Method) -> Result<(), SolveError> {
        if self.params.border_level > 0 { Err(SolveError::BorderLevel { method }) } else { Ok(()) }
    }

    /// Refuses a kernel that is not that of Love's squares on the half-space.
    fn check_half_space(&self, method: Method) -> Result<(), SolveError> {
        let split = self.split().filter(|split| split.deviates_below(0.0) == 0.0);
        let split = split.ok_or_else(|| self.not_the_half_space(method))?;
        Ok(check_split(self.problem.kernel.get(), split, self.problem.heights.grid())?)
    }

    /// The split of the kernel. `None` for a solid on a base, which the adaptive method does not solve.
    fn split(&self) -> Option<&dyn SplitByScale> {
        let kernel = self.problem.kernel.get();
        kernel.split().filter(|_| kernel.uniform_displacement().is_none())
    }

    fn automatic(&self) -> Chosen<'a> {
        let has_border = self.params.border_level > 0;
        let Some(split) = self.split() else {
            if has_border {
                return Err(self.not_the_half_space(Method::Adaptive));
            }
            return Ok((self.on_grid(Method::Uniform)?, self.without_split()));
        };
        let adaptive = match self.prepare(split) {
            Ok(adaptive) => adaptive,
            Err(error) if has_border => return Err(error.into()),
            Err(error) => return self.without_adaptive(error),
        };
        let percent = 100.0 * adaptive.estimate().area_fraction;
        let adaptive = ChosenMethod::Adaptive(Box::new(adaptive));
        if has_border {
            return Ok((adaptive, MethodReason::BorderLevel));
        }
        if percent <= 100.0 * Estimate::GREATEST_ADAPTIVE_AREA {
            return Ok((adaptive, MethodReason::SmallContact { percent }));
        }
        match self.on_grid(Method::Uniform) {
            Ok(uniform) => Ok((uniform, MethodReason::LargeContact { percent })),
            // The adaptive method fits, or it would not be chosen.
            Err(_) if self.params.method_follows_memory => Ok((adaptive, MethodReason::UniformDoesNotFit { percent })),
            Err(error) => Err(error),
        }
    }

    fn boundary(&self) -> Boundary {
        self.problem.boundary()
    }

    fn is_free(&self) -> bool {
        self.boundary() == Boundary::Free
    }

    /// The error of a method that does not solve contacts of this solid.
    fn not_the_half_space(&self, method: Method) -> SolveError {
        let kernel = self.problem.kernel.get();
        if kernel.uniform_displacement().is_some() {
            SolveError::Solid { method }
        } else {
            SolveError::Kernel { method, kernel: kernel.name() }
        }
    }

    /// Why a kernel without a split by scale is solved on the uniform grid.
    fn without_split(&self) -> MethodReason {
        let kernel = self.problem.kernel.get();
        match kernel.uniform_displacement() {
            Some(_) => MethodReason::Layer,
            None => MethodReason::NoSplitOfKernel { kernel: kernel.name() },
        }
    }

    /// Prepares the adaptive method, if it fits the problem and the memory.
    fn prepare(&self, split: &dyn SplitByScale) -> Result<AdaptiveProblem<'a>, AdaptiveError> {
        let (params, kernel) = (self.params.adaptive(self.bound), self.problem.kernel.get());
        let ground = self.shared.ground(&self.problem.heights, kernel, split, &params)?;
        AdaptiveProblem::on(ground, self.problem.bounds(), &params, &self.problem.place)
    }

    /// Chooses the uniform grid after the adaptive method has failed with `error`.
    ///
    /// Fails if the uniform method cannot solve the problem either.
    fn without_adaptive(&self, error: AdaptiveError) -> Chosen<'a> {
        let Some(reason) = self.obstacle(&error) else { return Err(error.into()) };
        match self.on_grid(Method::Uniform) {
            Ok(uniform) => Ok((uniform, reason)),
            // Neither method fits. The adaptive one needs less memory.
            Err(_) if matches!(error, AdaptiveError::Memory { .. }) => Err(error.into()),
            Err(other) => Err(other),
        }
    }

    /// The reason to solve by the uniform method if the adaptive one returns `error`.
    ///
    /// `None` if the uniform method must refuse the problem too. Also `None` if only memory is lacking, and
    /// [`SolveParams::method_follows_memory`] is `false`.
    fn obstacle(&self, error: &AdaptiveError) -> Option<MethodReason> {
        let grid = self.problem.heights.grid();
        let is_large = |percent: &f64| *percent > 100.0 * Estimate::GREATEST_ADAPTIVE_AREA;
        match error {
            AdaptiveError::Memory { area_percent, .. } => match area_percent.filter(is_large) {
                Some(percent) => Some(MethodReason::LargeContact { percent }),
                None => self.params.method_follows_memory.then_some(MethodReason::AdaptiveDoesNotFit),
            },
            AdaptiveError::Elements { .. } => Some(MethodReason::ElementsNotSquare { grid }),
            AdaptiveError::Grid { .. } | AdaptiveError::Base { .. } => Some(MethodReason::NoLevels { grid }),
            AdaptiveError::Deviation { kernel, .. } => Some(MethodReason::DeviationNotResolved { kernel }),
            AdaptiveError::Flat => Some(MethodReason::Flat),
            AdaptiveError::OperatorError { .. } => {
                Some(MethodReason::ToleranceTooSmall { tolerance: self.bound.value() })
            }
            _ => None,
        }
    }

    /// A method that stores fields on the whole grid, if they fit into memory.
    fn on_grid(&self, method: Method) -> Result<ChosenMethod<'a>, SolveError> {
        check_uniform(
            self.problem.heights.grid(),
            bytes_per_element(self.boundary()),
            self.params.memory_limit,
            method,
        )?;
        Ok(if method == Method::GaussSeidel { ChosenMethod::GaussSeidel } else { ChosenMethod::Uniform })
    }
}

/// Refuses a grid that exceeds the limits of [`Grid`] when it is padded.
///
/// A grid with free borders is padded, so that no element acts on another around the border.
fn check_padded(grid: Grid) -> Result<(), SolveError> {
    let [px, py] = [grid.nx(), grid.ny()].map(padded_side);
    Grid::in_cell(px, py, grid.cell_ratio() * (py * grid.nx()) as f64 / (px * grid.ny()) as f64)?;
    Ok(())
}

/// Refuses a grid that does not resolve the waves of its surface.
fn check_grid(heights: &HeightSource<'_>) -> Result<(), SolveError> {
    let grid = heights.grid();
    match heights.surface().and_then(HeightField::band_limit) {
        Some(waves) if grid.resolved_wavenumber() < waves => Err(SolveError::TooCoarse { grid, waves }),
        _ => Ok(()),
    }
}
