//! The summary of a result: what `summary.json` and `--json` hold, in SI.

use std::time::Duration;

use rc_core::Units;
use rc_solver::{ErrorBound, Solution};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::content::Cells;
use crate::leakage::LeakageSummary;
use crate::memory;
use crate::plan::ControlKind;

/// One solved contact problem. Pressures in Pa, lengths in m; fractions are of the nominal area.
///
/// Keys that the first summaries did not have are `None` when such a summary is read; new ones always have them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// `converged`, `full_contact` or `not_converged`.
    pub status: String,
    /// What was prescribed: `pressure` or `penetration`.
    pub control: String,
    /// `love` or `spectral`.
    pub kernel: String,
    /// The method that ran: `adaptive`, `uniform` or `gauss-seidel`.
    pub method: String,
    /// Why it was this one.
    pub method_reason: Option<String>,
    /// Elements per side of the grid, along x and y.
    pub grid: [usize; 2],
    /// How often elements at the edges of contacts are halved beyond the grid.
    pub border_level: Option<usize>,
    /// Elements in contact on an adaptive mesh; all of the grid for the uniform method.
    pub elements: usize,
    /// Nested levels; 0 when full contact needed no iteration.
    pub levels: usize,
    /// Mean pressure σ0 (Pa).
    pub mean_pressure: f64,
    /// Penetration Δ (m).
    pub penetration: f64,
    /// Penetration of full contact, max(h) - mean(h) (m).
    pub penetration_full_contact: f64,
    /// Contact area A/A0, best estimate: edges of contacts are located between the centres of elements.
    pub area_fraction: f64,
    /// Contact area A/A0 by counting elements with p > 0.
    pub area_fraction_cells: f64,
    /// Estimated error of `area_fraction`.
    pub area_fraction_error: f64,
    /// Greatest pressure that the contact bears (Pa); this key and the next three are there only with a hardness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardness: Option<f64>,
    /// Plastic area, where the pressure is the hardness, of the nominal area, best estimate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plastic_area_fraction: Option<f64>,
    /// Estimated error of `plastic_area_fraction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plastic_area_fraction_error: Option<f64>,
    /// Mean over the cell of the overlap that plastic flow has removed (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_plastic_gap: Option<f64>,
    /// Length of the edges of all contacts (m).
    pub contact_perimeter: Option<f64>,
    /// Root mean square of the pressure over the cell (Pa), of the elements.
    pub rms_pressure: f64,
    /// The same with what the elements at edges of contacts miss (Pa): the best estimate.
    pub rms_pressure_corrected: Option<f64>,
    /// Estimated discretisation error of `rms_pressure_corrected` (Pa); null when no coarser grid was solved.
    pub rms_pressure_error: Option<f64>,
    /// Greatest pressure (Pa).
    pub max_pressure: f64,
    /// Mean gap (m).
    pub mean_gap: f64,
    /// Estimated discretisation error of `mean_gap` and of `penetration` (m).
    pub mean_gap_error: Option<f64>,
    /// dσ0/dΔ (Pa/m); null where it is infinite, in full contact.
    pub contact_stiffness: Option<f64>,
    /// Electrical and thermal contact conductance of the nominal area for a conductivity of 1 (1/m): dσ0/dΔ / E*, to be
    /// multiplied with the harmonic mean 2 k1 k2/(k1 + k2) of the conductivities of the bodies (Barber, Proc. R. Soc. A
    /// 459, 2003); null in full contact, where it is infinite, and on a layer, whose stiffness does not say it.
    pub contact_conductance: Option<f64>,
    /// Elastic energy of the cell (J).
    pub elastic_energy: f64,
    /// Rms height about the mean (m).
    pub rms_height: f64,
    /// Rms slope √⟨|∇h|²⟩.
    pub rms_slope: f64,
    /// Greatest height on the grid (m).
    pub h_max: f64,
    /// Σ p (g - min g) / (H Σ p), with H = max(h) - min(h) and g of pressure-weighted mean 0.
    pub complementarity_error: f64,
    /// max(-g) / H.
    pub penetration_error: f64,
    /// √(G/U), a bound on the relative error of the pressure in the energy norm, with G = mean p (g - min g) and U =
    /// mean p v / 2.
    pub energy_error: Option<f64>,
    /// |mean p - σ0| / σ0, or the deviation of Δ over H under penetration control.
    pub load_error: f64,
    /// What `complementarity_error` and `penetration_error` were to reach; null where `energy_error` was.
    pub tolerance: Option<f64>,
    /// What `energy_error` was to reach.
    pub energy_tolerance: Option<f64>,
    /// Elements of the grid whose gap was computed for the certificate.
    pub cells_evaluated: Option<usize>,
    /// Elements that were proven to be out of contact without computing their gap: all others.
    pub cells_proven: Option<usize>,
    /// Iterations on each level, coarsest first.
    pub level_iterations: Option<Vec<usize>>,
    /// Iterations on the finest level.
    pub iterations: usize,
    /// Applications of L on the finest level, the certificate's included.
    pub operator_applications: usize,
    /// Flow through the gap, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leakage: Option<LeakageSummary>,
    /// Seconds from the parsed scene to the certified solution, evaluation of heights included.
    pub wall_seconds: f64,
    /// Peak resident memory of the process; null where the system does not say.
    pub peak_memory_bytes: Option<u64>,
    /// Worker threads.
    pub threads: usize,
    /// Version of rc.
    pub version: String,
}

/// What a summary says besides the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveContext {
    /// What was prescribed.
    pub control: ControlKind,
    /// How often elements at the edges of contacts were halved beyond the grid.
    pub border_level: usize,
    /// Rms height of the surface about its mean, in λ.
    pub rms_height: f64,
    /// Rms slope of the surface.
    pub rms_slope: f64,
    /// Time from the parsed scene to the certified solution.
    pub wall: Duration,
    /// Worker threads.
    pub threads: usize,
}

impl Summary {
    /// The summary of `solution` in SI. Its memory is that of the process so far.
    #[must_use]
    pub fn of(solution: &Solution<'_>, units: Units, context: &SolveContext) -> Self {
        let (info, observables, grid) = (solution.info(), solution.observables(), solution.grid());
        let stiffness = units.pascals_per_metre(solution.stiffness());
        let (tolerance, energy_tolerance) = match solution.bound() {
            ErrorBound::Relative(value) => (Some(value), None),
            ErrorBound::Energy(value) => (None, Some(value)),
        };
        Self {
            status: solution.status().name().to_owned(),
            control: context.control.key().to_owned(),
            kernel: solution.kernel().to_owned(),
            method: solution.method().name().to_owned(),
            method_reason: Some(solution.reason().to_string()),
            grid: [grid.nx(), grid.ny()],
            border_level: Some(context.border_level),
            elements: solution.n_elements(),
            levels: info.levels.len(),
            mean_pressure: units.pascals(info.mean_pressure),
            penetration: units.metres(info.penetration),
            penetration_full_contact: units.metres(info.penetration_full_contact),
            area_fraction: observables.area.fraction,
            area_fraction_cells: observables.area.cells,
            area_fraction_error: observables.area.error,
            hardness: Some(solution.hardness()).filter(|hardness| hardness.is_finite()).map(|h| units.pascals(h)),
            plastic_area_fraction: observables.plastic.map(|plastic| plastic.fraction),
            plastic_area_fraction_error: observables.plastic.map(|plastic| plastic.error),
            mean_plastic_gap: observables.plastic.map(|plastic| units.metres(plastic.mean_gap)),
            contact_perimeter: Some(units.metres(observables.area.perimeter)),
            rms_pressure: units.pascals(observables.rms_pressure),
            rms_pressure_corrected: Some(units.pascals(observables.rms_pressure_corrected)),
            rms_pressure_error: observables.rms_pressure_error.map(|error| units.pascals(error)),
            max_pressure: units.pascals(observables.max_pressure),
            mean_gap: units.metres(observables.mean_gap),
            mean_gap_error: Some(units.metres(observables.mean_gap_error)),
            contact_stiffness: Some(stiffness).filter(|value| value.is_finite()),
            contact_conductance: Some(stiffness / units.elasticity().e_star()).filter(|value| value.is_finite()),
            elastic_energy: units.joules(observables.elastic_energy),
            rms_height: units.metres(context.rms_height),
            rms_slope: context.rms_slope,
            h_max: units.metres(solution.h_max()),
            complementarity_error: info.certificate.complementarity,
            penetration_error: info.certificate.penetration,
            energy_error: Some(info.certificate.energy),
            load_error: info.certificate.load,
            tolerance,
            energy_tolerance,
            cells_evaluated: Some(solution.n_evaluated()),
            cells_proven: Some(solution.n_proven()),
            level_iterations: Some(info.levels.iter().map(|level| level.iterations).collect()),
            iterations: info.fine_iterations(),
            operator_applications: info.fine_operator_applications(),
            leakage: None,
            wall_seconds: context.wall.as_secs_f64(),
            peak_memory_bytes: memory::peak(),
            threads: context.threads,
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }

    /// The summary as the cells of a row. Of a flow, those are `permeance_x`, `permeance_y` (m³) and `percolates`
    /// (along x and along y).
    ///
    /// # Panics
    /// Never: a record of numbers and text is an object.
    #[must_use]
    pub fn cells(&self) -> Cells {
        let Ok(Value::Object(mut cells)) = serde_json::to_value(self) else { unreachable!("a record is an object") };
        if let (Some(leakage), Some(_)) = (&self.leakage, cells.shift_remove("leakage")) {
            cells.extend(leakage.cells().map(|(column, value)| (column.to_owned(), value)));
        }
        cells
    }

    /// The summary as JSON, one key a line, with a line break at the end.
    #[must_use]
    pub fn to_json(&self) -> String {
        to_json(self)
    }
}

/// `value` as JSON for a file or for standard output.
///
/// # Panics
/// Never for the plain records of this crate.
#[must_use]
pub fn to_json(value: &impl Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).expect("a record of numbers and text is valid JSON");
    text.push('\n');
    text
}
