//! Surfaces from a function, under one contact: sweeps in a few lines.

use std::path::PathBuf;
use std::sync::Arc;

use rc_core::{HeightSource, Kernel, Units};
use rc_solver::{Control, SolveError, SolveParams};
use thiserror::Error;

use crate::content::Cells;
use crate::ensemble::{Ensemble, EnsembleMean, Realisation, WantedMean};
use crate::plan::{ControlKind, PlannedSurface, SweepRow};
use crate::problems::{RowProblem, RowProblems};
use crate::results::{RowResults, SolvedRow};
use crate::row::Row;
use crate::row_solver::{RowError, RunError, Workers};
use crate::summary::{SolveContext, Summary};
use crate::sweep::Sweep;

/// A surface that is ready to be solved.
#[derive(Clone, Debug)]
pub struct SweptSurface {
    /// A map or a surface on its grid, in λ.
    pub heights: HeightSource<'static>,
    /// rms height about the mean (λ), for the summary.
    pub rms_height: f64,
    /// rms slope, for the summary.
    pub rms_slope: f64,
}

/// The contact of all rows, without the load.
#[derive(Clone)]
pub struct SweptContact {
    /// The cell and E*.
    pub units: Units,
    /// Elastic response. `None` is that of [`rc_solver::ContactProblem::new`].
    pub kernel: Option<Arc<dyn Kernel + Send + Sync>>,
    /// Maximum pressure (E*). It is infinite for an elastic contact.
    pub hardness: f64,
    /// Method, tolerance and limits.
    pub params: SolveParams,
}

/// Reasons why a row was not solved.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SurfaceError<E> {
    /// The surface could not be made.
    #[error("{row}: {cause}")]
    Surface {
        /// Name of the row.
        row: String,
        /// Error of the function that makes surfaces.
        cause: E,
    },
    /// The solver refused the problem. Its numbers are in units of λ and E*.
    #[error("{row}: {cause}")]
    Contact {
        /// Name of the row.
        row: String,
        /// Error of the solver.
        cause: Box<SolveError>,
    },
    /// The plan wants folders with fields, but only the caller of [`Sweep::solve`] can write them.
    #[error("the rows of this function have no fields; set keeps_fields to false, or call Sweep::solve")]
    NoFields,
}

impl SweptContact {
    /// An elastic half-space under certified contacts ([`SolveParams::certified`]).
    ///
    /// As in every sweep, the memory of the machine does not choose the method.
    #[must_use]
    pub fn new(units: Units) -> Self {
        let params = SolveParams { method_follows_memory: false, ..SolveParams::certified() };
        Self { units, kernel: None, hardness: f64::INFINITY, params }
    }
}

impl std::fmt::Debug for SweptContact {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("SweptContact");
        out.field("units", &self.units)
            .field("kernel", &self.kernel.as_ref().map(|kernel| kernel.name()))
            .field("hardness", &self.hardness)
            .field("params", &self.params)
            .finish()
    }
}

impl Sweep {
    /// Solves the remaining rows on surfaces that `make` makes, and returns the path of the table.
    ///
    /// A row has the keys of a [`Summary`]. `make` gets the entry of the plan, which may have a seed. All loads of a
    /// surface follow one another and share what it returns. It is called again only if workers are at two surfaces at
    /// once. Only the settings in the plan identify a sweep that is resumed, so they must say all that determines
    /// surfaces and contact.
    ///
    /// ```
    /// use std::f64::consts::{PI, TAU};
    ///
    /// use rc_core::{Elasticity, Field, Grid, PeriodicCell, Units};
    /// use rc_sweep::{ControlKind, PlannedSurface, Shard, Sweep, SweepPlan, SweptContact, SweptSurface, Workers};
    /// use serde_json::json;
    ///
    /// // Waves of two amplitudes, in a cell of 1 mm. At half the load of full contact, half of a wave touches.
    /// let units = Units::new(PeriodicCell::new(1e-3)?, Elasticity::from_e_star(1e9)?);
    /// let full = |amplitude: f64| units.pascals(PI * amplitude);
    /// let planned = |amplitude: f64| PlannedSurface {
    ///     surface: json!({ "amplitude": amplitude, "grid": 64 }),
    ///     contact: json!({ "e_star": 1e9, "cell": 1e-3 }),
    ///     loads: vec![0.25 * full(amplitude), 0.5 * full(amplitude)],
    ///     ..PlannedSurface::default()
    /// };
    /// let plan = SweepPlan::new(ControlKind::Pressure, vec![planned(1e-3), planned(2e-3)]);
    /// let wave = |surface: &PlannedSurface| {
    ///     let amplitude = surface.surface["amplitude"].as_f64().ok_or("no amplitude")?;
    ///     let heights = Field::from_fn(Grid::square(64).map_err(|_| "no grid")?, |at| amplitude * (TAU * at.x).cos());
    ///     let [rms_height, rms_slope] = [1.0, TAU].map(|factor| factor * amplitude / 2.0_f64.sqrt());
    ///     Ok::<_, &str>(SweptSurface { heights: std::sync::Arc::new(heights).into(), rms_height, rms_slope })
    /// };
    ///
    /// let folder = tempfile::tempdir()?;
    /// let sweep = Sweep::start(plan, Shard::WHOLE, &folder.path().join("waves"), false)?;
    /// sweep.solve_surfaces(&SweptContact::new(units), wave, Workers { threads: 2, at_once: 2 })?;
    /// let kept = sweep.kept();
    /// let areas: Vec<f64> = kept.rows().values().filter_map(|cells| cells["area_fraction"].as_f64()).collect();
    /// for (area, exact) in areas.iter().zip([1.0 / 3.0, 0.5, 1.0 / 3.0, 0.5]) {
    ///     assert!((area - exact).abs() < 0.01, "{areas:?}");
    /// }
    /// assert_eq!(areas.len(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RunError`]. A surface that cannot be made, or a load that the solver refuses, omits its rows only.
    pub fn solve_surfaces<E: Send>(
        &self,
        contact: &SweptContact,
        make: impl Fn(&PlannedSurface) -> Result<SweptSurface, E> + Sync,
        workers: Workers,
    ) -> Result<PathBuf, RunError<SurfaceError<E>>> {
        let plan = self.plan();
        if plan.keeps_fields {
            return Err(RunError::Failed(SurfaceError::NoFields));
        }
        let made = |row: &SweepRow| make(&plan.surfaces[row.surface]);
        let describe = |row: &SweepRow| plan.describe(row);
        let of_function = OfFunction { contact, control: plan.control, make: made, describe, threads: workers.threads };
        self.solve(&of_function, &of_function, workers)
    }
}

impl Ensemble {
    /// Solves the rows that the means need on surfaces that `make` makes, as [`Ensemble::run`] does.
    ///
    /// `make` gets seed and side of the grid.
    ///
    /// # Errors
    /// Those of [`Ensemble::run`].
    pub fn solve_surfaces<E: Send>(
        &self,
        wanted: &WantedMean,
        contact: &SweptContact,
        make: impl Fn(&Realisation) -> Result<SweptSurface, E> + Sync,
        workers: Workers,
    ) -> Result<Option<Vec<EnsembleMean>>, RunError<SurfaceError<E>>> {
        let control = self.plan().control;
        let describe = |row: &Realisation| row.describe(control);
        let of_function = OfFunction { contact, control, make, describe, threads: workers.threads };
        self.solve(wanted, &of_function, &of_function, |_| workers)
    }
}

/// Problems on surfaces of a function, and their summaries.
struct OfFunction<'a, M, D> {
    contact: &'a SweptContact,
    control: ControlKind,
    make: M,
    /// Name of a row.
    describe: D,
    /// Number of all threads.
    threads: usize,
}

/// The load of a row, with the name of the row for errors.
struct LoadOfRow {
    control: Control,
    row: String,
}

impl<R, M, D, E> RowProblems<R> for OfFunction<'_, M, D>
where
    R: Row,
    M: Fn(&R) -> Result<SweptSurface, E> + Sync,
    D: Fn(&R) -> String + Sync,
    E: Send,
{
    type Surface = SweptSurface;
    type Contact = LoadOfRow;
    type Error = SurfaceError<E>;

    fn surface(&self, row: &R) -> Result<SweptSurface, SurfaceError<E>> {
        (self.make)(row).map_err(|cause| SurfaceError::Surface { row: (self.describe)(row), cause })
    }

    fn contact(&self, row: &R) -> Result<LoadOfRow, SurfaceError<E>> {
        Ok(LoadOfRow { control: self.control.of(row.load(), self.contact.units), row: (self.describe)(row) })
    }

    fn problem(&self, surface: &SweptSurface, load: &LoadOfRow) -> Result<RowProblem, SurfaceError<E>> {
        let SweptContact { kernel, hardness, params, .. } = self.contact;
        let (heights, kernel) = (surface.heights.clone(), kernel.clone());
        Ok(RowProblem { heights, kernel, control: load.control, hardness: *hardness, params: *params })
    }

    fn refused(&self, _surface: &SweptSurface, load: &LoadOfRow, cause: SolveError) -> SurfaceError<E> {
        SurfaceError::Contact { row: load.row.clone(), cause: Box::new(cause) }
    }
}

impl<R, M, D, E> RowResults<Self, R> for OfFunction<'_, M, D>
where
    R: Row,
    M: Fn(&R) -> Result<SweptSurface, E> + Sync,
    D: Fn(&R) -> String + Sync,
    E: Send,
{
    fn cells(
        &self,
        _row: &R,
        surface: &SweptSurface,
        _load: &LoadOfRow,
        solved: SolvedRow,
    ) -> Result<Cells, SurfaceError<E>> {
        let context = SolveContext {
            control: self.control,
            border_level: self.contact.params.border_level,
            rms_height: surface.rms_height,
            rms_slope: surface.rms_slope,
            wall: solved.wall,
            threads: self.threads,
            conductivity: None,
            jump_distance: None,
            slides: solved.solution.info().friction.is_some(),
        };
        Ok(Summary::of(&solved.solution, self.contact.units, &context).cells())
    }

    fn failed(&self, _row: &R, error: SurfaceError<E>) -> RowError<SurfaceError<E>> {
        RowError::Refused(error)
    }
}
