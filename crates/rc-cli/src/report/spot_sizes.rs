//! Contact spots by size: a histogram of diameters, and a few numbers.

use std::f64::consts::PI;

use rc_core::{Boundary, EdgeBias, Field, Grid};
use rc_solver::ContactSpot;
use serde::Serialize;

use crate::files::result::ResultFolder;
use rc_core::quantity::{digits, engineering};

/// Number of bins for each factor of ten in the diameter.
const BINS_PER_DECADE: f64 = 8.0;

/// Minimum area of a spot, in elements.
const SMALLEST_SPOT: f64 = 0.1;

/// Relative error of a hardness that was a number of Pa.
const ROUNDING: f64 = 1e-12;

/// The data of the page about contact spots.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SpotSizes {
    rows: Vec<(&'static str, String)>,
    /// Ends of the bins (m). A diameter is that of a circle with the spot's area.
    diameters: Vec<f64>,
    counts: Vec<usize>,
    /// What is counted, as the name of the axis.
    size: &'static str,
    note: String,
}

impl SpotSizes {
    /// The spots of the stored fields.
    ///
    /// Edges are located in units of λ and E*. `None` without contact, or without values for the elements.
    pub(super) fn of_result(result: ResultFolder, bias: EdgeBias, boundary: Boundary) -> Option<Self> {
        if !result.is_of_elements() {
            return None;
        }
        let ResultFolder { side, e_star, pressure, mut gap, plastic_gap, summary, .. } = result;
        // Where the hardness limits the pressure, edges follow from the overlap that plastic flow has removed.
        for (gap, overlap) in gap.values_mut().iter_mut().zip(plastic_gap.iter().flat_map(Field::values)) {
            *gap -= overlap;
        }
        let hardness = summary.hardness.map_or(f64::INFINITY, |hardness| (1.0 - ROUNDING) * hardness / e_star);
        let over = |mut field: Field, unit: f64| {
            field.values_mut().iter_mut().for_each(|value| *value /= unit);
            field
        };
        let (pressure, gap) = (over(pressure, e_star), over(gap, side));
        let spots = ContactSpot::with_area([&pressure, &gap], hardness, bias, boundary, summary.area_fraction);
        Self::of(&spots, pressure.grid(), side)
    }

    /// The sizes of `spots`, which are ordered by size, largest first.
    ///
    /// They are on `grid` in a cell of side `side` along x (m). `None` without contact.
    pub(super) fn of(spots: &[ContactSpot], grid: Grid, side: f64) -> Option<Self> {
        let (largest, smallest) = (spots.first()?, spots.last()?);
        let (element, is_line) = ((grid.len() as f64).recip(), grid.ny() == 1);
        // The located area of a spot of one element may be too small for a diameter.
        let area = |spot: &ContactSpot| spot.area_fraction.max(SMALLEST_SPOT * element);
        let root_of_cell = side * grid.cell_ratio().sqrt();
        // A contact of a profile is a strip, of the whole depth.
        let across = |area: f64| if is_line { side * area } else { 2.0 * root_of_cell * (area / PI).sqrt() };
        let diameter = |spot: &ContactSpot| across(area(spot));
        let width = if is_line { side * element } else { root_of_cell * element.sqrt() };
        // The smallest spot is in the middle of the first bin.
        let low = diameter(smallest) / 10_f64.powf(0.5 / BINS_PER_DECADE);
        let bin = |spot: &ContactSpot| ((diameter(spot) / low).log10() * BINS_PER_DECADE) as usize;
        let mut counts = vec![0; bin(largest) + 1];
        for spot in spots {
            counts[bin(spot)] += 1;
        }
        Some(Self {
            rows: rows(spots, if is_line { "wide" } else { "across" }, diameter),
            diameters: (0..=counts.len()).map(|k| low * 10_f64.powf(k as f64 / BINS_PER_DECADE)).collect(),
            counts,
            size: if is_line { "width of a contact" } else { "diameter of a circle of the same area" },
            note: format!(
                "Spots are connected across edges of elements, and across the sides of a periodic cell. Their edges are located within \
                 elements. Spots narrower than an element, {}, are not resolved, so the number of small spots depends on the grid.",
                engineering(width, "m")
            ),
        })
    }
}

/// The numbers below the histogram.
///
/// There must be at least one spot, and the largest is the first.
fn rows(spots: &[ContactSpot], word: &str, diameter: impl Fn(&ContactSpot) -> f64) -> Vec<(&'static str, String)> {
    let percent = |part: f64| format!("{} %", digits(100.0 * part, 3));
    let across = |spot: &ContactSpot| format!("{} {word}", engineering(diameter(spot), "m"));
    let area: f64 = spots.iter().map(|spot| spot.area_fraction).sum();
    let load: f64 = spots.iter().map(|spot| spot.mean_pressure).sum();
    let largest = spots[0];
    let parts = (percent(largest.area_fraction / area), percent(largest.mean_pressure / load));
    vec![
        ("spots", spots.len().to_string()),
        ("spots of one element", spots.iter().filter(|spot| spot.elements == 1).count().to_string()),
        ("mean area", format!("{} of the cell", percent(area / spots.len() as f64))),
        ("largest", format!("{}, {} of the contact, {} of the load", across(&largest), parts.0, parts.1)),
        ("median", across(&spots[spots.len() / 2])),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spot_is_in_the_bin_of_its_diameter() {
        let grid = Grid::square(16).expect("a grid");
        let spot = |elements: usize, area: f64| ContactSpot {
            elements,
            area_fraction: area / grid.len() as f64,
            perimeter: 0.0,
            euler_number: 1.0,
            mean_pressure: 1e-3,
        };
        let sizes = SpotSizes::of(&[spot(16, 15.0), spot(1, 0.6), spot(1, -0.1)], grid, 1.6).expect("contact");
        assert_eq!((sizes.counts.iter().sum::<usize>(), sizes.rows[1].1.as_str()), (3, "2"));
        for area in [15.0, 0.6, SMALLEST_SPOT] {
            let diameter = 2.0 * (area * 0.01 / PI).sqrt();
            let bin = sizes.diameters.partition_point(|&end| end <= diameter) - 1;
            assert_eq!(sizes.counts[bin], 1, "{area} elements: {sizes:?}");
        }
        assert!(SpotSizes::of(&[], grid, 1.0).is_none());
        let line = Grid::new(100, 1).expect("a row");
        let widths =
            SpotSizes::of(&[ContactSpot { area_fraction: 0.05, ..spot(5, 5.0) }], line, 1e-3).expect("contact");
        assert!(widths.rows[3].1.starts_with("50 µm wide") && widths.note.contains(", 10 µm, are not"), "{widths:?}");
    }
}
