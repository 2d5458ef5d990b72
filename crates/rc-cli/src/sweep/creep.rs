//! `--times`: contacts of a solid that creeps under a constant load.

use rc_sweep::{Cells, ControlKind, Loads};
use serde_json::{Value, json};

use super::varied::Varied;
use crate::error::CliError;
use crate::scene::keys::{ContactKeys, Scene};
use crate::scene::quantity;
use crate::scene::resolve;

/// Times of creep, and what they are given with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Creep<'a> {
    pub(super) times: Option<&'a Loads>,
    pub(super) control: ControlKind,
    /// The loads of a list.
    pub(super) loads: &'a [f64],
    /// Whether rows keep fields.
    pub(super) fields: bool,
}

/// A solid that has crept.
#[derive(Clone, Debug)]
pub(super) struct Crept {
    /// Ratio of the load of the elastic contact to the constant load.
    pub(super) ratio: f64,
    /// The keys of the material and of the constant load, which those of the elastic contact do not have.
    pub(super) keys: ContactKeys,
}

/// An elastic scene with its name, its varied values, and the solid whose contact it is after a time.
pub(super) type TimedScene = (String, Varied, Scene, Option<Crept>);

/// The times of a list, as the command line has it: `1ms:1s:4`, or values with commas between them.
///
/// # Errors
/// One line about what is not a time.
pub fn times(text: &str) -> Result<Loads, String> {
    quantity::times(text)
}

/// The scenes at each of the times, or unchanged without times.
///
/// A contact under a constant load grows, and is then the elastic contact under σ0 J(t)/J∞ (E. H. Lee and J. R. M. Radok,
/// J. Appl. Mech. 27 (1960) 438-444).
pub(super) fn after_times(creep: Creep<'_>, scenes: Vec<(String, Varied, Scene)>) -> Result<Vec<TimedScene>, CliError> {
    let Some(Loads(times)) = creep.times else {
        return Ok(scenes.into_iter().map(|(name, values, scene)| (name, values, scene, None)).collect());
    };
    creep.check()?;
    let mut all = Vec::new();
    for (name, values, scene) in scenes {
        let (material, keys) = resolve::sliding::creeping(&scene.contact)?;
        let pressure = creep.loads.first().copied().or(keys.pressure);
        let keys = ContactKeys { pressure, force: keys.force, ..keys.relaxing() };
        for time in times {
            let varied = values.iter().cloned().chain([("time".to_owned(), json!(time))]).collect();
            // The compliance of a solid is positive from the beginning.
            let ratio = material.creep(*time).filter(|ratio| *ratio > 0.0).unwrap_or(1.0);
            let mut contact = scene.contact.clone().elastic();
            contact.force = contact.force.map(|force| force * ratio);
            let crept = Crept { ratio, keys: keys.clone() };
            all.push((name.clone(), varied, Scene { contact, ..scene.clone() }, Some(crept)));
        }
    }
    Ok(all)
}

impl Creep<'_> {
    fn check(&self) -> Result<(), CliError> {
        let refused = |why: &str| Err(CliError::input(format_args!("times: {why}")));
        if self.control == ControlKind::Penetration {
            return refused("a solid creeps under a constant load; give --pressure, not a penetration");
        }
        if self.loads.windows(2).any(|pair| pair[1] < pair[0]) {
            return refused(
                "after the load falls, a contact that shrinks is not an elastic one under another load; give one --pressure",
            );
        }
        if self.loads.len() > 1 {
            return refused("the load is constant; give one --pressure");
        }
        if self.fields {
            return refused(
                "the pressure after a time is not that of an elastic contact, so rows have no fields; omit fields",
            );
        }
        Ok(())
    }
}

/// Columns of an elastic contact that a solid which has crept does not have: its pressure has another history.
const NOT_CREPT: [&str; 6] = [
    "rms_pressure",
    "rms_pressure_corrected",
    "rms_pressure_error",
    "max_pressure",
    "contact_stiffness",
    "elastic_energy",
];

/// Makes the cells of an elastic contact those of a solid that has crept. The ratio of their loads is `creep`.
pub fn crept(cells: &mut Cells, creep: f64) {
    for key in NOT_CREPT {
        cells.shift_remove(key);
    }
    if let Some(pressure) = cells.get("mean_pressure").and_then(Value::as_f64) {
        cells.insert("mean_pressure".to_owned(), (pressure / creep).into());
    }
}
