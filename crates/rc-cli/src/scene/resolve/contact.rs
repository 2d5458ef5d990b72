//! The step from keys to a checked contact.

use std::sync::Arc;

use rc_comm::Ranks;
use rc_core::{Boundary, Elasticity, Kernel, PeriodicCell, UnitError, Units};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Spectral, SpectralLayer, Viscoelastic};
use rc_solver::{Control, SolveParams, Tolerance};

use super::checks::{missing, plausible, positive};
use super::shear::ShearSetup;
use super::sliding::SlidingSolid;
use super::{elastic_layer, shear, sliding};
use crate::error::CliError;
use crate::files::checkpoint::CheckpointFile;
use crate::scene::fluid::FluidSource;
use crate::scene::history::HistorySpec;
use crate::scene::keys::{ContactKeys, KernelName};
use crate::scene::values::ToleranceSpec;
use crate::scene::{features, file};

/// A checked contact: half-space, load and method.
#[derive(Clone, Debug)]
pub struct ContactSetup {
    /// The cell and the half-space.
    pub units: Units,
    /// Mean pressure in E*, or penetration in λ.
    pub control: Control,
    /// Maximum pressure in E*; infinite for an elastic contact.
    pub hardness: f64,
    /// Mean pressures in E* that follow each other; empty for a single load.
    ///
    /// `control` is the last of them above 0.
    pub history: Vec<f64>,
    /// The pressure of a fluid, if there is one.
    pub fluid: Option<FluidSource>,
    /// Discretisation.
    pub kernel: KernelName,
    /// The boundary, which is what is beyond the heights.
    pub boundary: Boundary,
    /// The layer or coating in place of the half-space, if there is one.
    pub layer: Option<Layer>,
    /// Sliding over a material that relaxes, if the surface slides.
    pub sliding: Option<SlidingSolid>,
    /// Shear of the contact with partial slip, if it is sheared.
    pub shear: Option<ShearSetup>,
    /// Ratio of the load of this elastic contact to the load under which a solid has crept; `None` without creep.
    pub creep: Option<f64>,
    /// Method, tolerance and limits, without the available memory.
    pub params: SolveParams,
    /// The resolved keys, for `scene.toml`.
    pub keys: ContactKeys,
    /// The ranks of the solve and the file that keeps its levels.
    pub place: Place,
    /// Whether a wanted error of the area chooses the grid.
    pub grid_is_chosen: bool,
}

/// The ranks of a solve, and its checkpoint file.
#[derive(Clone, Debug, Default)]
pub struct Place {
    /// The ranks that solve the problem together.
    pub ranks: Ranks,
    /// The file that keeps what each level leaves for the next.
    pub checkpoint: Option<Arc<CheckpointFile>>,
}

impl ContactSetup {
    /// Whether the last load of the history above 0 is none that the surface bears for the first time.
    pub(crate) fn is_reloaded(&self) -> bool {
        let loads: Vec<f64> = self.history.iter().copied().filter(|load| *load > 0.0).collect();
        loads.split_last().is_some_and(|(last, before)| before.iter().any(|load| load >= last))
    }

    /// The loads (E*) of the history without steps between them.
    pub(crate) fn loads_of_history(&self) -> Vec<f64> {
        loads_of_history(&self.keys, self.units)
    }

    /// The kernel of the contact.
    ///
    /// # Errors
    /// [`CliError::Input`] for a kernel that only a program knows.
    pub fn kernel(&self) -> Result<Arc<dyn Kernel + Send + Sync>, CliError> {
        Ok(match (self.kernel, self.layer) {
            (KernelName::Love, None) if self.boundary == Boundary::Free => Arc::new(FreeLove),
            (KernelName::Love, None) => self.under_sliding(Love),
            (KernelName::Spectral, None) => self.under_sliding(Spectral),
            (KernelName::Love, Some(layer)) => self.under_sliding(LoveLayer(layer)),
            (KernelName::Spectral, Some(layer)) => self.under_sliding(SpectralLayer(layer)),
            (KernelName::Own, _) => {
                return Err(CliError::input(
                    "kernel: 'own' stands for a function of a Python program, and only that program can solve with it; give love or spectral",
                ));
            }
        })
    }
}

impl ContactSetup {
    /// The kernel of the material under the surface that slides, or the kernel itself at rest.
    fn under_sliding<K: Kernel + Clone + Send + Sync + 'static>(&self, relaxed: K) -> Arc<dyn Kernel + Send + Sync> {
        match self.sliding.as_ref().filter(|sliding| sliding.speed > 0.0) {
            Some(sliding) => {
                let velocity = sliding.velocity(self.units.cell().side());
                Arc::new(Viscoelastic::new(relaxed, &sliding.material, velocity))
            }
            None => Arc::new(relaxed),
        }
    }
}

/// The kernel with this name; `None` for one that only a program knows.
#[must_use]
pub fn kernel(name: KernelName) -> Option<&'static dyn Kernel> {
    match name {
        KernelName::Love => Some(&Love),
        KernelName::Spectral => Some(&Spectral),
        KernelName::Own => None,
    }
}

/// Checks the keys of half-space, load and method.
///
/// Defaults are those of the embedded example. Control and method do not have a default.
///
/// # Errors
/// [`CliError::Input`].
pub fn contact(keys: ContactKeys, cell: PeriodicCell) -> Result<ContactSetup, CliError> {
    let keys = elastic_layer::with_poisson(keys)?;
    let defaults = ContactKeys { pressure: None, method: None, ..file::example().contact };
    let keys = sliding::with_terms(film(keys.over(defaults))?)?;
    let units = Units::new(cell, elasticity(&keys)?);
    let control = control(&keys, units)?;
    let hardness = hardness(&keys, (control, units))?;
    keys.jump_distance.map_or(Ok(0.0), |jump| plausible("jump_distance", "m", jump))?;
    keys.conductivity.map_or(Ok(0.0), |given| plausible("conductivity", "W/(m K) or S/m", given.mean()))?;
    let history = in_steps(loads_of_history(&keys, units), &keys)?;
    let kernel = keys.kernel.unwrap_or(KernelName::Love);
    features::check(&keys, None)?;
    let boundary = keys.boundary.unwrap_or_default();
    let layer = elastic_layer::layer(&keys, units)?;
    let sliding = sliding::solid(&keys)?;
    let shear = shear::shear(&keys, (control, units))?;
    let params = SolveParams {
        tolerance: tolerance(&keys)?,
        method: keys.method,
        border_level: keys.border_level.unwrap_or(0),
        ..SolveParams::certified()
    };
    let (place, grid_is_chosen, creep) = (Place::default(), false, None);
    Ok(ContactSetup {
        units,
        control,
        hardness,
        history,
        fluid: keys.fluid_pressure.clone().map(FluidSource::File),
        kernel,
        boundary,
        layer,
        sliding,
        shear,
        creep,
        params,
        keys,
        place,
        grid_is_chosen,
    })
}

fn control(keys: &ContactKeys, units: Units) -> Result<Control, CliError> {
    if let Some(HistorySpec(loads)) = &keys.history {
        return Ok(Control::pascals(last_of_history(keys, loads)?, units));
    }
    match (keys.pressure, keys.penetration, keys.force) {
        (Some(pressure), None, None) => Ok(Control::pascals(positive("pressure", "Pa", Some(pressure))?, units)),
        (None, Some(depth), None) => Ok(Control::metres(positive("penetration", "m", Some(depth))?, units)),
        (None, None, Some(force)) => Ok(Control::pascals(mean_pressure(force, units.cell())?, units)),
        (None, None, None) => {
            Err(CliError::input("give exactly one of pressure (Pa), penetration (m) and force (N); none is given"))
        }
        _ => Err(CliError::input("give exactly one of pressure (Pa), penetration (m) and force (N)")),
    }
}

/// The loads (E*) of a history, as they were given.
fn loads_of_history(keys: &ContactKeys, units: Units) -> Vec<f64> {
    keys.history.iter().flat_map(|HistorySpec(loads)| loads).map(|load| units.pressure(*load)).collect()
}

/// Largest number of steps to each load of a history.
const MOST_STEPS: usize = 1000;

/// The loads of a history, with each that is above the one before it in as many steps as the keys say.
fn in_steps(loads: Vec<f64>, keys: &ContactKeys) -> Result<Vec<f64>, CliError> {
    let Some(steps) = keys.history_steps else { return Ok(loads) };
    if loads.is_empty() {
        return Err(CliError::input("history_steps: a single load has no history; give history too, or omit it"));
    }
    if !(1..=MOST_STEPS).contains(&steps) {
        return Err(CliError::input(format_args!("history_steps: must be from 1 to {MOST_STEPS}, not {steps}")));
    }
    let mut before = 0.0;
    let stepped = loads.into_iter().flat_map(|load| {
        let from = std::mem::replace(&mut before, load);
        let n = if load > from { steps } else { 1 };
        // The last step is the load itself, without rounding.
        (1..n).map(move |i| from + (load - from) * i as f64 / n as f64).chain(std::iter::once(load))
    });
    Ok(stepped.collect())
}

/// The last load (Pa) of a history that is above 0.
fn last_of_history(keys: &ContactKeys, loads: &[f64]) -> Result<f64, CliError> {
    if keys.n_loads() > 1 {
        return Err(CliError::input("history: has the loads; omit pressure, penetration and force"));
    }
    if keys.hardness.is_none() {
        return Err(CliError::input(
            "history: an elastic contact keeps nothing of earlier loads; give hardness too, or pressure instead",
        ));
    }
    if let Some(wrong) = loads.iter().find(|load| !(**load >= 0.0 && load.is_finite())) {
        return Err(CliError::input(format_args!(
            "history: each load must be finite and at least 0 (Pa), not {wrong}"
        )));
    }
    let last = loads.iter().rev().copied().find(|load| *load > 0.0);
    last.ok_or_else(|| CliError::input("history: one of the loads must be above 0 (Pa), such as 1e7,0"))
}

/// The mean pressure (Pa) of a force (N) on a cell or patch.
///
/// # Errors
/// [`CliError::Input`] for a force that is not positive.
pub(crate) fn mean_pressure(force: f64, cell: PeriodicCell) -> Result<f64, CliError> {
    Ok(positive("force", "N", Some(force))? / cell.nominal_area())
}

/// The keys with a leakage if they have a film. Its viscosity and its pressure belong together.
fn film(keys: ContactKeys) -> Result<ContactKeys, CliError> {
    match (keys.viscosity, keys.pressure_drop) {
        (None, None) => Ok(keys),
        (Some(viscosity), Some(drop)) => {
            plausible("viscosity", "Pa s", viscosity)?;
            plausible("pressure_drop", "Pa", drop)?;
            Ok(ContactKeys { leakage: true, ..keys })
        }
        (Some(_), None) => Err(CliError::input("viscosity: the flow in m³/s also needs pressure_drop (Pa); give both")),
        (None, Some(_)) => {
            Err(CliError::input("pressure_drop: the flow in m³/s also needs viscosity (Pa s); give both"))
        }
    }
}

/// The hardness in E*; infinite if it is not given.
///
/// Converted back to Pa, it is at most the given value.
fn hardness(keys: &ContactKeys, (control, units): (Control, Units)) -> Result<f64, CliError> {
    let Some(given) = keys.hardness else { return Ok(f64::INFINITY) };
    let given = positive("hardness", "Pa", Some(given))?;
    let of_history = keys.history.iter().flat_map(|HistorySpec(loads)| loads).copied().reduce(f64::max);
    let pressure = match control {
        Control::MeanPressure(mean) => Some(of_history.or(keys.pressure).unwrap_or_else(|| units.pascals(mean))),
        Control::Penetration(_) => None,
    };
    if let Some(pressure) = pressure.filter(|pressure| *pressure >= given) {
        return Err(CliError::input(format_args!(
            "hardness: {given} Pa cannot bear a mean pressure of {pressure} Pa; it must be above the pressure"
        )));
    }
    let mut hardness = units.pressure(given);
    while units.pascals(hardness) > given {
        hardness = hardness.next_down();
    }
    Ok(hardness)
}

/// The half-space in place of both bodies.
fn elasticity(keys: &ContactKeys) -> Result<Elasticity, CliError> {
    let has_second = keys.young2.is_some() || keys.poisson2.is_some();
    if let Some(e_star) = keys.e_star {
        if has_second {
            return Err(CliError::input("young2: e_star is that of both bodies; give young and poisson instead of it"));
        }
        return Elasticity::from_e_star(positive("e_star", "Pa", Some(e_star))?).map_err(CliError::input);
    }
    let first = body(["young", "poisson"], [keys.young, keys.poisson])?;
    if !has_second {
        return Ok(first);
    }
    let second = body(["young2", "poisson2"], [keys.young2, keys.poisson2])?;
    first.against(second).map_err(|cause| CliError::input(format_args!("young2: {cause}")))
}

/// The half-space of one body, from the values of its two keys.
fn body([young_key, poisson_key]: [&str; 2], [young, poisson]: [Option<f64>; 2]) -> Result<Elasticity, CliError> {
    let young = positive(young_key, "Pa", young)?;
    let poisson = poisson.ok_or_else(|| missing(poisson_key))?;
    Elasticity::from_young_poisson(young, poisson).map_err(|error| match error {
        UnitError::Poisson { value } => {
            CliError::input(format_args!("{poisson_key}: must be above -1 and at most 0.5, not {value}"))
        }
        other => CliError::input(other),
    })
}

fn tolerance(keys: &ContactKeys) -> Result<Tolerance, CliError> {
    let is_part = |value: f64| value > 0.0 && value < 1.0;
    match (keys.tolerance, keys.energy_tolerance) {
        (Some(_), Some(_)) => {
            Err(CliError::input("energy_tolerance: give it or tolerance, not both; omit one of them"))
        }
        (Some(ToleranceSpec::Relative(value)), None) if !is_part(value) => {
            Err(CliError::input(format_args!("tolerance: must be above 0 and below 1, such as 1e-6, not {value}")))
        }
        (None, Some(value)) if !is_part(value) => Err(CliError::input(format_args!(
            "energy_tolerance: must be above 0 and below 1, such as 1e-3, not {value}"
        ))),
        (Some(tolerance), None) => Ok(tolerance.into()),
        (None, Some(value)) => Ok(Tolerance::Energy(value)),
        (None, None) => Ok(Tolerance::DEFAULT),
    }
}

#[cfg(test)]
mod tests {
    use rc_solver::ErrorBound;

    use super::*;

    fn keys(text: &str) -> ContactKeys {
        file::parse(text).expect("a scene").contact
    }

    fn resolved(keys: ContactKeys) -> Result<ContactSetup, CliError> {
        contact(keys, PeriodicCell::new(1.0).expect("a cell"))
    }

    /// Fails unless the keys in each text are refused with a message that begins with the name of the key.
    fn assert_named(cases: &[(&str, &str)]) {
        for (text, key) in cases {
            let keys = ContactKeys { pressure: Some(1.0), ..keys(text) };
            let error = resolved(keys).expect_err(text).to_string();
            assert!(error.starts_with(&format!("{key}:")), "{text}: {error}");
        }
    }

    #[test]
    fn the_control_is_never_assumed() {
        let error = resolved(ContactKeys::default()).expect_err("no control").to_string();
        assert!(error.contains("exactly one"), "{error}");
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
            ("hardness = 0.0", "hardness"),
            ("jump_distance = 0.0", "jump_distance"),
            ("jump_distance = nan", "jump_distance"),
            ("jump_distance = 1e-320", "jump_distance"),
            ("conductivity = \"1e308,1e308\"", "conductivity"),
            ("viscosity = 1e-320\npressure_drop = 1e5", "viscosity"),
            ("viscosity = 1e-3\npressure_drop = 1e300", "pressure_drop"),
            ("hardness = nan", "hardness"),
            ("hardness = inf", "hardness"),
            ("hardness = 1.0", "hardness"),
            ("hardness = 2.0\nmethod = \"gauss-seidel\"", "method"),
            ("energy_tolerance = 1.0", "energy_tolerance"),
            ("energy_tolerance = nan", "energy_tolerance"),
            ("tolerance = 1e-6\nenergy_tolerance = 1e-3", "energy_tolerance"),
            ("boundary = \"free\"\nkernel = \"spectral\"", "kernel"),
            ("boundary = \"free\"\nkernel = \"own\"", "boundary"),
            ("boundary = \"free\"\nlayer_thickness = 1e-3", "boundary"),
            ("boundary = \"free\"\nmethod = \"gauss-seidel\"", "method"),
            ("viscosity = 1e-3", "viscosity"),
            ("pressure_drop = 1e5", "pressure_drop"),
            ("viscosity = 0.0\npressure_drop = 1e5", "viscosity"),
            ("layer_thickness = 0.0", "layer_thickness"),
            ("layer_thickness = inf", "layer_thickness"),
            ("layer_thickness = 1e-3\ne_star = 1e9", "layer_poisson"),
            ("layer_thickness = 1e-3\nlayer_poisson = 0.51", "layer_poisson"),
            ("layer_thickness = 1e-3\ne_star = 1e9\nlayer_poisson = -1.0", "layer_poisson"),
            ("layer_thickness = 1e-3\npoisson = 0.4\nlayer_poisson = 0.3", "layer_poisson"),
            ("layer_poisson = 0.3", "layer_poisson"),
            ("layer_thickness = 1e-3\nmethod = \"gauss-seidel\"", "method"),
            ("layer_thickness = 1e-3\nkernel = \"own\"", "layer_thickness"),
        ];
        assert_named(&cases);
    }

    #[test]
    fn each_bad_value_of_a_sliding_contact_is_named_with_its_key() {
        assert_named(&[
            ("speed = 1.0", "speed"),
            ("direction = 90.0", "direction"),
            ("prony = [[1.0, 1.0]]", "prony"),
            ("glassy_ratio = 10.0\nrelaxation_time = 1.0", "glassy_ratio"),
            ("speed = 1.0\nglassy_ratio = 10.0", "relaxation_time"),
            ("speed = 1.0\nrelaxation_time = 1.0", "glassy_ratio"),
            ("speed = 1.0\nglassy_ratio = 1.0\nrelaxation_time = 1.0", "glassy_ratio"),
            ("speed = 1.0\nglassy_ratio = 2.0\nrelaxation_time = 0.0", "relaxation_time"),
            ("speed = 1.0\nprony = []", "prony"),
            ("speed = 1.0\nprony = [[1.0, 1.0], [0.0, 1.0]]", "prony"),
            ("speed = 1.0\nprony = [[1.0, -1.0]]", "prony"),
            ("speed = 1.0\nprony = [[1.0, 1.0]]\nglassy_ratio = 10.0\nrelaxation_time = 1.0", "prony"),
            ("speed = 1.0\nfractional = \"0.0,10,1\"", "fractional"),
            ("speed = 1.0\nfractional = { alpha = 0.2, glassy_ratio = 0.5, tau = 1.0 }", "fractional"),
            ("speed = -1.0\nprony = [[1.0, 1.0]]", "speed"),
            ("speed = 1e300\nprony = [[1.0, 1.0]]", "speed"),
            ("speed = 1.0\nprony = [[1.0, 1e300]]", "prony"),
            ("speed = 1.0\nglassy_ratio = 10.0\nrelaxation_time = 1e300", "relaxation_time"),
            ("speed = inf\nprony = [[1.0, 1.0]]", "speed"),
            ("speed = 1.0\nprony = [[1.0, 1.0]]\ndirection = nan", "direction"),
            ("speed = 1.0\nprony = [[1.0, 1.0]]\nboundary = \"free\"", "speed"),
            ("speed = 1.0\nprony = [[1.0, 1.0]]\nmethod = \"gauss-seidel\"", "method"),
            ("speed = 1.0\nprony = [[1.0, 1.0]]\nkernel = \"own\"", "speed"),
            ("speed = 1.0\nprony = [[1.0, 1.0]]\nborder_level = 1", "speed"),
            ("speed = 1.0\nprony = [[1.0, 1.0]]\nyoung2 = 1e9\npoisson2 = 0.3", "young2"),
        ]);
    }

    #[test]
    fn the_tolerance_auto_becomes_a_number_and_stays_auto_in_the_keys() {
        let setup = resolved(ContactKeys { pressure: Some(1.0), ..keys("tolerance = \"auto\"") }).expect("a contact");
        let bound = setup.params.tolerance.bound(Some(8.0));
        assert_eq!(bound, ErrorBound::Energy(6e-2));
        assert_eq!(setup.keys.tolerance, Some(ToleranceSpec::Auto));
    }

    #[test]
    fn a_hardness_is_never_more_than_given() {
        for (e_star, given) in [(3.0, 0.7), (5.016e8, 1.1e7), (7e10, 1e9 / 3.0)] {
            let setup = resolved(keys(&format!("e_star = {e_star:e}\npressure = 0.1\nhardness = {given:e}")));
            let setup = setup.expect("a contact");
            let found = setup.units.pascals(setup.hardness);
            assert!(found <= given && found / given > 1.0 - 1e-15, "{found} for {given}");
        }
        assert!(resolved(keys("pressure = 1.0")).expect("a contact").hardness.is_infinite());
    }

    #[test]
    fn loads_arrive_in_units_of_the_libraries() {
        let setup = resolved(keys("e_star = 4.0\npressure = 1.0")).expect("a contact");
        assert_eq!((setup.control, setup.keys.young), (Control::MeanPressure(0.25), None));
    }
}
