//! The pressure above which a sweep with flows does not leak.

use std::path::Path;
use std::time::Instant;

use rc_core::{Boundary, Silent};
use rc_sweep::memory::Budget;
use rc_sweep::{Sweep, SweepRow, files, to_json};

use super::surfaces::Surfaces;
use crate::curves::sealing::{AXES, Problem, SEALING_FILE, Sealing, SurfaceSeal};
use crate::error::CliError;
use crate::run::stop::Stop;
use crate::scene::keys::ContactKeys;
use crate::scene::loaded::LoadedSurface;
use crate::solve::leakage::open_gap;
use crate::solve::solved::{ProblemSetup, SolvedParts};

/// Ratio of the ends of a bracket, minus 1, at which bisection ends.
const NARROW: f64 = 0.01;

/// Least relative step of a load.
const LEAST_STEP: f64 = 1e-6;

/// A load, its mean pressure (Pa) and its contact area (fraction).
#[derive(Clone, Copy)]
struct State {
    load: f64,
    pressure: f64,
    area: f64,
}

/// Finds the sealing pressures of the finished rows of `sweep`, and writes them.
///
/// Between the last load with a flow and the first without, contacts under further loads are solved until the bracket
/// is narrower than 1 %, or `stop` says so. Their flows are not solved, because only the connection of the film counts.
///
/// # Errors
/// [`CliError`].
pub(super) fn find(surfaces: &Surfaces, sweep: &Sweep, folder: &Path, stop: &Stop) -> Result<Sealing, CliError> {
    let loads = sweep.plan().shape().loads;
    let mut problems: Vec<Problem> = Vec::new();
    for (i, surface) in surfaces.all().iter().enumerate().filter(|(_, surface)| surface.leaks()) {
        let rows = (0..loads).map(|load| sweep.plan().row(i * loads + load));
        let mut rows: Vec<(State, [bool; 2])> = rows.filter_map(|row| solved_before(sweep, &row)).collect();
        rows.sort_by(|a, b| a.0.load.total_cmp(&b.0.load));
        let mut search = Search { surfaces, index: i, heights: None, rows, stop };
        let name = surface.name();
        if problems.last().is_none_or(|problem| problem.scene != name) {
            problems.push(Problem::new(name));
        }
        for (axis, name) in AXES.into_iter().enumerate() {
            let ends = search.bracket(axis)?.map(|end| end.map(|state| [state.pressure, state.area]));
            if let Some(problem) = problems.last_mut() {
                problem.surfaces.push(SurfaceSeal::new(surface.seed(), name, ends));
            }
        }
    }
    let sealing = Sealing::of(problems);
    files::write_file(&folder.join(SEALING_FILE), |path| files::write_synced(path, to_json(&sealing).as_bytes()))?;
    Ok(sealing)
}

/// The state of a finished row, and whether its film percolates along x and along y.
fn solved_before(sweep: &Sweep, row: &SweepRow) -> Option<(State, [bool; 2])> {
    let kept = sweep.kept();
    let cells = kept.rows().get(&row.index)?;
    if cells.get("status")? == "not_converged" {
        return None;
    }
    let percolates = cells.get("percolates")?.as_array()?;
    let pressure = cells.get("mean_pressure")?.as_f64()?;
    let area = cells.get("area_fraction")?.as_f64()?;
    Some((State { load: row.load, pressure, area }, [percolates.first()?.as_bool()?, percolates.get(1)?.as_bool()?]))
}

/// The search on one surface.
struct Search<'a> {
    surfaces: &'a Surfaces,
    index: usize,
    heights: Option<LoadedSurface>,
    /// States in the order of their loads.
    rows: Vec<(State, [bool; 2])>,
    stop: &'a Stop,
}

impl Search<'_> {
    /// The last state with a flow along `axis` and the first without, after bisection.
    fn bracket(&mut self, axis: usize) -> Result<[Option<State>; 2], CliError> {
        loop {
            let leaks = self.rows.iter().rposition(|(_, percolates)| percolates[axis]);
            let seals = leaks.map_or(0, |last| last + 1);
            let at = |i: usize| self.rows.get(i).map(|(state, _)| *state);
            let (Some(low), Some(high)) = (leaks.and_then(at), at(seals)) else {
                return Ok([leaks.and_then(at), at(seals)]);
            };
            let is_narrow =
                high.pressure <= low.pressure * (1.0 + NARROW) || high.load <= low.load * (1.0 + LEAST_STEP);
            let between = if is_narrow || self.stop.reason().is_some() {
                None
            } else {
                self.solved((low.load * high.load).sqrt())?
            };
            let Some(state) = between else { return Ok([Some(low), Some(high)]) };
            self.rows.insert(seals, state);
        }
    }

    /// The film under one more load; `None` if its contact does not converge.
    fn solved(&mut self, load: f64) -> Result<Option<(State, [bool; 2])>, CliError> {
        let row = SweepRow { index: 0, surface: self.index, load };
        let mut contact = self.surfaces.contact_of(&row)?;
        contact.keys = ContactKeys { leakage: false, ..contact.keys };
        let budget = Budget::new(self.surfaces.run.memory_limit);
        let surface = match self.heights.take() {
            Some(surface) => surface,
            None => self.surfaces.surface(&row).load_within(budget)?,
        };
        let kernel = contact.kernel()?;
        let problem = ProblemSetup { surface: &surface, contact: &contact, kernel: &*kernel, budget };
        let SolvedParts { solution, failure, .. } = problem.solve(Instant::now(), &Silent)?.into_parts();
        if failure.is_some() {
            return Ok(None);
        }
        let gap = open_gap(&solution);
        let percolates = match contact.boundary {
            Boundary::Periodic => rc_leakage::percolates(&gap),
            Boundary::Free => {
                rc_leakage::patch_percolates(&gap).map_err(|cause| CliError::input(format_args!("leakage: {cause}")))?
            }
        };
        let pressure = contact.units.pascals(solution.info().mean_pressure);
        let area = solution.observables().area.fraction;
        drop(solution);
        self.heights = Some(surface);
        Ok(Some((State { load, pressure, area }, percolates)))
    }
}
