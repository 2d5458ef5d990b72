//! The files of a flow: its picture, and the fluxes as arrays.

use rc_core::{Field, Grid};
use rc_leakage::Leakage;
use rc_plot::{Map, MapPicture, Palette, Shade, save_png};
use rc_sweep::files::{FileError, Staged};

use super::map_file::MapFile;
use crate::files::flow::{FLUX_FILES, PICTURE_FILE};
use crate::scene::resolve::ContactSetup;

/// Decades below and above the mean flux that the picture distinguishes.
const DECADES: (f64, f64) = (-4.0, 2.0);

/// Adds the picture and the fluxes along x and y to a result.
///
/// Fluxes are in m², for ΔP = 1 across the cell and 12 η = 1. Without a flow there are no files of fluxes.
pub(super) fn add(staged: &mut Staged, contact: &ContactSetup, leakage: &Leakage, grid: Grid) -> Result<(), FileError> {
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
    let magnitude = leakage.flux.as_ref().map_or_else(|| Field::zeros(grid), rc_leakage::Flux::magnitude);
    let mean = magnitude.mean();
    let title = match leakage.flow_axis() {
        Some(axis) => format!("Flow along {}: log10 of flux/mean; black: none", axis.name()),
        None => "Nothing percolates".to_owned(),
    };
    let shade = Shade::Decades { range: DECADES, palette: Palette::Viridis, unit: if mean > 0.0 { mean } else { 1.0 } };
    let picture = MapPicture(Map { title: &title, field: &magnitude, shade, side });
    staged.add(PICTURE_FILE, |path| save_png(&picture, path))
}
