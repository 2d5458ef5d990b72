//! The pressure above which a sweep with flows does not leak.

use std::path::Path;
use std::time::Instant;

use rc_core::quantity::engineering;
use rc_core::{Boundary, Silent};
use rc_sweep::memory::Budget;
use rc_sweep::{Sweep, SweepRow, files, to_json};
use serde::Serialize;

use super::surfaces::Surfaces;
use crate::curves::means::Mean;
use crate::error::CliError;
use crate::run::stop::Stop;
use crate::scene::keys::ContactKeys;
use crate::scene::loaded::LoadedSurface;
use crate::solve::leakage::open_gap;
use crate::solve::solved::{ProblemSetup, SolvedParts};
use crate::study::record::words_with_error;

/// File of the sealing pressures in the folder of a sweep.
pub(crate) const SEALING_FILE: &str = "sealing.json";

/// Ratio of the ends of a bracket, minus 1, at which bisection ends.
const NARROW: f64 = 0.01;

/// Least relative step of a load.
const LEAST_STEP: f64 = 1e-6;

/// Minimum number of surfaces of a standard error.
const FEWEST: usize = 3;

/// Names of the axes of flows.
const AXES: [&str; 2] = ["x", "y"];

/// The sealing pressures of a sweep.
#[derive(Debug, Serialize)]
pub(super) struct Sealing {
    /// The sealing pressure (Pa) of the only problem; `None` if there are several, or its film does not close between the
    /// loads.
    #[serde(rename = "sealing_pressure")]
    pressure: Option<f64>,
    /// Highest mean pressure (Pa) with a flow and lowest without, of the only problem.
    bracket: Option<[f64; 2]>,
    /// Each scene, and each variation of its keys.
    problems: Vec<Problem>,
}

/// The seal of one scene, of which surfaces are realisations.
#[derive(Debug, Serialize)]
struct Problem {
    #[serde(skip_serializing_if = "String::is_empty")]
    scene: String,
    /// Mean over surfaces and axes (Pa); `None` unless the film of each closes between the loads.
    #[serde(rename = "sealing_pressure")]
    pressure: Option<f64>,
    /// Standard error (Pa) of the mean over at least three surfaces, each of which counts with the mean of its axes.
    standard_error: Option<f64>,
    /// Lowest pressure (Pa) with a flow, and highest without, in the brackets of all surfaces and axes.
    bracket: Option<[f64; 2]>,
    surfaces: Vec<SurfaceSeal>,
}

/// The sealing pressure of one surface along one axis.
#[derive(Debug, Serialize)]
struct SurfaceSeal {
    seed: Option<u64>,
    axis: &'static str,
    /// Middle of the bracket (Pa).
    #[serde(rename = "sealing_pressure")]
    pressure: Option<f64>,
    /// Highest mean pressure (Pa) at which the film leaks, and lowest at which it does not; null where no load shows it.
    bracket: [Option<f64>; 2],
}

/// A load and its mean pressure (Pa).
#[derive(Clone, Copy)]
struct State {
    load: f64,
    pressure: f64,
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
            let bracket = search.bracket(axis)?;
            let pressure = bracket[0].zip(bracket[1]).map(|(leaks, seals)| 0.5 * (leaks + seals));
            let seal = SurfaceSeal { seed: surface.seed(), axis: name, pressure, bracket };
            if let Some(problem) = problems.last_mut() {
                problem.surfaces.push(seal);
            }
        }
    }
    problems.iter_mut().for_each(Problem::average);
    let only = if let [only] = &problems[..] { Some(only) } else { None };
    let sealing = Sealing {
        pressure: only.and_then(|only| only.pressure),
        bracket: only.and_then(|only| only.bracket),
        problems,
    };
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
    Some((State { load: row.load, pressure }, [percolates.first()?.as_bool()?, percolates.get(1)?.as_bool()?]))
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
    /// The last pressure with a flow along `axis` and the first without, after bisection.
    fn bracket(&mut self, axis: usize) -> Result<[Option<f64>; 2], CliError> {
        loop {
            let leaks = self.rows.iter().rposition(|(_, percolates)| percolates[axis]);
            let seals = leaks.map_or(0, |last| last + 1);
            let at = |i: usize| self.rows.get(i).map(|(state, _)| *state);
            let (Some(low), Some(high)) = (leaks.and_then(at), at(seals)) else {
                return Ok([leaks.and_then(at), at(seals)].map(|state| state.map(|state| state.pressure)));
            };
            let is_narrow =
                high.pressure <= low.pressure * (1.0 + NARROW) || high.load <= low.load * (1.0 + LEAST_STEP);
            let between = if is_narrow || self.stop.reason().is_some() {
                None
            } else {
                self.solved((low.load * high.load).sqrt())?
            };
            let Some(state) = between else { return Ok([Some(low.pressure), Some(high.pressure)]) };
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
        drop(solution);
        self.heights = Some(surface);
        Ok(Some((State { load, pressure }, percolates)))
    }
}

impl Problem {
    fn new(scene: String) -> Self {
        Self { scene, pressure: None, standard_error: None, bracket: None, surfaces: Vec::new() }
    }

    /// Fills in the means, once all surfaces are there.
    fn average(&mut self) {
        let brackets = self.surfaces.iter().map(|seal| seal.bracket[0].zip(seal.bracket[1]));
        let both = brackets.flatten().reduce(|all, one| (all.0.min(one.0), all.1.max(one.1)));
        self.bracket = both.map(|(low, high)| [low, high]);
        // Without those beyond the loads the mean would be too small.
        let of_surface = |pair: &[SurfaceSeal]| {
            let axes: Option<Vec<f64>> = pair.iter().map(|seal| seal.pressure).collect();
            axes.map(|axes| [axes.iter().sum::<f64>() / axes.len() as f64, 0.0])
        };
        let found = self.surfaces.chunks(AXES.len()).map(of_surface).collect::<Option<Vec<[f64; 2]>>>();
        let Some((mean, n)) = found.and_then(|found| Some((Mean::of(&found)?, found.len()))) else { return };
        self.pressure = Some(mean.value);
        self.standard_error = mean.standard_error.filter(|_| n >= FEWEST);
    }

    /// The sealing pressure as text.
    fn line(&self) -> String {
        let pressure = |value: f64| engineering(value, "Pa");
        let name = if self.scene.is_empty() { String::new() } else { format!(" ({})", self.scene) };
        let of_axis = |seal: &SurfaceSeal| match (seal.pressure, seal.bracket) {
            (Some(found), _) => format!("{} along {}", pressure(found), seal.axis),
            (None, [Some(leaks), _]) => format!("above {} along {}", pressure(leaks), seal.axis),
            (None, [None, Some(seals)]) => format!("below {} along {}", pressure(seals), seal.axis),
            (None, [None, None]) => format!("unknown along {}", seal.axis),
        };
        if self.surfaces.len() == AXES.len() {
            let axes = self.surfaces.iter().map(of_axis).collect::<Vec<_>>().join(", ");
            return format!("sealing pressure{name}: {axes}\n");
        }
        let n = self.surfaces.len() / AXES.len();
        let of_mean =
            |mean| self.standard_error.map_or_else(|| pressure(mean), |error| words_with_error(mean, error, "Pa"));
        match (self.pressure, self.bracket) {
            (Some(mean), Some([low, high])) => {
                let range = format!("from {} to {}", pressure(low), pressure(high));
                format!("sealing pressure{name}: {}, mean of {n} surfaces, {range}\n", of_mean(mean))
            }
            _ => format!(
                "sealing pressure{name}: some of {n} surfaces are open or closed at all loads, see {SEALING_FILE}\n"
            ),
        }
    }
}

impl Sealing {
    /// A line for each problem.
    pub(super) fn lines(&self) -> String {
        self.problems.iter().map(Problem::line).collect()
    }
}
