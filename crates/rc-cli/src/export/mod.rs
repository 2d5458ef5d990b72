//! `rc export`: a result as files of other programs: VTK for ParaView, PyVista and VisIt, Zarr for Python and others.

mod paraview;
mod vtk;
mod xarray;
mod zarr;

use std::path::Path;

use rc_core::Field;

use crate::args::ExportArgs;
use crate::error::CliError;
use crate::output;
use crate::result::{ResultFolder, in_cell};
use crate::surface::HEIGHTS_FILE;
use rc_sweep::files::{self, Staged};

/// Elements of methods that have their own.
const ELEMENTS_FILE: &str = "elements.csv";

/// Runs `rc export`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &ExportArgs) -> Result<(), CliError> {
    let fields = Fields::read(&args.folder)?;
    let target = args.out.as_deref().unwrap_or(&args.folder);
    files::check_folder(target)?;
    let (vtk, zarr) = (args.vtk || !args.zarr, args.zarr);
    if zarr {
        zarr::check_place(&target.join(xarray::GROUP))?;
    }
    let mut staged = Staged::new(target)?;
    if vtk {
        add_vtk(&mut staged, &args.folder, &fields)?;
    }
    if zarr {
        staged.add(xarray::GROUP, |path| zarr::write(path, &xarray::group(&fields)))?;
    }
    let names = staged.names().to_vec();
    staged.commit()?;
    if args.quiet { Ok(()) } else { output::print_names(target, &names) }
}

/// Fields and, if there is one, adaptive mesh as VTK's XML files.
fn add_vtk(staged: &mut Staged, folder: &Path, fields: &Fields) -> Result<(), CliError> {
    let elements = folder.join(ELEMENTS_FILE);
    let elements = elements.is_file().then(|| read_elements(&elements)).transpose()?;
    staged.add("fields.vti", |path| vtk::write(path, &paraview::image(fields)))?;
    if let Some(elements) = elements {
        staged.add("elements.vtu", |path| vtk::write(path, &paraview::mesh(&elements)))?;
    }
    Ok(())
}

/// The fields of a result, all on one grid.
struct Fields {
    /// `status` of the summary.
    status: String,
    /// λ, along x (m).
    side: f64,
    /// E* (Pa).
    e_star: f64,
    /// Pa.
    pressure: Field,
    /// m.
    gap: Field,
    /// m, of a height map.
    height: Option<Field>,
    /// What 1 in [`Fields::contact`] says: `contact` of elements, `touched` of means over them, above 0 where any of them is in contact.
    contact_name: &'static str,
}

impl Fields {
    /// Reads them from the folder of a result.
    fn read(folder: &Path) -> Result<Self, CliError> {
        let result = ResultFolder::read_finite(folder)?;
        let contact_name = if result.is_of_elements() { "contact" } else { "touched" };
        let ResultFolder { summary, side, e_star, pressure, gap } = result;
        let heights = folder.join(HEIGHTS_FILE);
        let height = heights.is_file().then(|| in_cell(&heights, pressure.grid().cell_ratio())).transpose()?;
        // With --output-grid, pressure and gap are coarser than the heights.
        let height = height.filter(|height| height.grid() == pressure.grid());
        Ok(Self { status: summary.status, side, e_star, pressure, gap, height, contact_name })
    }

    /// 1 where the pressure is positive, else 0.
    fn contact(&self) -> Vec<u8> {
        self.pressure.values().iter().map(|p| u8::from(*p > 0.0)).collect()
    }
}

/// An element as its file has it.
#[derive(Clone, Copy, Debug, serde::Deserialize)]
struct Element {
    x: f64,
    y: f64,
    size: f64,
    pressure: f64,
}

fn read_elements(path: &Path) -> Result<Vec<Element>, CliError> {
    let fail = |cause: csv::Error| CliError::in_file(path, format_args!("not elements of rc solve: {cause}"));
    csv::Reader::from_path(path).map_err(fail)?.deserialize().collect::<Result<_, _>>().map_err(fail)
}
