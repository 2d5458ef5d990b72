//! Statistics of the measured points of a map.

use rc_core::{Field, Histogram};

use crate::AreaParameters;

/// Number of bins of the distribution of heights.
const BINS: usize = 40;

/// Maximum mean, relative to the rms height, that counts as rounding of a zero mean.
const ROUNDING: f64 = 1e-12;

/// Statistics of a height map. All lengths are in the unit of its sides.
#[derive(Clone, Debug, PartialEq)]
pub struct MapStatistics {
    /// Mean height. It is 0 if it is only rounding.
    pub mean: f64,
    /// Minimum height.
    pub min: f64,
    /// Maximum height.
    pub max: f64,
    /// Probability density of heights about the mean.
    pub distribution: Histogram,
    /// Parameters of ISO 25178-2, including skewness and kurtosis, from differences of neighbours.
    pub parameters: AreaParameters,
}

impl MapStatistics {
    /// Statistics of `heights`, which are in units of the side of the cell along x, and `NaN` where nothing was
    /// measured.
    ///
    /// `side` is the length of that side.
    #[must_use]
    pub fn of(heights: &Field, side: f64) -> Self {
        let parameters = AreaParameters::of(heights, [1.0, heights.grid().cell_ratio()]);
        let mean = Some(parameters.mean).filter(|mean| mean.abs() > ROUNDING * parameters.sq).unwrap_or(0.0);
        let (min, max) = (heights.min(), heights.max());
        let measured = heights.values().iter().filter(|height| !height.is_nan());
        let about_mean = measured.map(|height| (height - mean) * side);
        let distribution = Histogram::of(about_mean, (min - mean) * side, (max - mean) * side, BINS);
        Self { mean: mean * side, min: min * side, max: max * side, distribution, parameters: parameters.scaled(side) }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_core::Grid;

    use super::*;

    #[test]
    fn a_wave_has_the_statistics_of_a_wave() {
        let (amplitude, waves, side) = (1e-3, 4.0, 2.0);
        let field = Field::from_fn(Grid::square(64).expect("a grid"), |at| amplitude * (TAU * waves * at.x).cos());
        let statistics = MapStatistics::of(&field, side);
        assert!((statistics.parameters.sku / 1.5 - 1.0).abs() < 1e-9, "kurtosis {}", statistics.parameters.sku);
        assert!(statistics.parameters.ssk.abs() < 1e-12, "skewness {}", statistics.parameters.ssk);
        // Crests are between the centres of two elements.
        let highest = amplitude * side * (TAU * waves * 0.5 / 64.0).cos();
        assert!((statistics.distribution.high / highest - 1.0).abs() < 1e-12, "{statistics:?}");
        assert!(statistics.mean.abs() < 1e-18, "{statistics:?}");
    }
}
