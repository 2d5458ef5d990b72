//! The tables of Fig. 8.

use rc_theory::persson::Persson;

use super::{Bin, Curve, DECADES, Fig8};
use crate::table::{Quantity, Rows, quantity, sampled, summary};
use crate::{Rule, Table};

impl Fig8 {
    pub(super) fn summary(&self) -> Table {
        let of_curves = self
            .curves
            .iter()
            .enumerate()
            .flat_map(|(i, curve)| curve.quantities(self.load, self.printed.map(|printed| printed[i])));
        let table = summary(of_curves.chain(self.refined_quantities()), &["waves", "standard_error", "paper"])
            .column("value", Rule::relative(1e-4))
            .column("standard_error", Rule::of_value(1e-4))
            // These are in units of the peak, and powers of σ, from bins of few elements.
            .row("first bin over peak", Rule::absolute(2e-4))
            .row("first bin over peak by elements", Rule::absolute(5e-3))
            .row("slope from 0.01 to 0.1 of the peak stress", Rule::absolute(2e-3))
            .row("slope from 0.004 to 0.04", Rule::absolute(2e-3))
            // Elements at edges in the lowest bins flip. Sets of vector instructions gave differences of 5e-3.
            .row("slope by elements from 0.01 to 0.1", Rule::absolute(1e-2));
        self.refined.iter().fold(table, |table, (side, _)| {
            let rule = [Rule::absolute(4e-3), Rule::absolute(2e-2), Rule::absolute(1e-2)];
            refined_names(*side).iter().zip(rule).fold(table, |table, (name, rule)| table.row(name, rule))
        })
    }

    /// Comparisons of counting with interpolation on finer and finer elements.
    fn refined_quantities(&self) -> impl Iterator<Item = Quantity> {
        self.refined.iter().flat_map(|(side, curve)| {
            let values = [
                curve.small_slope(DECADES[0], |bin| bin.density.mean),
                curve.small_slope(DECADES[0], |bin| bin.of_elements),
                curve.first_over_peak(|bin| bin.of_elements),
            ];
            let named = refined_names(*side).into_iter().zip(values);
            named.map(|(name, value)| quantity(name, "1", value).waves(curve.waves))
        })
    }

    pub(super) fn bins_table(&self) -> Table {
        let bins = self.curves.iter().flat_map(|curve| curve.bins.iter().map(move |bin| (curve, bin)));
        let rows = binned(Rows::of(bins).column("waves", |(curve, _)| curve.waves), 2.0);
        rows.within("fit", Rule::of_scale(1e-4), |(curve, bin)| curve.fit.density(bin.stress)).table("bins")
    }

    pub(super) fn small_table(&self) -> Table {
        let bins = self.curves.iter().flat_map(|curve| curve.small.iter().map(move |bin| (curve, bin)));
        // The narrowest bins are hardly wider than the error of a pressure, so all of their elements may change.
        binned(Rows::of(bins).column("waves", |(curve, _)| curve.waves), 3.0).table("small")
    }

    /// Table of the approach to zero stress by counting, for one realisation.
    ///
    /// It has finer and finer elements.
    pub(super) fn refined_table(&self) -> Table {
        let bins = self.refined.iter().flat_map(|(side, curve)| curve.small.iter().map(move |bin| (side, curve, bin)));
        Rows::of(bins)
            .column("waves", |(_, curve, _)| curve.waves)
            .column("elements_per_wave", |(side, ..)| **side)
            .column("stress_over_e_star", |(.., bin)| bin.stress)
            .within("density", Rule::of_scale(5e-4), |(.., bin)| bin.density.mean)
            .within("elements", Rule::count(3.0), |(.., bin)| bin.elements)
            .within("by_elements", Rule::of_count("elements", 3.0), |(.., bin)| bin.of_elements)
            .table("refined")
    }
}

/// Names of the quantities in [`Fig8::refined_quantities`].
fn refined_names(elements_per_wave: usize) -> [String; 3] {
    ["slope from 0.01 to 0.1", "slope by elements from 0.01 to 0.1", "first bin over peak by elements"]
        .map(|name| format!("{name} with {elements_per_wave} elements per wave"))
}

/// Adds the columns of tables of bins.
///
/// Elements cross the ends of bins at random. A bin of n elements may differ by `part`·√n.
fn binned<'a>(rows: Rows<(&'a Curve, &'a Bin)>, part: f64) -> Rows<(&'a Curve, &'a Bin)> {
    rows.column("stress_over_e_star", |(_, bin)| bin.stress)
        .within("density", Rule::of_scale(2e-4), |(_, bin)| bin.density.mean)
        .within("standard_deviation", Rule::of_scale(8e-4), |(_, bin)| bin.density.deviation)
        .within("elements", Rule::count(part), |(_, bin)| bin.elements)
        .within("by_elements", Rule::of_count("elements", part), |(_, bin)| bin.of_elements)
}

impl Curve {
    fn quantities(&self, load: f64, printed: Option<f64>) -> Vec<Quantity> {
        let implied = printed.and_then(|area| Persson::from_area_fraction(load, area).ok()).map(|fit| fit.lambda);
        let needed = Persson::from_area_fraction(load, self.area.mean).map_or(f64::NAN, |fit| fit.lambda);
        let (peak_stress, peak) = self.peak();
        let one = |name: &str, value: f64| quantity(name, "1", value);
        let [tenth, twenty_fifth] = DECADES;
        let (interpolated, counted) = (|bin: &Bin| bin.density.mean, |bin: &Bin| bin.of_elements);
        let quantities = vec![
            sampled("area fraction", "A0", self.area).paper(printed),
            sampled("integral of P", "A0", self.integral).paper(printed),
            sampled("mean stress from P", "E*", self.mean_stress),
            quantity("fitted Lambda", "E*^2", self.fit.lambda).error(self.lambda.error()).paper(implied),
            quantity("Lambda from the area fraction", "E*^2", needed).paper(implied),
            one("fitted Lambda over slope^2/8", self.lambda_over_theory()),
            quantity("erf(load/2 sqrt(Lambda)) of the fit", "A0", self.fit.area_fraction()).paper(printed),
            quantity("stress of the peak", "E*", peak_stress),
            quantity("peak of P", "1/E*", peak),
            one("first bin over peak", self.first_over_peak(interpolated)),
            one("first bin over peak by elements", self.first_over_peak(counted)),
            one("slope from 0.01 to 0.1 of the peak stress", self.small_slope(tenth, interpolated)),
            one("slope from 0.004 to 0.04", self.small_slope(twenty_fifth, interpolated)),
            one("slope by elements from 0.01 to 0.1", self.small_slope(tenth, counted)),
        ];
        quantities.into_iter().map(|one| one.waves(self.waves)).collect()
    }

    /// Ratio of P in the first bin to its peak.
    fn first_over_peak(&self, density: fn(&Bin) -> f64) -> f64 {
        self.bins.first().map_or(f64::NAN, |bin| density(bin) / self.peak().1)
    }
}
