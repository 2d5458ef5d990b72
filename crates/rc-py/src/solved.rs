//! A solution as Python sees it.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use numpy::{PyArray1, PyArray2, PyArrayMethods as _};
use pyo3::prelude::*;
use rc_cli::scene::keys::SurfaceKeys;
use rc_cli::scene::resolve::ContactSetup;
use rc_cli::scene::wave_file::WaveFile;
use rc_cli::solve::{MapHeights, ResultFiles, SolvedFlow};
use rc_core::Field;
use rc_solver::{Solution, Status};
use rc_sweep::Summary;

use crate::arrays::{self, Heights};
use crate::errors::{bad_input, raised};
use crate::running::{self, Run};

/// What a solve leaves, without borrows.
pub(crate) struct Parts {
    pub(crate) surface: SurfaceKeys,
    /// The file of waves that was solved, if one was.
    pub(crate) waves: Option<Arc<WaveFile>>,
    pub(crate) contact: ContactSetup,
    pub(crate) solution: Solution<'static>,
    /// What is said of a solution that did not reach the tolerance.
    pub(crate) failure: Option<String>,
    /// The flow through the gap, where it was asked for and converged.
    pub(crate) flow: Option<SolvedFlow>,
    pub(crate) wall: Duration,
    /// Rms height (λ) and rms slope.
    pub(crate) height_and_slope: [f64; 2],
}

/// The caller's heights, for `heights.npy` of a result folder.
pub(crate) struct HeldMap {
    array: Py<PyArray2<f64>>,
    /// By which a change since the solve is noticed.
    fingerprint: u64,
}

impl HeldMap {
    pub(crate) fn new(heights: &Heights<'_>) -> PyResult<Self> {
        let fingerprint = arrays::fingerprint(arrays::values_of(heights)?);
        Ok(Self { array: (**heights).clone().unbind(), fingerprint })
    }
}

/// A solved contact problem.
#[pyclass(frozen, module = "roughcontact._core")]
pub(crate) struct Solved {
    parts: Parts,
    map: Option<HeldMap>,
    threads: usize,
    summary: OnceLock<Summary>,
}

impl Solved {
    pub(crate) fn new(parts: Parts, map: Option<HeldMap>, threads: usize) -> Self {
        Self { parts, map, threads, summary: OnceLock::new() }
    }

    fn e_star(&self) -> f64 {
        self.parts.contact.units.elasticity().e_star()
    }

    fn side(&self) -> f64 {
        self.parts.contact.units.cell().side()
    }

    fn files<'a>(&'a self, map: Option<MapHeights<'a>>) -> ResultFiles<'a> {
        let Parts { surface, waves, contact, solution, flow, .. } = &self.parts;
        ResultFiles { surface, map, waves: waves.as_deref(), contact, solution, flow: flow.as_ref() }
    }

    fn summary_of(&self) -> &Summary {
        self.summary.get_or_init(|| {
            let Parts { height_and_slope, wall, .. } = self.parts;
            self.files(None).summary(height_and_slope, wall, self.threads)
        })
    }

    /// Computes something on the threads of the solve.
    fn compute<T: Send>(&self, py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
        let run = Run { threads: self.threads, end: None, progress: None };
        let (value, _, ended) = running::run(py, run, move |_| work())?;
        ended.map_or(Ok(value), Err)
    }

    /// A field as an array, each value multiplied by `unit`, as it is written into files.
    fn array<'py>(
        &self,
        py: Python<'py>,
        unit: f64,
        field: for<'a> fn(&'a Solution<'static>) -> &'a Field,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let solution = &self.parts.solution;
        let values =
            self.compute(py, || field(solution).values().iter().map(|value| value * unit).collect::<Vec<f64>>())?;
        arrays::array_of(py, solution.grid(), values)
    }
}

#[pymethods]
impl Solved {
    /// Whether the tolerance was reached.
    #[getter]
    fn converged(&self) -> bool {
        self.parts.solution.status() != Status::NotConverged
    }

    /// What is said of a solution that did not reach the tolerance.
    #[getter]
    fn failure(&self) -> Option<&str> {
        self.parts.failure.as_deref()
    }

    /// Seconds from the checked scene to the certified solution.
    #[getter]
    fn wall_seconds(&self) -> f64 {
        self.parts.wall.as_secs_f64()
    }

    /// The summary as JSON.
    fn summary_json(&self, py: Python<'_>) -> PyResult<String> {
        self.compute(py, || self.summary_of().to_json())
    }

    /// The scene as it was solved, as in `scene.toml`.
    fn scene(&self) -> String {
        self.files(None).scene()
    }

    /// Pressure (Pa), shape (ny, nx).
    fn pressure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, self.e_star(), Solution::pressure)
    }

    /// Gap (m), shape (ny, nx).
    fn gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, self.side(), Solution::gap)
    }

    /// Displacement (m) of mean zero, shape (ny, nx).
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, self.side(), Solution::displacement)
    }

    /// Fluxes along x and y (m²), shape (ny, nx); `None` where nothing flows, or no flow was asked for.
    fn flux<'py>(&self, py: Python<'py>) -> PyResult<Option<[Bound<'py, PyArray2<f64>>; 2]>> {
        let Some(flux) = self.parts.flow.as_ref().and_then(|flow| flow.leakage.flux.as_ref()) else { return Ok(None) };
        let (grid, area) = (self.parts.solution.grid(), self.side() * self.side());
        let in_metres = |field: &Field| field.values().iter().map(|value| value * area).collect::<Vec<f64>>();
        let [x, y] = self.compute(py, || [&flux.x, &flux.y].map(in_metres))?;
        Ok(Some([arrays::array_of(py, grid, x)?, arrays::array_of(py, grid, y)?]))
    }

    /// Columns of the elements that are not those of the grid: x, y, size (m), pressure (Pa).
    fn elements<'py>(&self, py: Python<'py>) -> Option<[Bound<'py, PyArray1<f64>>; 4]> {
        let units = self.parts.contact.units;
        let mut columns: [Vec<f64>; 4] = Default::default();
        for element in self.parts.solution.elements()? {
            columns[0].push(units.metres(element.centre.x));
            columns[1].push(units.metres(element.centre.y));
            columns[2].push(units.metres(element.side));
            columns[3].push(units.pascals(element.pressure));
        }
        Some(columns.map(|column| PyArray1::from_vec(py, column)))
    }

    /// Writes the result folder of `rc solve --out`.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let heights = self.map.as_ref().map(|map| map.array.bind(py).try_readonly()).transpose();
        let heights = heights.map_err(|cause| bad_input(format_args!("heights: {cause}")))?;
        let map = heights.as_ref().map(|heights| self.map_heights(heights)).transpose()?;
        let written = self.compute(py, || {
            rc_sweep::files::check_folder(&folder)?;
            self.files(map).write(&folder, self.summary_of())
        })?;
        written.map_err(raised)
    }
}

impl Solved {
    /// The caller's heights, if they are still those that were solved.
    fn map_heights<'a>(&self, heights: &'a Heights<'_>) -> PyResult<MapHeights<'a>> {
        let values = arrays::values_of(heights)?;
        if self.map.as_ref().is_some_and(|map| map.fingerprint != arrays::fingerprint(values)) {
            return Err(bad_input(
                "heights: the array was changed after the solve, so it cannot be written; solve a copy",
            ));
        }
        Ok(MapHeights::InMetres { grid: arrays::grid_of(heights)?, values })
    }
}
