//! A sweep whose rows Python solves.
//!
//! It has a plan, and a journal if it has a folder.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rc_cli::sweep::{self, MapMark, PlannedRows, SweepLists, Variation, plan};
use rc_sweep::{Cells, ControlKind, FileMark, Loads, Seeds, Shard, SweepPlan};

use crate::arrays::{self, Heights};
use crate::errors::{bad_input, raised};
use crate::running::{on_threads, to_end};
use crate::scene;

/// Loads and surfaces of a sweep, and its folder.
#[derive(FromPyObject)]
pub(crate) struct Wanted<'py> {
    /// Whether loads are penetrations (m) and not pressures (Pa).
    #[pyo3(item)]
    penetrations: bool,
    #[pyo3(item)]
    loads: Vec<f64>,
    #[pyo3(item)]
    seeds: Option<Vec<u64>>,
    /// Keys that are varied.
    #[pyo3(item)]
    vary: Vec<(String, Values<'py>)>,
    /// A list of speeds, as on the command line.
    #[pyo3(item)]
    speeds: Option<String>,
    /// A list of times of creep, as on the command line.
    #[pyo3(item)]
    times: Option<String>,
    /// Heights (m), row by row.
    #[pyo3(item)]
    heights: Option<Heights<'py>>,
    /// Sides of the cell of the heights along x and y (m), if they are known.
    #[pyo3(item)]
    sides: Option<[f64; 2]>,
    /// Path of a scene file.
    #[pyo3(item)]
    scene: Option<PathBuf>,
    /// The folder of the journal, if there is one.
    #[pyo3(item)]
    folder: Option<PathBuf>,
    /// Whether an existing journal is continued.
    #[pyo3(item)]
    resume: bool,
    /// Whether each row has a result folder there.
    #[pyo3(item)]
    fields: bool,
}

/// The values of a varied key: one by one, or as text of the command line.
#[derive(FromPyObject)]
enum Values<'py> {
    Text(String),
    Each(Vec<Bound<'py, PyAny>>),
}

/// The variation of a key.
fn variation(key: &str, values: &Values<'_>) -> PyResult<Variation> {
    let found = match values {
        Values::Text(list) => format!("{key}={list}").parse(),
        Values::Each(values) => {
            let of = |value: &Bound<'_, PyAny>| scene::value_of(key, value).transpose();
            Variation::new(key.to_owned(), values.iter().filter_map(of).collect::<PyResult<_>>()?)
        }
    };
    found.map_err(|message| bad_input(format_args!("vary: {message}")))
}

/// The plan of a sweep and the rows that are finished.
#[pyclass(frozen, module = "roughcontact._core")]
pub(crate) struct Planned {
    plan: SweepPlan,
    /// For each surface of the plan, the ratio of its loads to that under which a solid creeps.
    creep: Vec<Option<f64>>,
    /// The journal until the sweep ends. While it exists, no other process may write to its folder.
    journal: Mutex<Option<rc_sweep::Sweep>>,
}

/// Checks a sweep, and starts or continues its journal.
#[pyfunction]
pub(crate) fn plan_sweep(py: Python<'_>, keys: &Bound<'_, PyDict>, wanted: Wanted<'_>) -> PyResult<Planned> {
    let Wanted { penetrations, loads, seeds, vary, speeds, times, heights, sides, .. } = wanted;
    let Wanted { scene: file, folder, resume, fields, .. } = wanted;
    let scene = scene::with_map(keys, file.as_deref(), heights.is_some())?;
    let control = if penetrations { ControlKind::Penetration } else { ControlKind::Pressure };
    let mut vary = vary.iter().map(|(key, values)| variation(key, values)).collect::<PyResult<Vec<_>>>()?;
    vary.extend(speeds.map(|list| Variation::speeds(&list)).transpose().map_err(|cause| refused("speeds", cause))?);
    let times = times.map(|list| sweep::times(&list)).transpose().map_err(|cause| refused("times", cause))?;
    let lists = SweepLists { control, loads: Loads(loads), seeds: seeds.map(Seeds), vary, times, fields };
    let map = heights.as_ref().map(|heights| mark(py, heights, folder.is_some())).transpose()?;
    let points = heights.as_ref().map(arrays::grid_of).transpose()?.map(|grid| [grid.nx(), grid.ny()]);
    let map = map.zip(points).map(|(mark, points)| MapMark { sides, points, mark });
    let name = file.as_deref().and_then(Path::file_stem).unwrap_or_default().to_string_lossy().into_owned();
    let planned = on_threads(py, 0, move || plan(&name, &scene, &lists, map))?.map_err(raised)?;
    let PlannedRows { plan, creep } = planned;
    let plan = SweepPlan { keeps_fields: fields, ..plan };
    // A signal must not leave this running, since a journal would then appear later.
    let start = |folder: PathBuf| py.detach(|| rc_sweep::Sweep::start(plan.clone(), Shard::WHOLE, &folder, resume));
    let journal = folder.map(start).transpose().map_err(|error| raised(error.into()))?;
    Ok(Planned { plan, creep, journal: Mutex::new(journal) })
}

fn refused(list: &str, cause: impl std::fmt::Display) -> PyErr {
    bad_input(format_args!("{list}: {cause}"))
}

/// The mark that identifies a map. Without a journal it is not needed, and marks no values.
fn mark(py: Python<'_>, heights: &Heights<'_>, has_journal: bool) -> PyResult<FileMark> {
    let values = if has_journal { arrays::values_of(heights)? } else { &[] };
    to_end(py, 1, || FileMark::of_values(values))
}

impl Planned {
    fn n_rows(&self) -> usize {
        self.plan.shape().rows()
    }

    /// The journal. A call that panicked leaves it whole, so a poisoned lock is ignored.
    fn journal(&self) -> MutexGuard<'_, Option<rc_sweep::Sweep>> {
        self.journal.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Planned {
    /// Seed, load, and varied keys as JSON of each row.
    fn rows(&self) -> Vec<(Option<u64>, f64, String)> {
        let row = |index| {
            let row = self.plan.row(index);
            let surface = &self.plan.surfaces[row.surface];
            let varied: Cells = surface.varied.iter().cloned().collect();
            (surface.seed, row.load, serde_json::Value::Object(varied).to_string())
        };
        (0..self.n_rows()).map(row).collect()
    }

    /// The ratio of the load of a row to that under which a solid creeps; `None` without times.
    fn creep(&self, index: usize) -> Option<f64> {
        self.creep[self.plan.row(index).surface]
    }

    /// Description of a row for messages.
    fn describe(&self, index: usize) -> String {
        self.plan.describe(&self.plan.row(index))
    }

    /// Indices of the unfinished rows, in order.
    fn todo(&self) -> Vec<usize> {
        self.journal().as_ref().map_or_else(|| (0..self.n_rows()).collect(), rc_sweep::Sweep::todo)
    }

    /// The finished rows: indices and cells as JSON.
    fn kept(&self) -> Vec<(usize, String)> {
        let journal = self.journal();
        let kept = journal.as_ref().map(rc_sweep::Sweep::kept);
        let json = |cells: &Cells| serde_json::Value::Object(cells.clone()).to_string();
        kept.map_or_else(Vec::new, |kept| kept.rows().iter().map(|(index, cells)| (*index, json(cells))).collect())
    }

    /// Stores a row from its summary as JSON. The row is on disk when this returns.
    fn keep(&self, py: Python<'_>, index: usize, summary: &str) -> PyResult<()> {
        let cells: Cells = serde_json::from_str(summary).map_err(bad_input)?;
        let row = self.plan.row(index);
        let kept = py.detach(|| self.journal().as_ref().map_or(Ok(()), |journal| journal.keep(&row, cells)));
        kept.map_err(|error| raised(error.into()))
    }

    /// Folder for the result of a row, if each row has one.
    fn fields_folder(&self, index: usize) -> Option<PathBuf> {
        self.journal().as_ref()?.fields_folder(index)
    }

    /// Ends the sweep and writes the table of its finished rows.
    ///
    /// A sweep without finished rows leaves nothing behind.
    fn end(&self, py: Python<'_>) -> PyResult<()> {
        let Some(journal) = self.journal().take() else { return Ok(()) };
        to_end(py, 1, || journal.end())?.map(drop).map_err(|error| raised(error.into()))
    }
}
