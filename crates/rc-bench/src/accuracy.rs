//! `cargo xtask accuracy`: how often the error bars hold, on random scenes.
//!
//! Every seed gives other scenes. Constants of error bars were chosen with scenes of the seeds 1, 11 to 13, and above
//! 100. Limits are from elements three to sixteen times smaller, and for the area from the other kernel. A bar that holds too seldom in a
//! stratum fails the command, and so does one that is too wide.

mod binomial;
mod measured;
mod random;
mod scene;
mod strata;
mod surfaces;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use rayon::prelude::*;
use rc_figures::Preset;

use measured::Measured;
use scene::{Family, Scene};

/// The scenes to solve.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The seed of all scenes.
    pub seed: u64,
    /// Least number of scenes in most strata.
    pub scenes: usize,
    /// Names of families. All if there is none.
    pub families: Vec<String>,
}

impl Choice {
    /// The scenes of a preset.
    #[must_use]
    pub fn of(preset: Preset) -> Self {
        let scenes = if preset == Preset::Full { 400 } else { 12 };
        Self { seed: 1, scenes, families: Vec::new() }
    }
}

/// Solves all scenes, writes and prints the table of strata, and writes the scenes.
///
/// # Errors
/// When a contact cannot be solved, a file cannot be written, a family is unknown, or a bar is too narrow or too wide.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub fn run(choice: &Choice, folder: &Path) -> Result<()> {
    let scenes = measure(choice)?;
    let table = strata::table(&scenes);
    fs::create_dir_all(folder).context(folder.display().to_string())?;
    for (name, text) in [("accuracy-coverage.csv", &table.csv), ("accuracy-scenes.csv", &measured::as_csv(&scenes))] {
        let path = folder.join(name);
        fs::write(&path, text).context(path.display().to_string())?;
    }
    println!("{}\n{}", table.aligned(), folder.join("accuracy-coverage.csv").display());
    let faults = strata::faults(&scenes);
    ensure!(faults.is_empty(), "seed {}:\n{}", choice.seed, faults.join("\n"));
    Ok(())
}

/// The errors and bars of all scenes.
fn measure(choice: &Choice) -> Result<Vec<Measured>> {
    let names = Family::ALL.map(Family::name);
    let unknown = choice.families.iter().find(|name| !names.contains(&name.as_str()));
    ensure!(unknown.is_none(), "family {}: unknown; there are {}", unknown.map_or("", |name| name), names.join(", "));
    let is_chosen = |family: &Family| choice.families.is_empty() || choice.families.iter().any(|f| f == family.name());
    let families = Family::ALL.into_iter().filter(is_chosen);
    let scenes: Vec<_> =
        families.flat_map(|family| (0..choice.scenes * family.parts()).map(move |i| (family, i))).collect();
    let measure = |(family, i): (Family, usize)| {
        let scene = Scene::new(family, choice.seed, i).and_then(|scene| Measured::of(&scene));
        scene.with_context(|| format!("{}, scene {i} of seed {}", family.name(), choice.seed))
    };
    scenes.into_par_iter().map(measure).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_hold_on_a_few_scenes_of_each_family() {
        let scenes = measure(&Choice { seed: 2, ..Choice::of(Preset::Quick) }).expect("solvable scenes");
        assert_eq!(strata::faults(&scenes), Vec::<String>::new());
        assert!(strata::table(&scenes).csv.lines().count() > 40);
        let families = Family::ALL.into_iter().map(Family::parts).sum::<usize>();
        assert_eq!(scenes.len(), 12 * families);
    }

    #[test]
    fn located_areas_have_less_than_a_fifth_of_the_counting_error() {
        let families = vec![Family::Rough.name().to_owned()];
        let scenes = measure(&Choice { seed: 3, scenes: 12, families }).expect("solvable scenes");
        for spectral in [false, true] {
            // Contacts of a few elements, and pools of a few elements, have relative errors of their own.
            let is_meant = |scene: &&Measured| scene.elements_per_wave >= 8 && (0.01..0.95).contains(&scene.limits[0]);
            let of_kernel = |scene: &&Measured| is_meant(scene) && scene.is_spectral == spectral;
            let [located, counted] = strata::rms_errors_of_area(scenes.iter().filter(of_kernel));
            assert!(located < 0.2 * counted, "spectral {spectral}: {located} located, {counted} counted");
        }
    }
}
