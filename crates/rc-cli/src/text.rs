//! Results as aligned lines of text.

use std::path::Path;

use rc_core::quantity::{Scale, count, digits, engineering};
use rc_sweep::{ControlKind, FrictionSummary, LeakageSummary, PathDifference, ShearSummary, Summary};

use crate::scene::keys::ContactKeys;
use crate::scene::resolve::{elastic_layer, sliding};
use crate::study::record::words_with_error;

/// A few aligned lines about a solved problem.
///
/// `sides` are those of the cell in m, `e_star` is E* in Pa, and `keys` say what the solid is and how the surface slides.
#[must_use]
pub(crate) fn solved(summary: &Summary, sides: [f64; 2], e_star: f64, keys: &ContactKeys) -> String {
    headline(summary) + &aligned(&solved_lines(summary, sides, e_star, keys))
}

/// Text of the stiffness of the contact.
pub(crate) fn stiffness(s: &Summary) -> String {
    s.contact_stiffness.map_or_else(|| "infinite".into(), |value| engineering(value, "Pa/m"))
}

/// The lines of [`solved`]: names and values.
pub(crate) fn solved_lines(
    s: &Summary,
    sides: [f64; 2],
    e_star: f64,
    keys: &ContactKeys,
) -> Vec<(&'static str, String)> {
    let [nx, ny] = s.grid;
    let pascals = |value| engineering(value, "Pa");
    let method = s.method_reason.as_ref().unwrap_or(&s.method).clone();
    // A profile has one row.
    let cell = match ny {
        1 => format!("{} long with {nx} elements, line contact, E* = {}", engineering(sides[0], "m"), pascals(e_star)),
        _ => format!("{} with {nx} x {ny} elements, E* = {}", cell(sides), pascals(e_star)),
    };
    let area = percent(s.area_fraction, s.area_fraction_error);
    let counted = digits(100.0 * s.area_fraction_cells, 4);
    let mean_pressure = measured(s.mean_pressure, s.mean_pressure_error_bar, "Pa");
    let force = s.force.map_or_else(String::new, |force| format!(", from {}", engineering(force, "N")));
    let mean_pressure = format!("{mean_pressure} ({} E*{force})", digits(s.mean_pressure / e_star, 4));
    let penetration = penetration(s);
    let mut lines = vec![
        ("method", method),
        ("cell", cell),
        ("surface", surface_line(s)),
        ("contact area", format!("{area} of the nominal area, {counted} % by counting")),
        ("mean pressure", mean_pressure),
        ("rms, max pressure", format!("{}, {}", pascals(s.rms_pressure), pascals(s.max_pressure))),
        ("penetration", penetration),
        ("mean gap", measured(s.mean_gap, s.mean_gap_error, "m")),
        ("stiffness", stiffness(s)),
        ("conductance", conductance(s)),
        ("elastic energy", engineering(s.elastic_energy, "J")),
        ("certificate", certificate_line(s)),
    ];
    if let Some(value) = s.mean_inverse_gap {
        let text = format!("{} 1/m times the conductivity of the gas", digits(value, 4));
        lines.insert(10, ("conductance of gas", text));
    }
    if let Some(friction) = friction(s) {
        lines.insert(4, ("friction", friction));
        lines.splice(4..4, sliding::in_words(keys).map(|sliding| ("sliding", sliding)));
    }
    if let Some(shear) = &s.shear {
        lines.splice(4..4, shear_lines(shear));
    }
    if let Some(plastic) = plastic(s) {
        let residual =
            s.residual_rms_height.map(|rms| ("unloaded surface", format!("rms height {}", engineering(rms, "m"))));
        let path = s.path_difference.map(|path| ("path", path_line(&path)));
        lines.splice(4..4, std::iter::once(("plastic area", plastic)).chain(residual).chain(path));
    }
    lines.splice(5..5, fluid(s).map(|fluid| ("fluid", fluid)));
    lines.splice(2..2, elastic_layer::in_words(keys).map(|layer| ("solid", layer)));
    if let Some(leakage) = &s.leakage {
        lines.extend(leakage_lines(leakage));
    }
    if let (Some(evaluated), Some(proven)) = (s.cells_evaluated, s.cells_proven) {
        lines.push(("elements", counts(evaluated, proven, nx * ny)));
    }
    lines
}

/// Numbers of elements with and without a computed gap, on a grid of `n` elements.
fn counts(evaluated: usize, proven: usize, n: usize) -> String {
    if evaluated + proven == n {
        format!("{evaluated} evaluated, {proven} proven out of contact")
    } else {
        format!("{evaluated} of several sizes evaluated, {proven} of the smallest size proven out of contact")
    }
}

/// Text of the parts of the load that fluid and contact bear; `None` without a fluid.
fn fluid(s: &Summary) -> Option<String> {
    let (fluid, contact) = (s.mean_fluid_pressure?, s.mean_contact_pressure?);
    let percent = digits(100.0 * contact / s.mean_pressure, 4);
    let [fluid, contact] = [fluid, contact].map(|mean| engineering(mean, "Pa"));
    Some(format!("bears {fluid} of it, the contact {contact} ({percent} %), with the pressures below"))
}

/// Text of what the steps of a history change.
fn path_line(path: &PathDifference) -> String {
    let percent = |part: f64| format!("{:+.2} %", 100.0 * part);
    format!(
        "{} steps to each load against one: area {}, removed volume {}, rms height {}",
        path.steps,
        percent(path.area_fraction),
        percent(path.removed_volume),
        percent(path.residual_rms_height)
    )
}

/// Text of the plastic part of the contact; `None` without a hardness.
pub(crate) fn plastic(s: &Summary) -> Option<String> {
    let (fraction, error) = (s.plastic_area_fraction?, s.plastic_area_fraction_error?);
    Some(format!(
        "{} of the nominal area, at the hardness of {}",
        percent(fraction, error),
        engineering(s.hardness?, "Pa")
    ))
}

/// Lines of a sheared contact.
fn shear_lines(s: &ShearSummary) -> [(&'static str, String); 3] {
    let stick = digits(100.0 * s.stick_area_fraction, 4);
    let stiffness = s.tangential_stiffness.map_or_else(|| "infinite".to_owned(), |value| engineering(value, "Pa/m"));
    let shear = format!(
        "{} with the friction coefficient {}, displacement {}",
        engineering(s.shear_pressure, "Pa"),
        s.coulomb_friction,
        engineering(s.shear_displacement, "m")
    );
    let areas = format!("{stick} %, {} % of the nominal area", digits(100.0 * s.slip_area_fraction, 4));
    let work = format!(
        "{stiffness} before slip, slip dissipates {}, energy error {:.1e}",
        engineering(s.slip_work, "J"),
        s.shear_error
    );
    [("shear", shear), ("stick, slip area", areas), ("tangential", work)]
}

/// Text of the friction; `None` without a speed.
pub(crate) fn friction(s: &Summary) -> Option<String> {
    let FrictionSummary { friction, friction_error, lateral_friction, dissipated_power, max_loss_tangent, .. } =
        s.friction?;
    let friction = coefficient(friction, friction_error);
    let lateral = if lateral_friction.abs() < NO_FRICTION { "0".to_owned() } else { digits(lateral_friction, 2) };
    let (power, tangent) = (engineering(dissipated_power, "W/m²"), digits(max_loss_tangent, 3));
    Some(format!("{friction}, lateral {lateral}, dissipates {power}, loss tangent up to {tangent}"))
}

/// Friction coefficient below which only errors of rounding are left.
const NO_FRICTION: f64 = 1e-12;

/// A friction coefficient that ends where its error does, such as `0.00580 ± 0.00040`.
pub(crate) fn coefficient(value: f64, error: f64) -> String {
    if value.abs().max(error) < NO_FRICTION { "0".to_owned() } else { words_with_error(value, error, "") }
}

/// Text of the electrical and thermal conductance.
fn conductance(s: &Summary) -> String {
    let Some(value) = s.contact_conductance else { return "infinite".into() };
    let error = s.contact_conductance_error.map_or_else(String::new, |error| format!(" ± {}", digits(error, 1)));
    let of_bodies = s.conductance.flatten().map_or_else(String::new, |value| {
        let error = s.conductance_error.flatten().map_or_else(String::new, |error| format!(" ± {}", digits(error, 1)));
        format!(", here ({}{error}) W/(m² K), or S/m² for electrical conductivities", digits(value, 4))
    });
    format!("({}{error}) 1/m times the conductivity{of_bodies}", digits(value, 4))
}

/// Lines of the permeances and constrictions of a flow.
fn leakage_lines(leakage: &LeakageSummary) -> Vec<(&'static str, String)> {
    let [x, y] = [0, 1].map(|axis| {
        if !leakage.percolates[axis] {
            return "0 (does not percolate)".to_owned();
        }
        let error = leakage.permeance_error[axis].map_or_else(String::new, |error| format!(" ± {error:.1e}"));
        format!("{:.4e}{error} m³ (solved to {:.0e})", leakage.permeance[axis], leakage.relative_error[axis].max(1e-16))
    });
    let [gap_x, gap_y] =
        leakage.critical_gap.map(|gap| gap.map_or_else(|| "none".to_owned(), |gap| engineering(gap, "m")));
    let mut lines = vec![
        ("permeance", format!("{x} along x, {y} along y")),
        ("critical gap", format!("{gap_x} along x, {gap_y} along y")),
    ];
    if let (Some(flow), Some(error)) = (leakage.flow, leakage.flow_error) {
        let [x, y] = [0, 1].map(|axis| {
            let error = error[axis].map_or_else(String::new, |error| format!(" ± {error:.1e}"));
            if leakage.percolates[axis] { format!("{:.4e}{error} m³/s", flow[axis]) } else { "0".to_owned() }
        });
        lines.push(("flow", format!("{x} along x, {y} along y")));
    }
    lines
}

fn penetration(s: &Summary) -> String {
    // A given penetration has no error; the load has it.
    let bar = s.penetration_error_bar.filter(|_| s.control != ControlKind::Penetration.key());
    let penetration = measured(s.penetration, bar, "m");
    // A layer and a patch with free borders are also displaced as a whole. Full contact then does not have a certain
    // depth.
    let open = s.mean_gap - s.mean_plastic_gap.unwrap_or(0.0);
    let displacement = open - (s.penetration_full_contact - s.penetration);
    if displacement > ROUNDING * s.penetration_full_contact.max(s.penetration) {
        format!("{penetration}, mean displacement {}", engineering(displacement, "m"))
    } else {
        format!("{penetration} of {} at full contact", engineering(s.penetration_full_contact, "m"))
    }
}

/// Ratio of lengths below which a difference is rounding.
const ROUNDING: f64 = 1e-12;

fn surface_line(s: &Summary) -> String {
    let (rms, max) = (engineering(s.rms_height, "m"), engineering(s.h_max, "m"));
    // After a history, the highest point is that of another surface than the rms height.
    let of_last = if s.residual_rms_height.is_some() { " before the last load" } else { "" };
    format!("rms height {rms}, rms slope {}, highest point {max}{of_last}", digits(s.rms_slope, 4))
}

fn certificate_line(s: &Summary) -> String {
    let energy = s.energy_error.map_or_else(String::new, |energy| format!("energy {energy:.1e}, "));
    let control = if s.control == ControlKind::Penetration.key() { "penetration" } else { "load" };
    format!(
        "{energy}complementarity {:.1e} and deepest overlap {:.1e} of the height range, {control} {:.1e}",
        s.complementarity_error, s.penetration_error, s.load_error
    )
}

/// A fraction with its error in percent, for instance `(7.18 ± 0.01) %`.
fn percent(fraction: f64, error: f64) -> String {
    let text = with_error(100.0 * fraction, 100.0 * error);
    if text.contains('±') { format!("({text}) %") } else { format!("{text} %") }
}

/// A value with its error, for instance `7.183 ± 0.008`.
///
/// Both end with the last digit that the error leaves certain. An error of the size of rounding is omitted.
pub(crate) fn with_error(value: f64, error: f64) -> String {
    if error > 1e-12 * value.abs() && error.is_finite() {
        let decimals = (-error.log10().floor()).clamp(0.0, 12.0) as usize;
        format!("{value:.decimals$} ± {error:.decimals$}")
    } else {
        digits(value, 6)
    }
}

/// A quantity with its error bar, for instance `15.14 µm ± 40 nm`. Errors of rounding are left out.
fn measured(value: f64, error: Option<f64>, unit: &'static str) -> String {
    let text = engineering(value, unit);
    match error.filter(|&error| error > 1e-12 * value.abs() && error.is_finite()) {
        Some(error) => {
            let scale = Scale::of(error, unit);
            format!("{text} ± {} {}", digits(error / scale.factor, 2), scale.unit())
        }
        None => text,
    }
}

/// Aligned lines of a name and a value.
pub(crate) fn aligned(lines: &[(&str, String)]) -> String {
    lines.iter().fold(String::new(), |text, (name, value)| text + &format!("  {name:<19}{value}\n"))
}

/// A line about the place of the results, if they were written.
#[must_use]
pub(crate) fn written(target: Option<&Path>) -> String {
    target.map_or_else(String::new, |target| format!("\nwritten to {}\n", target.display()))
}

fn headline(s: &Summary) -> String {
    let memory = s.peak_memory_bytes.map_or_else(String::new, |bytes| format!(", {} MB", bytes / 1_000_000));
    let how = match s.status.as_str() {
        "full_contact" if s.iterations == 0 => "full contact, solved exactly".to_owned(),
        "full_contact" => format!("full contact, {}", converged(s)),
        "not_converged" => format!("NOT CONVERGED after {}", count(s.iterations, "fine iteration")),
        _ => converged(s),
    };
    format!("{how}: {} s, {}{memory}\n", digits(s.wall_seconds, 3), count(s.threads, "thread"))
}

fn converged(s: &Summary) -> String {
    format!("converged in {}, {}", count(s.iterations, "fine iteration"), count(s.levels, "nested level"))
}

/// Text of the size of a cell (m).
///
/// It has one side of a square, and both sides of a rectangle.
#[must_use]
pub(crate) fn cell([x, y]: [f64; 2]) -> String {
    let side = engineering(x, "m");
    if (x - y).abs() <= 1e-12 * x { side } else { format!("{side} by {}", engineering(y, "m")) }
}

#[cfg(test)]
mod tests {
    use super::coefficient;

    #[test]
    fn a_friction_ends_where_its_error_does() {
        assert_eq!(coefficient(0.005_796, 0.000_4), "0.00580 ± 0.00040");
        assert_eq!(coefficient(-2e-19, 3e-18), "0");
    }
}
