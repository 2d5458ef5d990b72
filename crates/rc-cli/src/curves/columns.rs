//! The columns of results: which are quantities, their units, and their error bars.

use rc_sweep::Cells;
use serde_json::Value;

/// Numbers that say how a result was found, and not what it is.
const BOOKKEEPING: [&str; 27] = [
    "seed",
    "control_value",
    "speed",
    "time",
    "gmres_iterations",
    "monotone_steps",
    "friction_bound",
    "shear_rounds",
    "grid",
    "border_level",
    "elements",
    "levels",
    "level_iterations",
    "iterations",
    "operator_applications",
    "cells_evaluated",
    "cells_proven",
    "tolerance",
    "energy_tolerance",
    "energy_error",
    "complementarity_error",
    "penetration_error",
    "load_error",
    "wall_seconds",
    "peak_memory_bytes",
    "threads",
    "version",
];

/// Units of columns; others have none.
const UNITS: [(&str, &str); 31] = [
    ("mean_pressure", "Pa"),
    ("mean_fluid_pressure", "Pa"),
    ("mean_contact_pressure", "Pa"),
    ("shear_pressure", "Pa"),
    ("shear_force", "N"),
    ("shear_displacement", "m"),
    ("slip_work", "J"),
    ("rms_pressure", "Pa"),
    ("rms_pressure_corrected", "Pa"),
    ("max_pressure", "Pa"),
    ("hardness", "Pa"),
    ("penetration", "m"),
    ("penetration_full_contact", "m"),
    ("mean_gap", "m"),
    ("mean_plastic_gap", "m"),
    ("contact_perimeter", "m"),
    ("rms_height", "m"),
    ("residual_rms_height", "m"),
    ("h_max", "m"),
    ("contact_stiffness", "Pa/m"),
    ("tangential_stiffness", "Pa/m"),
    ("contact_conductance", "1/m"),
    ("mean_inverse_gap", "1/m"),
    ("elastic_energy", "J"),
    ("permeance_x", "m³"),
    ("permeance_y", "m³"),
    ("flow_x", "m³/s"),
    ("flow_y", "m³/s"),
    ("dissipated_power", "W/m²"),
    ("speed", "m/s"),
    ("time", "s"),
];

/// A quantity that is drawn against the pressure, the speed or the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Quantity {
    /// Name of its pictures, and its key on the page.
    pub(crate) name: &'static str,
    /// Its columns, of which it is the mean.
    keys: &'static [&'static str],
    /// Its name in words.
    pub(crate) words: &'static str,
    /// SI unit.
    pub(crate) unit: &'static str,
}

/// The mean pressure, against which the others are drawn, if neither speed nor time is varied.
pub(crate) const PRESSURE: Quantity =
    Quantity { name: "pressure", keys: &["mean_pressure"], words: "mean pressure", unit: "Pa" };

/// The varied keys against which the others are drawn.
pub(crate) const SWEPT: [Quantity; 2] = [
    Quantity { name: "speed", keys: &["speed"], words: "speed", unit: "m/s" },
    Quantity { name: "time", keys: &["time"], words: "time", unit: "s" },
];

/// The quantities that are drawn.
pub(crate) const QUANTITIES: [Quantity; 11] = [
    Quantity { name: "area", keys: &["area_fraction"], words: "contact area A/A0", unit: "" },
    Quantity { name: "gap", keys: &["mean_gap"], words: "mean gap", unit: "m" },
    Quantity { name: "penetration", keys: &["penetration"], words: "penetration", unit: "m" },
    Quantity { name: "stiffness", keys: &["contact_stiffness"], words: "stiffness", unit: "Pa/m" },
    Quantity {
        name: "conductance",
        keys: &["contact_conductance"],
        words: "conductance per conductivity",
        unit: "1/m",
    },
    Quantity { name: "gas", keys: &["mean_inverse_gap"], words: "mean of 1/(gap + jump distance)", unit: "1/m" },
    Quantity { name: "of_bodies", keys: &["conductance"], words: "conductance in W/(m² K) or S/m²", unit: "" },
    Quantity {
        name: "permeance",
        keys: &["permeance_x", "permeance_y"],
        words: "permeance, mean of x and y",
        unit: "m³",
    },
    Quantity { name: "flow", keys: &["flow_x", "flow_y"], words: "flow, mean of x and y", unit: "m³/s" },
    Quantity { name: "friction", keys: &["friction"], words: "friction coefficient", unit: "" },
    Quantity { name: "loss-tangent", keys: &["max_loss_tangent"], words: "maximum loss tangent", unit: "" },
];

impl Quantity {
    /// Its first column.
    pub(crate) fn key(&self) -> &'static str {
        self.keys[0]
    }

    /// Value and error bar in a row; `None` if it has no value. An unknown bar is 0.
    pub(crate) fn of(&self, cells: &Cells) -> Option<[f64; 2]> {
        let n = self.keys.len() as f64;
        self.keys.iter().try_fold([0.0, 0.0], |[value, bar], key| {
            Some([value + number(cells, key)? / n, bar + bar_of(cells, key).unwrap_or(0.0) / n])
        })
    }
}

/// The number in a column, if it is finite.
pub(crate) fn number(cells: &Cells, key: &str) -> Option<f64> {
    cells.get(key).and_then(Value::as_f64).filter(|value| value.is_finite())
}

/// Whether a column is a result, and neither its error nor how it was found.
pub(crate) fn is_result(key: &str) -> bool {
    let is_error = key.ends_with("_error") || key.ends_with("_error_bar") || key.contains("_error_");
    !BOOKKEEPING.contains(&key) && !is_error
}

/// The error bar of a column.
pub(crate) fn bar_of(cells: &Cells, key: &str) -> Option<f64> {
    let bar = match key {
        // `penetration_error` is the certificate's.
        "penetration" => "penetration_error_bar".to_owned(),
        "rms_pressure_corrected" => "rms_pressure_error".to_owned(),
        "rms_pressure" => return None,
        "permeance_x" | "permeance_y" => key.replace("permeance", "permeance_error"),
        "flow_x" | "flow_y" => key.replace("flow", "flow_error"),
        _ if cells.contains_key(&format!("{key}_error_bar")) => format!("{key}_error_bar"),
        _ => format!("{key}_error"),
    };
    number(cells, &bar)
}

/// SI unit of a column.
pub(crate) fn unit_of(key: &str) -> &'static str {
    UNITS.iter().find(|(name, _)| *name == key).map_or("", |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn bars_are_found_by_the_names_of_their_columns() {
        let cells = json!({
            "area_fraction": 0.1, "area_fraction_error": 0.01, "penetration": 2.0, "penetration_error": 9.0,
            "penetration_error_bar": 0.5, "permeance_x": 1.0, "permeance_y": 3.0, "permeance_error_x": 0.1,
            "permeance_error_y": 0.3, "contact_conductance": 4.0, "contact_conductance_error": 1.0, "conductance": 8.0,
            "conductance_error": 2.0,
            "contact_stiffness": null, "wall_seconds": 1.0,
        });
        let cells: Cells = cells.as_object().expect("an object").clone();
        let of = |name: &str| QUANTITIES.iter().find(|one| one.name == name).and_then(|one| one.of(&cells));
        assert_eq!(of("area"), Some([0.1, 0.01]));
        assert_eq!(of("penetration"), Some([2.0, 0.5]));
        assert_eq!((of("permeance"), of("of_bodies")), (Some([2.0, 0.2]), Some([8.0, 2.0])));
        assert_eq!((of("stiffness"), of("gap")), (None, None));
        let results: Vec<&str> = cells.keys().map(String::as_str).filter(|key| is_result(key)).collect();
        let expected = [
            "area_fraction",
            "penetration",
            "permeance_x",
            "permeance_y",
            "contact_conductance",
            "conductance",
            "contact_stiffness",
        ];
        assert_eq!(results, expected);
    }
}
