//! The treatments of a study: those of `rc prepare`, and each with one step changed.

use rc_core::Boundary;
use rc_heights::{Crop, Fill, HeightMap, Level, Periodic, Treatment};

use crate::error::CliError;
use crate::prepare::args::{after_crops, treatments};
use crate::surface::treatment::{PeriodicName, TreatmentKeys};

/// Robust deviations of a spike that a study tries.
const DESPIKE: [f64; 3] = [6.0, 8.0, 12.0];

/// Cut-off wavelengths that a study tries, in spacings. The least that the filter takes is four.
const LOW_PASS: [f64; 2] = [4.0, 8.0];

/// Part of each side that the smaller part of the map has.
const CROP: f64 = 0.75;

/// A map's treatment in a study.
#[derive(Clone, Debug)]
pub(super) struct Variant {
    /// The step that differs from the first variant, such as `fill`; `none` in the first.
    pub(super) step: &'static str,
    /// What differs, in words.
    pub(super) name: String,
    /// All treatments in their order.
    pub(super) treatments: Vec<Treatment>,
    /// What is beyond the heights; `None` for the default.
    pub(super) boundary: Option<Boundary>,
}

/// What a study starts from.
pub(super) struct Base<'a> {
    /// The treatments that are not changed.
    pub(super) keys: &'a TreatmentKeys,
    pub(super) boundary: Option<Boundary>,
    /// The map after its first crop.
    pub(super) cropped: &'a HeightMap,
}

impl Base<'_> {
    /// The unchanged treatments first, then those with one step changed.
    ///
    /// # Errors
    /// [`CliError::Input`] when `resample` is not a grid.
    pub(super) fn variants(&self) -> Result<Vec<Variant>, CliError> {
        let mut all = vec![self.with("none", "as prepared", self.keys)?];
        all.extend(self.fills()?);
        let levels = [Level::Plane, Level::Quadratic].into_iter().filter(|form| self.keys.level != Some(*form));
        for form in levels {
            let keys = TreatmentKeys { level: Some(form), ..self.keys.clone() };
            all.push(self.with("level", &format!("level {form}"), &keys)?);
        }
        // A part of a periodic map is not periodic.
        if self.keys.periodic != Some(PeriodicName::AsIs) {
            all.push(self.inserted("crop", &format!("middle {CROP} of each side"), self.smaller(), after_crops)?);
        }
        all.extend(self.borders()?);
        all.extend(self.low_passes()?);
        for sigma in DESPIKE.into_iter().filter(|sigma| self.keys.despike != Some(*sigma)) {
            let keys = TreatmentKeys { despike: Some(sigma), ..self.keys.clone() };
            all.push(self.with("despike", &format!("despike {sigma}"), &keys)?);
        }
        all.push(self.inserted("points", "every second point", Treatment::EverySecond, before_border)?);
        Ok(all)
    }

    fn with(&self, step: &'static str, name: &str, keys: &TreatmentKeys) -> Result<Variant, CliError> {
        Ok(Variant { step, name: name.to_owned(), treatments: treatments(keys)?, boundary: self.boundary })
    }

    /// The unchanged treatments and one more, at the place that `at` finds.
    fn inserted(
        &self,
        step: &'static str,
        name: &str,
        more: Treatment,
        at: fn(&[Treatment]) -> usize,
    ) -> Result<Variant, CliError> {
        let mut variant = self.with(step, name, self.keys)?;
        let at = at(&variant.treatments);
        variant.treatments.insert(at, more);
        Ok(variant)
    }

    /// Other ways to fill, if there is anything to fill.
    fn fills(&self) -> Result<Vec<Variant>, CliError> {
        if self.cropped.missing() == 0 {
            return Ok(Vec::new());
        }
        let others =
            [Fill::Laplace, Fill::Nearest, Fill::Lowest].into_iter().filter(|how| self.keys.fill != Some(*how));
        others
            .map(|how| {
                self.with("fill", &format!("fill {how}"), &TreatmentKeys { fill: Some(how), ..self.keys.clone() })
            })
            .collect()
    }

    /// Other borders: periodic ones, and a patch with free borders.
    fn borders(&self) -> Result<Vec<Variant>, CliError> {
        let is_patch = self.boundary == Some(Boundary::Free);
        let mut all = Vec::new();
        for (how, name) in [(PeriodicName::Mirror, "mirror"), (PeriodicName::Window, "window")] {
            if self.keys.periodic == Some(how) && !is_patch {
                continue;
            }
            let keys = TreatmentKeys { periodic: Some(how), ..self.keys.clone() };
            let variant = self.with("border", &format!("periodic {name}"), &keys)?;
            all.push(Variant { boundary: Some(Boundary::Periodic), ..variant });
        }
        if !is_patch {
            let keys = TreatmentKeys { periodic: None, ..self.keys.clone() };
            all.push(Variant { boundary: Some(Boundary::Free), ..self.with("border", "free patch", &keys)? });
        }
        Ok(all)
    }

    /// Low-pass filters of other lengths.
    fn low_passes(&self) -> Result<Vec<Variant>, CliError> {
        let with = |name: &str, low_pass| self.with("low-pass", name, &TreatmentKeys { low_pass, ..self.keys.clone() });
        if let Some(length) = self.keys.low_pass {
            return Ok(vec![with("no low-pass", None)?, with("low-pass, twice the length", Some(2.0 * length))?]);
        }
        let [dx, dy] = self.cropped.spacing();
        let spacing = dx.max(dy);
        LOW_PASS.into_iter().map(|n| with(&format!("low-pass {n} points"), Some(n * spacing))).collect()
    }

    /// The part of the cropped map in its middle.
    fn smaller(&self) -> Treatment {
        let grid = self.cropped.heights.grid();
        let [nx, ny] = [grid.nx(), grid.ny()].map(|n| ((CROP * n as f64).round() as usize).max(1));
        Treatment::Crop(Crop::Points { nx, ny, from: None })
    }
}

/// The place before the border is made periodic, and before the filters that take that border as it is.
///
/// A mirrored map of every second point then is that of the thinned map.
fn before_border(treatments: &[Treatment]) -> usize {
    let is_border = |treatment: &Treatment| {
        matches!(treatment, Treatment::Periodic(Periodic::Mirror | Periodic::Window { .. } | Periodic::AsIs))
            || matches!(treatment, Treatment::LowPass { .. } | Treatment::Resample(_) | Treatment::Repeat(_))
    };
    treatments.iter().position(is_border).unwrap_or(treatments.len())
}

#[cfg(test)]
mod tests {
    use rc_core::{Field, Grid};

    use super::*;

    fn names(keys: &TreatmentKeys, boundary: Option<Boundary>, hole: bool) -> Vec<String> {
        let mut heights = Field::from_fn(Grid::square(16).expect("a grid"), |at| at.x * at.y);
        if hole {
            heights.values_mut()[17] = f64::NAN;
        }
        let cropped = HeightMap { sides: Some([16.0, 16.0]), ..HeightMap::bare(heights) };
        let base = Base { keys, boundary, cropped: &cropped };
        base.variants().expect("variants").into_iter().map(|variant| variant.name).collect()
    }

    #[test]
    fn one_step_is_changed_and_never_to_what_it_is() {
        let usual = TreatmentKeys {
            crop: Some(Crop::Measured),
            despike: Some(8.0),
            level: Some(Level::Plane),
            fill: Some(Fill::Laplace),
            periodic: Some(PeriodicName::Mirror),
            taper: 0.1,
            ..TreatmentKeys::default()
        };
        let of_whole = names(&usual, None, false);
        let expected = [
            "as prepared",
            "level quadratic",
            "middle 0.75 of each side",
            "periodic window",
            "free patch",
            "low-pass 4 points",
            "low-pass 8 points",
            "despike 6",
            "despike 12",
            "every second point",
        ];
        assert_eq!(of_whole, expected);
        assert_eq!(names(&usual, None, true)[1..3], ["fill nearest", "fill lowest"]);
        let patch = TreatmentKeys { periodic: None, low_pass: Some(5.0), ..usual };
        let of_patch = names(&patch, Some(Boundary::Free), false);
        assert_eq!(of_patch[3..7], ["periodic mirror", "periodic window", "no low-pass", "low-pass, twice the length"]);
    }

    #[test]
    fn points_are_dropped_before_the_map_is_mirrored() {
        let mirror = Treatment::Periodic(Periodic::Mirror);
        let fill = Treatment::Fill(Fill::Laplace);
        assert_eq!(before_border(&[Treatment::Crop(Crop::Measured), fill, mirror]), 2);
        assert_eq!(before_border(&[fill]), 1);
        assert_eq!(after_crops(&[Treatment::Crop(Crop::Measured), Treatment::Crop(Crop::Square), fill]), 2);
    }
}
