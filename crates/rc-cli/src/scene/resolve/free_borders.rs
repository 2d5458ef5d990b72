//! Rules for free borders.

use rc_core::Boundary;
use rc_solver::Method;

use crate::error::CliError;
use crate::scene::keys::{ContactKeys, KernelName};

/// The boundary of the keys.
///
/// With free borders it refuses keys that are for a periodic cell only.
pub(super) fn boundary(keys: &ContactKeys, kernel: KernelName) -> Result<Boundary, CliError> {
    let boundary = keys.boundary.unwrap_or_default();
    if boundary == Boundary::Periodic {
        return Ok(boundary);
    }
    let refuse = |message: &str| Err(CliError::input(message));
    if keys.leakage {
        return refuse("leakage: the flow is computed on a periodic cell only; omit leakage or boundary");
    }
    match (kernel, keys.layer_thickness) {
        (KernelName::Spectral, _) => {
            refuse("kernel: spectral waves are periodic; give love for free borders, or omit it")
        }
        (KernelName::Own, _) => {
            refuse("boundary: the function given as kernel describes a periodic cell; omit one of the two")
        }
        (KernelName::Love, Some(_)) => {
            refuse("boundary: a layer has no free borders; omit boundary, or layer_thickness")
        }
        (KernelName::Love, None) => match keys.method {
            Some(method @ Method::GaussSeidel) => Err(CliError::input(format_args!(
                "method: '{method}' solves on a periodic cell only; give adaptive or uniform for free borders, or omit it"
            ))),
            _ => Ok(boundary),
        },
    }
}
