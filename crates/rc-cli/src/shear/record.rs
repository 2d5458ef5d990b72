//! The shear curves of a sweep: `shear.json`, `shear.csv`, and the text on the terminal.

use std::path::Path;

use rc_core::quantity::{digits, engineering};
use rc_sweep::files::Staged;
use rc_sweep::to_json;
use serde::{Deserialize, Serialize};

use super::curve::ShearCurve;
use super::means::MeanCurve;
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::files::names::{SHEAR_FILE, SHEAR_MEANS, SHEAR_TABLE};

/// All shear curves.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct ShearRecord {
    /// The command that repeats them.
    pub(crate) command: String,
    /// Coulomb's coefficient of friction.
    pub(crate) friction: f64,
    /// What the curves neglect, each once.
    pub(crate) notes: Vec<String>,
    /// One for each surface and load.
    pub(crate) curves: Vec<ShearCurve>,
    /// Means over the surfaces of each scene under each load.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) means: Vec<MeanCurve>,
}

/// A line of `shear.csv`.
#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    seed: Option<u64>,
    mean_pressure: f64,
    shear_pressure: f64,
    shear_displacement: f64,
    shear_displacement_error: f64,
    slip_area_fraction: f64,
    stick_area_fraction: f64,
    tangential_stiffness: Option<f64>,
    loss_per_cycle: f64,
    loss_factor: Option<f64>,
}

/// The first columns of a line of `shear_mean.csv`, before those of its [`MeanPoint`].
#[derive(Serialize)]
struct MeanLine<'a> {
    scene: &'a str,
    surfaces: usize,
    mean_pressure: f64,
}

impl ShearRecord {
    /// The record in `folder`; `None` if there is none.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is no record of shear curves.
    pub(crate) fn read(folder: &Path) -> Result<Option<Self>, CliError> {
        let path = folder.join(SHEAR_FILE);
        let Ok(text) = std::fs::read_to_string(&path) else { return Ok(None) };
        let record: Self = serde_json::from_str(&text)
            .map_err(|cause| CliError::in_file(&path, format_args!("not a record of rc shear: {cause}")))?;
        if record.curves.is_empty() || record.curves.iter().any(|curve| curve.points.is_empty()) {
            return Err(CliError::in_file(&path, "has no curves"));
        }
        Ok(Some(record))
    }

    /// Writes `shear.json` and `shear.csv`.
    ///
    /// # Errors
    /// [`CliError::Write`].
    pub(super) fn write(&self, folder: &Path) -> Result<(), CliError> {
        let mut staged: Staged = Kind::Shear.stage(folder)?;
        staged.add_text(SHEAR_FILE, &to_json(self))?;
        staged.add(SHEAR_TABLE, |path| self.write_table(path))?;
        if !self.means.is_empty() {
            staged.add(SHEAR_MEANS, |path| self.write_means(path))?;
        }
        Ok(staged.commit()?)
    }

    fn write_table(&self, path: &Path) -> Result<(), csv::Error> {
        let mut out = csv::Writer::from_path(path)?;
        for curve in &self.curves {
            for point in &curve.points {
                out.serialize(Line {
                    scene: &curve.scene,
                    seed: curve.seed,
                    mean_pressure: curve.mean_pressure,
                    shear_pressure: point.shear_pressure,
                    shear_displacement: point.shear_displacement,
                    shear_displacement_error: point.shear_displacement_error,
                    slip_area_fraction: point.slip_area_fraction,
                    stick_area_fraction: point.stick_area_fraction,
                    tangential_stiffness: point.tangential_stiffness,
                    loss_per_cycle: point.loss_per_cycle,
                    loss_factor: point.loss_factor,
                })?;
            }
        }
        out.flush()?;
        Ok(())
    }

    fn write_means(&self, path: &Path) -> Result<(), csv::Error> {
        let mut out = csv::Writer::from_path(path)?;
        for MeanCurve { scene, surfaces, mean_pressure, points, .. } in &self.means {
            for point in points {
                out.serialize((MeanLine { scene, surfaces: *surfaces, mean_pressure: *mean_pressure }, point))?;
            }
        }
        out.flush()?;
        Ok(())
    }

    /// A few lines about each curve.
    pub(crate) fn text(&self) -> String {
        let lines = |curve: &ShearCurve| {
            let end = curve.end();
            let stiffness =
                curve.tangential_stiffness.map_or_else(|| "infinite".to_owned(), |k| engineering(k, "Pa/m"));
            let of_sliding = digits(100.0 * end.shear_pressure / curve.sliding_pressure, 3);
            format!(
                "  {}: stiffness {stiffness} before slip; at {}, {of_sliding} % of the friction, displacement {}, of the contact {} % slips; \
                 half as many loads change displacements by up to {} % of it\n",
                curve.name(),
                engineering(end.shear_pressure, "Pa"),
                engineering(end.shear_displacement, "m"),
                digits(100.0 * end.slip_area_fraction / (end.slip_area_fraction + end.stick_area_fraction), 3),
                digits(100.0 * curve.spacing_error(), 2),
            )
        };
        self.curves.iter().map(lines).chain(self.means.iter().map(MeanCurve::text)).collect()
    }
}
