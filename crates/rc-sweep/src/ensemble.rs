//! A mean over realisations with a wanted error, stored row by row like a sweep.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::content::{Cells, Header};
use crate::error::SweepError;
use crate::journal::Journal;
use crate::kept::Kept;
use crate::levels::{self, Estimate, LevelMean, MOST_REALISATIONS, Samples, Step};
use crate::plan::{ControlKind, PlannedSurface};
use crate::row::Row;
use crate::row_solver::{RowSolver, RunError, Workers};
use crate::shard::{MAX_ROWS, SweepShape};
use crate::workers;

/// The surfaces and loads of an ensemble.
///
/// The results determine which realisations and grids are solved.
#[derive(Clone, Debug, PartialEq)]
pub struct EnsemblePlan {
    /// Quantity that the loads prescribe.
    pub control: ControlKind,
    /// The surface without seed and grid. Each of its loads has its own mean.
    pub surface: PlannedSurface,
    /// Elements per side of the possible grids, coarsest first.
    ///
    /// On one grid, which may be a rectangle with this longer side, the mean is that of its realisations.
    pub sides: Vec<usize>,
    /// Seed of the first realisation. The seeds of level l begin here plus 10000 l.
    pub first_seed: u64,
}

/// A realisation on one grid under one load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Realisation {
    /// Index of the row.
    pub index: usize,
    /// Pressure (Pa) or penetration (m).
    pub load: f64,
    /// Elements per side of the grid.
    pub side: usize,
    /// Seed of the surface.
    pub seed: u64,
}

/// The wanted mean and its error.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedMean {
    /// Name of a numeric cell of the rows, such as `area_fraction`.
    pub quantity: String,
    /// Relative rms error of statistics and grid together.
    pub error: f64,
}

/// A mean over realisations under one load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnsembleMean {
    /// `converged` or `not_converged`.
    pub status: String,
    /// Name of the cell of the rows that was averaged.
    pub mean_of: String,
    /// `pressure` or `penetration`.
    pub control: String,
    /// Prescribed value (Pa or m).
    pub control_value: f64,
    /// The mean.
    pub mean: f64,
    /// Standard error of the mean, from the variances of the levels.
    ///
    /// It is larger than that of known variances, by the number and the skewness of the realisations.
    pub standard_error: f64,
    /// Estimated error of the finest grid. `None` if there is only one.
    pub grid_error: Option<f64>,
    /// Square root of the sum of squares of both errors, relative to the mean.
    pub relative_error: f64,
    /// Wanted maximum of `relative_error`.
    pub wanted_error: f64,
    /// Number of rows in the mean that did not converge.
    pub not_converged: usize,
    /// Elements times applications of the operator, for all realisations.
    pub cost: f64,
    /// Estimated cost of the same standard error on the finest grid alone.
    pub cost_of_plain_mean: f64,
    /// The levels, coarsest first.
    pub levels: Vec<EnsembleLevel>,
}

/// One level of a mean.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnsembleLevel {
    /// Elements per side of the grid.
    pub grid: usize,
    /// Elements per side of the coarser grid whose results are subtracted.
    ///
    /// `None` on the coarsest level.
    pub coarser_grid: Option<usize>,
    /// Seed of the first realisation. The others follow it.
    pub first_seed: u64,
    /// The results on the level.
    #[serde(flatten)]
    pub found: LevelMean,
}

/// An ensemble in its folder. No other process may write to the folder during its lifetime.
#[derive(Debug)]
pub struct Ensemble {
    plan: EnsemblePlan,
    folder: PathBuf,
    journal: Mutex<Journal>,
}

impl Realisation {
    /// Name of the row in a message: `seed 1 on grid 64 (pressure 1e5)`.
    #[must_use]
    pub fn describe(&self, control: ControlKind) -> String {
        format!("seed {} on grid {} ({} {:e})", self.seed, self.side, control.key(), self.load)
    }
}

impl Row for Realisation {
    fn load(&self) -> f64 {
        self.load
    }

    fn shared_surface(&self) -> Option<usize> {
        None
    }
}

impl EnsemblePlan {
    /// Numbers of rows. They are numbered by load, level, realisation and grid, with the finer grid first.
    fn shape(&self) -> SweepShape {
        SweepShape { surfaces: 2 * MOST_REALISATIONS * self.sides.len(), loads: self.surface.loads.len() }
    }

    fn settings(&self) -> Value {
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "control": self.control.key(),
            "ensemble": { "first_seed": self.first_seed, "grids": self.sides },
            "surfaces": [self.surface],
        })
    }

    /// Seed of the first realisation of a level.
    fn first_seed(&self, level: usize) -> u64 {
        self.first_seed.wrapping_add((level * MOST_REALISATIONS) as u64)
    }

    /// Upper bound of the seeds, or `None` if it is too large for `u64`.
    #[must_use]
    pub fn greatest_seed(&self) -> Option<u64> {
        self.first_seed.checked_add((self.sides.len() * MOST_REALISATIONS) as u64)
    }

    /// Realisation `i` of a level.
    ///
    /// It is on the grid of the level, or on the coarser grid if `coarser` is 1.
    fn realisation(&self, load: usize, level: usize, i: usize, coarser: usize) -> Realisation {
        Realisation {
            index: 2 * ((load * self.sides.len() + level) * MOST_REALISATIONS + i) + coarser,
            load: self.surface.loads[load],
            side: self.sides[level - coarser],
            seed: self.first_seed(level) + i as u64,
        }
    }

    /// The rows for `counts` realisations of each level. Rows of finer grids are first.
    fn rows(&self, load: usize, counts: &[usize]) -> Vec<Realisation> {
        let of_level = |(level, &count): (usize, &usize)| {
            let grids = if level > 0 { 2 } else { 1 };
            (0..count).flat_map(move |i| (0..grids).map(move |coarser| self.realisation(load, level, i, coarser)))
        };
        let mut rows: Vec<Realisation> = counts.iter().enumerate().flat_map(of_level).collect();
        rows.sort_by_key(|row| (std::cmp::Reverse(row.side), row.index));
        rows
    }
}

impl Ensemble {
    /// Starts a new ensemble in `folder`, or continues an ensemble with `resume`.
    ///
    /// An ensemble to continue must have the same plan.
    ///
    /// # Errors
    /// [`SweepError`] when there are too many loads, when the folder contains something else, or when it cannot be
    /// written.
    pub fn start(plan: EnsemblePlan, folder: &Path, resume: bool) -> Result<Self, SweepError> {
        let shape = plan.shape();
        if shape.rows() > MAX_ROWS {
            return Err(SweepError::TooManyMeans { loads: shape.loads, most: MAX_ROWS / shape.surfaces });
        }
        let journal = Journal::start(folder, Header::whole(shape, plan.settings()), resume)?;
        Ok(Self { plan, folder: folder.to_owned(), journal: Mutex::new(journal) })
    }

    /// The plan of the ensemble.
    #[must_use]
    pub fn plan(&self) -> &EnsemblePlan {
        &self.plan
    }

    /// The rows that are stored so far.
    #[must_use]
    pub fn kept(&self) -> Kept<'_> {
        Kept::new(&self.folder, self.locked())
    }

    /// Solves the rows that the means of all loads need, and returns the means.
    ///
    /// The table of the rows is written too. The result is `None` if the solver stopped before the end. `workers`
    /// returns the workers for grids with a given number of elements. The selection of rows depends only on results, so
    /// a run that continues after an interruption gives the same digits.
    ///
    /// # Errors
    /// [`RunError`]. The solved rows are stored, and in the table.
    pub fn run<S: RowSolver<Realisation>>(
        &self,
        wanted: &WantedMean,
        solver: &S,
        workers: impl Fn(f64) -> Workers,
    ) -> Result<Option<Vec<EnsembleMean>>, RunError<S::Error>> {
        let means =
            (0..self.plan.surface.loads.len()).map(|load| self.mean(load, wanted, solver, &workers).transpose());
        let means = means.map_while(|mean| mean).collect::<Result<Vec<_>, _>>();
        let kept = self.kept();
        let written = kept.write_table();
        let means = means.inspect_err(|_| kept.discard_empty())?;
        written?;
        Ok(Some(means).filter(|means| means.len() == self.plan.surface.loads.len()))
    }

    /// The mean under one load, or `None` if the solver stopped before the end.
    fn mean<S: RowSolver<Realisation>>(
        &self,
        load: usize,
        wanted: &WantedMean,
        solver: &S,
        workers: &impl Fn(f64) -> Workers,
    ) -> Result<Option<EnsembleMean>, RunError<S::Error>> {
        let n_grids = self.plan.sides.len();
        let mut counts = levels::pilot(n_grids);
        loop {
            let rows = self.plan.rows(load, &counts);
            let missing = |rows: &[Realisation]| -> Vec<Realisation> {
                let journal = self.locked();
                rows.iter().filter(|row| !journal.rows.contains_key(&row.index)).copied().collect()
            };
            let todo = missing(&rows);
            if let Some(finest) = todo.first() {
                let keep = |row: &Realisation, cells| self.keep(row, cells);
                workers::run(&todo, solver, workers((finest.side as f64).powi(2)), &keep)?;
            }
            if !missing(&rows).is_empty() {
                return Ok(None);
            }
            match levels::next(&self.samples(load, &counts, &wanted.quantity)?, n_grids, wanted.error) {
                Step::More(more) => counts = more,
                Step::Done(estimate) => return Ok(Some(self.described(load, wanted, &rows, &estimate))),
            }
        }
    }

    /// The values of these realisations, from the stored rows.
    fn samples(&self, load: usize, counts: &[usize], quantity: &str) -> Result<Vec<Samples>, SweepError> {
        let journal = self.locked();
        let number = |row: &Realisation, of: &dyn Fn(&Cells) -> Option<f64>, name: &str| {
            let value = journal.rows.get(&row.index).and_then(of);
            value.ok_or_else(|| SweepError::NoNumber { quantity: name.to_owned(), seed: row.seed, grid: row.side })
        };
        let value = |row: &Realisation| number(row, &|cells| cells.get(quantity)?.as_f64(), quantity);
        let cost = |row: &Realisation| number(row, &cost_of, "operator_applications");
        let level = |(level, &count): (usize, &usize)| {
            let mut samples = Samples::default();
            for i in 0..count {
                let fine = self.plan.realisation(load, level, i, 0);
                let [mut difference, fine_cost] = [value(&fine)?, cost(&fine)?];
                let mut both = fine_cost;
                if level > 0 {
                    let coarse = self.plan.realisation(load, level, i, 1);
                    difference -= value(&coarse)?;
                    both += cost(&coarse)?;
                }
                samples.differences.push(difference);
                samples.costs.push(both);
                samples.fine_costs.push(fine_cost);
            }
            Ok(samples)
        };
        counts.iter().enumerate().map(level).collect()
    }

    fn described(&self, load: usize, wanted: &WantedMean, rows: &[Realisation], estimate: &Estimate) -> EnsembleMean {
        let journal = self.locked();
        let failed =
            |row: &&Realisation| journal.rows.get(&row.index).is_some_and(|cells| cells["status"] == "not_converged");
        let not_converged = rows.iter().filter(failed).count();
        let level = |(level, &found): (usize, &LevelMean)| EnsembleLevel {
            grid: self.plan.sides[level],
            coarser_grid: level.checked_sub(1).map(|coarser| self.plan.sides[coarser]),
            first_seed: self.plan.first_seed(level),
            found,
        };
        let is_good = estimate.is_reached && not_converged == 0;
        EnsembleMean {
            status: if is_good { "converged" } else { "not_converged" }.to_owned(),
            mean_of: wanted.quantity.clone(),
            control: self.plan.control.key().to_owned(),
            control_value: self.plan.surface.loads[load],
            mean: estimate.mean,
            standard_error: estimate.standard_error,
            grid_error: estimate.bias,
            relative_error: estimate.standard_error.hypot(estimate.bias.unwrap_or(0.0)) / estimate.mean.abs(),
            wanted_error: wanted.error,
            not_converged,
            cost: estimate.cost(),
            cost_of_plain_mean: estimate.cost_of_plain_mean(),
            levels: estimate.levels.iter().enumerate().map(level).collect(),
        }
    }

    fn keep(&self, row: &Realisation, cells: Cells) -> Result<(), SweepError> {
        let mut all = Map::new();
        all.insert("seed".into(), json!(row.seed));
        all.insert("control_value".into(), json!(row.load));
        all.extend(cells);
        self.locked().append(row.index, all)
    }

    /// The journal, also after a worker has panicked.
    ///
    /// Every row in it is complete, so it is still usable.
    fn locked(&self) -> MutexGuard<'_, Journal> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Cost of a row: elements of the finest level times applications of the operator.
///
/// Only elements for which the row was solved count. Unlike a time, the cost is the same on every machine.
fn cost_of(cells: &Cells) -> Option<f64> {
    let grid = || Some(cells.get("grid")?.as_array()?.iter().filter_map(Value::as_f64).product());
    let elements: f64 = cells.get("cells_evaluated").and_then(Value::as_f64).or_else(grid)?;
    Some(elements * cells.get("operator_applications")?.as_f64()?.max(1.0))
}
