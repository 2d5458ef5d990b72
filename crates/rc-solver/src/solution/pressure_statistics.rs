//! Statistics of a stored pressure field, which need no gap and no mesh.

use rc_core::{Field, Histogram};

/// Bins of the distribution of pressures.
const BINS: usize = 40;

/// Statistics of a pressure field, in the unit of the field.
///
/// [`crate::Observables`] are better estimates where there is a solution. [`crate::StressDistribution`] resolves
/// contact edges below the element.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PressureStatistics {
    /// Elements along x and y of the field.
    pub grid: [usize; 2],
    /// Part of the elements with p > 0.
    pub area_fraction_cells: f64,
    /// Mean over the cell.
    pub mean_pressure: f64,
    /// Root mean square over the cell.
    pub rms_pressure: f64,
    /// Maximum pressure.
    pub max_pressure: f64,
    /// Mean over the contact, or 0 without contact.
    pub mean_contact_pressure: f64,
    /// Probability density of the pressure of elements in contact.
    pub distribution: Histogram,
}

impl PressureStatistics {
    /// Statistics of `pressure`.
    #[must_use]
    pub fn of(pressure: &Field) -> Self {
        let grid = pressure.grid();
        let in_contact = pressure.values().iter().copied().filter(|p| *p > 0.0);
        let fraction = in_contact.clone().count() as f64 / grid.len() as f64;
        let (mean, max) = (pressure.mean(), pressure.max());
        Self {
            grid: [grid.nx(), grid.ny()],
            area_fraction_cells: fraction,
            mean_pressure: mean,
            rms_pressure: pressure.rms(),
            max_pressure: max,
            mean_contact_pressure: if fraction > 0.0 { mean / fraction } else { 0.0 },
            distribution: Histogram::of(in_contact, 0.0, max, BINS),
        }
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;

    #[test]
    fn means_are_over_the_cell_and_over_the_contact() {
        let pressure = Field::new(Grid::square(2).expect("a grid"), vec![1.0, 0.0, 3.0, 0.0]).expect("four values");
        let statistics = PressureStatistics::of(&pressure);
        let PressureStatistics { area_fraction_cells, mean_pressure, max_pressure, mean_contact_pressure, .. } =
            statistics;
        let found = [area_fraction_cells, mean_pressure, max_pressure, mean_contact_pressure];
        assert!(found.iter().zip([0.5, 1.0, 3.0, 2.0]).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        let none = PressureStatistics::of(&Field::zeros(pressure.grid()));
        assert_eq!((none.mean_contact_pressure, none.distribution.density.iter().sum()), (0.0, 0.0));
    }
}
