//! Arguments of `rc inspect`.

use std::path::PathBuf;

use clap::Args;
use rc_heights::{Layout, LengthUnit};

use crate::scene::values::GridSpec;

/// Arguments of `rc inspect`.
#[derive(Args, Clone, Debug)]
pub(crate) struct InspectArgs {
    /// A height map of any format that rc surface reads, a result folder, or its summary.json or pressure.npy;
    /// with --spectrum, a file of waves
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// FILE has Fourier coefficients, as rc solve --spectrum reads them, and not heights
    #[arg(long)]
    pub(crate) spectrum: bool,
    /// Elements per side on which the heights of waves are evaluated for their distribution; moments are exact
    /// [default: 4 per shortest wave]
    #[arg(long, value_name = "N", requires = "spectrum", allow_hyphen_values = true)]
    pub(crate) grid: Option<GridSpec>,
    /// Side λ of the periodic cell of a height map (m) [default: that of its file if it says it, else 0.01; of a
    /// result, that of its scene.toml]
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) cell: Option<f64>,
    /// Side of a rectangular cell along y (m) [default: that of its file if it says it, else that along x]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) cell_y: Option<f64>,
    /// Unit of the lengths of a height map that names none, or of coefficients: m, mm, um, nm [default: m]
    #[arg(long, value_name = "UNIT")]
    pub(crate) unit: Option<LengthUnit>,
    /// Height (m) of 1 in a height map that names no unit, as of one level of grey of an image, or in coefficients;
    /// goes before --unit
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub(crate) height_scale: Option<f64>,
    /// Channel of a height map that has several; they are listed first [default: the first with heights]
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,
    /// How a text of numbers is laid out, where it could be either: matrix (a row of the map a line) or xyz (a point a
    /// line)
    #[arg(long, value_name = "matrix|xyz")]
    pub(crate) layout: Option<Layout>,
    /// Folder for pictures of a height map: heights, spectrum with its power law, distribution
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print the statistics as JSON, with the whole spectrum
    #[arg(long)]
    pub(crate) json: bool,
}
