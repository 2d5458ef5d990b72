//! The plan of a sweep whose rows a program solves.
//!
//! It is the plan of `rc sweep`, so that each can continue the rows of the other.

use rc_sweep::{ControlKind, Loads, Seeds, SweepPlan};

use super::creep::{Creep, after_times};
use super::map_mark::MapMark;
use super::surfaces::{SweptSurface, check_rows, seeded};
use super::varied::{self, Variation};
use crate::error::CliError;
use crate::scene::keys::Scene;

/// Lists of a sweep, in addition to its scene.
#[derive(Clone, Debug)]
pub struct SweepLists {
    /// Quantity of the loads.
    pub control: ControlKind,
    /// Pressures (Pa) or penetrations (m). They are empty for a force, which is a key of the scene.
    pub loads: Loads,
    /// Seeds of a random surface, if the sweep has several.
    pub seeds: Option<Seeds>,
    /// Keys with several values.
    pub vary: Vec<Variation>,
    /// Times (s) of creep under a constant load.
    pub times: Option<Loads>,
    /// Whether rows keep fields or results.
    pub fields: bool,
}

/// The plan of a sweep, with what a row of creep is made from.
#[derive(Clone, Debug)]
pub struct PlannedRows {
    /// The plan.
    pub plan: SweepPlan,
    /// For each surface of the plan, the ratio of its loads to that under which a solid creeps.
    pub creep: Vec<Option<f64>>,
}

/// The plan of `rc sweep` for a scene with the name `name`.
///
/// `map` describes a map that a program holds.
///
/// # Errors
/// [`CliError::Input`] for keys that cannot be solved, or a file that cannot be read.
pub fn plan(name: &str, scene: &Scene, lists: &SweepLists, map: Option<MapMark>) -> Result<PlannedRows, CliError> {
    let SweepLists { control, loads: Loads(loads), seeds, vary, times, fields } = lists;
    let scenes = varied::scenes(vary, scene)?.into_iter().map(|(varied, scene)| (name.to_owned(), varied, scene));
    let times = Creep { times: times.as_ref(), control: *control, loads, fields: *fields };
    let (mut surfaces, mut creep) = (Vec::new(), Vec::new());
    for (_, varied, scene, crept) in after_times(times, scenes.collect())? {
        check_rows(surfaces.len() + 1, seeds.as_ref(), loads.len().max(1))?;
        let ratio = crept.as_ref().map(|crept| crept.ratio);
        let loads: Vec<f64> = loads.iter().map(|load| load * ratio.unwrap_or(1.0)).collect();
        for scene in seeded(seeds.as_ref(), name, &scene)? {
            let surface = match map {
                Some(map) => SweptSurface::of_map(name, scene, (*control, &loads), map)?,
                None => SweptSurface::new(name, scene, *control, &loads)?,
            };
            surfaces.push(surface.with(varied.clone(), crept.clone()).planned()?);
            creep.push(ratio);
        }
    }
    Ok(PlannedRows { plan: SweepPlan::new(*control, surfaces), creep })
}
