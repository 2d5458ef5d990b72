//! The expected cost of a plan.

use rc_core::Boundary;

use crate::problem::tolerance::ErrorBound;
use crate::solve::memory::bytes_per_element;
use crate::solve::plan::{ChosenMethod, Plan};

/// Processor seconds for each estimated element of the adaptive method, at the default tolerance.
///
/// Measured 1.1e-6 to 1.5e-6 s for each evaluated element (512² to 4096², 0.9 % to 20 % contact, H = 0.3 and 0.8). The
/// constant is larger, because the estimated number of elements is only 0.55 to 0.9 of the number evaluated.
const SECONDS_PER_ADAPTIVE_CELL: f64 = 1.7e-6;

/// Processor seconds for each element of the uniform grid.
///
/// Measured 0.6e-6 to 1.0e-6 (512² and 2048², 7 % to 71 % contact).
const SECONDS_PER_UNIFORM_ELEMENT: f64 = 0.85e-6;

/// Processor seconds for each element of a uniform grid with free borders.
///
/// Measured two to four times the time of a periodic cell at 512² and 2048².
const SECONDS_PER_FREE_ELEMENT: f64 = 2.5e-6;

/// Relative increase of the work for each decade by which a tolerance is below 1e-6.
///
/// Measured: 1e-9 takes 2.9 times the work.
const WORK_PER_DECADE: f64 = 0.63;

/// Estimated cost of a solve, within a factor of about two.
///
/// `None` stands for a number that is not known before the solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Contact area relative to the nominal area. Only the adaptive method estimates it.
    pub area_fraction: Option<f64>,
    /// Number of elements that are solved for on the finest level.
    pub elements: Option<f64>,
    /// Memory of the method, in bytes.
    pub bytes: Option<f64>,
    /// Processor seconds on an idle machine.
    pub cpu_seconds: Option<f64>,
}

impl Plan<'_> {
    /// The expected cost of the solve.
    #[must_use]
    pub fn cost(&self) -> Cost {
        Cost::of(self)
    }
}

impl Cost {
    fn of(plan: &Plan<'_>) -> Self {
        let digits = match plan.bound {
            ErrorBound::Relative(value) => value.log10(),
            // An energy error of 1e-2 takes as many iterations as 1e-6 of the height range.
            ErrorBound::Energy(value) => 2.0 * (value / 1e-2).log10() - 6.0,
        };
        let decades = (-6.0 - digits).max(0.0);
        let seconds = |work: f64| work * (1.0 + WORK_PER_DECADE * decades);
        match &plan.chosen {
            ChosenMethod::Adaptive(problem) => {
                let estimate = problem.estimate();
                Self {
                    area_fraction: Some(estimate.area_fraction),
                    elements: Some(estimate.cells),
                    bytes: Some(estimate.adaptive_bytes),
                    cpu_seconds: Some(seconds(SECONDS_PER_ADAPTIVE_CELL * estimate.work)),
                }
            }
            ChosenMethod::Uniform => {
                let grid = plan.problem.heights.grid();
                let elements = grid.len() as f64;
                let boundary = plan.problem.boundary();
                let per_element = match boundary {
                    Boundary::Periodic => SECONDS_PER_UNIFORM_ELEMENT,
                    Boundary::Free => SECONDS_PER_FREE_ELEMENT,
                };
                Self {
                    area_fraction: None,
                    elements: Some(elements),
                    bytes: Some(elements * bytes_per_element(&plan.problem) as f64),
                    cpu_seconds: Some(seconds(per_element * elements)),
                }
            }
            ChosenMethod::GaussSeidel => Self { area_fraction: None, elements: None, bytes: None, cpu_seconds: None },
        }
    }
}
