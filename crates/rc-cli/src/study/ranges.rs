//! The range of each result over the treatments, beside the error of the mesh.

use rc_sweep::{Cells, SweepRows};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::rows::TREATMENT;

/// Results that belong to the whole half-space under a patch, so that a patch and a periodic cell do not compare.
const OF_HALF_SPACE: [&str; 4] = ["penetration", "contact_stiffness", "contact_conductance", "conductance"];

/// Results that do not depend on the size of the map: key, unit, and key of the error of the mesh.
const RESULTS: [(&str, &str, Option<&str>); 12] = [
    ("area_fraction", "", Some("area_fraction_error")),
    ("penetration", "m", Some("penetration_error_bar")),
    ("mean_gap", "m", Some("mean_gap_error")),
    ("rms_pressure_corrected", "Pa", Some("rms_pressure_error")),
    ("max_pressure", "Pa", None),
    ("contact_stiffness", "Pa/m", None),
    ("contact_conductance", "1/m", Some("contact_conductance_error")),
    ("conductance", "W/(m² K) or S/m²", Some("conductance_error")),
    ("mean_inverse_gap", "1/m", None),
    ("plastic_area_fraction", "", Some("plastic_area_fraction_error")),
    ("permeance_x", "m³", Some("permeance_error_x")),
    ("permeance_y", "m³", Some("permeance_error_y")),
];

/// A result at one load, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Range {
    /// Key of the result.
    pub(crate) result: String,
    /// Its SI unit; empty for a number.
    pub(crate) unit: String,
    /// The result of the unchanged treatments.
    pub(crate) value: f64,
    /// Estimated error of the mesh of `value`; `None` if there is no estimate.
    pub(crate) mesh_error: Option<f64>,
    /// Least result of all treatments.
    pub(crate) treatment_low: f64,
    /// The treatment that gives it.
    pub(crate) low_by: String,
    /// Greatest result of all treatments.
    pub(crate) treatment_high: f64,
    /// The treatment that gives it.
    pub(crate) high_by: String,
}

impl Range {
    /// The unit of the result, also of one that was read from a file.
    pub(crate) fn si_unit(&self) -> &'static str {
        RESULTS.iter().find(|(key, ..)| *key == self.result).map_or("", |(_, unit, _)| unit)
    }
}

/// The results at one load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct LoadRanges {
    /// Mean pressure (Pa).
    pub(crate) pressure: f64,
    /// Number of treatments whose row converged.
    pub(crate) n_treatments: usize,
    pub(crate) results: Vec<Range>,
}

/// The ranges at each of `pressures`. The rows are ordered by treatment, the unchanged one first, and then by load.
///
/// `has_boundary` says for each treatment whether its boundary is that of the first. If not, penetration, stiffness and
/// conductance do not count: those of a patch contain the indentation of the whole patch.
///
/// A load without a converged row of the unchanged treatments is left out. Rows that did not converge do not count.
pub(super) fn of_rows(rows: &SweepRows, pressures: &[f64], has_boundary: &[bool]) -> Vec<LoadRanges> {
    let of_load = |(i, pressure): (usize, &f64)| {
        let base = rows.get(&i).filter(|row| has_converged(row))?;
        let at = |index: usize| index % pressures.len() == i;
        let same: Vec<(bool, &Cells)> = rows
            .iter()
            .filter(|(index, row)| at(**index) && has_converged(row))
            .map(|(index, row)| (has_boundary[index / pressures.len()], row))
            .collect();
        let results = RESULTS.iter().filter_map(|result| range(result, base, &same)).collect();
        Some(LoadRanges { pressure: *pressure, n_treatments: same.len(), results })
    };
    pressures.iter().enumerate().filter_map(of_load).collect()
}

fn has_converged(row: &Cells) -> bool {
    row.get("status").is_some_and(|status| status != "not_converged")
}

/// The range over `rows`, among which is `base`.
fn range(
    &(result, unit, error): &(&'static str, &'static str, Option<&str>),
    base: &Cells,
    rows: &[(bool, &Cells)],
) -> Option<Range> {
    let number = |row: &Cells, key: &str| row.get(key).and_then(Value::as_f64);
    let value = number(base, result)?;
    let by = |row: &Cells| row.get(TREATMENT).and_then(Value::as_str).unwrap_or_default().to_owned();
    let counted = rows.iter().filter(|(has_boundary, _)| *has_boundary || !OF_HALF_SPACE.contains(&result));
    let values: Vec<(f64, String)> = counted.filter_map(|(_, row)| Some((number(row, result)?, by(row)))).collect();
    let (low, low_by) = values.iter().min_by(|a, b| a.0.total_cmp(&b.0))?.clone();
    // The first of equal ones, as for the least.
    let (high, high_by) = values.iter().rev().max_by(|a, b| a.0.total_cmp(&b.0))?.clone();
    let mesh_error = error.and_then(|key| number(base, key));
    let (result, unit) = (result.to_owned(), unit.to_owned());
    Some(Range { result, unit, value, mesh_error, treatment_low: low, low_by, treatment_high: high, high_by })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn ranges_are_over_converged_treatments_at_one_load() {
        let row = |name: &str, area: f64, status: &str| -> Cells {
            let value = json!({ "treatment": name, "status": status, "area_fraction": area, "area_fraction_error": 0.01, "penetration": area });
            value.as_object().expect("an object").clone()
        };
        let rows = SweepRows::from([
            (0, row("as prepared", 0.2, "converged")),
            (1, row("as prepared", 0.4, "converged")),
            (2, row("window", 0.1, "converged")),
            (3, row("window", 0.5, "full_contact")),
            (4, row("level", 0.05, "not_converged")),
        ]);
        let ranges = of_rows(&rows, &[1.0, 2.0], &[true, false, true]);
        let found: Vec<_> = ranges.iter().map(|load| (load.n_treatments, load.results.clone())).collect();
        let expected = |value, low, low_by: &str, high, high_by: &str| Range {
            result: "area_fraction".to_owned(),
            unit: String::new(),
            value,
            mesh_error: Some(0.01),
            treatment_low: low,
            low_by: low_by.to_owned(),
            treatment_high: high,
            high_by: high_by.to_owned(),
        };
        assert_eq!((found[0].0, &found[0].1[0]), (2, &expected(0.2, 0.1, "window", 0.2, "as prepared")));
        assert_eq!((found[1].0, &found[1].1[0]), (2, &expected(0.4, 0.4, "as prepared", 0.5, "window")));
        // Rows of treatments with another boundary.
        assert_eq!((found[1].1[1].treatment_low, found[1].1[1].treatment_high), (0.4, 0.4));
    }
}
