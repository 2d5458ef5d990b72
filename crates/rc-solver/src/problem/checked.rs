//! A checked contact problem, in the quantities that every level shares.

use rayon::prelude::*;
use rc_core::{Boundary, Field};

use crate::problem::bounds::Bounds;
use crate::problem::control::Control;
use crate::problem::error::ProblemError;
use crate::problem::params::IterationParams;
use crate::problem::support::Support;
use crate::problem::tolerance::{ErrorBound, Measure};

/// Range of heights, in λ, that can be solved for.
///
/// Squares of pressures and their products with gaps neither underflow nor overflow there.
const HEIGHT_RANGE: [f64; 2] = [1e-130, 1e130];

/// Extremes and mean of the heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeightStatistics {
    pub(crate) greatest: f64,
    pub(crate) least: f64,
    pub(crate) mean: f64,
}

impl HeightStatistics {
    /// Statistics of `heights`, in one pass, in parallel over rows.
    pub(crate) fn of(heights: &Field) -> Result<Self, ProblemError> {
        let nx = heights.grid().nx();
        let rows: Vec<(f64, f64, f64)> = heights
            .values()
            .par_chunks(nx)
            .map(|row| {
                row.iter().fold((f64::NEG_INFINITY, f64::INFINITY, 0.0), |(max, min, sum), &h| {
                    // This is faster than f64::max. NaN shows in the sum.
                    (if h > max { h } else { max }, if h < min { h } else { min }, sum + h)
                })
            })
            .collect();
        // The sum is not finite if a height is NaN or infinite. It may also overflow, and then no such height is found.
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

/// The power of two next to a positive number, and 1 for other values. Scaling by it is exact.
pub(crate) fn power_of_two_near(value: f64) -> f64 {
    let exponent = value.log2();
    if exponent.is_finite() { 2.0_f64.powi(exponent.round() as i32) } else { 1.0 }
}

/// A checked problem, in the quantities that every level shares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Problem {
    /// What a pressure may be.
    pub(crate) bounds: Bounds,
    /// Maximum height, on the finest grid.
    pub(crate) h_max: f64,
    /// Mean height, on the finest grid.
    pub(crate) h_mean: f64,
    /// H = h_max - h_min.
    pub(crate) h_range: f64,
    /// The length that an overlap is compared with.
    pub(crate) measure: Measure,
    /// The support of the solid under a uniform pressure.
    pub(crate) support: Support,
}

/// Relative rounding of a printed penetration.
const ROUNDED: f64 = 1e-6;

/// Part of the penetration of full contact by which an iteration stays below it.
///
/// From there on, the penetration does not determine the pressure.
pub(crate) const BELOW_FULL: f64 = 1e-11;

/// Depth of [`Problem::out_of_reach`], in units of a bound of heights and displacements.
const OUT_OF_REACH: f64 = 100.0;

impl Problem {
    pub(crate) fn check(
        heights: &Field,
        bounds: impl Into<Bounds>,
        params: &IterationParams,
    ) -> Result<Self, ProblemError> {
        Self::check_on(Support::default(), heights, bounds, params)
    }

    /// [`Problem::check`] for a solid that a base or free borders may hold.
    pub(crate) fn check_on(
        support: Support,
        heights: &Field,
        bounds: impl Into<Bounds>,
        params: &IterationParams,
    ) -> Result<Self, ProblemError> {
        Self::of_statistics(HeightStatistics::of(heights)?, bounds.into(), params, support)
    }

    pub(crate) fn of_statistics(
        statistics: HeightStatistics,
        bounds: Bounds,
        params: &IterationParams,
        support: Support,
    ) -> Result<Self, ProblemError> {
        let Bounds { control, hardness } = bounds;
        let HeightStatistics { greatest: h_max, least: h_min, mean: h_mean } = statistics;
        let h_range = h_max - h_min;
        let full_contact = h_max - h_mean;
        let [smallest, greatest] = HEIGHT_RANGE;
        if h_range != 0.0 && !(smallest..=greatest).contains(&h_range) {
            return Err(ProblemError::HeightRange { value: h_range, smallest, greatest });
        }
        check_load(bounds)?;
        match control {
            // With a hardness, the penetration may go beyond full contact. A patch with free borders takes any depth,
            // because the depth at which all is plastic depends on its heights.
            Control::Penetration(value) if hardness.is_finite() && support.boundary == Boundary::Periodic => {
                let deepest = h_range + support.compliance * hardness;
                if !(value > 0.0 && value < deepest) {
                    return Err(ProblemError::FullyPlastic { value, deepest });
                }
            }
            // Also refuses every penetration into a flat surface. Its full contact is at zero.
            // A printed penetration of full contact may be rounded upward.
            Control::Penetration(value)
                if support.is_none()
                    && !(value > 0.0 && value <= full_contact * (1.0 + ROUNDED) && full_contact > 0.0) =>
            {
                return Err(ProblemError::Penetration { value, full_contact });
            }
            Control::Penetration(value) if !(value > 0.0 && value.is_finite()) => {
                return Err(ProblemError::Depth { value });
            }
            Control::MeanPressure(_) | Control::Penetration(_) => {}
        }
        let bounds = match control {
            Control::Penetration(value) if support.is_none() && hardness.is_infinite() => {
                Bounds { control: Control::Penetration(value.min(full_contact * (1.0 - BELOW_FULL))), hardness }
            }
            _ => bounds,
        };
        Ok(Self { bounds, h_max, h_mean, h_range, measure: params.bound.measure(), support })
    }

    /// The length that overlaps are compared with: H, or U/σ0 = Σ p v / 2 Σ p.
    ///
    /// `work` is Σ p v and `pressure` is Σ p, over `n_cell` elements. The work of a uniform pressure is subtracted.
    pub(crate) fn reference_length(&self, work: f64, pressure: f64, n_cell: f64) -> f64 {
        match self.measure {
            Measure::HeightRange if self.h_range > 0.0 => self.h_range,
            Measure::HeightRange => work / pressure,
            Measure::Energy => 0.5 * (work / pressure - self.support.compliance * (pressure / n_cell)),
        }
    }

    /// The unit of corrections: H, or the prescribed value on a flat patch.
    ///
    /// That value is about the displacement by the load.
    pub(crate) fn unit(&self) -> f64 {
        match self.bounds.control {
            _ if self.h_range > 0.0 => self.h_range,
            Control::MeanPressure(value) | Control::Penetration(value) => value,
        }
    }

    /// Displacement by a uniform pressure, in λ.
    pub(crate) fn uniform_displacement(&self, mean_pressure: f64) -> f64 {
        self.support.compliance * mean_pressure
    }

    /// Elastic energy of a uniform pressure.
    pub(crate) fn uniform_energy(&self, mean_pressure: f64) -> f64 {
        0.5 * self.support.compliance * mean_pressure * mean_pressure
    }

    /// The depth that a rigid plane may have to go into the surface.
    ///
    /// It is the height range, unless that is the depth of a pit.
    pub(crate) fn depth_range(&self) -> f64 {
        self.h_range.min(4.0 * (self.h_max - self.h_mean))
    }

    /// A height that is out of reach of the body on a level of `n` elements.
    ///
    /// It stands where vectors have a value but the surface has no element. λ = 1 and E* = 1. The load σ0 on a single
    /// element displaces it by less than 2 n σ0, and no pressure of this load displaces any place by more. A
    /// penetration Δ needs less than the load 5 Δ. Gaps at this height therefore stay larger than all others.
    pub(crate) fn out_of_reach(&self, n: usize) -> f64 {
        let (Control::MeanPressure(value) | Control::Penetration(value)) = self.bounds.control;
        self.h_max - OUT_OF_REACH * (self.h_range + n as f64 * value.abs())
    }

    /// The constant c in `g = L p - h + c`.
    ///
    /// Under penetration control c = h_max - Δ. Under pressure control Δ is a multiplier, and c = h_max. A large
    /// constant in the heights is therefore not in the gap. It would drown the sums over the gap.
    pub(crate) fn offset(&self) -> f64 {
        match self.bounds.control {
            Control::MeanPressure(_) => self.h_max,
            Control::Penetration(penetration) => self.h_max - penetration,
        }
    }
}

/// Refuses a mean pressure or a hardness that is out of range for all heights.
pub(crate) fn check_load(bounds: Bounds) -> Result<(), ProblemError> {
    let Bounds { control, hardness } = bounds;
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
