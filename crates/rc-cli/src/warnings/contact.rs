//! Doubts about a contact before its solve: load and grid.

use rc_core::quantity::{digits, engineering};
use rc_core::{Boundary, HeightSource};
use rc_heights::BorderStep;
use rc_solver::Control;
use rc_sweep::Warning;
use rc_sweep::WarningCode::{Coarse, Load};

use super::surface::{Shape, border, steep};
use crate::scene::keys::KernelName;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::ContactSetup;

/// Mean pressure in E* above which strains are not small.
const LARGE_MEAN: f64 = 0.1;

/// Elements for the shortest wave below which error bars are not calibrated (`love`).
const FEW_ELEMENTS: f64 = 4.0;

/// The same for the kernel `spectral`, whose displacements are exact for each wave that the grid represents.
const FEW_ELEMENTS_SPECTRAL: f64 = 2.25;

/// All doubts that are known before the solve: about the surface, the load and the grid.
pub(crate) fn before(surface: &LoadedSurface, contact: &ContactSetup) -> Vec<Warning> {
    let mut found = surface.warnings.clone();
    let step = surface.map().map(|(map, _)| BorderStep::of(map));
    match surface.form {
        // Range and slope of what the shape is added to are doubted already.
        Some(form) => found.extend(steep(form.slope())),
        None => found.extend(shape(surface, contact, step).warnings()),
    }
    if let (Some((map, _)), Some(step), Boundary::Periodic) = (surface.map(), step, contact.boundary) {
        found.extend(border(map.grid(), step));
    }
    if let Control::MeanPressure(mean) = contact.control {
        found.extend(mean_pressure(mean, contact));
    }
    found.extend(coarse(&surface.source(0, contact.boundary), contact));
    found
}

/// Steepness and range of the surface.
fn shape(surface: &LoadedSurface, contact: &ContactSetup, step: Option<BorderStep>) -> Shape {
    // The border of a map that is not periodic is no slope of the surface.
    let jumps = step.is_some_and(|step| !step.is_periodic());
    let boundary = if jumps { Boundary::Free } else { contact.boundary };
    let [rms_height, rms_slope] = surface.height_and_slope(boundary);
    let cell = contact.units.cell();
    match surface.map() {
        Some((map, _)) => Shape { rms_slope, range: (map.max() - map.min()) * cell.side(), sides: cell.sides() },
        None => Shape::of_waves(rms_height * cell.side(), rms_slope, cell.sides()),
    }
}

/// A doubt about the mean pressure `mean` in E*.
pub(crate) fn mean_pressure(mean: f64, contact: &ContactSetup) -> Option<Warning> {
    let pascals = |value| engineering(contact.units.pascals(value), "Pa");
    let text = || {
        format!(
            "the mean pressure of {} is {} E* (E* = {}), where strains are not small; check the units of load and modulus",
            pascals(mean),
            digits(mean, 3),
            pascals(1.0)
        )
    };
    (mean > LARGE_MEAN).then(|| Warning::new(Load, text()))
}

/// A doubt about the grid of a surface of waves, unless a wanted error of the area chooses it.
fn coarse(source: &HeightSource<'_>, contact: &ContactSetup) -> Option<Warning> {
    let per_wave = source.elements_per_wave().filter(|_| !contact.grid_is_chosen)?;
    let enough = if contact.kernel == KernelName::Love { FEW_ELEMENTS } else { FEW_ELEMENTS_SPECTRAL };
    let text = || {
        format!(
            "the grid has {} elements for the shortest wave; error bars are calibrated from {enough} on, so give a finer --grid",
            digits(per_wave, 3)
        )
    };
    (per_wave < enough).then(|| Warning::new(Coarse, text()))
}
