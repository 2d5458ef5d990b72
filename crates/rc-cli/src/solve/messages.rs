//! Messages of the solver in the user's units.

use rc_core::Grid;
use rc_core::quantity::{count, digits};
use rc_solver::{AdaptiveError, Feature, Method, ProblemError, Solution, SolveError, refusal};
use rc_sweep::memory::Budget;

use super::failure::Failure;
use crate::error::CliError;
use crate::scene::features;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::ContactSetup;

/// The solver's refusal of a contact, as an error in SI units.
///
/// `budget` is the memory that was available.
pub(super) fn in_si(error: &SolveError, surface: &LoadedSurface, contact: &ContactSetup, budget: Budget) -> CliError {
    match error {
        SolveError::Problem(error) => of_problem(error, contact),
        SolveError::Adaptive(AdaptiveError::OperatorError { .. }) => CliError::input(format_args!(
            "{}: {:e} is less than the adaptive method can certify; give a larger value, or --method uniform",
            tolerance_key(contact),
            contact.params.tolerance.bound(surface.source().elements_per_wave()).value()
        )),
        SolveError::Adaptive(error) => of_adaptive(error, contact, budget),
        SolveError::GaussSeidel(error) => CliError::input(format_args!("method gauss-seidel: {error}")),
        SolveError::Memory { method, grid, .. } => match budget.check_grid(&format!("the {method} method"), *grid) {
            Err(refused) => refused.into(),
            Ok(()) => CliError::input(format_args!("memory_limit: {error}")),
        },
        SolveError::AreaError { wanted, reached, side } => CliError::input(format_args!(
            "area_error: {} % cannot be reached; with {side} elements per side, the most that it tries, the error is {} %; give at least this",
            digits(100.0 * wanted, 2),
            digits(rounded_up(100.0 * reached), 2)
        )),
        SolveError::Unsupported(refused) => features::of(refused),
        SolveError::Grid(_) | SolveError::TooCoarse { .. } => CliError::input(format_args!("grid: {error}")),
        other => CliError::input(other),
    }
}

/// `value` with two significant digits, not below `value`.
fn rounded_up(value: f64) -> f64 {
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    (value / unit).ceil() * unit
}

/// The key that gave the tolerance.
fn tolerance_key(contact: &ContactSetup) -> &'static str {
    if contact.keys.tolerance.is_some() { "tolerance" } else { "energy_tolerance" }
}

fn of_problem(error: &ProblemError, contact: &ContactSetup) -> CliError {
    let units = contact.units;
    match error {
        ProblemError::Penetration { value, full_contact } => CliError::input(format_args!(
            "penetration: must be above 0 and below that of full contact, {} m, not {} m; beyond it the penetration \
             no longer determines the pressure, so give --pressure",
            digits(units.metres(*full_contact), 7),
            digits(units.metres(*value), 7)
        )),
        ProblemError::FullyPlastic { value, deepest } => CliError::input(format_args!(
            "penetration: must be above 0 and below {} m, where all is plastic, not {} m",
            digits(units.metres(*deepest), 7),
            digits(units.metres(*value), 7)
        )),
        ProblemError::TooSoft { value, hardness } => CliError::input(format_args!(
            "hardness: {} Pa cannot bear a mean pressure of {} Pa; it must be above the pressure",
            units.pascals(*hardness),
            units.pascals(*value)
        )),
        ProblemError::FluidBears { value, fluid } => CliError::input(format_args!(
            "fluid_pressure: its mean, {} Pa, already bears the mean pressure of {} Pa; the load must be above it",
            digits(units.pascals(*fluid), 7),
            digits(units.pascals(*value), 7)
        )),
        ProblemError::FluidParts { value, touching } => CliError::input(format_args!(
            "penetration: must be above {} m, where the surfaces first touch under the fluid, not {} m",
            digits(units.metres(*touching), 7),
            digits(units.metres(*value), 7)
        )),
        ProblemError::Hardness { value } => {
            CliError::input(format_args!("hardness: must be positive (Pa), not {}", units.pascals(*value)))
        }
        ProblemError::Depth { value } => {
            CliError::input(format_args!("penetration: must be positive and finite (m), not {}", units.metres(*value)))
        }
        ProblemError::HeightRange { value, smallest, greatest } => CliError::input(format_args!(
            "heights: their range must be 0 or from {:e} to {:e} m, not {:e} m; check the cell and the unit",
            units.metres(*smallest),
            units.metres(*greatest),
            units.metres(*value)
        )),
        ProblemError::MeanPressure { value } => {
            CliError::input(format_args!("pressure: must be positive and finite (Pa), not {}", units.pascals(*value)))
        }
        ProblemError::Tolerance { value, smallest } => {
            let key = tolerance_key(contact);
            CliError::input(format_args!("{key}: must be between {smallest:e} and 1, not {value:e}"))
        }
        other => CliError::input(other),
    }
}

fn of_adaptive(error: &AdaptiveError, contact: &ContactSetup, budget: Budget) -> CliError {
    match error {
        AdaptiveError::Deviation { deviates_below, resolved, .. } if contact.layer.is_some() => {
            let thickness = contact.keys.layer_thickness.unwrap_or(f64::NAN);
            CliError::input(format_args!(
                "layer_thickness: {thickness:e} m is too thin for the base grid of the adaptive method; give at least {:.2e} m, or --method uniform",
                rounded_up(thickness * deviates_below / resolved)
            ))
        }
        AdaptiveError::Grid { .. } | AdaptiveError::Base { .. } => {
            CliError::input(format_args!("grid: {error}; --method uniform takes any grid"))
        }
        AdaptiveError::Memory { grid, needed, area_percent, .. } => {
            let part = match area_percent {
                Some(percent) => format!(", at an estimated contact area of {} %,", digits(*percent, 2)),
                None => " needs its base grid, which alone".into(),
            };
            let what = format!("the adaptive method on {grid} elements{part}");
            // The base grid follows from the surface, whatever the grid.
            let remedy =
                |_| if area_percent.is_some() { "; give a coarser grid" } else { "; allow more memory" }.to_owned();
            match budget.check(&what, 1e6 * *needed as f64, remedy) {
                Err(refused) => refused.into(),
                Ok(()) => CliError::input(format_args!("memory_limit: {error}")),
            }
        }
        AdaptiveError::BorderLevel { .. } => CliError::input(format_args!("border_level: {error}")),
        other => CliError::input(format_args!("method: {other}")),
    }
}

/// The failure of a solution that did not reach the tolerance, with its finest grid and the iterations on it.
pub(super) fn not_converged(solution: &Solution<'_>, grid: Grid, iterations: usize, contact: &ContactSetup) -> Failure {
    let what = format!(
        "not converged to {} on {grid} elements after {}: {}",
        solution.bound(),
        count(iterations, "iteration"),
        solution.certificate()
    );
    let mut features = features::of_contact(&contact.keys);
    features.extend((contact.place.ranks.size() > 1).then_some(Feature::Ranks));
    let has_other = solution.method() == Method::Adaptive && refusal(&features, Some(Method::Uniform)).is_none();
    Failure { what, remedy: if has_other { UNIFORM_METHOD } else { LARGER_TOLERANCE } }
}

/// What to do about a solution of the adaptive method, whose operator has an error.
const UNIFORM_METHOD: &str = "; give --method uniform, which has an exact operator and needs memory for the whole grid, a larger tolerance or a longer time limit; for other causes see Questions in the guide (docs/faq.md)";

/// What to do about a solution that did not reach the tolerance.
const LARGER_TOLERANCE: &str =
    "; give a larger tolerance or a longer time limit; for other causes see Questions in the guide (docs/faq.md)";
