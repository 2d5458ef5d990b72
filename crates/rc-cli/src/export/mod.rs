//! `rc export`: a result as files of other programs.
//!
//! VTK is for ParaView, PyVista and VisIt, Zarr for Python and others.

pub(crate) mod args;

mod fields;
mod paraview;
mod vtk;
pub(crate) mod xarray;
pub(crate) mod zarr;

use std::path::Path;

use self::args::ExportArgs;
use self::fields::{Fields, read_elements};
use crate::error::CliError;
use crate::files::names::GROUP;
use crate::terminal;
use rc_sweep::files::{self, Staged};

/// File of the elements, of methods with a mesh of their own.
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
        zarr::check_place(&target.join(GROUP))?;
    }
    let mut staged = Staged::new(target)?;
    if vtk {
        add_vtk(&mut staged, &args.folder, &fields)?;
    }
    if zarr {
        staged.add(GROUP, |path| zarr::write(path, &xarray::group(&fields)))?;
    }
    let names = staged.names().to_vec();
    staged.commit()?;
    if args.quiet { Ok(()) } else { terminal::print_names(target, &names) }
}

/// Adds the fields and, if there is one, the adaptive mesh as VTK's XML files.
fn add_vtk(staged: &mut Staged, folder: &Path, fields: &Fields) -> Result<(), CliError> {
    let elements = folder.join(ELEMENTS_FILE);
    let elements = elements.is_file().then(|| read_elements(&elements)).transpose()?;
    staged.add("fields.vti", |path| vtk::write(path, &paraview::image(fields)))?;
    if let Some(elements) = elements {
        staged.add("elements.vtu", |path| vtk::write(path, &paraview::mesh(&elements)))?;
    }
    Ok(())
}
