//! Contact spots by size: a histogram over diameters, and a few numbers.

use std::f64::consts::PI;

use rc_core::Field;
use serde::Serialize;

use crate::quantity::{digits, engineering};
use crate::spots::{Spot, contact_spots};

/// Bins for each factor of ten in the diameter.
const BINS_PER_DECADE: f64 = 8.0;

/// What the page says of contact spots.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SpotSizes {
    rows: Vec<(&'static str, String)>,
    /// Ends of bins: diameters of circles of the same area (m).
    diameters: Vec<f64>,
    counts: Vec<usize>,
    note: String,
}

impl SpotSizes {
    /// Of a pressure field on a cell of this side (m); `None` without contact.
    pub(super) fn of(pressure: &Field, side: f64) -> Option<Self> {
        let spots = contact_spots(pressure);
        let (largest, smallest) = (spots.first()?, spots.last()?);
        let element = side * side / pressure.grid().len() as f64;
        let diameter = |spot: &Spot| 2.0 * (spot.elements as f64 * element / PI).sqrt();
        // The smallest spot is in the middle of the first bin.
        let low = diameter(smallest) / 10_f64.powf(0.5 / BINS_PER_DECADE);
        let bin = |spot: &Spot| ((diameter(spot) / low).log10() * BINS_PER_DECADE) as usize;
        let mut counts = vec![0; bin(largest) + 1];
        for spot in &spots {
            counts[bin(spot)] += 1;
        }
        Some(Self {
            rows: rows(&spots, pressure.grid().len(), diameter),
            diameters: (0..=counts.len()).map(|k| low * 10_f64.powf(k as f64 / BINS_PER_DECADE)).collect(),
            counts,
            note: format!(
                "Spots are joined across edges of elements, and across the sides of the cell. The smallest are as large as the \
                 elements, {} wide: how many there are depends on the grid.",
                engineering(element.sqrt(), "m")
            ),
        })
    }
}

/// The numbers below the histogram; there is at least one spot, and the largest is the first.
fn rows(spots: &[Spot], n_elements: usize, diameter: impl Fn(&Spot) -> f64) -> Vec<(&'static str, String)> {
    let percent = |part: f64| format!("{} %", digits(100.0 * part, 3));
    let across = |spot: &Spot| format!("{} across", engineering(diameter(spot), "m"));
    let elements: usize = spots.iter().map(|spot| spot.elements).sum();
    let load: f64 = spots.iter().map(|spot| spot.pressure).sum();
    let mean = elements as f64 / spots.len() as f64 / n_elements as f64;
    let largest = spots[0];
    let parts = (percent(largest.elements as f64 / elements as f64), percent(largest.pressure / load));
    vec![
        ("spots", spots.len().to_string()),
        ("of them single elements", spots.iter().filter(|spot| spot.elements == 1).count().to_string()),
        ("mean area", format!("{} of the cell", percent(mean))),
        ("largest", format!("{}, {} of the contact, {} of the load", across(&largest), parts.0, parts.1)),
        ("median", across(&spots[spots.len() / 2])),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rc_core::Grid;

    #[test]
    fn every_spot_is_in_the_bin_of_its_diameter() {
        // One element, and a square of sixteen.
        let pressure = Field::from_fn(Grid::square(16).expect("a grid"), |x, y| {
            let square = x < 0.25 && y < 0.25;
            let alone = (0.5..0.56).contains(&x) && (0.5..0.56).contains(&y);
            if square || alone { 2.0 } else { 0.0 }
        });
        let sizes = SpotSizes::of(&pressure, 1.6).expect("contact");
        assert_eq!((sizes.counts.iter().sum::<usize>(), sizes.rows[1].1.as_str()), (2, "1"));
        for elements in [1.0, 16.0] {
            let diameter = 2.0 * (elements * 0.01 / PI).sqrt();
            let bin = sizes.diameters.partition_point(|&end| end <= diameter) - 1;
            assert_eq!(sizes.counts[bin], 1, "{elements} elements: {sizes:?}");
        }
        assert!(SpotSizes::of(&Field::zeros(pressure.grid()), 1.0).is_none());
    }
}
