//! The tables of Fig. 8.

use rc_theory::persson::Persson;

use super::{Bin, Curve, DECADES, Fig8};
use crate::fit::Sample;
use crate::{Rule, Table, number};

impl Fig8 {
    pub(super) fn summary(&self) -> Table {
        let header = ["quantity", "unit", "waves", "value", "standard_error", "paper"];
        let rows = self.curves.iter().enumerate().flat_map(|(i, curve)| {
            let row = |quantity: &str, unit: &str, value: f64, error: Option<f64>, paper: Option<f64>| {
                let [error, paper] = [error, paper].map(|value| value.map_or_else(String::new, number));
                vec![quantity.to_owned(), unit.to_owned(), curve.waves.to_string(), number(value), error, paper]
            };
            let sample = |quantity: &str, unit: &str, sample: Sample, paper: Option<f64>| {
                row(quantity, unit, sample.mean, Some(sample.error()), paper)
            };
            let printed = self.printed.map(|printed| printed[i]);
            let implied = printed.and_then(|area| Persson::from_area_fraction(self.load, area).ok());
            let needed = Persson::from_area_fraction(self.load, curve.area.mean).map_or(f64::NAN, |fit| fit.lambda);
            let (peak_stress, peak) = curve.peak();
            let first = curve.bins.first().map_or((f64::NAN, f64::NAN), |bin| (bin.density.mean, bin.of_elements));
            let slope = |decade, density: fn(&Bin) -> f64| curve.small_slope(decade, density);
            let [tenth, twenty_fifth] = DECADES;
            vec![
                sample("area fraction", "A0", curve.area, printed),
                sample("integral of P", "A0", curve.integral, printed),
                sample("mean stress from P", "E*", curve.mean_stress, None),
                row(
                    "fitted Lambda",
                    "E*^2",
                    curve.fit.lambda,
                    Some(curve.lambda.error()),
                    implied.map(|fit| fit.lambda),
                ),
                row("Lambda from the area fraction", "E*^2", needed, None, implied.map(|fit| fit.lambda)),
                row("fitted Lambda over slope^2/8", "1", curve.lambda_over_theory(), None, None),
                row("erf(load/2 sqrt(Lambda)) of the fit", "A0", curve.fit.area_fraction(), None, printed),
                row("stress of the peak", "E*", peak_stress, None, None),
                row("peak of P", "1/E*", peak, None, None),
                row("first bin over peak", "1", first.0 / peak, None, None),
                row("first bin over peak by elements", "1", first.1 / peak, None, None),
                row("slope from 0.01 to 0.1 of the peak stress", "1", slope(tenth, |bin| bin.density.mean), None, None),
                row("slope from 0.004 to 0.04", "1", slope(twenty_fifth, |bin| bin.density.mean), None, None),
                row("slope by elements from 0.01 to 0.1", "1", slope(tenth, |bin| bin.of_elements), None, None),
            ]
        });
        let table = Table::new("summary", &header, rows.chain(self.refined_rows()))
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

    /// Rows that compare counting with interpolation on finer and finer elements.
    fn refined_rows(&self) -> impl Iterator<Item = Vec<String>> {
        self.refined.iter().flat_map(|(side, curve)| {
            let first = curve.bins.first().map_or(f64::NAN, |bin| bin.of_elements / curve.peak().1);
            let values = [
                curve.small_slope(DECADES[0], |bin| bin.density.mean),
                curve.small_slope(DECADES[0], |bin| bin.of_elements),
                first,
            ];
            let row = |(name, value): (String, f64)| {
                vec![name, "1".to_owned(), curve.waves.to_string(), number(value), String::new(), String::new()]
            };
            refined_names(*side).into_iter().zip(values).map(row).collect::<Vec<_>>()
        })
    }

    pub(super) fn bins_table(&self) -> Table {
        let header = ["waves", "stress_over_e_star", "density", "standard_deviation", "elements", "by_elements", "fit"];
        let line = |curve: &Curve, bin: &Bin| {
            let fit = number(curve.fit.density(bin.stress));
            [curve.waves.to_string()].into_iter().chain(bin.cells()).chain([fit]).collect::<Vec<_>>()
        };
        let line = &line;
        let rows = self.curves.iter().flat_map(|curve| curve.bins.iter().map(move |bin| line(curve, bin)));
        compared(Table::new("bins", &header, rows), 2.0).column("fit", Rule::of_scale(1e-4))
    }

    pub(super) fn small_table(&self) -> Table {
        let header = ["waves", "stress_over_e_star", "density", "standard_deviation", "elements", "by_elements"];
        let line =
            |curve: &Curve, bin: &Bin| [curve.waves.to_string()].into_iter().chain(bin.cells()).collect::<Vec<_>>();
        let line = &line;
        let rows = self.curves.iter().flat_map(|curve| curve.small.iter().map(move |bin| line(curve, bin)));
        // The narrowest bins are hardly wider than the error of a pressure, so all of their elements may change.
        compared(Table::new("small", &header, rows), 3.0)
    }

    /// Table of the approach to zero stress by counting, for one realisation.
    ///
    /// It has finer and finer elements.
    pub(super) fn refined_table(&self) -> Table {
        let header = ["waves", "elements_per_wave", "stress_over_e_star", "density", "elements", "by_elements"];
        let rows = self.refined.iter().flat_map(|(side, curve)| {
            let line = |bin: &Bin| {
                let [stress, density, _, elements, of_elements] = bin.cells();
                vec![curve.waves.to_string(), side.to_string(), stress, density, elements, of_elements]
            };
            curve.small.iter().map(line).collect::<Vec<_>>()
        });
        Table::new("refined", &header, rows)
            .column("density", Rule::of_scale(5e-4))
            .column("elements", Rule::count(3.0))
            .column("by_elements", Rule::of_count("elements", 3.0))
    }
}

/// Names of the quantities in [`Fig8::refined_rows`].
fn refined_names(elements_per_wave: usize) -> [String; 3] {
    ["slope from 0.01 to 0.1", "slope by elements from 0.01 to 0.1", "first bin over peak by elements"]
        .map(|name| format!("{name} with {elements_per_wave} elements per wave"))
}

impl Bin {
    fn cells(&self) -> [String; 5] {
        let Self { stress, density, elements, of_elements } = *self;
        [number(stress), number(density.mean), number(density.deviation), elements.to_string(), number(of_elements)]
    }
}

/// Adds the comparison rules of tables of bins.
///
/// Elements cross the ends of bins at random. A bin of n elements may differ by `part`·√n.
fn compared(table: Table, part: f64) -> Table {
    table
        .column("density", Rule::of_scale(2e-4))
        .column("standard_deviation", Rule::of_scale(8e-4))
        .column("elements", Rule::count(part))
        .column("by_elements", Rule::of_count("elements", part))
}
