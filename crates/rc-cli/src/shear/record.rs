//! The shear curves of a sweep: `shear.json`, `shear.csv`, and the text on the terminal.

use std::path::Path;

use rc_core::quantity::{digits, engineering};
use rc_sweep::files::Staged;
use rc_sweep::to_json;
use rc_theory::partial_slip::{Friction, LoadCurve, masing_loop};
use serde::{Deserialize, Serialize};

use crate::error::CliError;
use crate::files::kind::Kind;
use crate::files::names::{SHEAR_FILE, SHEAR_TABLE};

/// Shears of a curve, relative to its largest: small ones for the loss, then equal steps.
const SMALL: [f64; 3] = [1e-3, 2e-3, 5e-3];
const STEPS: usize = 100;

/// Part of the largest shear that the loop of the page has as amplitude.
const AMPLITUDE: f64 = 0.9;

/// All shear curves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ShearRecord {
    /// The command that repeats them.
    pub(crate) command: String,
    /// Coulomb's coefficient of friction.
    pub(crate) friction: f64,
    /// What the curves neglect, each once.
    pub(crate) notes: Vec<String>,
    /// One for each surface and load.
    pub(crate) curves: Vec<ShearCurve>,
}

/// The shear of one surface under one load.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ShearCurve {
    /// Name of the scene; empty if there is only one.
    pub(crate) scene: String,
    pub(crate) seed: Option<u64>,
    /// Mean pressure (Pa).
    pub(crate) mean_pressure: f64,
    /// Poisson's ratio of the tangential response.
    pub(crate) poisson: f64,
    /// Ratio of tangential to normal compliance.
    pub(crate) compliance_ratio: f64,
    /// Shear force per nominal area at which all slides (Pa).
    pub(crate) sliding_pressure: f64,
    /// Stiffness before slip (Pa/m); null in full contact.
    pub(crate) tangential_stiffness: Option<f64>,
    pub(crate) points: Vec<CurvePoint>,
    /// Displacement (m) and shear (Pa) of the loop whose amplitude is 0.9 of the largest shear.
    pub(crate) hysteresis: Vec<[f64; 2]>,
}

/// A line of `shear.csv`, without its surface.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct CurvePoint {
    /// Shear force per nominal area τ (Pa).
    pub(crate) shear_pressure: f64,
    /// Tangential displacement d (m).
    pub(crate) shear_displacement: f64,
    /// Its difference to the curve from every second load (m).
    pub(crate) shear_displacement_error: f64,
    pub(crate) slip_area_fraction: f64,
    pub(crate) stick_area_fraction: f64,
    /// dτ/dd (Pa/m); null where it is infinite.
    pub(crate) tangential_stiffness: Option<f64>,
    /// Energy per nominal area that a cycle between ±τ dissipates (J/m²).
    pub(crate) loss_per_cycle: f64,
    /// The loss divided by 2π times τ d/2; null at τ = 0.
    pub(crate) loss_factor: Option<f64>,
}

/// A line of `shear.csv`.
#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    seed: Option<u64>,
    mean_pressure: f64,
    shear_pressure: f64,
    shear_displacement: f64,
    shear_displacement_error: f64,
    slip_area_fraction: f64,
    stick_area_fraction: f64,
    tangential_stiffness: Option<f64>,
    loss_per_cycle: f64,
    loss_factor: Option<f64>,
}

/// A number that is not infinite.
fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

impl ShearCurve {
    /// The shear of the contact under the largest load of `curve`.
    pub(super) fn new(
        (scene, seed): (&str, Option<u64>),
        poisson: f64,
        (curve, friction): (&LoadCurve, Friction),
    ) -> Self {
        let largest = curve.largest_shear(friction);
        let steps = (1..=STEPS).map(|i| i as f64 / STEPS as f64);
        let shears: Vec<f64> = std::iter::once(0.0).chain(SMALL).chain(steps).map(|part| part * largest).collect();
        let errors = curve.spacing_error(friction, &shears);
        let points: Vec<CurvePoint> =
            shears.iter().zip(errors).map(|(&shear, error)| CurvePoint::new((curve, friction), shear, error)).collect();
        let first: Vec<[f64; 2]> = (0..=STEPS)
            .map(|i| AMPLITUDE * largest * i as f64 / STEPS as f64)
            .map(|shear| [shear, curve.sheared(friction, shear).displacement])
            .collect();
        Self {
            scene: scene.to_owned(),
            seed,
            mean_pressure: curve.largest_load(),
            poisson,
            compliance_ratio: friction.compliance_ratio,
            sliding_pressure: friction.coefficient * curve.largest_load(),
            tangential_stiffness: points[0].tangential_stiffness,
            points,
            hysteresis: masing_loop(&first).into_iter().map(|[shear, displacement]| [displacement, shear]).collect(),
        }
    }

    /// The name of scene, seed and load.
    pub(crate) fn name(&self) -> String {
        let seed = self.seed.map(|seed| format!("seed {seed}"));
        let parts = [self.scene.clone(), seed.unwrap_or_default(), engineering(self.mean_pressure, "Pa")];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }

    /// The last point.
    pub(crate) fn end(&self) -> &CurvePoint {
        &self.points[self.points.len() - 1]
    }

    /// The largest difference to the curve from every second load, relative to the largest displacement.
    pub(crate) fn spacing_error(&self) -> f64 {
        let largest = self.points.iter().map(|point| point.shear_displacement_error).fold(0.0, f64::max);
        largest / self.end().shear_displacement
    }
}

impl CurvePoint {
    fn new((curve, friction): (&LoadCurve, Friction), shear: f64, error: f64) -> Self {
        let point = curve.sheared(friction, shear);
        Self {
            shear_pressure: shear,
            shear_displacement: point.displacement,
            shear_displacement_error: error,
            slip_area_fraction: point.slip_area,
            stick_area_fraction: point.stick_area,
            tangential_stiffness: finite(point.stiffness),
            loss_per_cycle: point.loss,
            loss_factor: finite(point.loss / (std::f64::consts::PI * shear * point.displacement)),
        }
    }
}

impl ShearRecord {
    /// The record in `folder`; `None` if there is none.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is no record of shear curves.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, CliError> {
        let path = folder.join(SHEAR_FILE);
        let Ok(text) = std::fs::read_to_string(&path) else { return Ok(None) };
        let record: Self = serde_json::from_str(&text)
            .map_err(|cause| CliError::in_file(&path, format_args!("not a record of rc shear: {cause}")))?;
        if record.curves.is_empty() || record.curves.iter().any(|curve| curve.points.is_empty()) {
            return Err(CliError::in_file(&path, "has no curves"));
        }
        Ok(Some(record))
    }

    /// Writes `shear.json` and `shear.csv`.
    ///
    /// # Errors
    /// [`CliError::Write`].
    pub(super) fn write(&self, folder: &Path) -> Result<(), CliError> {
        let mut staged: Staged = Kind::Shear.stage(folder)?;
        staged.add_text(SHEAR_FILE, &to_json(self))?;
        staged.add(SHEAR_TABLE, |path| self.write_table(path))?;
        Ok(staged.commit()?)
    }

    fn write_table(&self, path: &Path) -> Result<(), csv::Error> {
        let mut out = csv::Writer::from_path(path)?;
        for curve in &self.curves {
            for point in &curve.points {
                out.serialize(Line {
                    scene: &curve.scene,
                    seed: curve.seed,
                    mean_pressure: curve.mean_pressure,
                    shear_pressure: point.shear_pressure,
                    shear_displacement: point.shear_displacement,
                    shear_displacement_error: point.shear_displacement_error,
                    slip_area_fraction: point.slip_area_fraction,
                    stick_area_fraction: point.stick_area_fraction,
                    tangential_stiffness: point.tangential_stiffness,
                    loss_per_cycle: point.loss_per_cycle,
                    loss_factor: point.loss_factor,
                })?;
            }
        }
        out.flush()?;
        Ok(())
    }

    /// A few lines about each curve.
    pub(crate) fn text(&self) -> String {
        let lines = |curve: &ShearCurve| {
            let end = curve.end();
            let stiffness =
                curve.tangential_stiffness.map_or_else(|| "infinite".to_owned(), |k| engineering(k, "Pa/m"));
            let of_sliding = digits(100.0 * end.shear_pressure / curve.sliding_pressure, 3);
            format!(
                "  {}: stiffness {stiffness} before slip; at {}, {of_sliding} % of the friction, displacement {}, of the contact {} % slips; \
                 half as many loads change displacements by up to {} % of it\n",
                curve.name(),
                engineering(end.shear_pressure, "Pa"),
                engineering(end.shear_displacement, "m"),
                digits(100.0 * end.slip_area_fraction / (end.slip_area_fraction + end.stick_area_fraction), 3),
                digits(100.0 * curve.spacing_error(), 2),
            )
        };
        self.curves.iter().map(lines).collect()
    }
}
