//! The choice of the method.
//!
//! If the caller asks for a method, it is used. Otherwise the adaptive method is chosen, if it fits and is cheaper.

use std::sync::Arc;

use rc_core::{Boundary, Field, Grid, HeightField, HeightSource, Kernel as _};
use rc_kernel::Love;

use crate::grid::response::padded_side;
use crate::levels::base_grid::{BASE_ELEMENTS_PER_WAVE, base_sides};
use crate::levels::checks::first_split;
use crate::levels::estimate::Estimate;
use crate::levels::split::check_split;
use crate::levels::tiles::TileLevels;
use crate::parallel::in_pool;
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::capabilities::{Feature, Refusal};
use crate::problem::checked::{check_load, check_tolerance};
use crate::problem::contact_problem::ContactProblem;
use crate::problem::contract::check_kernel;
use crate::problem::control::Control;
use crate::problem::method::Method;
use crate::problem::method_reason::MethodReason;
use crate::problem::tolerance::ErrorBound;
use crate::solve::error::SolveError;
use crate::solve::features::{check_ranks, features, refusal_of};
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
    if problem.is_shared() {
        plan_here(problem, params, shared)
    } else {
        in_pool(|| plan_here(problem, params, shared))
    }
}

fn plan_here<'a>(
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
    let features = features(&problem, params);
    if let Some(refused) = refusal_of(&problem, &features, params.method) {
        return Err(refused.into());
    }
    let choice = Choice { problem: &problem, params, bound, shared: &shared, features };
    let (chosen, reason) = match params.method {
        None => choice.automatic()?,
        Some(method @ Method::Adaptive) => {
            (ChosenMethod::Adaptive(Box::new(choice.prepare()?)), MethodReason::AskedFor(method))
        }
        Some(method) => {
            if let Some(split) = problem.kernel.get().split().filter(|_| method == Method::GaussSeidel) {
                check_split(problem.kernel.get(), split, problem.heights.grid())?;
            }
            (choice.on_grid(method)?, MethodReason::AskedFor(method))
        }
    };
    if !matches!(chosen, ChosenMethod::Adaptive(_)) {
        check_ranks(&problem, &reason)?;
    }
    Ok(Plan { problem, params: *params, bound, chosen, reason, shared })
}

/// Relative time of the adaptive method above which the slopes of a few heights decide. They differ by some percent from
/// those of the base grid.
const CLEARLY: f64 = 1.15;

/// One of four elements along both sides, if the map divides so.
fn every_fourth(map: &Field) -> Option<Field> {
    let (grid, [nx, ny]) = (map.grid(), [map.grid().nx(), map.grid().ny()]);
    let sample = Grid::in_cell(nx / 4, ny / 4, grid.cell_ratio()).ok()?;
    let heights = (0..ny).step_by(4).flat_map(|iy| map.row(iy).iter().step_by(4).copied()).collect();
    (nx % 4 == 0 && ny % 4 == 0).then(|| Field::new(sample, heights).ok())?
}

struct Choice<'a, 'b> {
    problem: &'b ContactProblem<'a>,
    params: &'b SolveParams,
    bound: ErrorBound,
    shared: &'b Shared<'a>,
    features: Vec<Feature>,
}

type Chosen<'a> = Result<(ChosenMethod<'a>, MethodReason), SolveError>;

impl<'a> Choice<'a, '_> {
    fn automatic(&self) -> Chosen<'a> {
        if let Some(refusal) = self.excluded(Method::Adaptive) {
            let method = Method::Uniform;
            return Ok((self.on_grid(method)?, MethodReason::Only { method, refusal }));
        }
        let only = self.excluded(Method::Uniform);
        if only.is_none()
            && let Some(percent) = self.large_contact()
            && let Ok(uniform) = self.on_grid(Method::Uniform)
        {
            return Ok((uniform, MethodReason::LargeContact { percent }));
        }
        let adaptive = match self.prepare() {
            Ok(adaptive) => adaptive,
            Err(error) if only.is_some() => return Err(error.into()),
            Err(error) => return self.without_adaptive(error),
        };
        let estimate = adaptive.estimate();
        let percent = 100.0 * estimate.area_fraction;
        let adaptive = ChosenMethod::Adaptive(Box::new(adaptive));
        if let Some(refusal) = only {
            return Ok((adaptive, MethodReason::Only { method: Method::Adaptive, refusal }));
        }
        // Only the adaptive method runs on several ranks.
        if estimate.relative_time <= 1.0 || self.features.contains(&Feature::Ranks) {
            return Ok((adaptive, MethodReason::SmallContact { percent }));
        }
        match self.on_grid(Method::Uniform) {
            Ok(uniform) => Ok((uniform, MethodReason::LargeContact { percent })),
            // The adaptive method fits, or it would not be chosen.
            Err(_) if self.params.method_follows_memory => Ok((adaptive, MethodReason::UniformDoesNotFit { percent })),
            Err(error) => Err(error),
        }
    }

    /// The estimated contact area (%), if contact is clearly too large for the adaptive method.
    ///
    /// A few heights show it. Those that the adaptive method prepares, with their bounds, would take a tenth of the time
    /// of the uniform method.
    fn large_contact(&self) -> Option<f64> {
        let (heights, kernel) = (&self.problem.heights, self.problem.kernel.get());
        let (grid, Control::MeanPressure(pressure)) = (heights.grid(), self.problem.control) else { return None };
        // The preparation also examines the split of any other kernel. Where the adaptive method fails, that is the reason.
        let is_usual = kernel.name() == Love.name() && kernel.half_space().is_none();
        let params = self.params.adaptive(self.bound);
        let fails =
            first_split(&params).is_err() || base_sides(heights, params.base_side, self.problem.boundary()).is_err();
        if !is_usual || fails || self.features.contains(&Feature::Ranks) || self.shared.has_tiles() {
            return None;
        }
        let sample = if let Some(map) = heights.map() {
            every_fourth(map)?
        } else {
            let (surface, side) = (heights.surface()?, BASE_ELEMENTS_PER_WAVE * heights.surface()?.band_limit()?);
            let coarse = Grid::square(side).ok().filter(|_| grid.is_square() && side < grid.nx())?;
            surface.sample(coarse)
        };
        let area = Estimate::area_under(pressure, (&sample, self.problem.boundary()), self.problem.hardness).min(1.0);
        let relative_time = Estimate::relative_time(area, sample.grid().len() as f64, grid.len() as f64);
        (relative_time > CLEARLY).then_some(100.0 * area)
    }

    /// What excludes a method. Ranks do not: see [`check_ranks`].
    fn excluded(&self, method: Method) -> Option<Refusal> {
        let alone: Vec<_> = self.features.iter().copied().filter(|&feature| feature != Feature::Ranks).collect();
        refusal_of(self.problem, &alone, Some(method))
    }

    /// Prepares the adaptive method, if it fits the problem and the memory.
    fn prepare(&self) -> Result<TileLevels<'a>, AdaptiveError> {
        let (params, kernel) = (self.params.adaptive(self.bound), self.problem.kernel.get());
        let split = kernel.split().expect("the table refuses kernels without a split");
        let data = self.shared.tiles(&self.problem.heights, kernel, split, &params)?;
        TileLevels::new(data, self.problem, &params)
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
            AdaptiveError::Grid { .. } | AdaptiveError::Base { .. } => Some(MethodReason::NoLevels { grid }),
            AdaptiveError::Deviation { kernel, .. } => Some(MethodReason::DeviationNotResolved { kernel }),
            AdaptiveError::Unsupported(refusal) => {
                Some(MethodReason::Only { method: Method::Uniform, refusal: refusal.clone() })
            }
            AdaptiveError::OperatorError { .. } => {
                Some(MethodReason::ToleranceTooSmall { tolerance: self.bound.value() })
            }
            _ => None,
        }
    }

    /// A method that stores fields on the whole grid, if they fit into memory.
    fn on_grid(&self, method: Method) -> Result<ChosenMethod<'a>, SolveError> {
        check_uniform(self.problem.heights.grid(), bytes_per_element(self.problem), self.params.memory_limit, method)?;
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
