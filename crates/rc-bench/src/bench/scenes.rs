//! The fixed scenes of the benchmark.

use anyhow::{Context, Result};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::Control;

/// A surface of the paper's spectrum under a mean pressure.
///
/// The rms height is 1.3e-3 of the cell.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub(super) name: &'static str,
    /// Number of waves N; the shortest is λ_min = λ/N.
    pub(super) waves: usize,
    /// Hurst exponent.
    pub(super) hurst: f64,
    pub(super) seed: u64,
    /// Mean pressure σ0/E*.
    pub(super) load: f64,
}

const fn scene(name: &'static str, waves: usize, hurst: f64, seed: u64, load: f64) -> Scene {
    Scene { name, waves, hurst, seed, load }
}

/// Every scene, with contact areas from 1 % to 30 %. The first scene is the paper's (Fig. 6a).
pub(super) const SCENES: [Scene; 10] = [
    scene("paper", 64, 0.8, 1, 8.9e-4),
    scene("seed-2", 64, 0.8, 2, 8.9e-4),
    scene("light", 64, 0.8, 3, 1.25e-4),
    scene("waves-128", 128, 0.8, 1, 8.9e-4),
    scene("waves-32", 32, 0.8, 4, 3.2e-4),
    scene("heavy", 32, 0.8, 5, 3.2e-3),
    scene("hurst-0.5", 32, 0.5, 6, 1.3e-3),
    scene("hurst-0.3", 32, 0.3, 7, 4.0e-3),
    scene("waves-16", 16, 0.8, 8, 6.2e-4),
    scene("hurst-0.3-light", 16, 0.3, 9, 3.4e-4),
];

/// Scenes of large grids, and scenes of several loads, all of the paper's spectrum.
///
/// The contact areas of the loads are from a thousandth to nearly full contact.
pub(super) const SCALE_SCENES: [Scene; 8] = [
    scene("waves-512", 512, 0.8, 1, 8.9e-4),
    scene("waves-1024", 1024, 0.8, 1, 8.9e-4),
    scene("load-1.25e-5", 64, 0.8, 1, 1.25e-5),
    scene("load-1.25e-4", 64, 0.8, 1, 1.25e-4),
    scene("load-4e-3", 64, 0.8, 1, 4e-3),
    scene("load-1e-2", 64, 0.8, 1, 1e-2),
    scene("load-2e-2", 64, 0.8, 1, 2e-2),
    scene("load-3.5e-2", 64, 0.8, 1, 3.5e-2),
];

impl Scene {
    /// The scene with this name.
    ///
    /// # Errors
    /// When no scene has the name. The text lists the names that exist.
    pub(super) fn named(name: &str) -> Result<Self> {
        let names = || SCENES.map(|scene| scene.name).join(", ");
        let found = SCENES.into_iter().chain(SCALE_SCENES).find(|scene| scene.name == name);
        found.with_context(|| format!("no scene is called '{name}'; there are {}", names()))
    }

    pub(super) fn surface(&self) -> Result<Surface> {
        let params = SpectrumParams { hurst: self.hurst, ..SpectrumParams::paper(self.waves, self.seed) };
        Surface::new(&params).with_context(|| format!("scene {}", self.name))
    }

    pub(super) fn control(&self) -> Control {
        Control::MeanPressure(self.load)
    }

    /// Elements per side of the cell, from elements for the shortest wave.
    pub(super) fn side(&self, elements_per_wave: f64) -> usize {
        (elements_per_wave * self.waves as f64).round() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_found_by_name_and_names_are_not_used_twice() {
        for scene in SCENES.into_iter().chain(SCALE_SCENES) {
            let found = Scene::named(scene.name).expect("a scene of the table");
            let load = |scene: Scene| (scene.waves, scene.seed, scene.load.to_bits());
            assert_eq!(load(found), load(scene), "{}", scene.name);
        }
        let error = Scene::named("papers").err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("'papers'") && error.contains("paper, seed-2"), "{error}");
    }
}
