//! From scene file and flags to a checked problem in the units of the libraries (λ = 1, E* = 1).

use std::path::Path;

use rc_core::{Elasticity, Grid, Kernel, PeriodicCell, UnitError};
use rc_fractal::{MAX_WAVES, Normalisation, SpectrumParams};
use rc_heights::Scales;
use rc_kernel::{Love, Spectral};
use rc_solver::{Control, IterationParams};

use crate::auto_tolerance::auto_tolerance;
use crate::error::CliError;
use crate::heights;
use crate::scene::{Amplitudes, ContactKeys, KernelName, Method, Scene, SurfaceKeys, Truncation};
use crate::scene_file;
use crate::surface::{Source, SurfaceProblem};
use crate::values::{GridSpec, Tolerance};

/// Elements per shortest wave of a random surface, when no grid is given: element side `λ_min/32`.
const ELEMENTS_PER_WAVE: usize = 32;

/// What is pressed against the surface, how hard, and how the problem is solved; in units of λ and E*.
#[derive(Clone, Debug)]
pub struct ContactProblem {
    /// E*.
    pub elasticity: Elasticity,
    /// Mean pressure in E*, or penetration in λ.
    pub control: Control,
    /// Discretisation.
    pub kernel: KernelName,
    /// Method of solution, where one is asked for.
    pub method: Option<Method>,
    /// Tolerance and limits.
    pub params: IterationParams,
    /// Whether it is a row of a sweep, which must not depend on the memory of the machine: a method that does not fit is an error, and
    /// another one is no way out.
    pub is_one_of_many: bool,
    /// The keys as resolved, for `scene.toml`.
    pub keys: ContactKeys,
}

impl ContactProblem {
    /// How often elements at the edges of contacts are halved beyond the grid.
    #[must_use]
    pub fn border_level(&self) -> usize {
        self.keys.border_level.unwrap_or(0)
    }

    /// The kernel itself.
    #[must_use]
    pub fn kernel(&self) -> &'static dyn Kernel {
        kernel(self.kernel)
    }
}

/// The kernel of this name.
#[must_use]
pub fn kernel(name: KernelName) -> &'static dyn Kernel {
    match name {
        KernelName::Love => &Love,
        KernelName::Spectral => &Spectral,
    }
}

/// Flags laid over the scene file, each checked for alternatives given together. No defaults yet.
///
/// # Errors
/// [`CliError::Input`].
pub fn layers(file: Option<&Path>, flags: Scene) -> Result<Scene, CliError> {
    check_alternatives(&flags).map_err(CliError::input)?;
    let Some(path) = file else { return Ok(flags) };
    let scene = scene_file::read(path)?;
    check_alternatives(&scene).map_err(|message| CliError::in_file(path, message))?;
    Ok(flags.over(scene))
}

/// Keys that exclude each other must not stand side by side in one place.
fn check_alternatives(scene: &Scene) -> Result<(), String> {
    let Scene { surface, contact, .. } = scene;
    if contact.pressure.is_some() && contact.penetration.is_some() {
        return Err("both pressure and penetration are given; give exactly one".into());
    }
    if contact.e_star.is_some() && (contact.young.is_some() || contact.poisson.is_some()) {
        return Err("e_star stands for young and poisson; give either e_star or the two".into());
    }
    if [surface.rms, surface.rms_slope, surface.c0].iter().flatten().count() > 1 {
        return Err("rms, rms_slope and c0 are alternatives; give one".into());
    }
    if surface.grid.is_some() && contact.area_error.is_some() {
        return Err("area_error chooses the grid; give either area_error or grid".into());
    }
    if surface.heights.is_some() && surface.generates() {
        return Err("heights is a surface already; give no parameters of a random one (waves, hurst, rms, ...)".into());
    }
    Ok(())
}

/// Checks the keys of the surface, with the embedded example for defaults.
///
/// # Errors
/// [`CliError::Input`].
pub fn surface(mut keys: SurfaceKeys) -> Result<SurfaceProblem, CliError> {
    // Read for its size alone: such files are small against what a solve takes.
    if let Some(path) = keys.heights.as_deref() {
        [keys.cell, keys.cell_y] = sides_of_map(path, &keys)?;
    }
    surface_in_cell(keys)
}

/// The same where a height map has no other sides than the keys say.
///
/// # Errors
/// [`CliError::Input`].
pub fn surface_in_cell(keys: SurfaceKeys) -> Result<SurfaceProblem, CliError> {
    let defaults = SurfaceKeys { grid: None, ..scene_file::example().surface };
    let mut keys = keys.over(defaults);
    let side = positive("cell", "m", keys.cell)?;
    let side_y = keys.cell_y.map_or(Ok(side), |side_y| positive("cell_y", "m", Some(side_y)))?;
    let cell = PeriodicCell::rectangle(side, side_y).map_err(CliError::input)?;
    let grid = keys.grid.map(checked_grid).transpose()?;
    if let Some(path) = keys.heights.clone() {
        let source = Source::File { path, expected: grid, scales: keys.scales() };
        return Ok(SurfaceProblem { cell, source, keys });
    }
    if keys.scales() != Scales::default() {
        return Err(CliError::input(
            "unit and height_scale: are for height maps; give --heights FILE, or leave them away",
        ));
    }
    if keys.cell_y.is_some() {
        return Err(CliError::input(
            "cell_y: is for height maps; a random surface has a square cell, so leave it away",
        ));
    }
    let spectrum = spectrum(&keys, side)?;
    let default = GridSpec::square(spectrum.waves.saturating_mul(ELEMENTS_PER_WAVE));
    let grid = grid.map_or_else(|| checked_grid(default), Ok)?;
    let smallest = spectrum.waves.saturating_mul(2).saturating_add(1);
    if grid.resolved_wavenumber() < spectrum.waves {
        return Err(CliError::input(format_args!(
            "grid: {grid} elements are too coarse for waves = {}; at least {smallest} per side are needed, and {} resolve \
             the shortest wave well",
            spectrum.waves, default.nx
        )));
    }
    keys.grid = Some(GridSpec { nx: grid.nx(), ny: grid.ny() });
    Ok(SurfaceProblem { cell, source: Source::Random { spectrum, grid }, keys })
}

/// Sides of the cell of a height map (m), where its file or the keys say them.
fn sides_of_map(path: &Path, keys: &SurfaceKeys) -> Result<[Option<f64>; 2], CliError> {
    let given = [keys.cell, keys.cell_y];
    if !rc_heights::format_of(path)?.has_sides() {
        return Ok(given);
    }
    heights::sides(path, heights::read(path, keys.scales())?.sides, given)
}

/// The parameters of a random surface on the unit cell; `side` is λ in m.
fn spectrum(keys: &SurfaceKeys, side: f64) -> Result<SpectrumParams, CliError> {
    let waves = keys.waves.ok_or_else(|| missing("waves"))?;
    if !(1..=MAX_WAVES).contains(&waves) {
        return Err(CliError::input(format_args!("waves: must be from 1 to {MAX_WAVES}, not {waves}")));
    }
    // The spectrum is per wave vector: C0 has the unit m⁴ (Eq. 9 with C(q) = (2π)⁻² ∫⟨h h⟩ e^{-iqx} dx).
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
    let seed = keys.seed.ok_or_else(|| missing("seed"))?;
    if i64::try_from(seed).is_err() {
        // Larger ones could not be written to the scene file that repeats the result.
        return Err(CliError::input(format_args!("seed: must be at most {}, not {seed}", i64::MAX)));
    }
    Ok(SpectrumParams {
        hurst,
        roll_off,
        normalisation,
        truncation: match keys.truncation {
            Some(Truncation::Square) => rc_fractal::Truncation::Square,
            _ => rc_fractal::Truncation::Disc,
        },
        amplitudes: match keys.amplitudes {
            Some(Amplitudes::Random) => rc_fractal::Amplitudes::Random,
            _ => rc_fractal::Amplitudes::Fixed,
        },
        ..SpectrumParams::paper(waves, seed)
    })
}

/// Checks the keys of half-space, load and method, with the embedded example for defaults; control and method have none.
/// `side` is λ in m; `elements_per_wave` is what the tolerance `auto` depends on ([`auto_tolerance`]).
///
/// # Errors
/// [`CliError::Input`].
pub fn contact(keys: ContactKeys, side: f64, elements_per_wave: Option<f64>) -> Result<ContactProblem, CliError> {
    let defaults = ContactKeys { pressure: None, penetration: None, method: None, ..scene_file::example().contact };
    let keys = keys.over(defaults);
    if keys.area_error.is_some() {
        return Err(CliError::input(
            "area_error: only rc solve, on a random surface, chooses its grid; give grid instead",
        ));
    }
    let elasticity = elasticity(&keys)?;
    let control = match (keys.pressure, keys.penetration) {
        (Some(pressure), None) => {
            Control::MeanPressure(positive("pressure", "Pa", Some(pressure))? / elasticity.e_star())
        }
        (None, Some(depth)) => Control::Penetration(positive("penetration", "m", Some(depth))? / side),
        _ => return Err(CliError::input("give exactly one of pressure (Pa) and penetration (m); neither is given")),
    };
    let (method, kernel) = (keys.method, keys.kernel.unwrap_or(KernelName::Love));
    if let (Some(method @ (Method::Adaptive | Method::GaussSeidel)), KernelName::Spectral) = (method, kernel) {
        return Err(CliError::input(format_args!(
            "method: '{}' has the paper's elements, so kernel must be love; uniform has spectral too",
            method.name()
        )));
    }
    if let (Some(1..), Some(Method::Uniform | Method::GaussSeidel), _) | (Some(1..), _, KernelName::Spectral) =
        (keys.border_level, method, kernel)
    {
        return Err(CliError::input(
            "border_level: only the adaptive method, with kernel love, halves elements at the edges of contacts",
        ));
    }
    let params =
        IterationParams { tolerance: tolerance(keys.tolerance, elements_per_wave)?, ..IterationParams::certified() };
    Ok(ContactProblem { elasticity, control, kernel, method, params, is_one_of_many: false, keys })
}

fn elasticity(keys: &ContactKeys) -> Result<Elasticity, CliError> {
    if let Some(e_star) = keys.e_star {
        return Elasticity::from_e_star(positive("e_star", "Pa", Some(e_star))?).map_err(CliError::input);
    }
    let young = positive("young", "Pa", keys.young)?;
    let poisson = keys.poisson.ok_or_else(|| missing("poisson"))?;
    Elasticity::from_young_poisson(young, poisson).map_err(|error| match error {
        UnitError::Poisson { value } => {
            CliError::input(format_args!("poisson: must be above -1 and at most 0.5, not {value}"))
        }
        other => CliError::input(other),
    })
}

fn tolerance(given: Option<Tolerance>, elements_per_wave: Option<f64>) -> Result<f64, CliError> {
    match given {
        Some(Tolerance::Relative(value)) if value > 0.0 && value < 1.0 => Ok(value),
        Some(Tolerance::Relative(value)) => {
            Err(CliError::input(format_args!("tolerance: must be between 0 and 1, as 1e-6, not {value}")))
        }
        Some(Tolerance::Auto) => Ok(auto_tolerance(elements_per_wave)),
        None => Ok(IterationParams::certified().tolerance),
    }
}

/// A grid that the libraries can count; what memory it needs depends on the method.
///
/// # Errors
/// [`CliError::Input`].
pub fn checked_grid(spec: GridSpec) -> Result<Grid, CliError> {
    Grid::new(spec.nx, spec.ny).map_err(|cause| CliError::input(format_args!("grid: {cause}")))
}

/// Checks the number of worker threads and starts them. When it is not given, they are all cores, or as many as this process
/// has already.
///
/// # Errors
/// [`CliError::Input`]: a number out of range, or another one than this process has already.
pub fn start_threads(threads: Option<usize>) -> Result<usize, CliError> {
    const MOST: usize = 1024;
    let builder = rayon::ThreadPoolBuilder::new();
    match threads {
        // Started on first use.
        None => {}
        Some(n @ 1..=MOST) => match builder.num_threads(n).build_global() {
            Err(_) if rayon::current_num_threads() == n => {}
            started => started.map_err(|cause| CliError::input(format_args!("threads: {cause}")))?,
        },
        Some(n) => return Err(CliError::input(format_args!("threads: must be from 1 to {MOST}, not {n}"))),
    }
    Ok(rayon::current_num_threads())
}

fn positive(key: &str, unit: &str, value: Option<f64>) -> Result<f64, CliError> {
    match value {
        Some(value) if value > 0.0 && value.is_finite() => Ok(value),
        Some(value) => Err(CliError::input(format_args!("{key}: must be positive and finite ({unit}), not {value}"))),
        None => Err(missing(key)),
    }
}

/// A key that neither the user nor the example gives: only after an edit of the example.
fn missing(key: &str) -> CliError {
    CliError::input(format_args!("{key}: must be given"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keys(text: &str) -> Scene {
        scene_file::parse(text).expect("a scene")
    }

    #[test]
    fn quantities_arrive_in_units_of_the_libraries() {
        let scene = keys("cell = 2e-2\nrms = 1e-5\nwaves = 8\ne_star = 4.0\npressure = 1.0");
        let surface = surface(scene.surface).expect("a surface");
        let Source::Random { spectrum, grid } = &surface.source else { panic!("not random: {:?}", surface.source) };
        assert_eq!(spectrum.normalisation, Normalisation::RmsHeight(1e-5 / 2e-2));
        assert_eq!((grid.nx(), grid.ny()), (256, 256));
        let contact = contact(scene.contact, surface.cell.side(), None).expect("a contact");
        assert_eq!(contact.control, Control::MeanPressure(0.25));
        assert_eq!(contact.keys.young, None);
    }

    #[test]
    fn the_control_is_never_assumed() {
        let error = contact(ContactKeys::default(), 1.0, None).expect_err("no control").to_string();
        assert!(error.contains("exactly one"), "{error}");
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
            ("grid = 0", "grid"),
            ("grid = 128", "grid"),
            ("grid = \"256x100\"", "grid"),
            ("grid = 1048577", "grid"),
        ];
        for (text, key) in cases {
            let error = surface(keys(text).surface).expect_err(text).to_string();
            assert!(error.starts_with(&format!("{key}:")), "{text}: {error}");
        }
    }

    #[test]
    fn each_bad_value_of_the_contact_is_named_with_its_key() {
        let cases = [
            ("young = 0.0", "young"),
            ("e_star = -1.0", "e_star"),
            ("poisson = 0.51", "poisson"),
            ("poisson = -1.0", "poisson"),
            ("poisson = nan", "poisson"),
            ("method = \"adaptive\"\nkernel = \"spectral\"", "method"),
            ("method = \"gauss-seidel\"\nkernel = \"spectral\"", "method"),
            ("tolerance = 1.0", "tolerance"),
            ("tolerance = 0.0", "tolerance"),
        ];
        for (text, key) in cases {
            let keys = ContactKeys { pressure: Some(1.0), ..keys(text).contact };
            let error = contact(keys, 1.0, None).expect_err(text).to_string();
            assert!(error.starts_with(&format!("{key}:")), "{text}: {error}");
        }
    }

    #[test]
    fn the_tolerance_auto_becomes_a_number_and_stays_auto_in_the_keys() {
        let keys = ContactKeys { pressure: Some(1.0), ..keys("tolerance = \"auto\"").contact };
        let contact = contact(keys, 1.0, Some(8.0)).expect("a contact");
        assert!((contact.params.tolerance / 3e-5 - 1.0).abs() < 1e-12, "{}", contact.params.tolerance);
        assert_eq!(contact.keys.tolerance, Some(Tolerance::Auto));
    }

    #[test]
    fn the_smallest_grid_that_resolves_the_waves_is_accepted() {
        assert!(surface(keys("waves = 8\ngrid = 17").surface).is_ok());
        let error = surface(keys("waves = 8\ngrid = 16").surface).expect_err("too coarse").to_string();
        assert!(error.contains("at least 17"), "{error}");
    }
}
