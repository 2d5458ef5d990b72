//! The record of the sealing pressures of a sweep.

use std::path::Path;

use rc_core::quantity::{digits, engineering};
use serde::{Deserialize, Serialize};

use super::means::Mean;
use crate::error::CliError;
use crate::study::record::words_with_error;

/// File of the sealing pressures in the folder of a sweep.
pub(crate) const SEALING_FILE: &str = "sealing.json";

/// Minimum number of surfaces of a standard error.
const FEWEST: usize = 3;

/// Names of the axes of flows.
pub(crate) const AXES: [&str; 2] = ["x", "y"];

/// The sealing pressures of a sweep.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Sealing {
    /// The sealing pressure (Pa) of the only problem; `None` if there are several, or its film does not close between the
    /// loads.
    #[serde(rename = "sealing_pressure")]
    pressure: Option<f64>,
    /// Highest mean pressure (Pa) with a flow and lowest without, of the only problem.
    bracket: Option<[f64; 2]>,
    /// Each scene, and each variation of its keys.
    problems: Vec<Problem>,
}

/// The seal of one scene, of which surfaces are realisations.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Problem {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub(crate) scene: String,
    /// Mean over surfaces and axes (Pa); `None` unless the film of each closes between the loads.
    #[serde(rename = "sealing_pressure")]
    pressure: Option<f64>,
    /// Standard error (Pa) of the mean over at least three surfaces, each of which counts with the mean of its axes.
    standard_error: Option<f64>,
    /// Lowest pressure (Pa) with a flow, and highest without, in the brackets of all surfaces and axes.
    bracket: Option<[f64; 2]>,
    pub(crate) surfaces: Vec<SurfaceSeal>,
}

/// The sealing pressure of one surface along one axis.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SurfaceSeal {
    seed: Option<u64>,
    axis: String,
    /// Middle of the bracket (Pa).
    #[serde(rename = "sealing_pressure")]
    pressure: Option<f64>,
    /// Highest mean pressure (Pa) at which the film leaks, and lowest at which it does not; null where no load shows it.
    bracket: [Option<f64>; 2],
    /// Contact area (fraction of the nominal area) at both ends of the bracket.
    #[serde(default)]
    area_fraction: [Option<f64>; 2],
}

impl Problem {
    pub(crate) fn new(scene: String) -> Self {
        Self { scene, pressure: None, standard_error: None, bracket: None, surfaces: Vec::new() }
    }

    /// Fills in the means, once all surfaces are there.
    fn average(&mut self) {
        let brackets = self.surfaces.iter().map(|seal| seal.bracket[0].zip(seal.bracket[1]));
        let both = brackets.flatten().reduce(|all, one| (all.0.min(one.0), all.1.max(one.1)));
        self.bracket = both.map(|(low, high)| [low, high]);
        // Without those beyond the loads the mean would be too small.
        let of_surface = |pair: &[SurfaceSeal]| {
            let axes: Option<Vec<f64>> = pair.iter().map(|seal| seal.pressure).collect();
            axes.map(|axes| [axes.iter().sum::<f64>() / axes.len() as f64, 0.0])
        };
        let found = self.surfaces.chunks(AXES.len()).map(of_surface).collect::<Option<Vec<[f64; 2]>>>();
        let Some((mean, n)) = found.and_then(|found| Some((Mean::of(&found)?, found.len()))) else { return };
        self.pressure = Some(mean.value);
        self.standard_error = mean.standard_error.filter(|_| n >= FEWEST);
    }

    /// The sealing pressure as text.
    fn line(&self) -> String {
        let pressure = |value: f64| engineering(value, "Pa");
        let name = if self.scene.is_empty() { String::new() } else { format!(" ({})", self.scene) };
        if self.surfaces.len() == AXES.len() {
            let axes = self.surfaces.iter().map(SurfaceSeal::words).collect::<Vec<_>>().join(", ");
            return format!("sealing pressure{name}: {axes}\n");
        }
        let n = self.surfaces.len() / AXES.len();
        let of_mean =
            |mean| self.standard_error.map_or_else(|| pressure(mean), |error| words_with_error(mean, error, "Pa"));
        match (self.pressure, self.bracket) {
            (Some(mean), Some([low, high])) => {
                let range = format!("from {} to {}", pressure(low), pressure(high));
                format!("sealing pressure{name}: {}, mean of {n} surfaces, {range}\n", of_mean(mean))
            }
            _ => format!(
                "sealing pressure{name}: some of {n} surfaces are open or closed at all loads, see {SEALING_FILE}\n"
            ),
        }
    }
}

impl SurfaceSeal {
    /// The seal between the last state with a flow and the first without: mean pressures (Pa) and contact areas.
    pub(crate) fn new(seed: Option<u64>, axis: &str, ends: [Option<[f64; 2]>; 2]) -> Self {
        let [bracket, area_fraction] = [0, 1].map(|i| ends.map(|end| end.map(|end| end[i])));
        let pressure = bracket[0].zip(bracket[1]).map(|(leaks, seals)| 0.5 * (leaks + seals));
        Self { seed, axis: axis.to_owned(), pressure, bracket, area_fraction }
    }

    /// Pressure, bracket and contact area along the axis.
    fn words(&self) -> String {
        let pressure = |value: f64| engineering(value, "Pa");
        let percent = |area: f64| digits(100.0 * area, 3);
        let text = match (self.pressure, self.bracket) {
            (Some(found), [Some(leaks), Some(seals)]) => {
                let area = match self.area_fraction {
                    [Some(low), Some(high)] => format!(", contact area {} to {} %", percent(low), percent(high)),
                    _ => String::new(),
                };
                format!("{} ({} to {}{area})", pressure(found), pressure(leaks), pressure(seals))
            }
            (_, [Some(leaks), _]) => format!("above {}", pressure(leaks)),
            (_, [None, Some(seals)]) => format!("below {}", pressure(seals)),
            (_, [None, None]) => "unknown".to_owned(),
        };
        format!("{text} along {}", self.axis)
    }
}

impl Sealing {
    /// The means of the problems, once all their surfaces are there.
    pub(crate) fn of(mut problems: Vec<Problem>) -> Self {
        problems.iter_mut().for_each(Problem::average);
        let only = if let [only] = &problems[..] { Some(only) } else { None };
        Self { pressure: only.and_then(|only| only.pressure), bracket: only.and_then(|only| only.bracket), problems }
    }

    /// The sealing pressures in the folder of a sweep; `None` if there are none.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is no record of them.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, CliError> {
        let path = folder.join(SEALING_FILE);
        let Ok(text) = std::fs::read_to_string(&path) else { return Ok(None) };
        let read = serde_json::from_str(&text);
        read.map(Some)
            .map_err(|cause| CliError::in_file(&path, format_args!("not sealing pressures of rc sweep: {cause}")))
    }

    /// A line for each problem.
    pub(crate) fn lines(&self) -> String {
        self.problems.iter().map(Problem::line).collect()
    }
}
