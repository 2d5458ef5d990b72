//! Arguments of `rc export`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `rc export`.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXPORT_HELP)]
pub(crate) struct ExportArgs {
    /// Folder of a result
    #[arg(value_name = "RESULT_DIR")]
    pub(crate) folder: PathBuf,
    /// VTK's XML files, for ParaView, PyVista and VisIt [the default]
    #[arg(long)]
    pub(crate) vtk: bool,
    /// A Zarr group, for Python (zarr, xarray) and other readers of large fields
    #[arg(long)]
    pub(crate) zarr: bool,
    /// Folder for the files [default: the result's own]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Do not list the files
    #[arg(long)]
    pub(crate) quiet: bool,
}

const EXPORT_HELP: &str = "\
--vtk writes fields.vti: pressure (Pa), gap (m) and contact (0 or 1). A solve of a height map adds height (m), and a solve with \
--leakage adds flow_x and flow_y (m²), one with --friction shear_x, shear_y (Pa) and slip (m), and one with --fluid-pressure \
that pressure (Pa). All are values of the cells of an image. If the result has elements.csv (rc solve --elements), --vtk also writes elements.vtu: the elements of \
the adaptive mesh as quadrilaterals, with pressure (Pa) and size (m). Lengths are in m. In ParaView, open a file, choose Apply, and \
colour by pressure. For a relief of a field, apply the filters Cell Data to Point Data and Warp By Scalar.

--zarr writes the folder fields.zarr, a Zarr group (version 2): the same fields, and the coordinates x and y (m) of the centres of \
elements, in compressed chunks of at most 1024 x 1024 values, with units as attributes. In Python: xarray.open_zarr(\"result/fields.zarr\").";
