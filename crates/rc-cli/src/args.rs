//! The command line.

use clap::{Parser, Subcommand};

use crate::export::args::ExportArgs;
use crate::inspect::args::InspectArgs;
use crate::manual::{CompletionsArgs, ManArgs};
use crate::plot::PlotArgs;
use crate::report::args::ReportArgs;
use crate::solve::args::SolveArgs;
use crate::surface::args::SurfaceArgs;
use crate::sweep::args::SweepArgs;

/// Contact of rough elastic surfaces.
///
/// SI units; any consistent system works too (cell 1, E* 1 gives dimensionless results).
/// Exit codes: 0 solved, 2 bad input, 3 not converged, 4 could not write, 130 interrupted.
#[derive(Parser, Clone, Debug)]
#[command(name = "rc", version, max_term_width = 120, disable_help_subcommand = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// The commands.
#[derive(Subcommand, Clone, Debug)]
pub(crate) enum Command {
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
    /// A result or a sweep as one HTML page that needs no network: maps to zoom, sections, curves, certificate,
    /// parameters
    Report(ReportArgs),
    /// A result as files of other programs: VTK for ParaView, PyVista and VisIt, Zarr for Python
    Export(ExportArgs),
    /// Completions of commands and flags for a shell, on standard output
    Completions(CompletionsArgs),
    /// Manual pages of all commands
    Man(ManArgs),
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
