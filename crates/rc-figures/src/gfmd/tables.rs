//! The tables of the comparison with the published reference.

use super::Gfmd;
use crate::table::{Rows, quantity, summary};
use crate::{Rule, Table};

impl Gfmd {
    pub(super) fn surface_table(&self) -> Table {
        let longest = self.params.longest as f64;
        let quantities = [
            quantity("longest waves in the cell", "1", longest),
            quantity("shortest waves in a longest one", "1", self.params.ratio as f64),
            quantity("elements along a side", "1", self.params.side as f64),
            quantity("rms slope", "1", self.rms_slope),
            quantity("energy of full contact", "E* longest wavelength", self.full_energy * longest),
        ];
        Table { name: "surface", ..summary(quantities, &[]) }
    }

    pub(super) fn areas_table(&self) -> Table {
        Rows::of(&self.points)
            .column("mean_pressure_over_e_star", |point| point.load)
            .within("area_fraction", Rule::relative(5e-4), |point| point.area.fraction)
            .within("area_error", Rule::of_scale(5e-4), |point| point.area.error)
            .within("area_fraction_by_counting", Rule::relative(5e-4), |point| point.area.cells)
            .column("published_first", |point| point.published.map(|one| one.first))
            .column("published_deviation", |point| point.published.map(|one| one.deviation))
            .column("published_second", |point| point.published.and_then(|one| one.second))
            .column("theory", |point| self.theory(point.load))
            .table("areas")
    }

    pub(super) fn curve_table(&self) -> Table {
        Rows::of(&self.points)
            .column("mean_pressure_over_e_star", |point| point.load)
            .within("kappa", Rule::relative(5e-4), |point| point.area.fraction * self.rms_slope / point.load)
            .within("mean_gap_over_rms_height", Rule::of_scale(1e-5), |point| point.mean_gap.0)
            .within("mean_gap_error", Rule::of_scale(5e-4), |point| point.mean_gap.1)
            .within("energy_over_full_contact", Rule::of_scale(1e-5), |point| point.energy)
            .table("curve")
    }

    pub(super) fn stress_table(&self) -> Table {
        let bins = self.distributions.iter().flat_map(|one| one.bins().map(move |bin| (one, bin)));
        Rows::of(bins)
            .column("mean_pressure_over_e_star", |(one, _)| one.load)
            .column("stress_over_e_star", |(_, (stress, _))| *stress)
            .within("density", Rule::of_scale(5e-4), |(_, (_, density))| *density)
            .within("theory", Rule::of_scale(1e-5), |(one, (stress, _))| one.theory.density(*stress))
            .table("stress")
    }
}
