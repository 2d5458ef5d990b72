//! The keys of an elastic layer.

use rc_core::Grid;
use rc_kernel::{Layer, THINNEST_LAYER};

use super::checks::positive;
use crate::error::CliError;
use crate::scene::keys::{ContactKeys, KernelName};

/// The keys with a single Poisson's ratio. The ratio of the layer becomes that of the material.
pub(super) fn with_poisson(keys: ContactKeys) -> Result<ContactKeys, CliError> {
    // This check comes first, since later messages would name the key of the material.
    keys.layer_poisson.map_or(Ok(()), check_ratio)?;
    match (keys.poisson, keys.layer_poisson) {
        (_, Some(ratio)) if keys.layer_thickness.is_none() => Err(CliError::input(format_args!(
            "layer_poisson: {ratio} is given without layer_thickness (m); give that too, or poisson for a half-space"
        ))),
        (Some(poisson), Some(ratio)) if (poisson - ratio).abs() > 0.0 => Err(CliError::input(format_args!(
            "layer_poisson: {ratio} and poisson {poisson} are of the same material; give one of them"
        ))),
        (None, Some(_)) if keys.e_star.is_none() => Ok(ContactKeys { poisson: keys.layer_poisson, ..keys }),
        _ => Ok(keys),
    }
}

fn check_ratio(poisson: f64) -> Result<(), CliError> {
    if poisson > -1.0 && poisson <= 0.5 {
        Ok(())
    } else {
        Err(CliError::input(format_args!("layer_poisson: must be above -1 and at most 0.5, not {poisson}")))
    }
}

/// The layer in units of the cell side; `None` for a half-space.
pub(super) fn layer(keys: &ContactKeys, side: f64) -> Result<Option<Layer>, CliError> {
    let Some(thickness) = keys.layer_thickness else { return Ok(None) };
    if keys.young2.is_some() {
        return Err(CliError::input("young2: a layer is pressed by a rigid body; omit young2, or layer_thickness"));
    }
    let thickness = positive("layer_thickness", "m", Some(thickness))? / side;
    let poisson = keys.layer_poisson.or(keys.poisson).ok_or_else(|| {
        CliError::input("layer_poisson: is missing; e_star does not contain Poisson's ratio of the layer")
    })?;
    check_ratio(poisson)?;
    Ok(Some(Layer { thickness, poisson }))
}

/// Refuses a layer that is thinner than elements, for the kernel love.
///
/// For such elements it would be a bed of springs, at a high cost. `side` is λ in m.
pub(crate) fn check_thickness(layer: Option<Layer>, kernel: KernelName, grid: Grid, side: f64) -> Result<(), CliError> {
    let spacing = grid.spacing().max_element();
    match (layer, kernel) {
        (Some(layer), KernelName::Love) if layer.thickness < THINNEST_LAYER * spacing => {
            Err(CliError::input(format_args!(
                "layer_thickness: {:e} m is below {THINNEST_LAYER} of the side of an element ({:e} m, {grid} elements); give a finer grid",
                layer.thickness * side,
                spacing * side
            )))
        }
        _ => Ok(()),
    }
}
