//! Reference values of the scenes, `data/bench/reference.csv`, and errors relative to them.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use rc_figures::repository;
use serde::{Deserialize, Serialize};

use super::record::from_csv;

/// File of the reference values.
pub(super) const REFERENCE: &str = "data/bench/reference.csv";

/// Quantities that have a reference value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Quantity {
    /// Contact area, relative to the cell.
    Area,
    /// Root mean square pressure, in E*.
    RmsPressure,
    /// Penetration Δ, in λ, from the highest point of the surface.
    Penetration,
    /// Mean gap, in λ.
    MeanGap,
}

impl Quantity {
    /// The quantities whose errors are shown. The error of the mean gap is the same as that of the penetration.
    pub(super) const COMPARED: [Self; 3] = [Self::Area, Self::RmsPressure, Self::Penetration];

    /// Name in sentences.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::RmsPressure => "rms pressure",
            Self::Penetration => "penetration",
            Self::MeanGap => "mean gap",
        }
    }
}

/// A reference value, which is a common limit of the two kernels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ReferenceRow {
    pub(super) scene: String,
    pub(super) quantity: Quantity,
    pub(super) value: f64,
    /// Estimated error of the value, from its own meshes.
    pub(super) uncertainty: f64,
    /// The limit of uniform grids with the other kernel, found independently.
    pub(super) other_kernel: f64,
    /// Estimated error of `other_kernel`.
    pub(super) other_uncertainty: f64,
}

impl ReferenceRow {
    /// The uncertainty that the documents state.
    ///
    /// It is at least the difference between the limits of the two kernels, since both have the same true limit.
    pub(super) fn stated_uncertainty(&self) -> f64 {
        self.uncertainty.max((self.value - self.other_kernel).abs())
    }
}

/// The reference values by scene and quantity.
#[derive(Clone, Debug)]
pub(super) struct References(BTreeMap<(String, Quantity), ReferenceRow>);

impl References {
    /// Reads the reference file of the repository.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub(super) fn read() -> Result<Self> {
        let path = repository::root().join(REFERENCE);
        let text = std::fs::read_to_string(&path).with_context(|| {
            format!("could not read {}; `cargo xtask bench --make-reference` makes it", path.display())
        })?;
        Self::from_text(&text)
    }

    /// The reference values in the text of a file.
    ///
    /// # Errors
    /// When a line is not as expected. The text names the line.
    pub(super) fn from_text(text: &str) -> Result<Self> {
        let rows: Vec<ReferenceRow> = from_csv(text, REFERENCE)?;
        Ok(Self(rows.into_iter().map(|row| ((row.scene.clone(), row.quantity), row)).collect()))
    }

    /// The reference value of a quantity in a scene, if the file has it.
    pub(super) fn row(&self, scene: &str, quantity: Quantity) -> Option<&ReferenceRow> {
        self.0.get(&(scene.to_owned(), quantity))
    }

    /// Relative error of a value, with its sign.
    ///
    /// For a penetration, `value` is the mean gap, and its error is divided by the penetration. Penetration and mean
    /// gap add up to the height of the highest point, and how close a grid's points are to that point says nothing
    /// about a solver.
    pub(super) fn error(&self, scene: &str, quantity: Quantity, value: f64) -> Option<f64> {
        let reference = self.row(scene, quantity)?.value;
        if quantity == Quantity::Penetration {
            return Some((self.row(scene, Quantity::MeanGap)?.value - value) / reference);
        }
        Some(value / reference - 1.0)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::bench::levels::levels;
    use crate::bench::record::to_csv;
    use crate::bench::scenes::SCENES;

    const ALL: [Quantity; 4] = [Quantity::Area, Quantity::RmsPressure, Quantity::Penetration, Quantity::MeanGap];

    const MEAN_GAP: f64 = 2.5;

    /// Reference values of one scene.
    pub(in crate::bench) fn references(scene: &str, [area, rms_pressure, penetration]: [f64; 3]) -> References {
        let values = [area, rms_pressure, penetration, MEAN_GAP].into_iter().zip(ALL);
        let row = |(value, quantity)| ReferenceRow {
            scene: scene.to_owned(),
            quantity,
            value,
            uncertainty: 1e-6 * value,
            other_kernel: value,
            other_uncertainty: 1e-5 * value,
        };
        let text = to_csv(&values.map(row).collect::<Vec<_>>()).expect("plain values");
        References::from_text(&text).expect("its own output")
    }

    /// Each scene has its values, and the limits of the two kernels agree.
    #[test]
    fn the_kernels_have_one_limit() {
        let references = References::read().expect("the file of the repository");
        for scene in SCENES {
            for quantity in ALL {
                let row = references.row(scene.name, quantity);
                let row = row.unwrap_or_else(|| panic!("no {} of {}", quantity.name(), scene.name));
                let (apart, allowed) = ((row.value - row.other_kernel).abs(), row.uncertainty + row.other_uncertainty);
                assert!(apart <= allowed, "{row:?}: {apart:e} apart, {allowed:e} allowed");
                assert!(row.uncertainty < 1e-4 * row.value, "{row:?} is not good enough to compare with");
            }
        }
    }

    /// The stated uncertainty covers the difference of the kernels.
    ///
    /// It is small compared with every error level.
    #[test]
    fn stated_uncertainties_cover_the_disagreement_of_the_kernels() {
        let references = References::read().expect("the file of the repository");
        let mut n_raised = 0;
        for scene in SCENES {
            for quantity in ALL {
                let row = references.row(scene.name, quantity).expect("a value");
                let (stated, apart) = (row.stated_uncertainty(), (row.value - row.other_kernel).abs());
                assert!(stated >= apart && stated >= row.uncertainty, "{row:?}: {stated:e}");
                n_raised += usize::from(stated > row.uncertainty);
                let wanted = levels().filter(|(other, _)| *other == quantity).map(|(_, level)| level);
                let wanted = wanted.fold(f64::INFINITY, f64::min);
                assert!(stated <= wanted * row.value / 3.0, "{row:?} is not good enough for {wanted:e}");
            }
        }
        assert!(n_raised > 0, "the kernels agree everywhere: then this test checks nothing");
    }

    #[test]
    fn the_error_of_a_penetration_is_that_of_the_gap() {
        let references = references("paper", [0.07, 4e-3, 2.0]);
        let error = |quantity, value| references.error("paper", quantity, value).unwrap_or(f64::NAN);
        let penetration = error(Quantity::Penetration, MEAN_GAP + 0.02);
        assert!((penetration + 0.01).abs() < 1e-12, "{penetration}");
        assert!((error(Quantity::MeanGap, MEAN_GAP + 0.02) - 0.008).abs() < 1e-12);
        assert!((error(Quantity::Area, 0.0707) - 0.01).abs() < 1e-12);
        assert_eq!(references.error("unknown", Quantity::Area, 0.07), None);
    }
}
