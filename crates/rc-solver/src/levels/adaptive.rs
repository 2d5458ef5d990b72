//! The contact problem on an adaptive mesh: work and memory grow with the contact.
//!
//! From each level to the next finer one, the side of the elements is halved. The coarsest levels, up to the base grid,
//! are uniform grids, as in the uniform method. Each finer level has only the tiles of 8 × 8 cells that contact touches
//! or nearly touches. The multilevel operator applies L on them. The module `exclusion` proves that the rest of the
//! cell is out of contact.

use std::sync::Arc;

use rc_comm::Ranks;
use rc_core::{Boundary, EdgeBias, Grid, Kernel, Observer};
use rc_quadtree::TILE;

use crate::levels::agreed_stop::AgreedStop;
use crate::levels::checkpoint::LevelStart;
use crate::levels::checks::{check_memory, first_split};
use crate::levels::estimate::Estimate;
use crate::levels::ground::Ground;
use crate::levels::level::SolvedLevel;
use crate::levels::nested_iteration::{NestedIteration, NestedSolution};
use crate::levels::operator_error::{PressureScale, can_certify, certifying_split};
use crate::levels::params::AdaptiveParams;
use crate::levels::setup::{Given, Splits};
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::bounds::Bounds;
use crate::problem::capabilities::{Feature, refusal};
use crate::problem::checked::Problem;
#[cfg(test)]
use crate::problem::control::Control;
use crate::problem::method::Method;
use crate::problem::place::Place;
use crate::problem::support::Support;
use crate::solution::gap_part::GapPart;
use crate::solution::rows::Receiver;
use crate::solution::rows::Rows;
use crate::tiles::contact_area::Values;
use crate::tiles::ladder::sides_of;
use crate::tiles::memory::base_bytes;
use crate::tiles::patch::displacement_of_patch;
use crate::tiles::solution::AdaptiveSolution;
use crate::tiles::solution::row_of_tiles;
use crate::tiles::split::GapSplit;

/// A checked contact problem, ready for the adaptive method.
///
/// Heights are sampled, but nothing is solved. Displacements are those of the kernel's [`rc_core::Kernel::split`].
pub(crate) struct AdaptiveProblem<'a> {
    pub(crate) ground: Arc<Ground<'a>>,
    pub(crate) problem: Problem,
    params: AdaptiveParams,
    /// Split for fresh gaps in descents.
    split: GapSplit,
    place: Place,
}

/// The reason why the uniform grid is better than the adaptive method.
///
/// An estimate had chosen the adaptive method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unsuitable {
    /// Contact is near so many tiles that the uniform grid is faster.
    Scattered {
        /// Part of the tiles that is near contact.
        tile_fraction: f64,
    },
    /// Pressures are so rough that no operator can certify the tolerance.
    Rough,
}

impl std::fmt::Debug for AdaptiveProblem<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("AdaptiveProblem").field("params", &self.params).finish_non_exhaustive()
    }
}

impl<'a> AdaptiveProblem<'a> {
    /// Checks and prepares the problem.
    ///
    /// # Errors
    /// [`AdaptiveError`].
    #[cfg(test)]
    pub(crate) fn new(
        source: rc_core::HeightSource<'a>,
        control: Control,
        params: &AdaptiveParams,
    ) -> Result<Self, AdaptiveError> {
        let ground = Ground::new(source, &rc_kernel::Love, &rc_kernel::HalfSpace, params)?;
        Self::on(&Arc::new(ground), control.into(), params, &Place::default())
    }

    /// The problem of one load, solved in this place.
    ///
    /// `ground` was made with the same `params`.
    ///
    /// # Errors
    /// [`AdaptiveError`].
    pub(crate) fn on(
        ground: &Arc<Ground<'a>>,
        bounds: Bounds,
        params: &AdaptiveParams,
        place: &Place,
    ) -> Result<Self, AdaptiveError> {
        let split = first_split(params)?;
        let support = Support { boundary: ground.boundary(), compliance: 0.0 };
        let problem = Problem::of_statistics(ground.heights.extremes(), bounds, &params.solve, support)?;
        if problem.h_range == 0.0
            && let Some(refusal) = refusal(&[Feature::Flat], Some(Method::Adaptive))
        {
            return Err(refusal.into());
        }
        let prepared = Self { ground: Arc::clone(ground), problem, params: *params, split, place: place.clone() };
        let grid = prepared.grid();
        let Estimate { area_fraction, adaptive_bytes, .. } = prepared.estimate();
        // Ranks share all bytes except those of the base grid.
        let base_bytes = base_bytes(ground.kernels.base().period()) + ground.sampled_bytes;
        let bytes = base_bytes + (adaptive_bytes - base_bytes) / place.ranks.size() as f64;
        check_memory(grid, params.memory_limit, bytes, Some(100.0 * area_fraction))?;
        Ok(prepared)
    }

    /// The expected cost of the solve, from only the surface and the load.
    #[must_use]
    pub(crate) fn estimate(&self) -> Estimate {
        let Ground { heights, kernels, .. } = &*self.ground;
        let estimate = Estimate::new(heights, self.params.border_level, &self.problem, kernels.base().period());
        Estimate { adaptive_bytes: estimate.adaptive_bytes + self.ground.sampled_bytes, ..estimate }
    }

    /// The grid that solutions are on.
    fn grid(&self) -> Grid {
        let (finest, level) = (self.ground.heights.ladder().finest(), self.params.border_level);
        finest.with_elements(finest.nx() >> level, finest.ny() >> level).expect("a coarser grid than the finest")
    }

    /// The same problem without a borrow. A borrowed map of heights is copied.
    pub(crate) fn into_owned(self) -> AdaptiveProblem<'static> {
        let Self { ground, problem, params, split, place } = self;
        AdaptiveProblem { ground: Arc::new(Ground::into_owned(ground)), problem, params, split, place }
    }

    /// The bound that the certificate must meet.
    pub(crate) fn bound(&self) -> crate::problem::tolerance::ErrorBound {
        self.params.solve.bound
    }

    /// The maximum height over the finest grid, in λ.
    #[must_use]
    pub(crate) fn h_max(&self) -> f64 {
        self.problem.h_max
    }

    /// Solves the problem.
    ///
    /// The certificate comes from a fresh application of L on the returned pressure, plus bounds on the error of that
    /// operator. It covers every cell where a bound does not exclude contact. The result is bitwise the same for any
    /// number of threads.
    ///
    /// The `kernel` is the one that the ground was made with.
    pub(crate) fn solve(&self, kernel: &dyn Kernel, observer: &dyn Observer) -> AdaptiveSolution {
        let observer = &AgreedStop { observer, ranks: &self.place.ranks };
        let solver = self.first_solver(kernel);
        let start = solver.prepare(solver.begin(observer), observer);
        self.finish(self.solve_levels(&solver, start, observer), kernel.edge_bias())
    }

    /// Solves the problem, unless the uniform grid is better.
    ///
    /// The levels below the finest show which method is better.
    ///
    /// # Errors
    /// [`Unsuitable`].
    pub(crate) fn solve_if_suitable(
        &self,
        kernel: &dyn Kernel,
        observer: &dyn Observer,
    ) -> Result<AdaptiveSolution, Unsuitable> {
        let observer = &AgreedStop { observer, ranks: &self.place.ranks };
        let solver = self.first_solver(kernel);
        let base = solver.begin(observer);
        if base.tile_fraction > Estimate::GREATEST_TILE_FRACTION {
            return Err(Unsuitable::Scattered { tile_fraction: base.tile_fraction });
        }
        let start = solver.prepare(base, observer);
        if !can_certify(&solver.scale(&start), self.params.solve.bound, &self.problem) {
            return Err(Unsuitable::Rough);
        }
        Ok(self.finish(self.solve_levels(&solver, start, observer), kernel.edge_bias()))
    }

    pub(crate) fn first_solver<'s>(&'s self, kernel: &'s dyn Kernel) -> NestedIteration<'s> {
        self.solver(kernel, Splits { fresh: self.split, certified: self.split })
    }

    /// Solves the finest level, with operators that are as accurate as the bound needs.
    pub(crate) fn solve_levels(
        &self,
        solver: &NestedIteration<'_>,
        start: LevelStart,
        observer: &dyn Observer,
    ) -> NestedSolution {
        let (first, kernel) = (solver.splits(), solver.kernel());
        let certified = self.certifying_split(first.certified, &solver.scale(&start));
        let solved = if certified == first.certified {
            solver.finish(start, observer)
        } else {
            self.solver(kernel, Splits { certified, ..first }).take_over(start, observer)
        };
        let certificate = solved.level.outcome.certificate;
        let better = self.certifying_split(solved.splits.certified, &solved.scale);
        // A pressure may be rougher than its start.
        let is_done = certificate.meets(self.params.solve.bound) || observer.should_stop();
        if better == solved.splits.certified || is_done {
            return solved;
        }
        let splits = Splits { certified: better, ..solved.splits };
        self.solver(kernel, splits).improve(solved, observer)
    }

    fn solver<'s>(&'s self, kernel: &'s dyn Kernel, splits: Splits) -> NestedIteration<'s> {
        let given = Given { ground: &self.ground, place: &self.place, kernel };
        NestedIteration::new(given, self.problem, &self.params, splits)
    }

    /// The first split, from `split` on, that can certify a pressure of this scale.
    fn certifying_split(&self, split: GapSplit, scale: &PressureScale) -> GapSplit {
        certifying_split(split, scale, self.params.solve.bound, &self.problem)
    }

    /// Makes the solution from the results of the levels.
    fn finish(&self, solved: NestedSolution, bias: EdgeBias) -> AdaptiveSolution {
        let NestedSolution { grid, level, levels, coarser, .. } = solved;
        let SolvedLevel { elements, pressure, gap, outcome, evaluated, covered, .. } = level;
        let (contact_gap, hardness) = (outcome.contact_gap, self.problem.bounds.hardness);
        let values = Values { mesh: &elements, pressure: &pressure, gap: &gap, contact_gap, hardness, bias };
        let (area, plastic) = (values.contact_area(grid), values.plastic_edges(grid));
        let mut info = outcome.info(&self.problem, levels, coarser);
        if self.problem.support.boundary == Boundary::Free {
            info.mean_displacement += displacement_of_patch(&elements, &pressure, grid);
        }
        AdaptiveSolution {
            converged: outcome.certificate.meets(self.params.solve.bound),
            base: self.ground.kernels.base(),
            grid: self.grid(),
            finest: grid,
            elements,
            pressure,
            area,
            hardness,
            plastic,
            info,
            evaluated,
            proven: grid.len() - covered,
        }
    }

    /// Hands out the displacement of the mean `solution` on the grid.
    ///
    /// The rows are those of [`AdaptiveSolution::displacement_rows`].
    ///
    /// # Errors
    /// The error that `take` returns.
    pub(crate) fn displacement_rows<E>(
        &self,
        solution: &AdaptiveSolution,
        receiver: Receiver,
        take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        solution.displacement_rows(&self.ground.kernels, Rows::on_grid(receiver), take)
    }

    /// The ranks that solve the problem.
    pub(crate) fn ranks(&self) -> &Ranks {
        &self.place.ranks
    }

    /// The contact stiffness of `solution`, as [`AdaptiveSolution::contact_stiffness`].
    pub(crate) fn contact_stiffness(&self, solution: &AdaptiveSolution) -> f64 {
        solution.contact_stiffness(&self.ground.kernels)
    }

    /// Hands out a part of the gap under the mean `solution` on the grid.
    ///
    /// The rows are those of [`AdaptiveSolution::displacement_rows`]. Neither the gap nor the heights are ever whole in
    /// memory.
    ///
    /// # Errors
    /// The error that `take` returns.
    ///
    /// # Panics
    /// When the solution is on another grid than this problem.
    pub(crate) fn gap_rows<E>(
        &self,
        solution: &AdaptiveSolution,
        part: GapPart,
        rows: Rows,
        mut take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        assert_eq!(solution.finest_grid(), self.ground.heights.ladder().finest(), "not a solution of this problem");
        let offset = solution.gap_offset(self.h_max());
        let grid = if rows.finest { solution.finest_grid() } else { solution.grid() };
        let of_pressure = solution.hardness.is_finite().then(|| solution.on_one_size(rows.finest));
        solution.displacement_rows(&self.ground.kernels, rows, |first, displacement| {
            let mut rows = self.ground.heights.row_of_tiles(sides_of(grid), first / TILE);
            for (h, v) in rows.iter_mut().zip(displacement) {
                *h = v - *h + offset;
            }
            if let Some((mesh, pressure)) = &of_pressure {
                for (g, p) in rows.iter_mut().zip(row_of_tiles(mesh.finest(), pressure, first / TILE)) {
                    *g = part.of(*g, p, solution.hardness);
                }
            }
            take(first, &rows)
        })
    }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, HeightField};

    use super::*;
    use crate::problem::params::IterationParams;

    #[test]
    fn a_base_grid_above_the_limit_is_refused_before_heights_are_sampled() {
        struct Unsampled;
        impl HeightField for Unsampled {
            fn height(&self, _at: DVec2) -> f64 {
                panic!("sampled")
            }

            fn band_limit(&self) -> Option<usize> {
                Some(1000)
            }
        }
        let params = AdaptiveParams {
            solve: IterationParams::relative(1e-6),
            operator_error: 1e-6,
            border_level: 0,
            base_side: None,
            memory_limit: Some(100_000_000),
        };
        let source = Unsampled.on(Grid::square(32768).expect("a grid"));
        let error = AdaptiveProblem::new(source, Control::MeanPressure(1e-3), &params).err();
        let expected = matches!(error, Some(AdaptiveError::Memory { limit: 100, area_percent: None, .. }));
        assert!(expected, "{error:?}");
    }
}
