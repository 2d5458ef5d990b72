//! From a solution to its summary in SI.

use rc_solver::Control;

use super::Solved;
use rc_sweep::Summary;
use rc_sweep::memory;

/// The summary in SI.
pub(super) fn summarise(solved: &Solved<'_>, threads: usize) -> Summary {
    let Solved { found, contact, side, .. } = solved;
    let (e_star, side) = (contact.elasticity.e_star(), *side);
    let info = found.info();
    let observables = found.observables(contact);
    let grid = found.grid();
    let stiffness = found.contact_stiffness(contact) * e_star / side;
    let (cells_evaluated, cells_proven) = found.evaluated_and_proven();
    // Not before: the time to the certified solution does not include what the solution does not need.
    let moments = solved.surface.moments();
    let text = |text: &str| text.to_owned();
    Summary {
        status: text(found.status()),
        control: text(match contact.control {
            Control::MeanPressure(_) => "pressure",
            Control::Penetration(_) => "penetration",
        }),
        kernel: text(contact.kernel().name()),
        method: text(found.method.name()),
        method_reason: Some(solved.reason.clone()),
        grid: [grid.nx(), grid.ny()],
        border_level: Some(contact.border_level()),
        elements: found.n_elements(),
        levels: info.levels.len(),
        mean_pressure: info.mean_pressure * e_star,
        penetration: info.penetration * side,
        penetration_full_contact: info.penetration_full_contact * side,
        area_fraction: observables.area.fraction,
        area_fraction_cells: observables.area.cells,
        area_fraction_error: observables.area.error,
        contact_perimeter: Some(observables.area.perimeter * side),
        rms_pressure: observables.rms_pressure * e_star,
        rms_pressure_corrected: Some(observables.rms_pressure_corrected * e_star),
        rms_pressure_error: observables.rms_pressure_error.map(|error| error * e_star),
        max_pressure: observables.max_pressure * e_star,
        mean_gap: observables.mean_gap * side,
        mean_gap_error: observables.mean_gap_error.map(|error| error * side),
        contact_stiffness: Some(stiffness).filter(|value| value.is_finite()),
        elastic_energy: observables.elastic_energy * e_star * side.powi(3) * solved.surface.grid.cell_ratio(),
        rms_height: moments.rms_height * side,
        rms_slope: moments.rms_slope,
        h_max: found.h_max * side,
        complementarity_error: info.certificate.complementarity,
        penetration_error: info.certificate.penetration,
        load_error: info.certificate.load,
        tolerance: Some(contact.params.tolerance),
        cells_evaluated: Some(cells_evaluated),
        cells_proven: Some(cells_proven),
        level_iterations: Some(info.levels.iter().map(|level| level.iterations).collect()),
        iterations: info.fine_iterations(),
        operator_applications: info.fine_operator_applications(),
        wall_seconds: solved.wall.as_secs_f64(),
        peak_memory_bytes: memory::peak(),
        threads,
        version: text(env!("CARGO_PKG_VERSION")),
    }
}
