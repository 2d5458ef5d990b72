//! Refusals of flags for files that are never written.

use rc_solver::Method;

use super::keys::{ContactKeys, Scene};
use crate::error::CliError;

/// Refuses `--elements` and `--precision` where no fields are written, which `without` says, and `--elements` where the
/// method has no elements of its own.
///
/// Only `flags` are refused. A scene file may say how fields are written whenever they are.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn check(flags: &ContactKeys, scene: &Scene, without: Option<&str>) -> Result<(), CliError> {
    let given = [("elements", flags.elements), ("precision", flags.precision.is_some())];
    let first = given.iter().find(|(_, is_given)| *is_given);
    if let (Some((key, _)), Some(without)) = (first, without) {
        return Err(CliError::input(format_args!("{key}: {without}")));
    }
    let what = match scene.contact.method {
        _ if scene.surface.line => "a line contact",
        Some(Method::Uniform) => "the method uniform",
        _ => return Ok(()),
    };
    if flags.elements {
        return Err(CliError::input(format_args!(
            "elements: {what} has no elements but those of the grid, whose pressures are in pressure.npy; omit --elements"
        )));
    }
    Ok(())
}
