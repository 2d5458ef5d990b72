//! What is exported of a result.

use std::path::Path;

use rc_core::Field;

use crate::error::CliError;
use crate::files::flow::FLUX_FILES;
use crate::files::result::{ResultFolder, in_cell};
use crate::scene::heights::check_finite;
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
    /// Fluxes of a flow along x and y, with their names (m²).
    pub(super) flow: Vec<(&'static str, Field)>,
    /// What 1 in [`Fields::contact`] says: `contact` of elements, `touched` of means over them, above 0 where any of
    /// them is in contact.
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
        let flow = read_flow(folder, &pressure)?;
        Ok(Self { status: summary.status, side, e_star, pressure, gap, plastic_gap, height, flow, contact_name })
    }

    /// 1 where the pressure is positive, else 0.
    pub(super) fn contact(&self) -> Vec<u8> {
        self.pressure.values().iter().map(|p| u8::from(*p > 0.0)).collect()
    }
}

/// The fluxes in the folder of a result, where there are any on the grid of its `pressure`.
fn read_flow(folder: &Path, pressure: &Field) -> Result<Vec<(&'static str, Field)>, CliError> {
    let mut flow = Vec::new();
    for (file, name) in FLUX_FILES.into_iter().zip(["flow_x", "flow_y"]) {
        let path = folder.join(file);
        if path.is_file() {
            let field = in_cell(&path, pressure.grid().cell_ratio())?;
            check_finite(&path, &field)?;
            flow.push((name, field));
        }
    }
    flow.retain(|(_, field)| field.grid() == pressure.grid());
    Ok(flow)
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
