//! The files of a flow: its picture, and the fluxes as arrays.

use std::convert::Infallible;

use rc_core::Field;
use rc_plot::{Map, MapPicture, Palette, Shade, WALL, save_png};
use rc_solver::Solution;
use rc_sweep::files::{FileError, Staged};

use super::leakage::SolvedFlow;
use super::map_file::MapFile;
use crate::files::flow::{FLUX_FILES, PICTURE_FILE};
use crate::scene::resolve::ContactSetup;

/// Decades below and above the mean flux that the picture distinguishes.
const DECADES: (f64, f64) = (-4.0, 2.0);

/// Adds the picture and the fluxes along x and y to a result.
///
/// Fluxes are in m², for ΔP = 1 across the cell and 12 η = 1. Without a flow there are no files of fluxes.
pub(super) fn add(
    staged: &mut Staged,
    contact: &ContactSetup,
    flow: &SolvedFlow,
    solution: &Solution<'_>,
) -> Result<(), FileError> {
    let (leakage, grid) = (&flow.leakage, solution.grid());
    let side = contact.units.cell().side();
    if let Some(flux) = &leakage.flux {
        for (name, field) in FLUX_FILES.into_iter().zip([&flux.x, &flux.y]) {
            staged.add(name, |path| {
                let mut file = MapFile::create(path, grid, &contact.keys, side * side)?;
                file.take(field.values())?;
                file.finish()
            })?;
        }
    }
    let mut magnitude = leakage.flux.as_ref().map_or_else(|| Field::zeros(grid), rc_leakage::Flux::magnitude);
    let mean = magnitude.mean();
    mark_walls(&mut magnitude, solution);
    let title = match leakage.flow_axis() {
        Some(axis) => format!("Flow along {}: log10 of flux/mean", axis.name()),
        None => "Nothing percolates".to_owned(),
    };
    let critical = leakage.flow_axis().and_then(|axis| leakage.flows[axis.index()].constriction);
    let ring = critical.map(|place| [place.at.x, place.at.y / grid.cell_ratio()]);
    let unit = if mean > 0.0 { mean } else { 1.0 };
    let shade = Shade::Flow { range: DECADES, palette: Palette::Viridis, unit, ring };
    let picture = MapPicture(Map { title: &title, field: &magnitude, shade, side });
    staged.add(PICTURE_FILE, |path| save_png(&picture, path))
}

/// Gives the elements in contact, where nothing flows, the value that the picture draws as contact.
fn mark_walls(magnitude: &mut Field, solution: &Solution<'_>) {
    let nx = solution.grid().nx();
    let values = magnitude.values_mut();
    let Ok(()) = solution.pressure_rows(|first, rows| {
        let flux = &mut values[first * nx..first * nx + rows.len()];
        flux.iter_mut().zip(rows).filter(|(_, pressure)| **pressure > 0.0).for_each(|(flux, _)| *flux = WALL);
        Ok::<_, Infallible>(())
    });
}
