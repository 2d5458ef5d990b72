//! Solutions as Python sees them.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

use numpy::{PyArray1, PyArray2, PyArrayMethods as _};
use pyo3::prelude::*;
use rc_cli::error::CliError;
use rc_cli::kind::Kind;
use rc_cli::scene::as_read::AsRead;
use rc_cli::scene::keys::SurfaceKeys;
use rc_cli::scene::resolve::ContactSetup;
use rc_cli::scene::wave_file::WaveFile;
use rc_cli::solve::{MapHeights, ResultFiles, SolvedFlow, SolvedFluid, SolvedShear};
use rc_core::{Field, Grid};
use rc_solver::{Feature, GradientError, Held, Quantity, Solution, Status, refusal};
use rc_sweep::{MapOrigin, PathDifference, Summary, Warning};

use crate::arrays::{self, Heights};
use crate::errors::{bad_input, raised};
use crate::running::{Rest, on_threads, to_end};

/// The result of a solve without borrows.
pub(crate) struct Parts {
    pub(crate) surface: SurfaceKeys,
    /// The file of the map, if it was read from one.
    pub(crate) origin: Option<MapOrigin>,
    /// The file of waves that was solved, if the surface is from one.
    pub(crate) waves: Option<Arc<WaveFile>>,
    /// The map that was solved, if it is not the caller's array.
    pub(crate) own_map: Option<(Arc<Field>, AsRead)>,
    pub(crate) contact: ContactSetup,
    pub(crate) solution: Solution<'static>,
    /// The unloaded surface after a history of loads (λ).
    pub(crate) residual: Option<Field>,
    /// What the steps of the history change, if they were asked for.
    pub(crate) path: Option<PathDifference>,
    /// The fluid that presses on the surfaces, if there is one.
    pub(crate) fluid: Option<SolvedFluid>,
    /// Message about a solution that did not reach the tolerance.
    pub(crate) failure: Option<String>,
    /// The flow through the gap, if it was asked for and converged.
    pub(crate) flow: Option<SolvedFlow>,
    /// The shear of the contact, if it was asked for.
    pub(crate) shear: Option<SolvedShear>,
    /// The warnings that were known before the solve.
    pub(crate) warnings: Vec<Warning>,
    /// Codes and texts of all warnings of the summary. They are needed at once, and the summary takes longer.
    pub(crate) all_warnings: Vec<(&'static str, String)>,
    pub(crate) wall: Duration,
    /// Rms height (λ) and rms slope.
    pub(crate) height_and_slope: [f64; 2],
}

/// The caller's heights, for `heights.npy` of a result folder.
pub(crate) struct HeldMap {
    array: Py<PyArray2<f64>>,
    /// Fingerprint that reveals a change since the solve.
    fingerprint: u64,
}

impl HeldMap {
    pub(crate) fn new(heights: &Heights<'_>) -> PyResult<Self> {
        let fingerprint = arrays::fingerprint(heights)?;
        Ok(Self { array: (**heights).clone().unbind(), fingerprint })
    }
}

/// A solved contact problem.
#[pyclass(frozen, module = "roughcontact._core")]
pub(crate) struct Solved {
    found: Arc<Found>,
    map: Option<HeldMap>,
}

/// A solution and its summary, shared with threads that continue on their own.
struct Found {
    parts: Parts,
    threads: usize,
    summary: OnceLock<Summary>,
}

impl Parts {
    fn files<'a>(&'a self, map: Option<MapHeights<'a>>) -> ResultFiles<'a> {
        let Self { surface, waves, contact, solution, flow, shear, warnings, origin, .. } = self;
        let (waves, flow, origin) = (waves.as_deref(), flow.as_ref(), origin.as_ref());
        let (shear, residual, fluid) = (shear.as_ref(), self.residual.as_ref(), self.fluid.as_ref());
        let path = self.path;
        ResultFiles { surface, map, waves, contact, solution, residual, path, fluid, flow, shear, warnings, origin }
    }

    pub(crate) fn with_all_warnings(mut self) -> Self {
        let all = self.files(None).all_warnings();
        self.all_warnings = all.into_iter().map(|warning| (warning.code.name(), warning.text)).collect();
        self
    }
}

impl Found {
    fn files<'a>(&'a self, map: Option<MapHeights<'a>>) -> ResultFiles<'a> {
        self.parts.files(map)
    }

    fn summary(&self) -> &Summary {
        self.summary.get_or_init(|| {
            let Parts { height_and_slope, wall, .. } = self.parts;
            self.files(None).summary(height_and_slope, wall, self.threads)
        })
    }
}

impl Solved {
    pub(crate) fn new(parts: Parts, map: Option<HeldMap>, threads: usize) -> Self {
        Self { found: Arc::new(Found { parts, threads, summary: OnceLock::new() }), map }
    }

    fn e_star(&self) -> f64 {
        self.found.parts.contact.units.elasticity().e_star()
    }

    fn side(&self) -> f64 {
        self.found.parts.contact.units.cell().side()
    }

    /// Computes a value on the threads of the solve.
    fn compute<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Found) -> T + Send + 'static,
    ) -> PyResult<T> {
        let found = Arc::clone(&self.found);
        on_threads(py, found.threads, move || work(&found))
    }

    /// The array of a field, with each value multiplied by `unit`, as in the files.
    fn array<'py>(
        &self,
        py: Python<'py>,
        unit: f64,
        field: for<'a> fn(&'a Solution<'static>) -> &'a Field,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let values = self.compute(py, move |found| in_unit(field(&found.parts.solution), unit))?;
        arrays::array_of(py, self.found.parts.solution.grid(), values)
    }
}

/// The values of a field, each multiplied by `unit`.
fn in_unit(field: &Field, unit: f64) -> Vec<f64> {
    field.values().iter().map(|value| value * unit).collect()
}

#[pymethods]
impl Solved {
    /// Whether the tolerance was reached.
    #[getter]
    fn converged(&self) -> bool {
        let parts = &self.found.parts;
        let shear_has = parts.shear.as_ref().is_none_or(|shear| shear.has_converged);
        parts.solution.status() != Status::NotConverged && shear_has
    }

    /// Message about a solution that did not reach the tolerance.
    #[getter]
    fn failure(&self) -> Option<&str> {
        self.found.parts.failure.as_deref()
    }

    /// Seconds from the checked scene to the certified solution.
    #[getter]
    fn wall_seconds(&self) -> f64 {
        self.found.parts.wall.as_secs_f64()
    }

    /// Codes and texts of the warnings of the summary.
    fn warnings(&self) -> Vec<(&'static str, String)> {
        self.found.parts.all_warnings.clone()
    }

    /// The summary as JSON.
    fn summary_json(&self, py: Python<'_>) -> PyResult<String> {
        self.compute(py, |found| found.summary().to_json())
    }

    /// The solved scene, as in `scene.toml`.
    fn scene(&self) -> String {
        self.found.files(None).scene()
    }

    /// Pressure (Pa), shape (ny, nx).
    fn pressure<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, self.e_star(), Solution::pressure)
    }

    /// Gap (m), shape (ny, nx).
    fn gap<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.array(py, self.side(), Solution::gap)
    }

    /// Gap (m) on the grid of the smallest elements.
    ///
    /// The overlap that plastic flow has removed is subtracted. `None` if that is the grid of the fields.
    fn finest_gap<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let side = self.side();
        let gap: Option<(Grid, Vec<f64>)> = self.compute(py, move |found| {
            let gap = found.parts.solution.finest_gap()?;
            Some((gap.grid(), in_unit(&gap, side)))
        })?;
        gap.map(|(grid, values)| arrays::array_of(py, grid, values)).transpose()
    }

    /// Overlap (m) that plastic flow has removed, shape (ny, nx); `None` without a hardness.
    fn plastic_gap<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        if self.found.parts.contact.hardness.is_infinite() {
            return Ok(None);
        }
        self.array(py, self.side(), Solution::plastic_gap).map(Some)
    }

    /// Heights (m) of the unloaded surface after a history of loads, shape (ny, nx); `None` without one.
    fn residual<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let side = self.side();
        let values = self.compute(py, move |found| Some(in_unit(found.parts.residual.as_ref()?, side)))?;
        values.map(|values| arrays::array_of(py, self.found.parts.solution.grid(), values)).transpose()
    }

    /// Pressure of the fluid (Pa), shape (ny, nx); `None` without one.
    fn fluid_pressure<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let values = self.compute(py, |found| Some(found.parts.fluid.as_ref()?.pressure.values().to_vec()))?;
        values.map(|values| arrays::array_of(py, self.found.parts.solution.grid(), values)).transpose()
    }

    /// Tractions along x and y (Pa) and the length of the slip (m), shape (ny, nx); `None` without a shear.
    fn shear<'py>(&self, py: Python<'py>) -> PyResult<Option<[Bound<'py, PyArray2<f64>>; 3]>> {
        let (grid, units) = (self.found.parts.solution.grid(), [self.e_star(), self.e_star(), self.side()]);
        let fields: Option<[Vec<f64>; 3]> = self.compute(py, move |found| {
            let shear = &found.parts.shear.as_ref()?.solution;
            let [x, y] = &shear.traction;
            Some([(x, units[0]), (y, units[1]), (&shear.slip, units[2])].map(|(field, unit)| in_unit(field, unit)))
        })?;
        let Some([x, y, slip]) = fields else { return Ok(None) };
        Ok(Some([arrays::array_of(py, grid, x)?, arrays::array_of(py, grid, y)?, arrays::array_of(py, grid, slip)?]))
    }

    /// Displacement (m) of mean zero, shape (ny, nx).
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        if self.found.parts.fluid.is_some() {
            return Err(bad_input("displacement: under a fluid, it is heights + gap + a constant; add these"));
        }
        self.array(py, self.side(), Solution::displacement)
    }

    /// Derivatives of a number of the summary with respect to the heights, in its SI unit per m, shape (ny, nx).
    ///
    /// `held` is what stays the same, by default what the solve was given.
    fn gradient<'py>(&self, py: Python<'py>, name: &str, held: Option<&str>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let units = self.found.parts.contact.units;
        let (quantity, unit) = match name {
            "elastic_energy" => (Quantity::ElasticEnergy, units.joules(1.0)),
            "mean_pressure" => (Quantity::MeanPressure, units.pascals(1.0)),
            "penetration" => (Quantity::Penetration, units.metres(1.0)),
            "mean_gap" => (Quantity::MeanGap, units.metres(1.0)),
            other => return Err(no_gradient(other)),
        };
        let held = held_of(held)?;
        self.gradient_by(py, unit / self.side(), move |solution| solution.gradient(quantity, held))
    }

    /// Derivatives of a function of the pressures (Pa) with respect to the heights (m), from those to the pressures.
    fn gradient_of<'py>(
        &self,
        py: Python<'py>,
        derivatives: Heights<'py>,
        held: Option<&str>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (values, held) = (arrays::values_of(&derivatives)?.to_vec(), held_of(held)?);
        let unit = self.e_star() / self.side();
        self.gradient_by(py, unit, move |solution| solution.gradient_of(&values, held))
    }

    /// Fluxes along x and y (m²), shape (ny, nx).
    ///
    /// `None` if there is no flow, or the flow was not asked for.
    fn flux<'py>(&self, py: Python<'py>) -> PyResult<Option<[Bound<'py, PyArray2<f64>>; 2]>> {
        let (grid, area) = (self.found.parts.solution.grid(), self.side() * self.side());
        let flux: Option<[Vec<f64>; 2]> = self.compute(py, move |found| {
            let flux = found.parts.flow.as_ref()?.leakage.flux.as_ref()?;
            Some([&flux.x, &flux.y].map(|field| in_unit(field, area)))
        })?;
        let Some([x, y]) = flux else { return Ok(None) };
        Ok(Some([arrays::array_of(py, grid, x)?, arrays::array_of(py, grid, y)?]))
    }

    /// Columns of the elements of a mesh: x, y, size (m), pressure (Pa).
    ///
    /// `None` if the elements are those of the grid.
    fn elements<'py>(&self, py: Python<'py>) -> Option<[Bound<'py, PyArray1<f64>>; 4]> {
        let units = self.found.parts.contact.units;
        let mut columns: [Vec<f64>; 4] = Default::default();
        for element in self.found.parts.solution.elements()? {
            columns[0].push(units.metres(element.centre.x));
            columns[1].push(units.metres(element.centre.y));
            columns[2].push(units.metres(element.side));
            columns[3].push(units.pascals(element.pressure));
        }
        Some(columns.map(|column| PyArray1::from_vec(py, column)))
    }

    /// Writes the result folder of `rc solve --out`.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let own = self.found.parts.own_map.as_ref();
        let callers = self.map.as_ref().filter(|_| own.is_none());
        let heights = callers.map(|map| map.array.bind(py).try_readonly()).transpose();
        let heights = heights.map_err(|cause| bad_input(format_args!("heights: {cause}")))?;
        let callers = heights.as_ref().map(|heights| self.map_heights(heights)).transpose()?;
        let map = own.map(|(heights, as_read)| MapHeights::InCell { heights, as_read }).or(callers);
        let written = to_end(py, self.found.threads, || {
            Kind::Result.check_out(&folder)?;
            self.found.files(map).write(&folder, self.found.summary())
        })?;
        written.map_err(raised)
    }
}

impl Solved {
    /// A gradient, in multiples of `unit`.
    fn gradient_by<'py>(
        &self,
        py: Python<'py>,
        unit: f64,
        gradient: impl FnOnce(&Solution<'static>) -> Result<Field, GradientError> + Send + 'static,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let Parts { shear, fluid, .. } = &self.found.parts;
        for (feature, is_there) in [(Feature::Shear, shear.is_some()), (Feature::FluidPressure, fluid.is_some())] {
            if let Some(refused) = refusal(&[Feature::Gradient, feature], None).filter(|_| is_there) {
                return Err(bad_input(refused));
            }
        }
        let field = self.compute(py, move |found| Ok(in_unit(&gradient(&found.parts.solution)?, unit)))?;
        let values = field.map_err(|error: GradientError| bad_input(format_args!("gradient: {error}")))?;
        arrays::array_of(py, self.found.parts.solution.grid(), values)
    }

    /// The caller's heights, if they have not changed since the solve.
    fn map_heights<'a>(&self, heights: &'a Heights<'_>) -> PyResult<MapHeights<'a>> {
        let values = arrays::values_of(heights)?;
        if self.map.as_ref().map(|map| map.fingerprint) != Some(arrays::fingerprint(heights)?) {
            return Err(bad_input(
                "heights: the array was changed after the solve, so it cannot be written; solve a copy",
            ));
        }
        Ok(MapHeights::InMetres { grid: arrays::grid_of(heights)?, values })
    }
}

/// The meaning of the argument `fixed`.
fn held_of(word: Option<&str>) -> PyResult<Option<Held>> {
    match word {
        None => Ok(None),
        Some("pressure") => Ok(Some(Held::MeanPressure)),
        Some("penetration") => Ok(Some(Held::Penetration)),
        Some(other) => Err(bad_input(format_args!("fixed: must be \"pressure\" or \"penetration\", not \"{other}\""))),
    }
}

/// The error for the gradient of anything else.
fn no_gradient(name: &str) -> PyErr {
    const NAMES: &str = "elastic_energy, mean_pressure, penetration or mean_gap";
    if name.starts_with("area_fraction") {
        let why = "the elements in contact are held fixed, so the area does not change";
        return bad_input(format_args!("gradient: {name} has none, because {why}; choose {NAMES}"));
    }
    bad_input(format_args!("gradient: must be that of {NAMES}, not of {name}"))
}

/// A solve that continues on its own after a signal.
#[pyclass(frozen, module = "roughcontact._core")]
pub(crate) struct Unfinished {
    rest: Mutex<Rest<Result<Parts, CliError>>>,
    map: Mutex<Option<HeldMap>>,
    threads: usize,
}

impl Unfinished {
    pub(crate) fn new(rest: Rest<Result<Parts, CliError>>, map: Option<HeldMap>, threads: usize) -> Self {
        Self { rest: Mutex::new(rest), map: Mutex::new(map), threads }
    }
}

#[pymethods]
impl Unfinished {
    /// Waits for the solution. It can be taken only once.
    fn wait(&self, py: Python<'_>) -> PyResult<Solved> {
        let mut rest =
            self.rest.try_lock().map_err(|_| bad_input("another call is already waiting for the solution"))?;
        let parts = rest.wait(py)?.map_err(raised)?;
        let map = self.map.lock().unwrap_or_else(PoisonError::into_inner).take();
        Ok(Solved::new(parts, map, self.threads))
    }
}
