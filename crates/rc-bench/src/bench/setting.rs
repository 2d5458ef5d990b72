//! Settings of a solve: method, kernel, mesh, tolerance.

use std::fmt;

use rc_core::Kernel;
use rc_kernel::{Love, Spectral};
use rc_solver::{Method, Tolerance};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::scenes::Scene;

/// Meshes of the benchmark, in elements for the shortest wave.
///
/// The first ones hardly resolve it; only a kernel without a cut-off error of its own, and bars that are true there, make
/// them of use.
pub(super) const MESHES: [f64; 12] = [2.25, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 24.0, 32.0];

/// Coarsest mesh of `love`, whose displacement of waves of fewer elements is not theirs.
const COARSEST_OF_LOVE: f64 = 4.0;

/// Coarsest mesh of the adaptive method: the base grid has four elements for the shortest wave, and the grid must be finer
/// than it.
const COARSEST_ADAPTIVE: f64 = 8.0;

/// Largest number of elements per side of a uniform grid.
pub(super) const LARGEST_UNIFORM: usize = 2048;

/// Maximum numbers of smallest elements for the shortest wave and along the cell's side.
const SMALLEST_ELEMENTS: (f64, usize) = (64.0, 4096);

/// Deepest border level.
const DEEPEST_BORDER: usize = 3;

/// The tolerance that other programs certify too.
pub(super) const CERTIFIED: Tolerance = Tolerance::Relative(1e-6);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum KernelName {
    Love,
    Spectral,
}

impl KernelName {
    pub(super) fn kernel(self) -> &'static dyn Kernel {
        match self {
            Self::Love => &Love,
            Self::Spectral => &Spectral,
        }
    }
}

/// One way to solve a scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Setting {
    is_adaptive: bool,
    pub(super) kernel: KernelName,
    /// Number of times that elements at edges of contacts are halved.
    pub(super) border_level: usize,
    /// Elements of the grid for the shortest wave.
    pub(super) elements_per_wave: f64,
    #[serde(serialize_with = "write_tolerance", deserialize_with = "read_tolerance")]
    pub(super) tolerance: Tolerance,
}

impl Setting {
    pub(super) fn uniform(kernel: KernelName, elements_per_wave: impl Into<f64>, tolerance: Tolerance) -> Self {
        let elements_per_wave = elements_per_wave.into();
        Self { is_adaptive: false, kernel, border_level: 0, elements_per_wave, tolerance }
    }

    pub(super) fn adaptive(border_level: usize, elements_per_wave: impl Into<f64>, tolerance: Tolerance) -> Self {
        let elements_per_wave = elements_per_wave.into();
        Self { is_adaptive: true, kernel: KernelName::Love, border_level, elements_per_wave, tolerance }
    }

    pub(super) fn method(&self) -> Method {
        if self.is_adaptive { Method::Adaptive } else { Method::Uniform }
    }

    /// Elements of the border for the shortest wave.
    pub(super) fn smallest(&self) -> f64 {
        self.elements_per_wave * (self.border_level as f64).exp2()
    }

    /// Every setting on one mesh of a scene, without those that have too many elements.
    pub(super) fn of_mesh(scene: &Scene, elements_per_wave: f64) -> Vec<Self> {
        let mut settings = Vec::new();
        if scene.side(elements_per_wave) <= LARGEST_UNIFORM {
            let resolves = |kernel: &KernelName| match kernel {
                KernelName::Spectral => true,
                KernelName::Love => elements_per_wave >= COARSEST_OF_LOVE,
            };
            for kernel in [KernelName::Spectral, KernelName::Love].into_iter().filter(resolves) {
                settings.extend([Tolerance::Auto, CERTIFIED].map(|t| Self::uniform(kernel, elements_per_wave, t)));
            }
        }
        for border_level in 0..=DEEPEST_BORDER {
            let smallest = Self::adaptive(border_level, elements_per_wave, CERTIFIED).smallest();
            let (per_wave, per_side) = SMALLEST_ELEMENTS;
            if elements_per_wave < COARSEST_ADAPTIVE || smallest > per_wave || scene.side(smallest) > per_side {
                continue;
            }
            settings.push(Self::adaptive(border_level, elements_per_wave, Tolerance::Auto));
            if border_level == 0 {
                settings.push(Self::adaptive(border_level, elements_per_wave, CERTIFIED));
            }
        }
        settings
    }
}

/// A tolerance as a user types it.
pub(super) fn typed(tolerance: Tolerance) -> String {
    match tolerance {
        Tolerance::Relative(value) => format!("{value:e}"),
        Tolerance::Energy(value) => format!("{ENERGY}{value:e}"),
        Tolerance::Auto => "auto".to_owned(),
    }
}

/// First word of a tolerance of the energy error.
const ENERGY: &str = "energy ";

fn write_tolerance<S: Serializer>(tolerance: &Tolerance, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&typed(*tolerance))
}

/// Reads what [`typed`] writes.
fn read_tolerance<'a, D: Deserializer<'a>>(from: D) -> Result<Tolerance, D::Error> {
    let text = String::deserialize(from)?;
    Ok(match text.strip_prefix(ENERGY) {
        Some(number) => Tolerance::Energy(number.parse().map_err(D::Error::custom)?),
        None if text == "auto" => Tolerance::Auto,
        None => Tolerance::Relative(text.parse().map_err(D::Error::custom)?),
    })
}

/// The tolerance of a peer as a number, relative to the peak-to-valley height.
///
/// For `auto` it is 3e-5 (m/8)^(-3/2) with m elements per shortest wave. This is well below the error of the peer's
/// grid.
pub(super) fn of_peer(tolerance: Tolerance, elements_per_wave: f64) -> f64 {
    match tolerance {
        Tolerance::Relative(value) | Tolerance::Energy(value) => value,
        Tolerance::Auto => 3e-5 * (elements_per_wave / 8.0).powf(-1.5),
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { is_adaptive, kernel, border_level, elements_per_wave, tolerance } = *self;
        write!(f, "{} {}", self.method(), kernel.kernel().name())?;
        if is_adaptive {
            write!(f, ", border level {border_level}")?;
        }
        write!(f, ", λ_min/{elements_per_wave}, tolerance {}", typed(tolerance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::scenes::SCENES;

    #[test]
    fn settings_stay_within_their_bounds() {
        for scene in SCENES {
            for mesh in MESHES {
                let settings = Setting::of_mesh(&scene, mesh);
                assert!(!settings.is_empty(), "{} has nothing to solve at λ_min/{mesh}", scene.name);
                for setting in settings {
                    let side = scene.side(setting.smallest());
                    assert!(side <= SMALLEST_ELEMENTS.1, "{}: {setting}", scene.name);
                    assert!(setting.is_adaptive || side <= LARGEST_UNIFORM, "{}: {setting}", scene.name);
                }
            }
        }
    }

    #[test]
    fn a_setting_is_written_for_people_and_for_processes() {
        let setting = Setting::adaptive(2, 8, Tolerance::Auto);
        assert_eq!(setting.to_string(), "adaptive love, border level 2, λ_min/8, tolerance auto");
        for tolerance in [CERTIFIED, Tolerance::Auto, Tolerance::DEFAULT] {
            let setting = Setting::uniform(KernelName::Spectral, 4, tolerance);
            let text = serde_json::to_string(&setting).expect("plain data");
            assert_eq!(serde_json::from_str::<Setting>(&text).ok(), Some(setting), "{text}");
        }
    }
}
