//! `--times`: contacts of a solid that creeps under a constant load.

use rc_sweep::{ControlKind, Loads};
use serde_json::json;

use super::args::SweepArgs;
use super::varied::Varied;
use crate::error::CliError;
use crate::scene::keys::Scene;
use crate::scene::resolve;

/// A scene with its name, its varied values, and the ratio of its loads to that under which a solid creeps.
pub(super) type TimedScene = (String, Varied, Scene, Option<f64>);

/// The scenes at each of the times, or unchanged without times.
///
/// A contact under a constant load grows, and is then the elastic contact under σ0 J(t)/J∞ (E. H. Lee and J. R. M. Radok,
/// J. Appl. Mech. 27 (1960) 438-444).
pub(super) fn after_times(
    args: &SweepArgs,
    control: ControlKind,
    scenes: Vec<(String, Varied, Scene)>,
) -> Result<Vec<TimedScene>, CliError> {
    let Some(Loads(times)) = &args.times else {
        return Ok(scenes.into_iter().map(|(name, values, scene)| (name, values, scene, None)).collect());
    };
    let refused = |why: &str| Err(CliError::input(format_args!("times: {why}")));
    if control == ControlKind::Penetration {
        return refused("a solid creeps under a constant load; give --pressure, not a penetration");
    }
    if args.pressures.as_ref().is_some_and(|Loads(pressures)| pressures.len() > 1) {
        return refused("the load is constant; give one --pressure");
    }
    if args.fields {
        return refused(
            "the pressure after a time is not that of an elastic contact, so rows have no fields; omit --fields",
        );
    }
    let mut all = Vec::new();
    for (name, values, scene) in scenes {
        let material = resolve::sliding::creeping(&scene.contact)?;
        for time in times {
            let creep = material.creep(*time).filter(|creep| *creep > 0.0);
            let varied = values.iter().cloned().chain([("time".to_owned(), json!(time))]).collect();
            let mut contact = scene.contact.clone().elastic();
            contact.force = contact.force.map(|force| force * creep.unwrap_or(1.0));
            all.push((name.clone(), varied, Scene { contact, ..scene.clone() }, creep));
        }
    }
    Ok(all)
}
