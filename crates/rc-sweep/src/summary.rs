//! The summary of a result in SI units, as in `summary.json` and `--json`.

use std::time::Duration;

use rc_core::Units;
use rc_solver::{ErrorBound, Solution, UnderFluid};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value;

use crate::content::Cells;
use crate::friction::FrictionSummary;
use crate::leakage::LeakageSummary;
use crate::memory;
use crate::origin::MapOrigin;
use crate::plan::ControlKind;
use crate::shear::ShearSummary;
use crate::warning::Warning;

/// One solved contact problem. Pressures are in Pa, lengths in m, and fractions relative to the nominal area.
///
/// Some keys are missing in the oldest summaries, and are `None` after reading these. New summaries have them all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// `converged`, `full_contact` or `not_converged`.
    pub status: String,
    /// Prescribed quantity, `pressure`, `penetration` or `force`. In sweeps, a force is given as its pressure.
    pub control: String,
    /// The prescribed force (N). It exists only where a force is prescribed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// Kernel, for example `love` or `spectral`.
    pub kernel: String,
    /// Method that was used: `adaptive`, `uniform` or `gauss-seidel`.
    pub method: String,
    /// Reason for this method.
    pub method_reason: Option<String>,
    /// Elements per side of the grid, along x and y.
    pub grid: [usize; 2],
    /// Number of times that elements at the edges of contacts are halved beyond the grid.
    pub border_level: Option<usize>,
    /// Number of elements in contact on an adaptive mesh.
    ///
    /// For the uniform method it is the number of all elements.
    pub elements: usize,
    /// Number of nested levels. It is 1 when full contact needed no iteration.
    pub levels: usize,
    /// Mean pressure σ0 (Pa).
    pub mean_pressure: f64,
    /// Estimated discretisation error of `mean_pressure` (Pa). It is null under a given load.
    pub mean_pressure_error_bar: Option<f64>,
    /// Mean pressure of a fluid (Pa). Pressures of the summary other than `mean_pressure` are those of the contact alone.
    ///
    /// This key and the next exist only with a fluid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_fluid_pressure: Option<f64>,
    /// Mean of the pressure that the contact bears beside the fluid (Pa).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_contact_pressure: Option<f64>,
    /// Penetration Δ (m).
    pub penetration: f64,
    /// Estimated discretisation error of `penetration` at this load (m).
    ///
    /// It contains the height of the surface's maximum above the highest sample.
    pub penetration_error_bar: Option<f64>,
    /// Penetration of full contact, max(h) - mean(h) (m).
    pub penetration_full_contact: f64,
    /// Best estimate of the contact area A/A0. Edges of contacts are located between the centres of elements.
    pub area_fraction: f64,
    /// Contact area A/A0 from the number of elements with p > 0.
    pub area_fraction_cells: f64,
    /// Estimated error of `area_fraction`.
    pub area_fraction_error: f64,
    /// Maximum pressure that the contact bears (Pa).
    ///
    /// This key and the next three exist only with a hardness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardness: Option<f64>,
    /// Best estimate of the plastic area, relative to the nominal area.
    ///
    /// In this area the pressure is the hardness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plastic_area_fraction: Option<f64>,
    /// Estimated error of `plastic_area_fraction`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plastic_area_fraction_error: Option<f64>,
    /// Mean over the cell of the overlap that plastic flow has removed (m).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_plastic_gap: Option<f64>,
    /// rms height of the unloaded surface after a history of loads (m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_rms_height: Option<f64>,
    /// What steps to each load of a history change, if they were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path_difference: Option<PathDifference>,
    /// Length of the edges of all contacts (m).
    pub contact_perimeter: Option<f64>,
    /// rms pressure over the cell (Pa), from the pressures of elements.
    pub rms_pressure: f64,
    /// Best estimate of the rms pressure (Pa).
    ///
    /// It is corrected for the error of ⟨p²⟩ at edges of contacts and inside them.
    pub rms_pressure_corrected: Option<f64>,
    /// Estimated discretisation error of `rms_pressure_corrected` (Pa).
    ///
    /// It is null where contact reaches a free border, and in full contact on one grid with the kernel `spectral`.
    pub rms_pressure_error: Option<f64>,
    /// Maximum pressure (Pa).
    pub max_pressure: f64,
    /// Mean gap (m).
    pub mean_gap: f64,
    /// Estimated discretisation error of `mean_gap` (m).
    pub mean_gap_error: Option<f64>,
    /// Contact stiffness dσ0/dΔ (Pa/m). It is null in full contact, where it is infinite.
    pub contact_stiffness: Option<f64>,
    /// Electrical and thermal contact conductance of the nominal area for unit conductivity (1/m).
    ///
    /// It is that of the contact spots between two half-spaces ([`Solution::conductance`]). Multiply it by the harmonic
    /// mean 2 k1 k2/(k1 + k2) of the conductivities of the bodies. It is null in full contact, where it is infinite.
    pub contact_conductance: Option<f64>,
    /// Estimated error of `contact_conductance` (1/m).
    pub contact_conductance_error: Option<f64>,
    /// Conductance per nominal area for the given conductivities (W/(m² K) for thermal ones, S/m² for electrical ones).
    ///
    /// It exists only with conductivities, and is null in full contact.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "as_given")]
    pub conductance: Option<Option<f64>>,
    /// Estimated error of `conductance`, in its unit.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "as_given")]
    pub conductance_error: Option<Option<f64>>,
    /// ⟨1/(g + m)⟩ over the nominal area (1/m), with the gap g and the given jump distance m of a gas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_inverse_gap: Option<f64>,
    /// Friction of a surface that slides. Its keys exist only with a speed, and are 0 at the speed 0.
    #[serde(flatten)]
    pub friction: Option<FrictionSummary>,
    /// Shear of the contact. Its keys exist only with a friction that is given.
    #[serde(flatten)]
    pub shear: Option<ShearSummary>,
    /// The smallest dp/dσ0 in contact, of a solid that creeps. At most 0 where it would have to pull.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least_pressure_rise: Option<f64>,
    /// Elastic energy of the cell (J).
    pub elastic_energy: f64,
    /// rms height about the mean (m).
    pub rms_height: f64,
    /// rms slope √⟨|∇h|²⟩.
    pub rms_slope: f64,
    /// Maximum height on the grid (m).
    pub h_max: f64,
    /// Complementarity error Σ p (g - min g) / (H Σ p).
    ///
    /// H = max(h) - min(h), and the pressure-weighted mean of g is 0.
    pub complementarity_error: f64,
    /// Maximum overlap max(-g) / H.
    pub penetration_error: f64,
    /// Bound √(G/U) of the relative error of the pressure in the energy norm.
    ///
    /// G = mean p (g - min g) and U = mean p v / 2.
    pub energy_error: Option<f64>,
    /// Error of the prescribed quantity: |mean p - σ0| / σ0, or the deviation of Δ divided by H.
    pub load_error: f64,
    /// Tolerance of `complementarity_error` and `penetration_error`.
    ///
    /// It is null where the tolerance applied to `energy_error`.
    pub tolerance: Option<f64>,
    /// Tolerance of `energy_error`.
    pub energy_tolerance: Option<f64>,
    /// Number of elements whose gap was computed for the certificate.
    ///
    /// With border levels, they have several sizes.
    pub cells_evaluated: Option<usize>,
    /// Number of elements of the smallest size that are proven to be out of contact.
    ///
    /// Their gap was not computed. They are the rest of the cell.
    pub cells_proven: Option<usize>,
    /// Numbers of iterations on each level, coarsest first.
    pub level_iterations: Option<Vec<usize>>,
    /// Number of iterations on the finest level.
    pub iterations: usize,
    /// Number of applications of L on the finest level, including the certificate's.
    pub operator_applications: usize,
    /// Flow through the gap, if it was requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leakage: Option<LeakageSummary>,
    /// Origin of the heights, if they are from a file of a map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<MapOrigin>,
    /// Material of the other body, if both bodies are elastic.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second_body: Option<SecondBody>,
    /// Doubts about the input and the result.
    ///
    /// Summaries of older versions have none.
    #[serde(default)]
    pub warnings: Vec<Warning>,
    /// Time from the parsed scene to the certified solution, in seconds.
    ///
    /// It includes the evaluation of heights.
    pub wall_seconds: f64,
    /// Peak resident memory of the process, or null if unknown.
    pub peak_memory_bytes: Option<u64>,
    /// Number of worker threads.
    pub threads: usize,
    /// Version of rc.
    pub version: String,
}

/// Results of a history with steps to each load against those with one step, as relative differences.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathDifference {
    /// Steps to each load that is above the one before it.
    pub steps: usize,
    /// Difference of the contact area.
    pub area_fraction: f64,
    /// Difference of the volume that plastic flow has removed under all loads.
    pub removed_volume: f64,
    /// Difference of the rms height of the unloaded surface.
    pub residual_rms_height: f64,
}

/// The elastic constants of the other body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SecondBody {
    /// Young's modulus (Pa).
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

/// Information for a summary besides the solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveContext {
    /// Prescribed quantity.
    pub control: ControlKind,
    /// Number of times that elements at the edges of contacts were halved beyond the grid.
    pub border_level: usize,
    /// rms height of the surface about its mean, in λ.
    pub rms_height: f64,
    /// rms slope of the surface.
    pub rms_slope: f64,
    /// Time from the parsed scene to the certified solution.
    pub wall: Duration,
    /// Number of worker threads.
    pub threads: usize,
    /// Harmonic mean of the conductivities of the bodies, if they are given.
    pub conductivity: Option<f64>,
    /// Jump distance (m) of the gas in the gap, if it is given.
    pub jump_distance: Option<f64>,
    /// Whether a speed is given, which may be 0.
    pub slides: bool,
}

/// The tolerance relative to the range of heights, and that of the energy.
fn tolerances(bound: ErrorBound) -> [Option<f64>; 2] {
    match bound {
        ErrorBound::Relative(value) => [Some(value), None],
        ErrorBound::Energy(value) => [None, Some(value)],
    }
}

/// A value that is there, which may be null.
#[expect(clippy::option_option, reason = "a null is not a missing key")]
fn as_given<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Option<f64>>, D::Error> {
    Option::deserialize(deserializer).map(Some)
}

/// A value that is not infinite.
fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

/// Conductance for unit conductivity and its error (1/m). There is none in full contact.
fn conductance(solution: &Solution<'_>, units: Units) -> [Option<f64>; 2] {
    // A conductance in 1/λ is a stiffness in E*/λ per E*.
    let per_metre = |value| units.pascals_per_metre(value) / units.elasticity().e_star();
    let value = Some(per_metre(solution.conductance())).filter(|value| value.is_finite());
    [value, value.map(|_| per_metre(solution.conductance_error()))]
}

impl Summary {
    /// The summary of `solution` in SI units. Its memory is the peak of the process so far.
    #[must_use]
    #[expect(clippy::too_many_lines, reason = "one line for each key")]
    pub fn of(solution: &Solution<'_>, units: Units, context: &SolveContext) -> Self {
        let (info, observables, of_spots) = (solution.info(), solution.observables(), conductance(solution, units));
        Self {
            status: solution.status().name().to_owned(),
            control: context.control.key().to_owned(),
            force: None,
            kernel: solution.kernel().to_owned(),
            method: solution.method().name().to_owned(),
            method_reason: Some(solution.reason().to_string()),
            grid: [solution.grid().nx(), solution.grid().ny()],
            border_level: Some(context.border_level),
            elements: solution.n_elements(),
            levels: info.levels.len(),
            mean_pressure: units.pascals(info.mean_pressure),
            mean_pressure_error_bar: solution.mean_pressure_error().map(|error| units.pascals(error)),
            mean_fluid_pressure: None,
            mean_contact_pressure: None,
            penetration: units.metres(info.penetration),
            penetration_error_bar: Some(units.metres(solution.penetration_error())),
            penetration_full_contact: units.metres(info.penetration_full_contact),
            area_fraction: observables.area.fraction,
            area_fraction_cells: observables.area.cells,
            area_fraction_error: observables.area.error,
            hardness: finite(solution.hardness()).map(|h| units.pascals(h)),
            plastic_area_fraction: observables.plastic.map(|plastic| plastic.fraction),
            plastic_area_fraction_error: observables.plastic.map(|plastic| plastic.error),
            mean_plastic_gap: observables.plastic.map(|plastic| units.metres(plastic.mean_gap)),
            residual_rms_height: None,
            path_difference: None,
            contact_perimeter: Some(units.metres(observables.area.perimeter)),
            rms_pressure: units.pascals(observables.rms_pressure),
            rms_pressure_corrected: Some(units.pascals(observables.rms_pressure_corrected)),
            rms_pressure_error: observables.rms_pressure_error.map(|error| units.pascals(error)),
            max_pressure: units.pascals(observables.max_pressure),
            mean_gap: units.metres(observables.mean_gap),
            mean_gap_error: Some(units.metres(observables.mean_gap_error)),
            contact_stiffness: finite(units.pascals_per_metre(solution.stiffness())),
            contact_conductance: of_spots[0],
            contact_conductance_error: of_spots[1],
            conductance: context.conductivity.map(|of_bodies| of_spots[0].map(|per_unit| per_unit * of_bodies)),
            conductance_error: context.conductivity.map(|of_bodies| of_spots[1].map(|error| error * of_bodies)),
            mean_inverse_gap: context.jump_distance.map(|jump| {
                // It is in 1/λ.
                solution.mean_inverse_gap(units.length(jump)) / units.metres(1.0)
            }),
            friction: context.slides.then(|| FrictionSummary::of(solution, units)),
            shear: None,
            least_pressure_rise: None,
            elastic_energy: units.joules(observables.elastic_energy),
            rms_height: units.metres(context.rms_height),
            rms_slope: context.rms_slope,
            h_max: units.metres(solution.h_max()),
            complementarity_error: info.certificate.complementarity,
            penetration_error: info.certificate.penetration,
            energy_error: Some(info.certificate.energy),
            load_error: info.certificate.load,
            tolerance: tolerances(solution.bound())[0],
            energy_tolerance: tolerances(solution.bound())[1],
            cells_evaluated: Some(solution.n_evaluated()),
            cells_proven: Some(solution.n_proven()),
            level_iterations: Some(info.levels.iter().map(|level| level.iterations).collect()),
            iterations: info.fine_iterations(),
            operator_applications: info.fine_operator_applications(),
            leakage: None,
            source: None,
            second_body: None,
            warnings: Vec::new(),
            wall_seconds: context.wall.as_secs_f64(),
            peak_memory_bytes: memory::peak(),
            threads: context.threads,
            version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }

    /// The summary of a contact under a fluid, from that of the contact pressure alone.
    #[must_use]
    pub fn under_fluid(self, both: &UnderFluid, units: Units) -> Self {
        Self {
            mean_contact_pressure: Some(self.mean_pressure),
            mean_fluid_pressure: Some(units.pascals(both.mean_fluid_pressure)),
            mean_pressure: units.pascals(both.mean_pressure),
            penetration: units.metres(both.penetration),
            penetration_error_bar: Some(units.metres(both.penetration_error)),
            penetration_full_contact: units.metres(both.penetration_full_contact),
            h_max: units.metres(both.h_max),
            elastic_energy: units.joules(both.elastic_energy),
            ..self
        }
    }

    /// The summary as the cells of a row.
    ///
    /// The cell `warnings` has the codes of the warnings. There is no `source`, no
    /// `second_body` and no `path_difference`. The cells of a flow are `permeance_x`, `permeance_y`, their
    /// errors (all in m³), and `percolates` (along x and along y).
    ///
    /// # Panics
    /// Never, because a record of numbers and text is an object.
    #[must_use]
    pub fn cells(&self) -> Cells {
        let Ok(Value::Object(mut cells)) = serde_json::to_value(self) else { unreachable!("a record is an object") };
        let mut codes: Vec<&str> = Vec::new();
        for warning in &self.warnings {
            if !codes.contains(&warning.code.name()) {
                codes.push(warning.code.name());
            }
        }
        cells.insert("warnings".to_owned(), codes.into());
        cells.shift_remove("source");
        cells.shift_remove("second_body");
        cells.shift_remove("path_difference");
        if let (Some(leakage), Some(_)) = (&self.leakage, cells.shift_remove("leakage")) {
            cells.extend(leakage.cells().map(|(column, value)| (column.to_owned(), value)));
        }
        cells
    }

    /// The summary as JSON, with one key in each line.
    ///
    /// It ends with a line break.
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
