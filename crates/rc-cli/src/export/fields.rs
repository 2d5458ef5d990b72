//! What is exported of a result.

use std::path::Path;

use rc_core::Field;

use crate::error::CliError;
use crate::files::result::{ResultFolder, in_cell};
use crate::scene::surface::HEIGHTS_FILE;

/// The fields of a result, all on one grid.
pub(super) struct Fields {
    /// `status` of the summary.
    pub(super) status: String,
    /// λ, along x (m).
    pub(super) side: f64,
    /// E* (Pa).
    pub(super) e_star: f64,
    /// Pa.
    pub(super) pressure: Field,
    /// m.
    pub(super) gap: Field,
    /// m, with a hardness.
    pub(super) plastic_gap: Option<Field>,
    /// m, of a height map.
    pub(super) height: Option<Field>,
    /// What 1 in [`Fields::contact`] says: `contact` of elements, `touched` of means over them, above 0 where any of them is in contact.
    pub(super) contact_name: &'static str,
}

impl Fields {
    /// Reads them from the folder of a result.
    pub(super) fn read(folder: &Path) -> Result<Self, CliError> {
        let result = ResultFolder::read_finite(folder)?;
        let contact_name = if result.is_of_elements() { "contact" } else { "touched" };
        let ResultFolder { summary, side, e_star, pressure, gap, plastic_gap } = result;
        let heights = folder.join(HEIGHTS_FILE);
        let height = heights.is_file().then(|| in_cell(&heights, pressure.grid().cell_ratio())).transpose()?;
        // With --output-grid, pressure and gap are coarser than the heights.
        let height = height.filter(|height| height.grid() == pressure.grid());
        Ok(Self { status: summary.status, side, e_star, pressure, gap, plastic_gap, height, contact_name })
    }

    /// 1 where the pressure is positive, else 0.
    pub(super) fn contact(&self) -> Vec<u8> {
        self.pressure.values().iter().map(|p| u8::from(*p > 0.0)).collect()
    }
}

/// An element as its file has it.
#[derive(Clone, Copy, Debug, serde::Deserialize)]
pub(super) struct Element {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) size: f64,
    pub(super) pressure: f64,
}

/// The elements in the file at `path`.
pub(super) fn read_elements(path: &Path) -> Result<Vec<Element>, CliError> {
    let fail = |cause: csv::Error| CliError::in_file(path, format_args!("not elements of rc solve: {cause}"));
    csv::Reader::from_path(path).map_err(fail)?.deserialize().collect::<Result<_, _>>().map_err(fail)
}
