//! The flow through the gap of a solved contact.

use std::convert::Infallible;
use std::time::Instant;

use rc_core::{Boundary, Field, Units};
use rc_leakage::{Leakage, LeakageError, LeakageParams};
use rc_solver::{Solution, UNIFORM_BYTES_PER_ELEMENT};
use rc_sweep::LeakageSummary;

use crate::scene::keys::ContactKeys;
use crate::scene::resolve::ContactSetup;

/// A flow and its part of the summary.
#[derive(Debug)]
pub struct SolvedFlow {
    /// The flow in units of λ.
    pub leakage: Leakage,
    /// The flow's part of the summary, in SI units.
    pub summary: LeakageSummary,
}

impl SolvedFlow {
    /// The flow through the gap of `solution`. An element with positive pressure is in contact.
    ///
    /// # Errors
    /// [`LeakageError`].
    pub(super) fn of(solution: &Solution<'_>, contact: &ContactSetup) -> Result<Self, LeakageError> {
        let started = Instant::now();
        let leakage = match contact.boundary {
            Boundary::Periodic => rc_leakage::leakage(&open_gap(solution), &LeakageParams::default())?,
            Boundary::Free => rc_leakage::leakage_of_patch(&open_gap(solution), &LeakageParams::default())?,
        };
        let summary = summary(&leakage, contact.units, started.elapsed().as_secs_f64());
        // Q = K ΔP/(12 η).
        let film = contact.keys.pressure_drop.zip(contact.keys.viscosity);
        let factor = film.map(|(drop, viscosity)| drop / (12.0 * viscosity));
        let flow = factor.map(|factor| summary.permeance.map(|permeance| permeance * factor));
        let flow_error = factor.map(|factor| summary.permeance_error.map(|error| error.map(|error| error * factor)));
        Ok(Self { leakage, summary: LeakageSummary { flow, flow_error, ..summary } })
    }
}

/// Ratio of the memory of a solve with its flow to that without it.
///
/// Both are on the same number of elements.
pub(crate) fn memory_factor(keys: &ContactKeys) -> f64 {
    let images = images(keys.boundary.unwrap_or_default());
    if keys.leakage { 1.0 + images * rc_leakage::BYTES_PER_ELEMENT / UNIFORM_BYTES_PER_ELEMENT as f64 } else { 1.0 }
}

/// Ratio of the elements of a flow to those of its contact. A patch is solved beside three mirror images.
pub(super) fn images(boundary: Boundary) -> f64 {
    if boundary == Boundary::Free { 4.0 } else { 1.0 }
}

/// The gap with zero in contact. Small negative values of the solver are rounding and become zero.
pub(crate) fn open_gap(solution: &Solution<'_>) -> Field {
    let mut gap = Field::zeros(solution.grid());
    let nx = solution.grid().nx();
    let values = gap.values_mut();
    let Ok(()) = solution.gap_rows(|first, rows| {
        let out = &mut values[first * nx..first * nx + rows.len()];
        out.iter_mut().zip(rows).for_each(|(out, gap)| *out = gap.max(0.0));
        Ok::<_, Infallible>(())
    });
    let Ok(()) = solution.pressure_rows(|first, rows| {
        let out = &mut values[first * nx..first * nx + rows.len()];
        out.iter_mut().zip(rows).filter(|(_, pressure)| **pressure > 0.0).for_each(|(out, _)| *out = 0.0);
        Ok::<_, Infallible>(())
    });
    gap
}

fn summary(leakage: &Leakage, units: Units, wall_seconds: f64) -> LeakageSummary {
    let flows = leakage.flows.each_ref();
    let cube = units.metres(1.0).powi(3);
    let place = |at: rc_core::DVec2| [units.metres(at.x), units.metres(at.y)];
    LeakageSummary {
        permeance: flows.map(|flow| flow.permeance * cube),
        relative_error: flows.map(|flow| flow.info.error),
        flow: None,
        flow_error: None,
        permeance_error: flows.map(|flow| flow.permeance_error.map(|error| error * cube)),
        flow_direction: leakage.flow_axis().map(|axis| axis.name().to_owned()),
        percolates: flows.map(|flow| flow.percolates),
        critical_gap: flows.map(|flow| flow.constriction.map(|place| units.metres(place.gap))),
        critical_place: flows.map(|flow| flow.constriction.map(|constriction| place(constriction.at))),
        conservation_error: flows.map(|flow| flow.info.conservation),
        iterations: flows.map(|flow| flow.info.iterations),
        wall_seconds,
    }
}
