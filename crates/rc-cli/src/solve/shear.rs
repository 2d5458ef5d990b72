//! The shear of a solved contact, and its files.

use rc_core::quantity::engineering;
use rc_core::{Observer, Units};
use rc_solver::{Plan, ShearControl, ShearError, ShearSolution, Solution, SolveError};
use rc_sweep::ShearSummary;
use rc_sweep::files::{FileError, Staged};
use rc_sweep::memory::ByteSize;

use super::failure::Failure;
use super::map_file::MapFile;
use crate::error::CliError;
use crate::files::names::SHEAR_FILES;
use crate::scene::resolve::shear::slides;
use crate::scene::resolve::{ContactSetup, ShearSetup};

/// A sheared contact.
#[derive(Clone, Debug)]
pub struct SolvedShear {
    /// The tractions and their numbers, in units of λ and E*.
    pub solution: ShearSolution,
    /// Whether the tolerance was reached.
    pub has_converged: bool,
}

impl SolvedShear {
    /// Shears the solved contact `normal`. `plan` is one of the same problem.
    ///
    /// `refuse` puts a refusal of the second normal contact into words. A shear that did not converge is not an error, but a failure. Without its second normal contact there is none.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn of(
        (plan, normal): (&Plan<'_>, &Solution<'_>),
        (setup, units): (&ShearSetup, Units),
        observer: &dyn Observer,
        refuse: &dyn Fn(&SolveError) -> CliError,
    ) -> Result<(Option<Self>, Option<Failure>), CliError> {
        let error = match plan.shear(normal, &setup.params, observer) {
            Ok(solution) => return Ok((Some(Self { solution, has_converged: true }), None)),
            Err(error) => error,
        };
        let failure = Failure { what: format!("friction: {error}"), remedy: REMEDY };
        match error {
            ShearError::NotConverged { solution, .. } => {
                Ok((Some(Self { solution: *solution, has_converged: false }), Some(failure)))
            }
            ShearError::Normal(SolveError::NotConverged { .. }) => Ok((None, Some(failure))),
            ShearError::Normal(other) => Err(refuse(&other)),
            other => {
                let is_force = matches!(setup.params.control, ShearControl::MeanShear(_));
                Err(in_si(&other, units, is_force))
            }
        }
    }

    /// Its part of the summary, in SI units.
    pub(super) fn summary(&self, contact: &ContactSetup) -> ShearSummary {
        let note = contact.shear.as_ref().and_then(|shear| shear.note.as_deref());
        let note = note.map(|note| note.trim_start_matches("note: ").to_owned());
        ShearSummary::of(&self.solution.info, contact.units, note)
    }
}

/// What to do about a shear that did not reach the tolerance.
const REMEDY: &str = "; give a larger energy tolerance or a longer time limit";

/// A refusal of the solver in SI units.
fn in_si(error: &ShearError, units: Units, is_force: bool) -> CliError {
    match *error {
        ShearError::Sliding { shear, limit } => slides(units.pascals(shear), units.pascals(limit)),
        ShearError::SlipsAll { displacement, limit } => CliError::input(format_args!(
            "shear_displacement: at {} the surface slides as a whole, which begins at {}; give less",
            engineering(units.metres(displacement), "m"),
            engineering(units.metres(limit), "m")
        )),
        ShearError::TooSmall { value, least } if is_force => CliError::input(format_args!(
            "shear_pressure: {:e} Pa cannot be told from no shear under this load; give at least {:e} Pa",
            units.pascals(value),
            units.pascals(least)
        )),
        ShearError::TooSmall { value, least } => CliError::input(format_args!(
            "shear_displacement: {:e} m cannot be told from no shear in this contact; give at least {:e} m",
            units.metres(value),
            units.metres(least)
        )),
        ShearError::Memory { grid, needed, limit } => CliError::input(format_args!(
            "memory_limit: a shear on {grid} elements needs about {}, more than the {} that may be used; give a coarser grid",
            ByteSize(needed),
            ByteSize(limit)
        )),
        _ => CliError::input(format_args!("friction: {error}")),
    }
}

/// Adds the tractions along x and y (Pa) and the length of the slip (m) to a result.
pub(super) fn add(staged: &mut Staged, contact: &ContactSetup, shear: &SolvedShear) -> Result<(), FileError> {
    let units = contact.units;
    let (e_star, side) = (units.elasticity().e_star(), units.cell().side());
    let [x, y] = &shear.solution.traction;
    for (name, (field, unit)) in SHEAR_FILES.into_iter().zip([(x, e_star), (y, e_star), (&shear.solution.slip, side)]) {
        staged.add(name, |path| {
            let mut file = MapFile::create(path, field.grid(), &contact.keys, unit)?;
            file.take(field.values())?;
            file.finish()
        })?;
    }
    Ok(())
}
