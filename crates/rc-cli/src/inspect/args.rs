//! Arguments of `rc inspect`.

use std::path::PathBuf;

use clap::Args;
use rc_heights::{Layout, LengthUnit};

use crate::scene::values::GridSpec;

/// Arguments of `rc inspect`.
#[derive(Args, Clone, Debug)]
pub(crate) struct InspectArgs {
    /// A height map, a result folder, or its summary.json or pressure.npy; with --spectrum, a file of waves
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// FILE has Fourier coefficients, as rc solve --spectrum reads them
    #[arg(long)]
    pub(crate) spectrum: bool,
    /// With --spectrum: elements per side for the heights [default: 4 per shortest wave]
    ///
    /// The distribution of the heights is that on these elements. Moments are exact.
    #[arg(long, value_name = "N", requires = "spectrum", allow_hyphen_values = true)]
    pub(crate) grid: Option<GridSpec>,
    /// Side λ of the cell, along x (m) [default: the file's; 0.01 if it has none]
    ///
    /// A result has its cell in scene.toml, and takes no --cell.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) cell: Option<f64>,
    /// Side of the cell along y (m) [default: that in the file, or --cell]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) cell_y: Option<f64>,
    /// Unit of lengths in a file that names none: m, cm, mm, um, nm, angstrom, pm [default: m]
    #[arg(long, value_name = "UNIT")]
    pub(crate) unit: Option<LengthUnit>,
    /// Height (m) of the value 1 in a file without a unit; overrides --unit
    ///
    /// In an image, 1 is one level of grey.
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) height_scale: Option<f64>,
    /// Channel of a file with several [default: the first with heights]
    ///
    /// The list of channels is printed before the statistics.
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,
    /// Layout of an ambiguous text: each line a row (matrix) or point (xyz)
    #[arg(long, value_name = "matrix|xyz")]
    pub(crate) layout: Option<Layout>,
    /// Folder for pictures of a height map: heights, spectrum, distribution
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print the statistics as JSON, with the whole spectrum
    #[arg(long)]
    pub(crate) json: bool,
}
