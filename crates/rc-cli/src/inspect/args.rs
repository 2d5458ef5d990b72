//! Arguments of `rc inspect`.

use std::path::PathBuf;

use clap::Args;
use rc_heights::{Layout, LengthUnit, Mask};
use rc_sweep::memory::ByteSize;

use crate::scene::keys::{RunKeys, Scene, SurfaceKeys};
use crate::scene::quantity::length;
use crate::scene::values::{GridSpec, Marks};

/// Arguments of `rc inspect`.
#[derive(Args, Clone, Debug)]
pub(crate) struct InspectArgs {
    /// A height map, a folder of a result, surface or sweep, or a scene; with --spectrum, a file of waves
    ///
    /// A result is also found by its summary.json or pressure.npy.
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
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    pub(crate) cell: Option<f64>,
    /// Side of the cell along y (m) [default: that in the file, or equal spacings]
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    pub(crate) cell_y: Option<f64>,
    /// Unit of a file that names none: m, cm, mm, um, nm, angstrom, pm [default: m]
    #[arg(long, value_name = "UNIT")]
    pub(crate) unit: Option<LengthUnit>,
    /// Unit of heights, where it differs from --unit
    #[arg(long, value_name = "UNIT")]
    pub(crate) height_unit: Option<LengthUnit>,
    /// Height (m) of the value 1 in a file without a unit; overrides --unit
    ///
    /// In an image, 1 is one level of grey.
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    pub(crate) height_scale: Option<f64>,
    /// Values of missing points, in the numbers of the file: -9999,1e30
    #[arg(long, value_name = "VALUES", allow_hyphen_values = true)]
    pub(crate) missing: Option<Marks>,
    /// Masked points of a .gwy file: use (they are missing) or ignore [default: use]
    #[arg(long, value_name = "use|ignore")]
    pub(crate) mask: Option<Mask>,
    /// Channel of a file with several [default: the first with heights]
    ///
    /// The list of channels is printed before the statistics.
    #[arg(long, value_name = "NAME")]
    pub(crate) channel: Option<String>,
    /// Layout of an ambiguous text: each line a row (matrix) or point (xyz)
    #[arg(long, value_name = "matrix|xyz")]
    pub(crate) layout: Option<Layout>,
    /// Profiles: Gaussian filter against waves shorter than this λs (m)
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    pub(crate) lambda_s: Option<f64>,
    /// Profiles: Gaussian filter against waves longer than this λc (m)
    ///
    /// The filter is that of ISO 16610-21. Half a λc at both ends is not evaluated.
    #[arg(long, value_name = "M", value_parser = length::parse, allow_hyphen_values = true)]
    pub(crate) lambda_c: Option<f64>,
    /// Profiles: file for the spectrum of the isotropic surface, as rc surface --psd reads it
    #[arg(long, value_name = "FILE")]
    pub(crate) psd_out: Option<PathBuf>,
    /// Folder for pictures of a map or profile (also psd.csv), or for means.csv of a sweep
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print the statistics as JSON, with the whole spectrum
    #[arg(long)]
    pub(crate) json: bool,
    /// Memory that the file may take when it is read, such as 2GB [default: a quarter of the machine]
    #[arg(long, value_name = "SIZE")]
    pub(crate) memory_limit: Option<ByteSize>,
    /// A warning is an error: exit code 2
    #[arg(long)]
    pub(crate) strict: bool,
}

impl InspectArgs {
    /// The keys of the map.
    pub(crate) fn keys(&self) -> SurfaceKeys {
        SurfaceKeys {
            heights: Some(self.file.clone()),
            cell: self.cell,
            cell_y: self.cell_y,
            unit: self.unit,
            height_unit: self.height_unit,
            height_scale: self.height_scale,
            missing: self.missing.clone(),
            mask: self.mask,
            channel: self.channel.clone(),
            layout: self.layout,
            grid: self.grid,
            read_limit: self.memory_limit,
            ..SurfaceKeys::default()
        }
    }

    /// The flags over the keys of a scene.
    pub(crate) fn over_scene(&self) -> Scene {
        let run = RunKeys { memory_limit: self.memory_limit, ..RunKeys::default() };
        Scene { surface: SurfaceKeys { heights: None, ..self.keys() }, run, ..Scene::default() }
    }

    /// The first flag that says how a file is read, which only height maps and profiles have.
    pub(super) fn of_reading(&self) -> Option<&'static str> {
        let given = [
            ("unit", self.unit.is_some()),
            ("height_unit", self.height_unit.is_some()),
            ("height_scale", self.height_scale.is_some()),
            ("missing", self.missing.is_some()),
            ("mask", self.mask.is_some()),
            ("channel", self.channel.is_some()),
            ("layout", self.layout.is_some()),
        ];
        given.into_iter().chain(self.of_profiles()).find(|(_, is_given)| *is_given).map(|(key, _)| key)
    }

    /// The flags of profiles, and whether they are given.
    pub(super) fn of_profiles(&self) -> [(&'static str, bool); 3] {
        [
            ("lambda_s", self.lambda_s.is_some()),
            ("lambda_c", self.lambda_c.is_some()),
            ("psd_out", self.psd_out.is_some()),
        ]
    }

    /// How the command prints its warnings.
    pub(crate) fn run_keys(&self) -> RunKeys {
        RunKeys { strict: self.strict, ..RunKeys::default() }
    }
}
