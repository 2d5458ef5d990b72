//! The tables of the Challenge's surface, in its units.

use super::{CELL_UM, Challenge, E_STAR_MPA, Point, Solved};
use crate::{Rule, Table, number};

/// Lower end of the first bin of patch areas, as a power of ten.
///
/// Areas are relative to the cell. Bins per decade and their number follow.
const FIRST_DECADE: i32 = -9;
const PER_DECADE: i32 = 3;
const N_BINS: i32 = 27;

/// Columns of a solved contact in the units of the Challenge.
pub(super) const SOLVED: [&str; 8] = [
    "mean_pressure_mpa",
    "area_fraction",
    "area_error",
    "area_fraction_by_counting",
    "mean_gap_um",
    "mean_gap_error_um",
    "stiffness_mpa_per_um",
    "elements_in_contact",
];

impl Solved {
    /// The cells of [`SOLVED`].
    pub(super) fn cells(&self, load: f64) -> Vec<String> {
        let Self { area, observables, stiffness, n_in_contact, .. } = self;
        let mut cells: Vec<String> = [
            load * E_STAR_MPA,
            area.fraction,
            area.error,
            area.cells,
            observables.mean_gap * CELL_UM,
            observables.mean_gap_error * CELL_UM,
            stiffness * E_STAR_MPA / CELL_UM,
        ]
        .map(number)
        .to_vec();
        cells.push(n_in_contact.to_string());
        cells
    }
}

impl Challenge {
    pub(super) fn surface_table(&self) -> Table {
        let row = |quantity: &str, unit: &str, value: f64| vec![quantity.to_owned(), unit.to_owned(), number(value)];
        let rows = [
            row("cell side", "µm", CELL_UM),
            row("shortest wavelength", "µm", CELL_UM / self.waves as f64),
            row("rms height", "µm", self.rms_height * CELL_UM),
            row("rms slope", "1", self.rms_slope),
            row("elements along a side", "1", self.side as f64),
            row("elements per shortest wave", "1", self.side as f64 / self.waves as f64),
        ];
        Table::new("surface", &["quantity", "unit", "value"], rows)
    }

    pub(super) fn curve_table(&self) -> Table {
        let mut header = SOLVED.to_vec();
        header.extend(["patches", "largest_patch_fraction"]);
        let rows = self.points.iter().map(|Point { load, solved, patches }| {
            let mut cells = solved.cells(*load);
            let largest = patches.first().map_or(0.0, |largest| largest / solved.area.fraction);
            cells.extend([patches.len().to_string(), number(largest)]);
            cells
        });
        Table::new("curve", &header, rows)
            .column("area_fraction", Rule::relative(5e-4))
            .column("area_error", Rule::of_scale(5e-4))
            .column("area_fraction_by_counting", Rule::relative(5e-4))
            .column("mean_gap_um", Rule::of_scale(1e-5))
            .column("mean_gap_error_um", Rule::of_scale(5e-4))
            .column("stiffness_mpa_per_um", Rule::of_scale(5e-4))
            .column("elements_in_contact", Rule::count(1.0))
            .column("patches", Rule::count(0.0))
            .column("largest_patch_fraction", Rule::of_scale(5e-4))
    }

    /// Table of the patches in each bin of areas.
    ///
    /// It has their number and their fraction of the contact area.
    pub(super) fn patches_table(&self) -> Table {
        let header =
            ["mean_pressure_mpa", "patch_area_from_um2", "patch_area_to_um2", "patches", "part_of_contact_area"];
        let cell = CELL_UM * CELL_UM;
        let rows = self.points.iter().flat_map(|Point { load, solved, patches }| {
            let end = |bin: i32| 10_f64.powf(f64::from(FIRST_DECADE) + f64::from(bin) / f64::from(PER_DECADE));
            (0..N_BINS).map(move |bin| {
                let (from, to) = (end(bin), end(bin + 1));
                let inside = patches.iter().filter(|area| (from..to).contains(*area));
                let (n, sum) = (inside.clone().count(), inside.sum::<f64>());
                let [load, from, to] = [load * E_STAR_MPA, from * cell, to * cell].map(number);
                vec![load, from, to, n.to_string(), number(sum / solved.area.fraction)]
            })
        });
        Table::new("patches", &header, rows)
            .column("patches", Rule::count(0.0))
            .column("part_of_contact_area", Rule::of_count("patches", 0.0))
    }
}
