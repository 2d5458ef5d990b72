//! A checked contact problem, in what every level shares.

use rayon::prelude::*;
use rc_core::{Boundary, Field};

use crate::support::Support;
use crate::tolerance::{ErrorBound, Measure};
use crate::{Control, IterationParams, ProblemError};

/// Height ranges, in λ, for which squares of pressures and their products with gaps neither underflow nor overflow.
const HEIGHT_RANGE: [f64; 2] = [1e-130, 1e130];

/// Extremes and mean of the heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeightStatistics {
    pub(crate) greatest: f64,
    pub(crate) least: f64,
    pub(crate) mean: f64,
}

impl HeightStatistics {
    /// In one pass, in parallel over rows.
    pub(crate) fn of(heights: &Field) -> Result<Self, ProblemError> {
        let nx = heights.grid().nx();
        let rows: Vec<(f64, f64, f64)> = heights
            .values()
            .par_chunks(nx)
            .map(|row| {
                row.iter().fold((f64::NEG_INFINITY, f64::INFINITY, 0.0), |(max, min, sum), &h| {
                    // Faster than f64::max; NaN shows in the sum.
                    (if h > max { h } else { max }, if h < min { h } else { min }, sum + h)
                })
            })
            .collect();
        // A sum that is not finite gives away NaN and infinities; so does an overflow, which finds none.
        for (iy, (_, _, sum)) in rows.iter().enumerate() {
            if let Some(ix) = (!sum.is_finite()).then(|| heights.row(iy).iter().position(|h| !h.is_finite())).flatten()
            {
                return Err(ProblemError::Height { ix, iy, value: heights.at(ix, iy) });
            }
        }
        Ok(Self {
            greatest: rows.iter().map(|row| row.0).fold(f64::NEG_INFINITY, f64::max),
            least: rows.iter().map(|row| row.1).fold(f64::INFINITY, f64::min),
            mean: rows.iter().map(|row| row.2).sum::<f64>() / heights.grid().len() as f64,
        })
    }
}

/// The power of two next to a positive number, by which scaling is exact; 1 for what is none.
pub(crate) fn power_of_two_near(value: f64) -> f64 {
    let exponent = value.log2();
    if exponent.is_finite() { 2.0_f64.powi(exponent.round() as i32) } else { 1.0 }
}

/// What presses, and the greatest pressure that the rough body bears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Load {
    pub(crate) control: Control,
    /// H_p in 0 ≤ p ≤ H_p, in E*; infinite for an elastic contact.
    pub(crate) hardness: f64,
}

impl From<Control> for Load {
    /// Elastic.
    fn from(control: Control) -> Self {
        Self { control, hardness: f64::INFINITY }
    }
}

/// A checked problem, in the quantities that every level shares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Problem {
    pub(crate) control: Control,
    /// The greatest pressure, in E*; infinite for an elastic contact.
    pub(crate) hardness: f64,
    /// Greatest height, on the finest grid.
    pub(crate) h_max: f64,
    /// Mean height, on the finest grid.
    pub(crate) h_mean: f64,
    /// H = h_max - h_min.
    pub(crate) h_range: f64,
    /// What an overlap is measured by.
    pub(crate) measure: Measure,
    /// What holds the solid under a uniform pressure.
    pub(crate) support: Support,
}

impl Problem {
    pub(crate) fn check(
        heights: &Field,
        load: impl Into<Load>,
        params: &IterationParams,
    ) -> Result<Self, ProblemError> {
        Self::check_on(Support::default(), heights, load, params)
    }

    /// The same for a solid that something may hold.
    pub(crate) fn check_on(
        support: Support,
        heights: &Field,
        load: impl Into<Load>,
        params: &IterationParams,
    ) -> Result<Self, ProblemError> {
        Self::of_statistics(HeightStatistics::of(heights)?, load.into(), params, support)
    }

    pub(crate) fn of_statistics(
        statistics: HeightStatistics,
        load: Load,
        params: &IterationParams,
        support: Support,
    ) -> Result<Self, ProblemError> {
        let Load { control, hardness } = load;
        let HeightStatistics { greatest: h_max, least: h_min, mean: h_mean } = statistics;
        let h_range = h_max - h_min;
        let full_contact = h_max - h_mean;
        let [smallest, greatest] = HEIGHT_RANGE;
        if h_range != 0.0 && !(smallest..=greatest).contains(&h_range) {
            return Err(ProblemError::HeightRange { value: h_range, smallest, greatest });
        }
        check_load(load)?;
        match control {
            // The hardness limits the mean pressure beyond full contact. How deep a patch with free borders is when all
            // is plastic depends on its heights, and any depth is a problem.
            Control::Penetration(value) if hardness.is_finite() && support.boundary == Boundary::Periodic => {
                let deepest = h_range + support.compliance * hardness;
                if !(value > 0.0 && value < deepest) {
                    return Err(ProblemError::FullyPlastic { value, deepest });
                }
            }
            // Also refuses every penetration into a flat surface, whose full contact is at zero.
            Control::Penetration(value) if support.is_none() && !(value > 0.0 && value < full_contact) => {
                return Err(ProblemError::Penetration { value, full_contact });
            }
            Control::Penetration(value) if !(value > 0.0 && value.is_finite()) => {
                return Err(ProblemError::Depth { value });
            }
            Control::MeanPressure(_) | Control::Penetration(_) => {}
        }
        Ok(Self { control, hardness, h_max, h_mean, h_range, measure: params.bound.measure(), support })
    }

    /// The length that overlaps are compared with, where the pressure does the `work` Σ p v and sums up to `pressure`:
    /// H, or U/σ0 = Σ p v / 2 Σ p, without what a uniform pressure does; over `n_cell` elements.
    pub(crate) fn reference_length(&self, work: f64, pressure: f64, n_cell: f64) -> f64 {
        match self.measure {
            Measure::HeightRange if self.h_range > 0.0 => self.h_range,
            Measure::HeightRange => work / pressure,
            Measure::Energy => 0.5 * (work / pressure - self.support.compliance * (pressure / n_cell)),
        }
    }

    /// The length that corrections are multiples of: H, or about what the load displaces on a flat patch.
    pub(crate) fn unit(&self) -> f64 {
        match self.control {
            _ if self.h_range > 0.0 => self.h_range,
            Control::MeanPressure(value) | Control::Penetration(value) => value,
        }
    }

    /// Elastic energy of a uniform pressure.
    pub(crate) fn uniform_energy(&self, mean_pressure: f64) -> f64 {
        0.5 * self.support.compliance * mean_pressure * mean_pressure
    }

    /// How deep a rigid plane may have to go into the surface: the height range, unless that is the depth of a pit.
    pub(crate) fn depth_range(&self) -> f64 {
        self.h_range.min(4.0 * (self.h_max - self.h_mean))
    }

    /// The constant c in `g = L p - h + c`: h_max - Δ under penetration control. Under pressure control Δ is a
    /// multiplier, and c is h_max, so that a large constant in the heights is not in the gap, whose sums it would
    /// drown.
    pub(crate) fn offset(&self) -> f64 {
        match self.control {
            Control::MeanPressure(_) => self.h_max,
            Control::Penetration(penetration) => self.h_max - penetration,
        }
    }
}

/// Refuses a mean pressure or a hardness that is out of range whatever the heights are.
pub(crate) fn check_load(load: Load) -> Result<(), ProblemError> {
    let Load { control, hardness } = load;
    if hardness <= 0.0 || hardness.is_nan() {
        return Err(ProblemError::Hardness { value: hardness });
    }
    match control {
        Control::MeanPressure(value) if !(value > 0.0 && value.is_finite()) => {
            Err(ProblemError::MeanPressure { value })
        }
        Control::MeanPressure(value) if value >= hardness => Err(ProblemError::TooSoft { value, hardness }),
        _ => Ok(()),
    }
}

/// Refuses a tolerance that is out of range.
pub(crate) fn check_tolerance(bound: ErrorBound) -> Result<(), ProblemError> {
    let (value, smallest) = (bound.value(), bound.smallest());
    if value >= smallest && value < 1.0 { Ok(()) } else { Err(ProblemError::Tolerance { value, smallest }) }
}
