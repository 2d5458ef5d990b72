//! The plan of a sweep whose rows a program solves.
//!
//! It is the plan of `rc sweep`, so that each can continue the rows of the other.

use rc_sweep::{ControlKind, Loads, Seeds, SweepPlan};

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
}

/// The plan of `rc sweep` for a scene with the name `name`.
///
/// `map` describes a map that a program holds.
///
/// # Errors
/// [`CliError::Input`] for keys that cannot be solved, or a file that cannot be read.
pub fn plan(name: &str, scene: &Scene, lists: &SweepLists, map: Option<MapMark>) -> Result<SweepPlan, CliError> {
    let SweepLists { control, loads: Loads(loads), seeds, vary } = lists;
    let mut surfaces = Vec::new();
    for (varied, scene) in varied::scenes(vary, scene)? {
        check_rows(surfaces.len() + 1, seeds.as_ref(), loads.len().max(1))?;
        for scene in seeded(seeds.as_ref(), name, &scene)? {
            let surface = match map {
                Some(map) => SweptSurface::of_map(name, scene, (*control, loads), map)?,
                None => SweptSurface::new(name, scene, *control, loads)?,
            };
            surfaces.push(surface.with(varied.clone()).planned()?);
        }
    }
    Ok(SweepPlan::new(*control, surfaces))
}
