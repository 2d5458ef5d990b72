//! The tables of the Challenge's surface, in its units.

use super::{CELL_UM, Challenge, E_STAR_MPA, Solved};
use crate::table::{Rows, quantity, summary};
use crate::{Rule, Table};

/// Lower end of the first bin of patch areas, as a power of ten.
///
/// Areas are relative to the cell. Bins per decade and their number follow.
const FIRST_DECADE: i32 = -9;
const PER_DECADE: i32 = 3;
const N_BINS: i32 = 27;

/// The rows with the columns of a solved contact, in the units of the Challenge.
pub(super) fn solved<T>(rows: Rows<T>, of: impl Fn(&T) -> (f64, &Solved)) -> Rows<T> {
    let (area, error) = (Rule::relative(5e-4), Rule::of_scale(5e-4));
    rows.column("mean_pressure_mpa", |item| of(item).0 * E_STAR_MPA)
        .within("area_fraction", area, |item| of(item).1.area.fraction)
        .within("area_error", error, |item| of(item).1.area.error)
        .within("area_fraction_by_counting", area, |item| of(item).1.area.cells)
        .within("mean_gap_um", Rule::of_scale(1e-5), |item| of(item).1.observables.mean_gap * CELL_UM)
        .within("mean_gap_error_um", error, |item| of(item).1.observables.mean_gap_error * CELL_UM)
        .within("stiffness_mpa_per_um", error, |item| of(item).1.stiffness * E_STAR_MPA / CELL_UM)
        .within("elements_in_contact", Rule::count(1.0), |item| of(item).1.n_in_contact)
}

impl Challenge {
    pub(super) fn surface_table(&self) -> Table {
        let quantities = [
            quantity("cell side", "µm", CELL_UM),
            quantity("shortest wavelength", "µm", CELL_UM / self.waves as f64),
            quantity("rms height", "µm", self.rms_height * CELL_UM),
            quantity("rms slope", "1", self.rms_slope),
            quantity("elements along a side", "1", self.side as f64),
            quantity("elements per shortest wave", "1", self.side as f64 / self.waves as f64),
        ];
        Table { name: "surface", ..summary(quantities, &[]) }
    }

    pub(super) fn curve_table(&self) -> Table {
        solved(Rows::of(&self.points), |point| (point.load, &point.solved))
            .within("patches", Rule::count(0.0), |point| point.patches.len())
            .within("largest_patch_fraction", Rule::of_scale(5e-4), |point| {
                point.patches.first().map_or(0.0, |largest| largest / point.solved.area.fraction)
            })
            .table("curve")
    }

    /// Table of the patches in each bin of areas.
    ///
    /// It has their number and their fraction of the contact area.
    pub(super) fn patches_table(&self) -> Table {
        let end = |bin: i32| 10_f64.powf(f64::from(FIRST_DECADE) + f64::from(bin) / f64::from(PER_DECADE));
        let bins = self.points.iter().flat_map(|point| {
            (0..N_BINS).map(move |bin| {
                let inside = point.patches.iter().filter(|area| (end(bin)..end(bin + 1)).contains(*area));
                (point, bin, inside.clone().count(), inside.sum::<f64>())
            })
        });
        let cell = CELL_UM * CELL_UM;
        Rows::of(bins)
            .column("mean_pressure_mpa", |bin| bin.0.load * E_STAR_MPA)
            .column("patch_area_from_um2", |bin| end(bin.1) * cell)
            .column("patch_area_to_um2", |bin| end(bin.1 + 1) * cell)
            .within("patches", Rule::count(0.0), |bin| bin.2)
            .within("part_of_contact_area", Rule::of_count("patches", 0.0), |bin| bin.3 / bin.0.solved.area.fraction)
            .table("patches")
    }
}
