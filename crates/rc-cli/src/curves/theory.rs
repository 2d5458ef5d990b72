//! Persson's contact area beside that of a sweep.

use rc_core::PeriodicCell;
use rc_theory::persson::Persson;
use serde::Serialize;
use serde_json::Value;

use super::columns::PRESSURE;
use super::table::{Row, SweepTable};
use crate::scene::keys::ContactKeys;
use crate::scene::resolve;

/// Number of points of a line.
const POINTS: usize = 80;

/// Relative difference of E* h' below which two lines are one.
const SAME: f64 = 1e-9;

/// The keys that E* follows from.
const MATERIAL: [&str; 5] = ["young", "poisson", "e_star", "young2", "poisson2"];

/// A line of the theory.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct PerssonLine {
    /// Index of the first scene that it belongs to.
    pub(crate) scene: usize,
    /// Mean pressure (Pa) and area fraction.
    pub(crate) points: Vec<[f64; 2]>,
}

/// The area erf(σ0/2√Λ) with Λ = (E* h')²/8, of each scene that is an elastic half-space under a rough surface.
///
/// Scenes with the same product E* h' share a line. h' is the mean rms slope over the rows.
pub(crate) fn persson(table: &SweepTable) -> Vec<PerssonLine> {
    let Some(settings) = table.settings.as_ref().filter(|_| table.against == PRESSURE) else { return Vec::new() };
    let pressures = || table.rows.iter().filter_map(|row| row.number("mean_pressure")).filter(|p| *p > 0.0);
    let (low, high) = (pressures().fold(f64::INFINITY, f64::min), pressures().fold(0.0, f64::max));
    if high <= 0.0 {
        return Vec::new();
    }
    let mut found: Vec<f64> = Vec::new();
    let mut lines = Vec::new();
    for (scene, rows) in table.scenes().into_iter().enumerate() {
        let Some((e_star, slope)) = half_space(rows, settings) else { continue };
        let width = e_star * slope;
        if found.iter().any(|other| (other / width - 1.0).abs() < SAME) {
            continue;
        }
        found.push(width);
        let area = |pressure: f64| Persson::from_rms_slope(pressure / e_star, slope).area_fraction();
        // Below the lowest load, the line continues to the origin of linear axes.
        let ratio = high / (0.5 * low);
        let pressure = |i: usize| 0.5 * low * ratio.powf(i as f64 / (POINTS - 1) as f64);
        let curve = (0..POINTS).map(|i| [pressure(i), area(pressure(i))]);
        lines.push(PerssonLine { scene, points: std::iter::once([0.0, 0.0]).chain(curve).collect() });
    }
    lines
}

/// E* (Pa) and rms slope, if the theory applies to the rows of a scene.
fn half_space(rows: &[Row], settings: &Value) -> Option<(f64, f64)> {
    let keys = &settings["surfaces"][rows.first()?.place.as_ref()?.surface];
    let (surface, contact) = (&keys["surface"], &keys["contact"]);
    let is_shape = !surface["shape"].is_null() && surface["waves"].is_null() && surface["heights"].is_null();
    let slides = contact["speed"].as_f64().is_some_and(|speed| speed > 0.0);
    if slides || is_shape || !contact["hardness"].is_null() || !contact["layer_thickness"].is_null() {
        return None;
    }
    let material: ContactKeys = serde_json::from_value(material(contact)).ok()?;
    let cell = PeriodicCell::new(surface["cell"].as_f64()?).ok()?;
    // The load does not matter here, but a contact has one.
    let loaded = ContactKeys { pressure: Some(1.0), ..material };
    let e_star = resolve::contact(loaded, cell).ok()?.units.elasticity().e_star();
    let slopes = rows.iter().map(|row| row.number("rms_slope")).collect::<Option<Vec<f64>>>()?;
    let slope = slopes.iter().sum::<f64>() / slopes.len() as f64;
    (slope > 0.0).then_some((e_star, slope))
}

/// The keys of the material that have a value.
fn material(contact: &Value) -> Value {
    let given = MATERIAL.iter().filter(|key| !contact[**key].is_null());
    given.map(|key| ((*key).to_owned(), contact[*key].clone())).collect::<serde_json::Map<_, _>>().into()
}
