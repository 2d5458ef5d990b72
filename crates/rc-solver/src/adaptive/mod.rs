//! The contact problem on an adaptive mesh: work and memory follow the contact, not the cell.
//!
//! Uniform grids up to a base grid, as in [`crate::solve_uniform`]; from there on, level by level, only the tiles of 8 × 8
//! cells that contact touches or nearly does, with the multilevel operator. What is not stored is out of contact, and the
//! survey proves it.

mod contact_area;
mod element_heights;
mod elements;
mod error;
mod estimate;
mod fresh;
pub(crate) mod heights;
mod level;
mod multilevel;
pub(crate) mod operator;
mod prolongation;
mod refinement;
mod solution;
mod split;
mod survey;
pub(crate) mod tiles;

use rc_core::{Event, Grid, Observer};
use rc_kernel::{Love, ScaleSplit, SplitParams};

use self::contact_area::contact_area;
use self::elements::Elements;
pub use self::error::AdaptiveError;
pub use self::estimate::Estimate;
pub use self::heights::HeightSource;
use self::heights::Heights;
use self::level::{Level, Mesh};
pub use self::multilevel::MultilevelOperator;
use self::operator::{Prepared, Real};
use self::refinement::State;
pub use self::solution::{AdaptiveSolution, ContactElement};
use self::tiles::{TILE, TileSet};
use crate::problem::Problem;
use crate::solution::{LevelInfo, LevelValues};
use crate::uniform::{self, Climb, Climbed};
use crate::{Certificate, Control, SolveParams};

/// Operator errors from here on are reached in single precision.
const SINGLE_PRECISION: f64 = 1e-6;

/// Error of L relative to the rms displacement, over the tolerance, that a certificate may have: tolerances are relative to
/// the height range, which is at least ten times the error's measure on any surface.
const OPERATOR_ERROR_PER_TOLERANCE: f64 = 10.0;

/// Elements of the base grid for the shortest wave: what interpolates heights to other levels needs no more.
const BASE_ELEMENTS_PER_WAVE: usize = 4;

/// Fewest elements per side of the base grid.
const SMALLEST_BASE: usize = 64;

/// How accurately, and within which limits, the adaptive method solves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdaptiveParams {
    /// Tolerance of the certificate and limit of iterations.
    pub solve: SolveParams,
    /// Bound on the error of one application of L, relative to the rms displacement, on pressures of contacts
    /// ([`SplitParams`] has the measurements). A tolerance below a tenth of it lowers it.
    pub operator_error: f64,
    /// How often elements at the edges of contacts are halved beyond the finest grid. Inside contacts they stay as they are.
    pub border_level: usize,
    /// Elements per side of the base grid; `None` chooses.
    pub base_side: Option<usize>,
    /// Most memory, in bytes; a larger estimate is an error, before any work. That of the base grid is checked before heights
    /// are sampled.
    pub memory_limit: Option<u64>,
}

impl AdaptiveParams {
    /// As [`SolveParams::certified`], L to 1e-6, no limit of memory.
    #[must_use]
    pub fn certified() -> Self {
        Self {
            solve: SolveParams::certified(),
            operator_error: 1e-6,
            border_level: 0,
            base_side: None,
            memory_limit: None,
        }
    }
}

/// A checked contact problem, ready for the adaptive method: heights are sampled, nothing is solved.
///
/// Displacements are those of Love's squares ([`rc_kernel::Love`]) of the finest side.
pub struct AdaptiveProblem<'a> {
    heights: Heights<'a>,
    problem: Problem,
    params: AdaptiveParams,
    split: SplitParams,
}

impl<'a> AdaptiveProblem<'a> {
    /// Checks and prepares.
    ///
    /// # Errors
    /// [`AdaptiveError`], but not [`AdaptiveError::NotConverged`].
    pub fn new(source: HeightSource<'a>, control: Control, params: &AdaptiveParams) -> Result<Self, AdaptiveError> {
        let error = params.operator_error.min(OPERATOR_ERROR_PER_TOLERANCE * params.solve.tolerance);
        let split = SplitParams::for_error(error)
            .ok_or(AdaptiveError::OperatorError { value: error, smallest: SplitParams::SMALLEST_ERROR })?;
        let base_side = base_side(&source, params.base_side)?;
        check_memory(params.memory_limit, estimate::base_bytes(base_side), None)?;
        let heights = Heights::new(with_border_level(source, params.border_level)?, base_side)?;
        let problem = Problem::of_statistics(heights.extremes(), control, &params.solve)?;
        if problem.h_range == 0.0 {
            return Err(AdaptiveError::Flat);
        }
        let prepared = Self { heights, problem, params: *params, split };
        let Estimate { area_fraction, adaptive_bytes, .. } = prepared.estimate();
        check_memory(params.memory_limit, adaptive_bytes, Some(100.0 * area_fraction))?;
        Ok(prepared)
    }

    /// What solving it will cost, from the surface and the load alone.
    #[must_use]
    pub fn estimate(&self) -> Estimate {
        Estimate::new(&self.heights, self.params.border_level, self.problem.control)
    }

    /// The greatest height over the finest grid, in λ.
    #[must_use]
    pub fn h_max(&self) -> f64 {
        self.problem.h_max
    }

    /// Solves it.
    ///
    /// The certificate comes from a fresh application of L on the returned pressure; it covers every cell where a bound does
    /// not exclude contact. The result is bitwise the same for any number of threads.
    ///
    /// # Errors
    /// [`AdaptiveError::NotConverged`].
    pub fn solve(&self, observer: &dyn Observer) -> Result<AdaptiveSolution, AdaptiveError> {
        let Self { heights, problem, params, split } = self;
        if params.operator_error.min(OPERATOR_ERROR_PER_TOLERANCE * params.solve.tolerance) >= SINGLE_PRECISION {
            Solver::<f32>::new(heights, *problem, params, *split).solve(observer)
        } else {
            Solver::<f64>::new(heights, *problem, params, *split).solve(observer)
        }
    }

    /// Hands out the gap under the mean `solution` on the grid, as [`AdaptiveSolution::displacement_rows`] does the
    /// displacement. Neither it nor the heights are ever whole in memory.
    ///
    /// # Errors
    /// What `take` returns.
    ///
    /// # Panics
    /// When the solution is on another grid than this problem.
    pub fn gap_rows<E>(
        &self,
        solution: &AdaptiveSolution,
        mut take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        assert_eq!(solution.finest_side(), self.heights.finest_side(), "not a solution of this problem");
        let offset = solution.gap_offset(self.h_max());
        solution.displacement_rows(|first, displacement| {
            let mut rows = self.heights.row_of_tiles(solution.grid().nx(), first / TILE);
            for (h, v) in rows.iter_mut().zip(displacement) {
                *h = v - *h + offset;
            }
            take(first, &rows)
        })
    }
}

/// Solves a contact problem on an adaptive mesh: [`AdaptiveProblem::new`] and [`AdaptiveProblem::solve`].
///
/// # Errors
/// [`AdaptiveError`].
pub fn solve_adaptive(
    source: HeightSource<'_>,
    control: Control,
    params: &AdaptiveParams,
    observer: &dyn Observer,
) -> Result<AdaptiveSolution, AdaptiveError> {
    AdaptiveProblem::new(source, control, params)?.solve(observer)
}

/// The source on the grid of the smallest elements.
fn with_border_level(source: HeightSource<'_>, border_level: usize) -> Result<HeightSource<'_>, AdaptiveError> {
    match source {
        _ if border_level == 0 => Ok(source),
        HeightSource::Surface(surface, side) if surface.band_limit().is_some() => {
            let finest = (border_level < 32).then(|| side.checked_shl(border_level as u32)).flatten();
            let finest = finest.filter(|&finest| finest >> border_level == side && finest <= DEEPEST_SIDE);
            let deepest = (DEEPEST_SIDE / side.max(1)).checked_ilog2().unwrap_or(0);
            let finest = finest.ok_or(AdaptiveError::BorderLevel { border_level, side, deepest })?;
            Ok(HeightSource::Surface(surface, finest))
        }
        _ => Err(AdaptiveError::BorderOfMap),
    }
}

/// Refuses what needs more bytes than the limit.
fn check_memory(limit: Option<u64>, bytes: f64, area_percent: Option<f64>) -> Result<(), AdaptiveError> {
    match limit {
        Some(limit) if bytes > limit as f64 => {
            let needed = (bytes / 1e6).ceil() as u64;
            Err(AdaptiveError::Memory { needed, limit: limit / 1_000_000, area_percent })
        }
        _ => Ok(()),
    }
}

/// Checks or chooses the elements per side of the base grid.
fn base_side(source: &HeightSource<'_>, wanted: Option<usize>) -> Result<usize, AdaptiveError> {
    let (nx, ny, waves) = match source {
        HeightSource::Surface(surface, side) => (*side, *side, surface.band_limit()),
        HeightSource::Map(map) => (map.grid().nx(), map.grid().ny(), None),
    };
    let finest = nx;
    if let Some(base) = wanted {
        let fits = base >= TILE && base.is_multiple_of(TILE) && base > 2 * waves.unwrap_or(0) && 2 * base <= finest;
        let divides = fits && finest.is_multiple_of(base) && (finest / base).is_power_of_two();
        let error = AdaptiveError::Base { base, waves: waves.unwrap_or(0), finest };
        return if divides && nx == ny { Ok(base) } else { Err(error) };
    }
    // A map may hold waves as short as a few elements: two levels above the base grid are safe, and three on large maps.
    let least = match waves {
        Some(waves) => (BASE_ELEMENTS_PER_WAVE * waves).max(SMALLEST_BASE),
        None => (finest / if finest >= 4096 { 8 } else { 4 }).max(SMALLEST_BASE),
    };
    let halves = |side: usize| side.is_multiple_of(2 * TILE) && side / 2 >= least;
    let mut base = finest;
    while halves(base) {
        base /= 2;
    }
    if base == finest && finest.is_multiple_of(2 * TILE) && finest / 2 > 2 * waves.unwrap_or(0) {
        base /= 2;
    }
    let allowed = nx == ny && base < finest && Grid::square(finest).is_ok();
    if allowed { Ok(base) } else { Err(AdaptiveError::Grid { nx, ny, smallest: 2 * least }) }
}

/// Most elements per side of the grid of the smallest elements: where tiles are is looked up in tables of 4 bytes for 64 of
/// them.
const DEEPEST_SIDE: usize = 1 << 17;

/// What the levels share; `T` is the precision of fresh gaps.
struct Solver<'a, T> {
    heights: &'a Heights<'a>,
    problem: Problem,
    params: SolveParams,
    border_level: usize,
    /// L, and its approximate inverse, for corrections.
    response: Prepared<f32>,
    preconditioner: Prepared<f32>,
    /// L for fresh gaps.
    fresh: Prepared<T>,
}

impl<'a, T: Real + Into<f64>> Solver<'a, T> {
    fn new(heights: &'a Heights<'a>, problem: Problem, params: &AdaptiveParams, split: SplitParams) -> Self {
        let (quick, certified) = (ScaleSplit::new(SplitParams::quick()), ScaleSplit::new(split));
        let (base, border_level) = (heights.base().grid(), params.border_level);
        Self {
            response: Prepared::displacement(&quick, base, border_level),
            preconditioner: Prepared::inverse(&quick, base),
            fresh: Prepared::displacement(&certified, base, border_level),
            heights,
            problem,
            params: params.solve,
            border_level,
        }
    }

    fn base(&self) -> Grid {
        self.heights.base().grid()
    }

    fn solve(&self, observer: &dyn Observer) -> Result<AdaptiveSolution, AdaptiveError> {
        let n_above = (self.heights.finest_side() / self.base().nx()).ilog2() as usize;
        let (mut mesh, mut contact_gap, mut infos, mut coarser) = self.solve_base(n_above, observer);
        for above in 1..=n_above {
            let grid = Grid::square(self.base().nx() << above).expect("a level of a checked grid");
            observer.notify(&Event::Level { grid, level: infos.len(), n_levels: infos.len() + 1 + n_above - above });
            if above == n_above {
                let level = self.solve_finest(grid, mesh, contact_gap, observer);
                infos.push(level.info);
                return self.finish(grid, level, infos, coarser);
            }
            let tolerance = uniform::coarse_tolerance(n_above - above - 1).max(self.params.tolerance);
            let level = self.prepare_level(grid, mesh, tolerance, observer);
            infos.push(level.info);
            if above + 1 == n_above {
                coarser = Some(self.values(grid, &level));
            }
            contact_gap = level.outcome.contact_gap;
            mesh = self.refined(&level, above >= n_above - self.border_level);
        }
        unreachable!("the finest level returns")
    }

    /// The start on elements half as large: of all, or of those `at_edges` of contacts only.
    fn refined(&self, level: &Level, at_edges: bool) -> Mesh {
        let Level { elements, pressure, gap, outcome, .. } = level;
        let function = prolongation::level_function(elements, pressure, gap, outcome.contact_gap);
        if !at_edges {
            return prolongation::prolong(elements.finest(), &function);
        }
        let chosen = self.state(elements, pressure, gap, outcome.contact_gap).too_coarse();
        let refined = split::split(elements, chosen, true, self.fresh.reach().stencil);
        let mut pressure = elements.moved(&refined, pressure, 0.0);
        prolongation::prolong_to(elements, &function, &refined, &mut pressure);
        Mesh { elements: refined, pressure }
    }

    /// What decides on the size of elements.
    fn state<'b>(&self, elements: &'b Elements, pressure: &'b [f64], gap: &'b [f64], contact_gap: f64) -> State<'b> {
        State { elements, pressure, gap, contact_gap, height_curvature: self.heights.curvature() }
    }

    /// What a level found.
    fn values(&self, grid: Grid, level: &Level) -> LevelValues {
        let Level { elements, pressure, gap, outcome, .. } = level;
        LevelValues {
            area_fraction: contact_area(elements, pressure, (gap, outcome.contact_gap), grid).fraction,
            rms_pressure: solution::rms_pressure(elements, pressure),
            penetration: self.problem.h_max + outcome.approach,
        }
    }

    /// Wraps up what the finest level found.
    fn finish(
        &self,
        grid: Grid,
        level: Level,
        levels: Vec<LevelInfo>,
        coarser: Option<LevelValues>,
    ) -> Result<AdaptiveSolution, AdaptiveError> {
        let area = contact_area(&level.elements, &level.pressure, (&level.gap, level.outcome.contact_gap), grid);
        let area = coarser.map_or(area, |coarser| area.with_coarser(coarser.area_fraction));
        let (outcome, iterations) = (level.outcome, level.info.iterations);
        let certificate = outcome.certificate;
        let info = outcome.info(&self.problem, levels, coarser);
        let solution = AdaptiveSolution {
            base: self.base(),
            grid: Grid::square(grid.nx() >> self.border_level).expect("a coarser grid than the finest"),
            finest: grid,
            border_level: self.border_level,
            elements: level.elements,
            pressure: level.pressure,
            area,
            info,
            evaluated: level.evaluated,
            proven: grid.len() - level.evaluated,
        };
        if certificate.penetration <= self.params.tolerance && certificate.load <= Certificate::LOAD_TOLERANCE {
            Ok(solution)
        } else {
            Err(AdaptiveError::NotConverged { grid, iterations, certificate, solution: Box::new(solution) })
        }
    }

    /// Uniform grids up to the base grid: the start on the level above it, the gap in contact, the work, and what it found
    /// when one level is left.
    fn solve_base(&self, n_above: usize, observer: &dyn Observer) -> (Mesh, f64, Vec<LevelInfo>, Option<LevelValues>) {
        let base = self.heights.base();
        let (problem, params) = (&self.problem, self.params);
        let climb = Climb { kernel: &Love, problem, params, n_above, observer };
        let Climbed { descent, outcome, levels, coarser } = climb.to(base);
        let function = to_tiles(base.grid(), &uniform::level_function(&descent));
        let tiles = TileSet::full(base.grid().nx() / TILE);
        (prolongation::prolong(&tiles, &function), outcome.contact_gap, levels, coarser)
    }
}

/// Values of a grid, tile by tile.
fn to_tiles(grid: Grid, values: &[f64]) -> Vec<f64> {
    let tiles = TileSet::full(grid.nx() / TILE);
    let mut result = Vec::with_capacity(values.len());
    for &[column, row] in tiles.places() {
        for y in 0..TILE {
            let start = (row as usize * TILE + y) * grid.nx() + column as usize * TILE;
            result.extend_from_slice(&values[start..start + TILE]);
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use rc_core::HeightField;

    use super::*;

    /// Any surface with this many waves.
    struct Waves(usize);

    impl HeightField for Waves {
        fn height(&self, _x: f64, _y: f64) -> f64 {
            0.0
        }

        fn band_limit(&self) -> Option<usize> {
            Some(self.0)
        }
    }

    #[test]
    fn the_base_grid_follows_the_waves_and_the_divisors() {
        let base = |side, waves| base_side(&HeightSource::Surface(&Waves(waves), side), None);
        for (side, waves, expected) in [(2048, 64, 256), (32768, 1024, 4096), (128, 8, 64), (1_000_000, 8, 125_000)] {
            assert_eq!(base(side, waves).ok(), Some(expected), "{side}, {waves} waves");
        }
        assert!(matches!(base(1001, 8), Err(AdaptiveError::Grid { .. })));
    }

    #[test]
    fn a_base_grid_above_the_limit_is_refused_before_heights_are_sampled() {
        struct Unsampled;
        impl HeightField for Unsampled {
            fn height(&self, _x: f64, _y: f64) -> f64 {
                panic!("sampled")
            }

            fn band_limit(&self) -> Option<usize> {
                Some(1000)
            }
        }
        let params = AdaptiveParams { memory_limit: Some(100_000_000), ..AdaptiveParams::certified() };
        let source = HeightSource::Surface(&Unsampled, 32768);
        let error = AdaptiveProblem::new(source, Control::MeanPressure(1e-3), &params).err();
        assert!(matches!(error, Some(AdaptiveError::Memory { limit: 100, area_percent: None, .. })), "{error:?}");
    }
}
