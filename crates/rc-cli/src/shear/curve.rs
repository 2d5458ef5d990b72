//! The shear of one surface under one load.

use rc_core::quantity::engineering;
use rc_theory::partial_slip::{Friction, LoadCurve, masing_loop};
use serde::{Deserialize, Serialize};

/// Shears of a curve, relative to its largest: small ones for the loss, then equal steps.
const SMALL: [f64; 3] = [1e-3, 2e-3, 5e-3];
const STEPS: usize = 100;

/// Part of the largest shear that the loop of the page has as amplitude.
const AMPLITUDE: f64 = 0.9;

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
