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
    /// Mean gap, in λ.
    MeanGap,
}

impl Quantity {
    /// All quantities, in the order of tables and pictures.
    pub(super) const ALL: [Self; 3] = [Self::Area, Self::RmsPressure, Self::MeanGap];

    /// Name in sentences.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Area => "area",
            Self::RmsPressure => "rms pressure",
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
    pub(super) fn error(&self, scene: &str, quantity: Quantity, value: f64) -> Option<f64> {
        Some(value / self.row(scene, quantity)?.value - 1.0)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::bench::record::to_csv;
    use crate::bench::scenes::SCENES;
    use crate::bench::times::LEVELS;

    /// Reference values of one scene: area, rms pressure and mean gap.
    pub(in crate::bench) fn references(scene: &str, values: [f64; 3]) -> References {
        let row = |(value, quantity)| ReferenceRow {
            scene: scene.to_owned(),
            quantity,
            value,
            uncertainty: 1e-6 * value,
            other_kernel: value,
            other_uncertainty: 1e-5 * value,
        };
        let rows: Vec<ReferenceRow> = values.into_iter().zip(Quantity::ALL).map(row).collect();
        References::from_text(&to_csv(&rows).expect("plain values")).expect("its own output")
    }

    /// Each scene has its values, and the limits of the two kernels agree.
    ///
    /// The values are good enough to compare errors of every level with.
    #[test]
    fn the_kernels_have_one_limit() {
        let references = References::read().expect("the file of the repository");
        for scene in SCENES {
            for quantity in Quantity::ALL {
                let row = references.row(scene.name, quantity);
                let row = row.unwrap_or_else(|| panic!("no {} of {}", quantity.name(), scene.name));
                let (apart, allowed) = ((row.value - row.other_kernel).abs(), row.uncertainty + row.other_uncertainty);
                assert!(apart <= allowed, "{row:?}: {apart:e} apart, {allowed:e} allowed");
                assert!(row.uncertainty < 1e-4 * row.value, "{row:?} is not good enough to compare with");
                let levels = LEVELS.into_iter().filter(|(of, _)| *of == quantity).map(|(_, level)| level);
                let smallest = levels.fold(f64::INFINITY, f64::min);
                let uncertainty = row.uncertainty.max(apart);
                assert!(uncertainty <= smallest * row.value / 3.0, "{row:?} is not good enough for {smallest:e}");
            }
        }
    }

    #[test]
    fn errors_are_relative() {
        let references = references("paper", [0.07, 4e-3, 2.5]);
        let error = |quantity, value| references.error("paper", quantity, value).unwrap_or(f64::NAN);
        assert!((error(Quantity::MeanGap, 2.52) - 0.008).abs() < 1e-12);
        assert!((error(Quantity::Area, 0.0707) - 0.01).abs() < 1e-12);
        assert_eq!(references.error("unknown", Quantity::Area, 0.07), None);
    }
}
