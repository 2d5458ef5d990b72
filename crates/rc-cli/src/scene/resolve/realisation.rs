//! Realisations of measured spectra, and their seeds.

use std::path::PathBuf;
use std::sync::Arc;

use rc_core::{Grid, PeriodicCell};
use rc_fractal::Amplitudes;

use crate::error::CliError;
use crate::scene::keys::SurfaceKeys;
use crate::scene::psd_file::PsdFile;
use crate::scene::surface::{Source, SurfaceSetup};
use crate::scene::values::GridSpec;

/// Seed of a realisation of a measured spectrum without a given one.
pub(super) const FIRST_SEED: u64 = 1;

/// The setup of a realisation of the spectrum in `table`.
pub(super) fn realisation(
    keys: SurfaceKeys,
    (path, table): (PathBuf, PsdFile),
    cell: PeriodicCell,
    grid: Grid,
) -> Result<SurfaceSetup, CliError> {
    let seed = checked_seed(keys.seed.unwrap_or(FIRST_SEED))?;
    let amplitudes = keys.amplitudes.unwrap_or(Amplitudes::Fixed);
    let spec = GridSpec { nx: grid.nx(), ny: grid.ny() };
    let keys = SurfaceKeys { grid: Some(spec), seed: Some(seed), amplitudes: Some(amplitudes), ..keys };
    Ok(SurfaceSetup::new(cell, Source::Spectrum { path, table: Arc::new(table), amplitudes, seed, grid }, keys))
}

/// Refuses a seed that cannot be written to the scene file that repeats the result.
pub(super) fn checked_seed(seed: u64) -> Result<u64, CliError> {
    let is_written = i64::try_from(seed).is_ok();
    let refuse = || CliError::input(format_args!("seed: must be at most {}, not {seed}", i64::MAX));
    is_written.then_some(seed).ok_or_else(refuse)
}
