//! Means of shear curves over the surfaces of a scene.

use rc_core::quantity::{digits, engineering};
use serde::{Deserialize, Serialize};

use super::curve::{CurvePoint, ShearCurve};

/// Relative difference of loads and shears that are the same.
const SAME: f64 = 1e-9;

/// The mean of the curves of several surfaces under one load.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct MeanCurve {
    /// Name of the scene; empty if there is only one.
    pub(crate) scene: String,
    /// Number of surfaces.
    pub(crate) surfaces: usize,
    /// Mean pressure (Pa).
    pub(crate) mean_pressure: f64,
    /// Shear force per nominal area at which all slides (Pa).
    pub(crate) sliding_pressure: f64,
    pub(crate) points: Vec<MeanPoint>,
}

/// Means over the surfaces at one shear, and their spread, which is the standard deviation of one surface.
///
/// The units are those of [`CurvePoint`]. A value is null if it is for one of the surfaces.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct MeanPoint {
    pub(crate) shear_pressure: f64,
    pub(crate) shear_displacement: f64,
    pub(crate) shear_displacement_spread: f64,
    pub(crate) slip_area_fraction: f64,
    pub(crate) slip_area_fraction_spread: f64,
    pub(crate) stick_area_fraction: f64,
    pub(crate) stick_area_fraction_spread: f64,
    pub(crate) tangential_stiffness: Option<f64>,
    pub(crate) tangential_stiffness_spread: Option<f64>,
    pub(crate) loss_per_cycle: f64,
    pub(crate) loss_per_cycle_spread: f64,
    pub(crate) loss_factor: Option<f64>,
    pub(crate) loss_factor_spread: Option<f64>,
}

/// The means over at least two curves of one scene under the same load, to the same shears.
pub(super) fn of(curves: &[ShearCurve]) -> Vec<MeanCurve> {
    let mut groups: Vec<Vec<&ShearCurve>> = Vec::new();
    for curve in curves {
        match groups.iter_mut().find(|group| are_alike(group[0], curve)) {
            Some(group) => group.push(curve),
            None => groups.push(vec![curve]),
        }
    }
    groups.iter().filter(|group| group.len() > 1).map(|group| MeanCurve::of(group)).collect()
}

fn are_alike(a: &ShearCurve, b: &ShearCurve) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs();
    a.scene == b.scene
        && same(a.mean_pressure, b.mean_pressure)
        && same(a.sliding_pressure, b.sliding_pressure)
        && same(a.end().shear_pressure, b.end().shear_pressure)
        && a.points.len() == b.points.len()
}

impl MeanCurve {
    fn of(curves: &[&ShearCurve]) -> Self {
        let ShearCurve { scene, mean_pressure, sliding_pressure, points, .. } = curves[0];
        let at = |i: usize| MeanPoint::of(&curves.iter().map(|curve| curve.points[i]).collect::<Vec<_>>());
        Self {
            scene: scene.clone(),
            surfaces: curves.len(),
            mean_pressure: *mean_pressure,
            sliding_pressure: *sliding_pressure,
            points: (0..points.len()).map(at).collect(),
        }
    }

    /// Its name, beside those of its curves.
    pub(crate) fn name(&self) -> String {
        let load = engineering(self.mean_pressure, "Pa");
        let scene = if self.scene.is_empty() { String::new() } else { format!("{}, ", self.scene) };
        format!("{scene}mean of {} surfaces, {load}", self.surfaces)
    }

    /// A line about its end.
    pub(super) fn text(&self) -> String {
        let end = self.points[self.points.len() - 1];
        let contact = end.slip_area_fraction + end.stick_area_fraction;
        let percent = |part: f64| digits(100.0 * part / contact, 3);
        format!(
            "  {}: at {}, displacement {}, spread {}, of the contact {} % slips, spread {} %\n",
            self.name(),
            engineering(end.shear_pressure, "Pa"),
            engineering(end.shear_displacement, "m"),
            engineering(end.shear_displacement_spread, "m"),
            percent(end.slip_area_fraction),
            percent(end.slip_area_fraction_spread),
        )
    }
}

impl MeanPoint {
    fn of(points: &[CurvePoint]) -> Self {
        let of = |value: &dyn Fn(&CurvePoint) -> f64| mean_and_spread(&points.iter().map(value).collect::<Vec<_>>());
        let known = |value: &dyn Fn(&CurvePoint) -> Option<f64>| {
            let values: Option<Vec<f64>> = points.iter().map(value).collect();
            values.map_or([None; 2], |values| mean_and_spread(&values).map(Some))
        };
        let displacement = of(&|point| point.shear_displacement);
        let (slip, stick) = (of(&|point| point.slip_area_fraction), of(&|point| point.stick_area_fraction));
        let (stiffness, factor) = (known(&|point| point.tangential_stiffness), known(&|point| point.loss_factor));
        let loss = of(&|point| point.loss_per_cycle);
        Self {
            shear_pressure: points[0].shear_pressure,
            shear_displacement: displacement[0],
            shear_displacement_spread: displacement[1],
            slip_area_fraction: slip[0],
            slip_area_fraction_spread: slip[1],
            stick_area_fraction: stick[0],
            stick_area_fraction_spread: stick[1],
            tangential_stiffness: stiffness[0],
            tangential_stiffness_spread: stiffness[1],
            loss_per_cycle: loss[0],
            loss_per_cycle_spread: loss[1],
            loss_factor: factor[0],
            loss_factor_spread: factor[1],
        }
    }
}

/// Mean and standard deviation of at least two values.
fn mean_and_spread(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    [mean, (squares / (n - 1.0)).sqrt()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spread_is_that_of_one_surface() {
        let [mean, spread] = mean_and_spread(&[1.0, 3.0]);
        assert!((mean - 2.0).abs() < 1e-15 && (spread - 2.0_f64.sqrt()).abs() < 1e-15, "{mean}, {spread}");
    }
}
