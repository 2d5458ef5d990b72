//! The features that keys ask for, and refusals from the solver's table of them.

use rc_core::Boundary;
use rc_solver::{Feature, Method, Refusal, refusal};

use crate::error::CliError;
use crate::scene::keys::{ContactKeys, KernelName};

/// The features of a contact that its keys show.
pub(crate) fn of_contact(keys: &ContactKeys) -> Vec<Feature> {
    let all = [
        (Feature::Spectral, keys.kernel == Some(KernelName::Spectral)),
        (Feature::KernelFunction, keys.kernel == Some(KernelName::Own)),
        (Feature::Layer, keys.layer_thickness.is_some()),
        (Feature::Coating, keys.substrate_young.is_some()),
        (Feature::FreeBorders, keys.boundary == Some(Boundary::Free)),
        (Feature::Penetration, keys.penetration.is_some()),
        (Feature::Hardness, keys.hardness.is_some()),
        (Feature::History, keys.history.is_some()),
        (Feature::FluidPressure, keys.fluid_pressure.is_some()),
        (Feature::BorderLevel, keys.border_level.is_some_and(|level| level > 0)),
        (Feature::AreaError, keys.area_error.is_some()),
        (Feature::Leakage, keys.leakage),
        (Feature::Shear, keys.friction.is_some()),
        (Feature::Sliding, keys.speed.is_some_and(|speed| speed > 0.0)),
    ];
    all.into_iter().filter_map(|(feature, is_there)| is_there.then_some(feature)).collect()
}

/// Refuses keys that cannot be combined with each other, with the method, or with `more`.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn check(keys: &ContactKeys, more: impl IntoIterator<Item = Feature>) -> Result<(), CliError> {
    let features: Vec<_> = of_contact(keys).into_iter().chain(more).collect();
    check_all(&features, keys.method)
}

/// Refuses features that cannot be combined.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn check_all(features: &[Feature], method: Option<Method>) -> Result<(), CliError> {
    refusal(features, method).map_or(Ok(()), |refused| Err(of(&refused)))
}

/// The refusal with the key that it is about.
pub(crate) fn of(refused: &Refusal) -> CliError {
    CliError::input(format_args!("{}: {refused}", refused.key()))
}
