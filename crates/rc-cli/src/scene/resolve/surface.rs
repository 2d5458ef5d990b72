//! The step from keys to a checked surface.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use rc_core::{Grid, PeriodicCell};
use rc_fractal::{Amplitudes, MAX_WAVES, Normalisation, SpectrumParams, Truncation};
use rc_heights::Scales;

use super::checks::{checked_grid, missing, positive};
use super::form::form;
use super::like;
use super::realisation::{checked_seed, realisation};
use crate::error::CliError;
use crate::scene::file;
use crate::scene::form::Form;
use crate::scene::heights::{self, CellOfMap};
use crate::scene::keys::SurfaceKeys;
use crate::scene::psd_file::PsdFile;
use crate::scene::surface::{Source, SurfaceSetup};
use crate::scene::values::GridSpec;
use crate::scene::wave_file::WaveFile;

/// Default number of elements per shortest wave, for surfaces made of waves.
///
/// The side of an element is then `λ_min/32`.
const ELEMENTS_PER_WAVE: usize = 32;

/// Default number of elements per side for a shape.
const ELEMENTS_OF_SHAPE: usize = 512;

/// Checks the keys of the surface, with defaults from the embedded example.
///
/// # Errors
/// [`CliError::Input`].
pub fn surface(keys: SurfaceKeys) -> Result<SurfaceSetup, CliError> {
    check_companions(&keys)?;
    if let Some(path) = keys.like.clone() {
        let setup = like::like(keys, &path)?;
        return Ok(SurfaceSetup { form: form(&setup.keys, setup.cell)?, ..setup });
    }
    let Some(path) = keys.heights.clone() else { return surface_in_cell(keys) };
    if keys.line && keys.cell_y.is_some_and(|side| keys.cell.is_none_or(|cell| !heights::same(side, cell))) {
        return Err(CliError::input("cell_y: a profile has no side along y; omit cell_y"));
    }
    // Only the whole file tells the sides and the numbers of points. It is not read again.
    let map = heights::read(&path, &keys.read_params(), keys.scales())?;
    let CellOfMap { cell, cell_y, assumed } =
        CellOfMap::of(&path, &map, [keys.cell, if keys.line { keys.cell } else { keys.cell_y }])?;
    if keys.line && cell.is_none() {
        return Err(CliError::in_file(&path, "a profile without places; give cell (m), the length of the profile"));
    }
    let setup = surface_in_cell(SurfaceKeys { cell, cell_y, ..keys })?;
    Ok(SurfaceSetup { assumed, held: Arc::new(Mutex::new(Some(map))), ..setup })
}

/// Checks the keys of a surface whose size is in the keys only.
///
/// A height map gets the size of the keys, or no size.
///
/// # Errors
/// [`CliError::Input`].
pub fn surface_in_cell(keys: SurfaceKeys) -> Result<SurfaceSetup, CliError> {
    let example = SurfaceKeys { grid: None, ..file::example().surface };
    let keys = if keys.file().is_some() || keys.is_shape() { keys } else { keys.over(example) };
    let side = positive("cell", "m", keys.cell)?;
    let side_y = keys.cell_y.map_or(Ok(side), |side_y| positive("cell_y", "m", Some(side_y)))?;
    let cell = PeriodicCell::rectangle(side, side_y).map_err(CliError::input)?;
    let grid = keys.grid.map(checked_grid).transpose()?;
    let form = form(&keys, cell)?;
    let setup = match (keys.heights.clone(), keys.spectrum.clone()) {
        (Some(path), _) => {
            let source = Source::File { path, expected: grid, params: keys.read_params(), scales: keys.scales() };
            Ok(SurfaceSetup::new(cell, source, keys))
        }
        (None, Some(path)) => of_waves(keys, &path, cell, grid),
        (None, None) => match keys.psd.clone() {
            Some(path) => of_spectrum(keys, path, cell, grid),
            None if keys.is_shape() => of_shape(keys, form, cell, grid),
            None => random(keys, cell, grid),
        },
    };
    Ok(SurfaceSetup { form, ..setup? })
}

/// Refuses keys that say how another key is meant, without it.
fn check_companions(keys: &SurfaceKeys) -> Result<(), CliError> {
    if keys.psd_convention.is_some() && keys.psd.is_none() {
        return Err(CliError::input("psd_convention: applies to tables of a spectrum; give --psd FILE, or omit it"));
    }
    if keys.line && keys.heights.is_none() {
        return Err(CliError::input("line: applies to profiles; give --heights FILE with a profile, or omit line"));
    }
    if keys.heights_like.is_some() && keys.like.is_none() {
        return Err(CliError::input("heights_like: applies to twins; give --like FILE, or omit it"));
    }
    Ok(())
}

/// The setup of a surface that is a shape alone.
fn of_shape(
    keys: SurfaceKeys,
    form: Option<Form>,
    cell: PeriodicCell,
    grid: Option<Grid>,
) -> Result<SurfaceSetup, CliError> {
    check_generated(&keys, "a shape")?;
    let waves = form.and_then(Form::waves).map_or(0, |waves| waves.ceil() as usize);
    let default = GridSpec::square(waves.saturating_mul(ELEMENTS_PER_WAVE).max(ELEMENTS_OF_SHAPE));
    let grid = grid.map_or_else(|| checked_grid(default), Ok)?;
    let grid = resolving_grid(Some(grid), waves)?;
    let keys = SurfaceKeys { grid: Some(GridSpec { nx: grid.nx(), ny: grid.ny() }), ..keys };
    Ok(SurfaceSetup::new(cell, Source::Shape { grid }, keys))
}

/// Refuses keys that only surfaces from files have, for a surface that is generated.
///
/// They may be those of the file of another body.
fn check_generated(keys: &SurfaceKeys, what: &str) -> Result<(), CliError> {
    if keys.scales() != Scales::default() && keys.add.is_none() {
        return Err(CliError::input(
            "unit and height_scale apply to surfaces from files; give --heights FILE or --spectrum FILE, or omit them",
        ));
    }
    if keys.reads_in_a_way() && keys.add.is_none() {
        return Err(CliError::input(
            "channel, layout, missing and mask apply to height maps; give --heights FILE, or omit them",
        ));
    }
    if keys.cell_y.is_some() {
        return Err(CliError::input(format_args!(
            "cell_y: applies to height maps; {what} has a square cell, so omit it"
        )));
    }
    Ok(())
}

/// The setup of a random surface, on a grid that resolves its waves.
fn random(keys: SurfaceKeys, cell: PeriodicCell, grid: Option<Grid>) -> Result<SurfaceSetup, CliError> {
    check_generated(&keys, "a random surface")?;
    let spectrum = spectrum(&keys, cell.side())?;
    let grid = resolving_grid(grid, spectrum.waves)?;
    let keys = SurfaceKeys { grid: Some(GridSpec { nx: grid.nx(), ny: grid.ny() }), ..keys };
    Ok(SurfaceSetup::new(cell, Source::Random { spectrum, grid }, keys))
}

/// The setup of a surface from a file of waves.
///
/// The grid resolves the waves. The file is read here, since the grid depends on it.
fn of_waves(keys: SurfaceKeys, path: &Path, cell: PeriodicCell, grid: Option<Grid>) -> Result<SurfaceSetup, CliError> {
    if keys.cell_y.is_some() {
        return Err(CliError::input(
            "cell_y: applies to height maps; a surface of waves has a square cell, so omit it",
        ));
    }
    let waves = Arc::new(WaveFile::read(path, (keys.scales(), keys.read_params().max_bytes), cell.side())?);
    let grid = resolving_grid(grid, waves.surface().waves())?;
    let keys = SurfaceKeys { grid: Some(GridSpec { nx: grid.nx(), ny: grid.ny() }), ..keys };
    Ok(SurfaceSetup::new(cell, Source::Waves { path: path.to_owned(), waves, grid }, keys))
}

/// The setup of a realisation of a tabulated spectrum, on a grid that resolves its waves.
fn of_spectrum(
    keys: SurfaceKeys,
    path: PathBuf,
    cell: PeriodicCell,
    grid: Option<Grid>,
) -> Result<SurfaceSetup, CliError> {
    if keys.cell_y.is_some() {
        return Err(CliError::input(
            "cell_y: applies to height maps; a surface of waves has a square cell, so omit it",
        ));
    }
    // They may be those of the file of another body.
    if (keys.scales() != Scales::default() || keys.reads_in_a_way()) && keys.add.is_none() {
        return Err(CliError::input(
            "psd: a table is in rad/m and m^4; omit unit, height_unit, height_scale, channel, layout, missing and mask",
        ));
    }
    let convention = keys.psd_convention.unwrap_or_default();
    let table = PsdFile::read(&path, convention, (cell.side(), keys.read_params().max_bytes))?;
    let grid = resolving_grid(grid, table.waves())?;
    realisation(keys, (path, table), cell, grid)
}

/// The given grid, or one that resolves `waves` waves per cell well.
fn resolving_grid(grid: Option<Grid>, waves: usize) -> Result<Grid, CliError> {
    let default = GridSpec::square(waves.saturating_mul(ELEMENTS_PER_WAVE));
    let grid = grid.map_or_else(|| checked_grid(default), Ok)?;
    if grid.resolved_wavenumber() < waves {
        let smallest = waves.saturating_mul(2).saturating_add(1);
        return Err(CliError::input(format_args!(
            "grid: {grid} elements are too coarse for waves = {waves}; at least {smallest} per side are needed, and {} resolve \
             the shortest wave well",
            default.nx
        )));
    }
    Ok(grid)
}

/// The parameters of a random surface on the unit cell.
///
/// `side` is λ in m.
fn spectrum(keys: &SurfaceKeys, side: f64) -> Result<SpectrumParams, CliError> {
    let waves = keys.waves.ok_or_else(|| missing("waves"))?;
    if !(1..=MAX_WAVES).contains(&waves) {
        return Err(CliError::input(format_args!("waves: must be from 1 to {MAX_WAVES}, not {waves}")));
    }
    // The spectrum is per wave vector, so C0 has the unit m⁴ (Eq. 9 with C(q) = (2π)⁻² ∫⟨h h⟩ e^{-iqx} dx).
    let normalisation = match (keys.rms, keys.rms_slope, keys.c0) {
        (Some(rms), None, None) => Normalisation::RmsHeight(positive("rms", "m", Some(rms))? / side),
        (None, Some(slope), None) => Normalisation::RmsSlope(positive("rms_slope", "no unit", Some(slope))?),
        (None, None, Some(c0)) => Normalisation::C0(positive("c0", "m^4", Some(c0))? / side.powi(4)),
        _ => return Err(missing("exactly one of rms, rms_slope and c0")),
    };
    let hurst = keys.hurst.ok_or_else(|| missing("hurst"))?;
    if !(hurst > 0.0 && hurst <= 1.0) {
        return Err(CliError::input(format_args!("hurst: must be above 0 and at most 1, not {hurst}")));
    }
    let roll_off = keys.roll_off.ok_or_else(|| missing("roll_off"))?;
    if !(roll_off >= 1.0 && roll_off <= waves as f64) {
        let range = format_args!("roll_off: must be from 1 (none) to waves = {waves}, not {roll_off}");
        return Err(CliError::input(range));
    }
    let low_cut = keys.low_cut.unwrap_or(1.0);
    if !(low_cut >= 1.0 && low_cut <= waves as f64) {
        let range = format_args!("low_cut: must be from 1 (none) to waves = {waves}, not {low_cut}");
        return Err(CliError::input(range));
    }
    let seed = checked_seed(keys.seed.ok_or_else(|| missing("seed"))?)?;
    Ok(SpectrumParams {
        hurst,
        roll_off,
        low_cut,
        normalisation,
        truncation: keys.truncation.unwrap_or(Truncation::Disc),
        amplitudes: keys.amplitudes.unwrap_or(Amplitudes::Fixed),
        ..SpectrumParams::paper(waves, seed)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(text: &str) -> SurfaceKeys {
        file::parse(text).expect("a scene").surface
    }

    #[test]
    fn quantities_arrive_in_units_of_the_libraries() {
        let surface = surface(keys("cell = 2e-2\nrms = 1e-5\nwaves = 8")).expect("a surface");
        let Source::Random { spectrum, grid } = &surface.source else { panic!("not random: {:?}", surface.source) };
        assert_eq!(spectrum.normalisation, Normalisation::RmsHeight(1e-5 / 2e-2));
        assert_eq!((grid.nx(), grid.ny()), (256, 256));
    }

    #[test]
    fn each_bad_value_is_named_with_its_key() {
        let cases = [
            ("cell = 0", "cell"),
            ("cell = -1.0", "cell"),
            ("cell = nan", "cell"),
            ("rms = -1.0", "rms"),
            ("rms_slope = 0.0", "rms_slope"),
            ("c0 = inf", "c0"),
            ("hurst = 0.0", "hurst"),
            ("hurst = 1.5", "hurst"),
            ("waves = 0", "waves"),
            ("waves = 4000000000", "waves"),
            ("roll_off = 0.5", "roll_off"),
            ("roll_off = 65", "roll_off"),
            ("low_cut = 0.5", "low_cut"),
            ("low_cut = 65", "low_cut"),
            ("low_cut = nan", "low_cut"),
            ("grid = 0", "grid"),
            ("grid = 128", "grid"),
            ("grid = \"256x100\"", "grid"),
            ("grid = 1048577", "grid"),
        ];
        for (text, key) in cases {
            let error = surface(keys(text)).expect_err(text).to_string();
            assert!(error.starts_with(&format!("{key}:")), "{text}: {error}");
        }
    }

    #[test]
    fn the_smallest_grid_that_resolves_the_waves_is_accepted() {
        assert!(surface(keys("waves = 8\ngrid = 17")).is_ok());
        let error = surface(keys("waves = 8\ngrid = 16")).expect_err("too coarse").to_string();
        assert!(error.contains("at least 17"), "{error}");
    }
}
