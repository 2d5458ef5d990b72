//! The keys of an elastic layer and its substrate.

use rc_core::quantity::engineering;
use rc_core::{Elasticity, Grid, Units};
use rc_kernel::{Layer, Substrate, THINNEST_LAYER};

use super::checks::{missing, positive};
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

/// The layer or coating of these keys in words; `None` for a half-space.
pub(crate) fn in_words(keys: &ContactKeys) -> Option<String> {
    let thickness = engineering(keys.layer_thickness?, "m");
    let ratio = keys.layer_poisson.or(keys.poisson).map_or_else(String::new, |nu| format!(" (ν = {nu})"));
    Some(match keys.substrate_young.zip(keys.substrate_poisson) {
        Some((young, nu)) => {
            format!("coating of {thickness}{ratio} on an elastic substrate, E = {}, ν = {nu}", engineering(young, "Pa"))
        }
        None => format!("layer of {thickness}{ratio} on a rigid base"),
    })
}

/// The layer in units of the cell side and its own E*; `None` for a half-space.
pub(super) fn layer(keys: &ContactKeys, units: Units) -> Result<Option<Layer>, CliError> {
    let substrate = substrate(keys, units)?;
    let Some(thickness) = keys.layer_thickness else { return Ok(None) };
    if keys.young2.is_some() {
        return Err(CliError::input("young2: a layer is pressed by a rigid body; omit young2, or layer_thickness"));
    }
    let thickness = positive("layer_thickness", "m", Some(thickness))? / units.cell().side();
    let poisson = keys.layer_poisson.or(keys.poisson).ok_or_else(|| {
        CliError::input("layer_poisson: is missing; e_star does not contain Poisson's ratio of the layer")
    })?;
    check_ratio(poisson)?;
    Ok(Some(Layer { thickness, poisson, substrate }))
}

/// The substrate below a layer, in units of E* of the layer; `None` for a rigid base.
fn substrate(keys: &ContactKeys, units: Units) -> Result<Option<Substrate>, CliError> {
    let (young, poisson) = match (keys.substrate_young, keys.substrate_poisson) {
        (None, None) => return Ok(None),
        (Some(young), Some(poisson)) => (positive("substrate_young", "Pa", Some(young))?, poisson),
        (Some(_), None) => return Err(missing("substrate_poisson")),
        (None, Some(_)) => return Err(missing("substrate_young")),
    };
    if keys.layer_thickness.is_none() {
        return Err(CliError::input(
            "substrate_young: is given without layer_thickness (m) of the coating on it; give that too, or young for a half-space",
        ));
    }
    if !(0.0..=0.5).contains(&poisson) {
        return Err(CliError::input(format_args!("substrate_poisson: must be from 0 to 0.5, not {poisson}")));
    }
    let substrate = Elasticity::from_young_poisson(young, poisson)
        .map_err(|cause| CliError::input(format_args!("substrate_young: {cause}")))?;
    Ok(Some(Substrate { modulus: units.pressure(substrate.e_star()), poisson }))
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
