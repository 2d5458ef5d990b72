//! The fields of a result for export.

use std::path::Path;

use rc_core::Field;

use crate::error::CliError;
use crate::files::flow::FLUX_FILES;
use crate::files::names::{FLUID_FILE, HEIGHTS_FILE, SHEAR_FILES};
use crate::files::result::{ResultFolder, in_cell};
use crate::scene::heights::check_finite;

/// The fields of a result, all on one grid.
pub(super) struct Fields {
    /// Value of `status` in the summary.
    pub(super) status: String,
    /// Side λ of the cell along x (m).
    pub(super) side: f64,
    /// E* (Pa).
    pub(super) e_star: f64,
    /// Pressure (Pa).
    pub(super) pressure: Field,
    /// Gap (m).
    pub(super) gap: Field,
    /// Overlap that plastic flow has removed (m), with a hardness.
    pub(super) plastic_gap: Option<Field>,
    /// Height (m), of a height map.
    pub(super) height: Option<Field>,
    /// Other fields with their names: fluxes along x and y (m²), tractions along them (Pa) and slip (m), and the pressure
    /// of a fluid (Pa).
    pub(super) others: Vec<(&'static str, Field)>,
    /// Meaning of 1 in [`Fields::contact`].
    ///
    /// It is `contact` for elements. It is `touched` for means over elements, which are above 0 if any of the elements
    /// is in contact.
    pub(super) contact_name: &'static str,
}

impl Fields {
    /// Reads the fields from the folder of a result.
    pub(super) fn read(folder: &Path) -> Result<Self, CliError> {
        let result = ResultFolder::read_finite(folder)?;
        let contact_name = if result.is_of_elements() { "contact" } else { "touched" };
        let ResultFolder { summary, side, e_star, pressure, gap, plastic_gap, .. } = result;
        let heights = folder.join(HEIGHTS_FILE);
        let height = heights.is_file().then(|| in_cell(&heights, pressure.grid().cell_ratio())).transpose()?;
        // With --output-grid, pressure and gap are on a coarser grid than the heights.
        let height = height.filter(|height| height.grid() == pressure.grid());
        let others = read_others(folder, &pressure)?;
        Ok(Self { status: summary.status, side, e_star, pressure, gap, plastic_gap, height, others, contact_name })
    }

    /// 1 for each element with positive pressure, else 0.
    pub(super) fn contact(&self) -> Vec<u8> {
        self.pressure.values().iter().map(|p| u8::from(*p > 0.0)).collect()
    }
}

/// The other fields in the folder of a result, without those on another grid than its `pressure`.
fn read_others(folder: &Path, pressure: &Field) -> Result<Vec<(&'static str, Field)>, CliError> {
    let files = FLUX_FILES.into_iter().chain(SHEAR_FILES).chain([FLUID_FILE]);
    let mut others = Vec::new();
    for file in files {
        let path = folder.join(file);
        if path.is_file() {
            let field = in_cell(&path, pressure.grid().cell_ratio())?;
            check_finite(&path, &field)?;
            others.push((file.trim_end_matches(".npy"), field));
        }
    }
    others.retain(|(_, field)| field.grid() == pressure.grid());
    Ok(others)
}

/// An element with the columns of its file.
#[derive(Clone, Copy, Debug, serde::Deserialize)]
pub(super) struct Element {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) size: f64,
    pub(super) pressure: f64,
}

/// The elements in the file at `path`.
pub(super) fn read_elements(path: &Path) -> Result<Vec<Element>, CliError> {
    let fail = |cause: csv::Error| CliError::in_file(path, format_args!("not an elements.csv of rc solve: {cause}"));
    csv::Reader::from_path(path).map_err(fail)?.deserialize().collect::<Result<_, _>>().map_err(fail)
}
