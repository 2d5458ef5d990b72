//! Extreme units: the same problem with cells of a nanometre and of a kilometre.

use crate::support::{Place, assert_solved};

/// Quantities of a summary, with the powers of E* and of the cell side in their units.
const QUANTITIES: [(&str, i32, i32); 20] = [
    ("mean_pressure", 1, 0),
    ("penetration", 0, 1),
    ("penetration_error_bar", 0, 1),
    ("penetration_full_contact", 0, 1),
    ("area_fraction", 0, 0),
    ("area_fraction_cells", 0, 0),
    ("area_fraction_error", 0, 0),
    ("contact_perimeter", 0, 1),
    ("rms_pressure", 1, 0),
    ("rms_pressure_corrected", 1, 0),
    ("rms_pressure_error", 1, 0),
    ("max_pressure", 1, 0),
    ("mean_gap", 0, 1),
    ("mean_gap_error", 0, 1),
    ("contact_stiffness", 1, -1),
    ("elastic_energy", 1, 3),
    ("rms_height", 0, 1),
    ("rms_slope", 0, 0),
    ("h_max", 0, 1),
    ("iterations", 0, 0),
];

#[test]
fn results_in_units_of_cell_and_modulus_do_not_depend_on_the_units() {
    let place = Place::new();
    for method in ["uniform", "adaptive"] {
        // The rms height is 1.3e-3 of the cell, and the mean pressure 1e-3 of E*.
        let systems = [("1e-9", "1.3e-12", "1e13", "1e10"), ("1e3", "1.3", "1", "1e-3")];
        let [small, large] = systems.map(|(cell, rms, e_star, pressure)| {
            let out = format!("{method}-{cell}");
            let surface = ["--waves", "4", "--grid", "64", "--cell", cell, "--rms", rms];
            let contact = ["--e-star", e_star, "--pressure", pressure, "--method", method, "--quiet", "--out", &out];
            assert_solved(&place.run(&[&["solve"], &surface[..], &contact[..]].concat()));
            let summary = place.json(&format!("{out}/summary.json"));
            let [cell, e_star]: [f64; 2] = [cell, e_star].map(|value| value.parse().expect("a number"));
            QUANTITIES.map(|(name, pressures, lengths)| {
                let value = summary[name].as_f64().unwrap_or_else(|| panic!("no {name}: {summary}"));
                value / (e_star.powi(pressures) * cell.powi(lengths))
            })
        });
        for ((name, ..), (a, b)) in QUANTITIES.into_iter().zip(small.into_iter().zip(large)) {
            assert!(a > 0.0 && (a / b - 1.0).abs() < 1e-9, "{method}, {name}: {a:e} and {b:e}");
        }
    }
}
