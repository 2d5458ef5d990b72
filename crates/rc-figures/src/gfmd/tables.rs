//! The tables of the comparison with the published reference.

use super::{Gfmd, Point};
use crate::{Rule, Table, number};

impl Gfmd {
    pub(super) fn surface_table(&self) -> Table {
        let row = |quantity: &str, unit: &str, value: f64| vec![quantity.to_owned(), unit.to_owned(), number(value)];
        let longest = self.params.longest as f64;
        let rows = [
            row("longest waves in the cell", "1", longest),
            row("shortest waves in a longest one", "1", self.params.ratio as f64),
            row("elements along a side", "1", self.params.side as f64),
            row("rms slope", "1", self.rms_slope),
            row("energy of full contact", "E* longest wavelength", self.full_energy * longest),
        ];
        Table::new("surface", &["quantity", "unit", "value"], rows)
    }

    pub(super) fn areas_table(&self) -> Table {
        let header = [
            "mean_pressure_over_e_star",
            "area_fraction",
            "area_error",
            "area_fraction_by_counting",
            "published_first",
            "published_deviation",
            "published_second",
            "theory",
        ];
        let rows = self.points.iter().map(|point| {
            let published = point.published;
            let or_none = |value: Option<f64>| value.map_or_else(String::new, number);
            let Point { load, area, .. } = *point;
            vec![
                number(load),
                number(area.fraction),
                number(area.error),
                number(area.cells),
                or_none(published.map(|one| one.first)),
                or_none(published.map(|one| one.deviation)),
                or_none(published.and_then(|one| one.second)),
                number(self.theory(load)),
            ]
        });
        Table::new("areas", &header, rows)
            .column("area_fraction", Rule::relative(5e-4))
            .column("area_error", Rule::of_scale(5e-4))
            .column("area_fraction_by_counting", Rule::relative(5e-4))
    }

    pub(super) fn curve_table(&self) -> Table {
        let header = [
            "mean_pressure_over_e_star",
            "kappa",
            "mean_gap_over_rms_height",
            "mean_gap_error",
            "energy_over_full_contact",
        ];
        let rows = self.points.iter().map(|point| {
            let kappa = point.area.fraction * self.rms_slope / point.load;
            [point.load, kappa, point.mean_gap.0, point.mean_gap.1, point.energy].map(number).to_vec()
        });
        Table::new("curve", &header, rows)
            .column("kappa", Rule::relative(5e-4))
            .column("mean_gap_over_rms_height", Rule::of_scale(1e-5))
            .column("mean_gap_error", Rule::of_scale(5e-4))
            .column("energy_over_full_contact", Rule::of_scale(1e-5))
    }

    pub(super) fn stress_table(&self) -> Table {
        let header = ["mean_pressure_over_e_star", "stress_over_e_star", "density", "theory"];
        let rows = self.distributions.iter().flat_map(|one| {
            let middles = one.stress.edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1]));
            middles
                .zip(&one.stress.density)
                .map(|(stress, density)| [one.load, stress, *density, one.theory.density(stress)].map(number).to_vec())
        });
        Table::new("stress", &header, rows)
            .column("density", Rule::of_scale(5e-4))
            .column("theory", Rule::of_scale(1e-5))
    }
}
