//! The pressure above which a sweep with flows does not leak.

use std::path::Path;
use std::time::Instant;

use rc_core::quantity::{digits, engineering};
use rc_core::{Boundary, Silent};
use rc_sweep::memory::Budget;
use rc_sweep::{Sweep, SweepRow, files, to_json};
use serde::Serialize;

use super::surfaces::Surfaces;
use crate::error::CliError;
use crate::scene::keys::ContactKeys;
use crate::scene::loaded::LoadedSurface;
use crate::solve::leakage::open_gap;
use crate::solve::solved::ProblemSetup;

/// File of the sealing pressures in the folder of a sweep.
pub(crate) const SEALING_FILE: &str = "sealing.json";

/// Ratio of the ends of a bracket, minus 1, at which bisection ends.
const NARROW: f64 = 0.01;

/// Names of the axes of flows.
const AXES: [&str; 2] = ["x", "y"];

/// The sealing pressures of all surfaces and axes.
#[derive(Debug, Serialize)]
pub(super) struct Sealing {
    /// Mean of the sealing pressures (Pa) over surfaces and axes; `None` if no film closes between two loads.
    sealing_pressure: Option<f64>,
    /// Standard error of the mean (Pa), from at least two.
    standard_error: Option<f64>,
    /// Lowest pressure (Pa) with a flow, and highest without, in all brackets.
    bracket: Option<[f64; 2]>,
    /// Each surface and axis.
    surfaces: Vec<SurfaceSeal>,
}

/// The sealing pressure of one surface along one axis.
#[derive(Debug, Serialize)]
struct SurfaceSeal {
    #[serde(skip_serializing_if = "String::is_empty")]
    scene: String,
    seed: Option<u64>,
    axis: &'static str,
    /// Middle of the bracket (Pa).
    sealing_pressure: Option<f64>,
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
/// is narrower than 1 %. Their flows are not solved, because only the connection of the film counts.
///
/// # Errors
/// [`CliError`].
pub(super) fn find(surfaces: &Surfaces, sweep: &Sweep, folder: &Path) -> Result<Sealing, CliError> {
    let loads = sweep.plan().shape().loads;
    let mut found = Vec::new();
    for (i, surface) in surfaces.all().iter().enumerate().filter(|(_, surface)| surface.leaks()) {
        let rows = (0..loads).map(|load| sweep.plan().row(i * loads + load));
        let mut rows: Vec<(State, [bool; 2])> = rows.filter_map(|row| solved_before(sweep, &row)).collect();
        rows.sort_by(|a, b| a.0.load.total_cmp(&b.0.load));
        let mut search = Search { surfaces, index: i, heights: None, rows };
        for axis in 0..2 {
            let bracket = search.bracket(axis)?;
            let sealing_pressure = bracket[0].zip(bracket[1]).map(|(leaks, seals)| 0.5 * (leaks + seals));
            let scene = surface.name();
            found.push(SurfaceSeal { scene, seed: surface.seed(), axis: AXES[axis], sealing_pressure, bracket });
        }
    }
    let sealing = Sealing::of(found);
    files::write_file(&folder.join(SEALING_FILE), |path| files::write_synced(path, to_json(&sealing).as_bytes()))?;
    Ok(sealing)
}

/// The state of a finished row, and whether its film percolates along x and along y.
fn solved_before(sweep: &Sweep, row: &SweepRow) -> Option<(State, [bool; 2])> {
    let kept = sweep.kept();
    let cells = kept.rows().get(&row.index)?;
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
            if high.load <= low.load * (1.0 + NARROW) {
                return Ok([Some(low.pressure), Some(high.pressure)]);
            }
            let state = self.solved((low.load * high.load).sqrt())?;
            self.rows.insert(seals, state);
        }
    }

    /// The film under one more load.
    fn solved(&mut self, load: f64) -> Result<(State, [bool; 2]), CliError> {
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
        let solution = problem.solve(Instant::now(), &Silent)?.into_parts().solution;
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
        Ok((State { load, pressure }, percolates))
    }
}

impl Sealing {
    fn of(surfaces: Vec<SurfaceSeal>) -> Self {
        let found: Vec<f64> = surfaces.iter().filter_map(|seal| seal.sealing_pressure).collect();
        let n = found.len() as f64;
        let mean = found.iter().sum::<f64>() / n;
        let variance = found.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let both = surfaces.iter().filter_map(|seal| seal.bracket[0].zip(seal.bracket[1]));
        let bracket = both.reduce(|all, one| (all.0.min(one.0), all.1.max(one.1))).map(|(low, high)| [low, high]);
        Self {
            sealing_pressure: (n > 0.0).then_some(mean),
            standard_error: (n > 1.0).then(|| (variance / n).sqrt()),
            bracket,
            surfaces,
        }
    }

    /// The sealing pressure as a line of text.
    pub(super) fn line(&self) -> String {
        let (Some(mean), Some([low, high])) = (self.sealing_pressure, self.bracket) else {
            return "sealing pressure: not between the loads; see sealing.json".to_owned();
        };
        let pressure = |value: f64| engineering(value, "Pa");
        let n = self.surfaces.iter().filter(|seal| seal.sealing_pressure.is_some()).count();
        let open = self.surfaces.len() - n;
        let others = if open > 0 { format!("; {open} others are not between the loads") } else { String::new() };
        match self.standard_error {
            Some(error) => format!(
                "sealing pressure: {} ± {} %, mean of {n} surfaces and axes, from {} to {}{others}",
                pressure(mean),
                digits(100.0 * error / mean, 2),
                pressure(low),
                pressure(high)
            ),
            None => format!(
                "sealing pressure: {}, between {} and {}{others}",
                pressure(mean),
                pressure(low),
                pressure(high)
            ),
        }
    }
}
