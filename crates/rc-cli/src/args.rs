//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use rc_heights::LengthUnit;

use crate::scene::{RunKeys, Scene, SurfaceKeys};
use crate::sweep::args::SweepArgs;
use crate::treatment::TreatmentKeys;

/// Contact of rough elastic surfaces.
///
/// SI units; any consistent system works too (cell 1, E* 1 gives dimensionless results).
/// Exit codes: 0 solved, 2 bad input, 3 not converged, 4 could not write, 130 interrupted.
#[derive(Parser, Clone, Debug)]
#[command(name = "rc", version, max_term_width = 120, disable_help_subcommand = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Subcommand, Clone, Debug)]
pub enum Command {
    /// Solve one contact problem (without arguments: the embedded example, the paper's N = 64 surface, into rc-result/)
    Solve(SolveArgs),
    /// Solve a list of loads on a list of surfaces; can be interrupted and resumed
    Sweep(Box<SweepArgs>),
    /// Generate or convert a surface: statistics, and with --out its files
    Surface(SurfaceArgs),
    /// Statistics of a surface or of a result: rms, slopes, spectrum, distributions
    Inspect(InspectArgs),
    /// Pictures of a result
    Plot(PlotArgs),
    /// A result or a sweep as one HTML page that needs no network: maps to zoom, sections, curves, certificate, parameters
    Report(ReportArgs),
    /// A result as files of other programs: VTK for ParaView, PyVista and VisIt, Zarr for Python
    Export(ExportArgs),
    /// Completions of commands and flags for a shell, on standard output
    Completions(CompletionsArgs),
    /// Manual pages of all commands
    Man(ManArgs),
}

/// Arguments of `rc solve`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SOLVE_HELP)]
pub struct SolveArgs {
    /// Scene file: TOML with the flags below for keys, written with _ for -
    #[arg(value_name = "SCENE.toml")]
    pub scene_file: Option<PathBuf>,
    /// What is given here holds against the scene file.
    #[command(flatten)]
    pub scene: Scene,
    /// Print the elements, memory and time to be expected, and solve nothing
    #[arg(long, help_heading = "Run")]
    pub dry_run: bool,
    /// While solving, keep a picture of the contact so far in DIR/watch.png (DIR: --out), drawn anew once a second at most
    #[arg(long, help_heading = "Run")]
    pub watch: bool,
}

const SOLVE_HELP: &str = "\
What neither scene file nor flags give has the value of the embedded example: cell 0.01 m, E = 0.4 GPa, ν = 0.45, N = 64, \
H = 0.8, rms 13 µm, seed 1, kernel love, tolerance 1e-6. The control is never assumed: give --pressure or --penetration, \
exactly one. A flag replaces its alternatives in the scene file: --penetration its pressure, --heights its random surface. \
Relative paths in a scene file start at its folder.

Without --method, the solver is adaptive where the estimated contact area makes that cheaper than the uniform grid, and where \
it can be: kernel love, and a square grid that halves into levels. --method adaptive, uniform or gauss-seidel is held to.

DIR receives summary.json, pressure.npy (Pa), gap.npy (m), contact.png and scene.toml, from which the result can be repeated; \
elements.csv (m, m, m, Pa) from the methods with elements of their own, adaptive and gauss-seidel; and heights.npy, if the \
heights came from a file. In the summary, iterations and operator_applications are those of the finest level.

rc solve --waves 256 --pressure 446395 --out result --watch shows the contact as it emerges, from coarse grids to fine ones: open \
result/watch.png in a viewer that reloads. The picture looks as contact.png does, is replaced as a whole, and is removed when the \
result is there, which does not depend on it.";

/// Arguments of `rc surface`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SURFACE_HELP)]
pub struct SurfaceArgs {
    /// Scene file; its keys of the contact are passed over
    #[arg(value_name = "SCENE.toml")]
    pub scene_file: Option<PathBuf>,
    /// What is given here holds against the scene file.
    #[command(flatten)]
    pub surface: SurfaceKeys,
    /// Treatment of a height map.
    #[command(flatten)]
    pub treatment: TreatmentKeys,
    /// Threads and output.
    #[command(flatten)]
    pub run: RunKeys,
}

const SURFACE_HELP: &str = "\
--out DIR receives heights.npy (m), scene.toml, surface.png and surface.json; --out FILE.npy or --out FILE.csv the heights \
alone; without --out nothing is written. Heights are written in m.

A measured map mostly needs --crop square --fill laplace --level plane --periodic mirror. What each treatment changes is printed \
and goes into surface.json.";

/// Arguments of `rc inspect`.
#[derive(Args, Clone, Debug)]
pub struct InspectArgs {
    /// A height map of any format that rc surface reads, a result folder, or its summary.json or pressure.npy
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Side λ of the periodic cell of a height map (m) [default: that of its file if it says it, else 0.01; of a result, that of
    /// its scene.toml]
    #[arg(long, allow_hyphen_values = true)]
    pub cell: Option<f64>,
    /// Side of a rectangular cell along y (m) [default: that of its file if it says it, else that along x]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub cell_y: Option<f64>,
    /// Unit of the lengths of a height map that names none: m, mm, um, nm [default: m]
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<LengthUnit>,
    /// Height (m) of 1 in a height map that names no unit, as of one level of grey of an image; goes before --unit
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub height_scale: Option<f64>,
    /// Folder for pictures of a height map: heights, spectrum with its power law, distribution
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the statistics as JSON, with the whole spectrum
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `rc plot`.
#[derive(Args, Clone, Debug)]
pub struct PlotArgs {
    /// Folder of a result
    #[arg(value_name = "RESULT_DIR")]
    pub folder: PathBuf,
    /// Folder for the pictures [default: the result's own]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Do not list the pictures
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `rc report`.
#[derive(Args, Clone, Debug)]
#[command(after_help = REPORT_HELP)]
pub struct ReportArgs {
    /// Folder of a result (rc solve --out) or of a sweep (rc sweep --out)
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// The page [default: report.html in DIR]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Do not print the name of the page
    #[arg(long)]
    pub quiet: bool,
}

const REPORT_HELP: &str = "\
The page is one file of at most 2 MB, which loads nothing: it can be sent by mail and opened anywhere. Of a result: maps of \
contact, pressure and gap, sections through the cursor, the stress distribution with a fit of Eq. 7, contact spots, certificate, \
parameters, the command that repeats it. Of a sweep: area-load and load-penetration curves and the rows. Fields are averaged \
to 512 x 512 pixels.";

/// Arguments of `rc export`.
#[derive(Args, Clone, Debug)]
#[command(after_help = EXPORT_HELP)]
pub struct ExportArgs {
    /// Folder of a result
    #[arg(value_name = "RESULT_DIR")]
    pub folder: PathBuf,
    /// VTK's XML files, for ParaView, PyVista and VisIt [the default]
    #[arg(long)]
    pub vtk: bool,
    /// A Zarr group, for Python (zarr, xarray) and other readers of large fields
    #[arg(long)]
    pub zarr: bool,
    /// Folder for the files [default: the result's own]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Do not list the files
    #[arg(long)]
    pub quiet: bool,
}

const EXPORT_HELP: &str = "\
--vtk writes fields.vti: pressure (Pa), gap (m), contact (0 or 1) and, of a height map, height (m), as values of the cells of an \
image; and elements.vtu, if the result has elements.csv: the elements of the adaptive mesh as quadrilaterals, with pressure (Pa) and \
size (m). Lengths in m. In ParaView: open, Apply, colour by pressure; fields above the plane: Cell Data to Point Data, Warp By Scalar.

--zarr writes the folder fields.zarr, a Zarr group (version 2): the same fields, and the coordinates x and y (m) of the centres of \
elements, in compressed chunks of at most 1024 x 1024 values, with units as attributes. In Python: xarray.open_zarr(\"result/fields.zarr\").";

/// Arguments of `rc completions`.
#[derive(Args, Clone, Debug)]
#[command(after_help = COMPLETIONS_HELP)]
pub struct CompletionsArgs {
    /// The shell
    pub shell: Shell,
}

const COMPLETIONS_HELP: &str = "\
For the current user, in a new shell:
  bash  rc completions bash > ~/.local/share/bash-completion/completions/rc
  zsh   rc completions zsh > a folder of $fpath, as the file _rc
  fish  rc completions fish > ~/.config/fish/completions/rc.fish";

/// Arguments of `rc man`.
#[derive(Args, Clone, Debug)]
pub struct ManArgs {
    /// Folder that receives rc.1, rc-solve.1 and so on
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }
}
