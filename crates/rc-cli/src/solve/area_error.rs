//! `rc solve --area-error`: the coarsest grid that gives the contact area as accurately as wanted.

use std::time::Instant;

use super::{Solved, finish, observer};
use crate::error::CliError;
use crate::resolve;
use crate::scene::{ContactKeys, Scene, SurfaceKeys};
use crate::stop;
use crate::surface::SurfaceProblem;
use crate::values::{Fraction, GridSpec, Tolerance};
use rc_core::quantity::digits;
use rc_sweep::files;

/// Elements per shortest wave of the first grid, and of the last that is tried.
const COARSEST: usize = 4;
const FINEST: usize = 256;

/// Fewest elements per side.
const SMALLEST_SIDE: usize = 64;

/// Order at which the error bar falls with the element side: most of it is the scatter of edges, √(edges) element areas.
const ORDER: f64 = 1.5;

/// Solves on finer and finer grids until the error bar of the contact area is at most `wanted` of it. The first grid's bar says
/// where to go next, so that it is mostly two solves, of which the last costs more than all others.
///
/// # Errors
/// [`CliError`] of every kind.
pub(super) fn run(scene: Scene, Fraction(wanted): Fraction, watch: bool, started: Instant) -> Result<(), CliError> {
    let Scene { surface: surface_keys, contact: contact_keys, run } = scene;
    if surface_keys.heights.is_some() {
        return Err(CliError::input(
            "area_error: a height map has its own grid, which cannot be chosen; leave it away",
        ));
    }
    if let Some(folder) = &run.out {
        files::check_folder(folder)?;
    }
    let threads = resolve::start_threads(run.threads)?;
    let tolerance = contact_keys.tolerance.or(Some(Tolerance::Auto));
    let contact_keys = ContactKeys { area_error: None, tolerance, ..contact_keys };
    stop::listen();
    let problem = |elements_per_wave: usize| {
        let (surface, side) = on_grid(&surface_keys, elements_per_wave)?;
        let contact = resolve::contact(contact_keys.clone(), surface.cell.side(), surface.elements_per_wave())?;
        Ok::<_, CliError>((surface, contact, side))
    };
    let mut elements_per_wave = COARSEST;
    let (surface, contact, _) = problem(elements_per_wave)?;
    let progress = observer(&run, watch, &surface, &contact, started);
    loop {
        let (surface, contact, side) = problem(elements_per_wave)?;
        progress.say("heights");
        let loaded = surface.load()?;
        let solved = Solved::new(&loaded, &contact, surface.cell.side(), &run, started, &progress)?;
        let error = solved.relative_area_error();
        if error <= wanted || solved.failure().is_some() {
            return finish(&solved, &surface, &run, threads, progress);
        }
        if elements_per_wave >= FINEST {
            return Err(CliError::input(format_args!(
                "area_error: {} % cannot be reached; with {side} elements per side the error is {} %",
                digits(100.0 * wanted, 2),
                digits(100.0 * error, 2)
            )));
        }
        elements_per_wave = next(elements_per_wave, error / wanted);
    }
}

/// The surface on a grid with this many elements per shortest wave, or more where the grid would be tiny.
fn on_grid(keys: &SurfaceKeys, elements_per_wave: usize) -> Result<(SurfaceProblem, usize), CliError> {
    // The defaults of the keys fill up what is not given, the number of waves included.
    let coarse = resolve::surface(SurfaceKeys { grid: None, ..keys.clone() })?;
    let waves = coarse.keys.waves.unwrap_or(1);
    let mut side = waves * elements_per_wave;
    while side < SMALLEST_SIDE * elements_per_wave / COARSEST {
        side *= 2;
    }
    let keys = SurfaceKeys { grid: Some(GridSpec::square(side)), ..keys.clone() };
    Ok((resolve::surface(keys)?, side))
}

/// Elements per wave for an error this many times smaller.
fn next(elements_per_wave: usize, factor: f64) -> usize {
    let halvings = (factor.log2() / ORDER).ceil().max(1.0) as u32;
    (elements_per_wave << halvings.min(8)).min(FINEST)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_grid_is_where_the_error_should_be_reached() {
        for (factor, expected) in [(1.01, 8), (2.8, 8), (2.9, 16), (8.0, 16), (9.0, 32), (1e9, 256)] {
            assert_eq!(next(4, factor), expected, "{factor}");
        }
    }
}
