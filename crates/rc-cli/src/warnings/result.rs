//! Doubts about a solved contact: its pressures, and spots of single elements.

use rc_core::Boundary;
use rc_core::quantity::{digits, engineering};
use rc_solver::{Control, Solution};
use rc_sweep::Warning;
use rc_sweep::WarningCode::{Coarse, Creep, Edges, Load};

use super::contact::mean_pressure;
use super::single_spots::SingleSpots;
use crate::scene::resolve::ContactSetup;

/// Maximum pressure in E* above which an elastic contact is hardly elastic.
///
/// Strains below a contact are about p/E*. Metals yield at p/E* = 0.01 to 0.03. Only rubber bears 0.3 E*.
const LARGE_PRESSURE: f64 = 0.3;

/// Part of the contact area in spots of single elements above which a map is too coarse for the load.
///
/// The area of such a spot may be wrong by half an element.
const MANY_SINGLE: f64 = 0.1;

/// The doubts that only the solution shows.
///
/// Ranks call this together, and the first one gets the doubts.
pub(crate) fn after(solution: &Solution<'_>, contact: &ContactSetup, is_map: bool) -> Vec<Warning> {
    let mut found = Vec::new();
    let mean = if let Control::MeanPressure(_) = contact.control { None } else { Some(solution.info().mean_pressure) };
    found.extend(mean.and_then(|mean| mean_pressure(mean, contact)));
    if contact.hardness.is_infinite() {
        found.extend(maximum(maximum_pressure(solution), contact));
    }
    if contact.creep.is_some() {
        found.extend(solution.least_pressure_rise().and_then(relieved));
    }
    if is_map {
        found.extend(single(solution, contact.boundary));
        found.extend(jumps(solution.area().part_of_jumps()));
    }
    found
}

/// The maximum pressure, without the time that all observables take.
fn maximum_pressure(solution: &Solution<'_>) -> f64 {
    let mine = match solution.elements() {
        Some(elements) => elements.map(|element| element.pressure).fold(0.0, f64::max),
        None => solution.pressure().max(),
    };
    solution.ranks().maximum(mine, 0.0)
}

fn maximum(pressure: f64, contact: &ContactSetup) -> Option<Warning> {
    // A fast contact has the strains of the glassy solid.
    let glassy_ratio = contact.sliding.as_ref().map_or(1.0, |sliding| sliding.material.glassy_ratio());
    let text = || {
        format!(
            "the maximum pressure of {} is {} {}E*, which few materials bear elastically; give a --hardness, or check the units \
             of load and modulus",
            engineering(contact.units.pascals(pressure), "Pa"),
            digits(pressure / glassy_ratio, 3),
            if glassy_ratio > 1.0 { "glassy " } else { "" }
        )
    };
    (pressure > LARGE_PRESSURE * glassy_ratio).then(|| Warning::new(Load, text()))
}

/// The doubt about creep if the pressure of an elastic contact rises by at least `rise` for each unit of the load.
fn relieved(rise: f64) -> Option<Warning> {
    let text = || {
        format!(
            "while the contact grows, the pressure falls somewhere (by {} of the rise of the load), where the solid that creeps \
             may have to pull; there the contact opens, and the area is too large",
            digits(-rise, 2)
        )
    };
    (rise < 0.0).then(|| Warning::new(Creep, text()))
}

/// Part of the contact edges where heights jump above which the contact area depends on the samples.
const MANY_JUMPS: f64 = 0.25;

fn jumps(part: f64) -> Option<Warning> {
    let text = || {
        format!(
            "heights jump at {} % of the contact edges, which lie anywhere between two points of the map; the contact area \
             is counted there",
            digits(100.0 * part, 2)
        )
    };
    (part > MANY_JUMPS).then(|| Warning::new(Edges, text()))
}

fn single(solution: &Solution<'_>, boundary: Boundary) -> Option<Warning> {
    let mut spots = SingleSpots::new(solution.grid(), boundary);
    let Ok(()) = solution.pressure_rows(|_, rows| {
        spots.take(rows);
        Ok::<_, std::convert::Infallible>(())
    });
    let part = spots.part();
    let text = || {
        format!(
            "{} % of the contact area is in spots of a single element, whose area is uncertain; the map is too coarse for \
             this load (rc surface --resample, or a larger load)",
            digits(100.0 * part, 3)
        )
    };
    (part > MANY_SINGLE).then(|| Warning::new(Coarse, text()))
}
