//! The command line.

use clap::{Parser, Subcommand};

use crate::compare::args::CompareArgs;
use crate::export::args::ExportArgs;
use crate::help::help_flag;
use crate::inspect::args::InspectArgs;
use crate::manual::{CompletionsArgs, ManArgs};
use crate::plot::PlotArgs;
use crate::prepare::args::PrepareArgs;
use crate::report::args::ReportArgs;
use crate::shear::args::ShearArgs;
use crate::solve::args::SolveArgs;
use crate::study::args::StudyArgs;
use crate::surface::args::SurfaceArgs;
use crate::sweep::args::SweepArgs;

/// Contact of rough elastic surfaces
#[derive(Parser, Clone, Debug)]
#[command(name = "rc", version, max_term_width = 120, disable_help_subcommand = true, after_help = RC_HELP)]
#[command(disable_help_flag = true, arg = help_flag())]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

const RC_HELP: &str = "\
Units are SI; any consistent system works too (cell 1, E* 1 gives dimensionless results).
Eq. numbers are those of Putignano et al., Int. J. Solids Struct. 49 (2012) 338-343.
Exit codes: 0 solved, 2 bad input, 3 not converged, 4 could not write, 130 interrupted.";

/// The commands.
#[derive(Subcommand, Clone, Debug)]
pub(crate) enum Command {
    /// Solve one contact problem; without arguments, the paper's surface into rc-result/
    Solve(Box<SolveArgs>),
    /// Solve a list of loads on a list of surfaces; --resume continues after an interruption
    Sweep(Box<SweepArgs>),
    /// Shear curves with partial slip, loops and losses from the load curves of a sweep
    Shear(ShearArgs),
    /// Generate, convert or treat a surface
    Surface(Box<SurfaceArgs>),
    /// The usual treatments of a measured map, for rc solve, with pictures of what they did
    Prepare(Box<PrepareArgs>),
    /// One contact under varied treatments of a measured map: how much the results depend on them
    Study(Box<StudyArgs>),
    /// Statistics of a surface or a result; means over the seeds of a sweep
    Inspect(InspectArgs),
    /// Pictures of a result or a surface, curves of a sweep
    Plot(PlotArgs),
    /// A result, a surface or a sweep as one HTML page that needs no network
    Report(ReportArgs),
    /// Two results: a table of their numbers, and a picture of the difference of their fields
    Compare(CompareArgs),
    /// A result as VTK for ParaView, PyVista and VisIt, or as Zarr for Python
    Export(ExportArgs),
    /// Completions for a shell, on standard output
    Completions(CompletionsArgs),
    /// Manual pages of all commands, with longer texts than --help
    Man(ManArgs),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;

    /// Two screens of 50 lines.
    const MOST_LINES: usize = 100;

    /// The page that a command line asks for, on a terminal of 100 columns.
    fn page(words: &[&str]) -> String {
        let asked = Cli::command().term_width(100).try_get_matches_from(words).expect_err("help");
        assert_eq!(asked.kind(), clap::error::ErrorKind::DisplayHelp, "{words:?}");
        asked.to_string()
    }

    fn check_pages(command: &clap::Command, words: &[&str]) -> usize {
        let long = page(&[words, &["--help"]].concat());
        assert_eq!(long, page(&[words, &["-h"]].concat()), "{words:?}");
        let n_lines = long.lines().count();
        assert!(n_lines <= MOST_LINES, "{words:?}: {n_lines} lines\n{long}");
        let longest = long.lines().map(|line| line.chars().count()).max();
        assert!(longest <= Some(100), "{words:?}: a line of {longest:?} characters\n{long}");
        let below = command.get_subcommands().map(|below| check_pages(below, &[words, &[below.get_name()]].concat()));
        1 + below.sum::<usize>()
    }

    /// The flags of a command, and of those below, that refuse a number with a unit of their quantity.
    fn without_units(command: &clap::Command, words: &[&str]) -> Vec<String> {
        let unit = |name: &str| match name {
            "M" | "LENGTH" => Some("1.5mm"),
            "PA" => Some("1.5MPa"),
            "DEG" => Some("1.5deg"),
            "M/S" => Some("1.5mm/s"),
            "S" => Some("1.5ms"),
            "PAS" => Some("1.5mPas"),
            _ => None,
        };
        let refuses = |arg: &clap::Arg| {
            let (long, name) = (arg.get_long()?, arg.get_value_names()?.first()?);
            let flag = format!("--{long}={}", unit(name)?);
            let read = Cli::command().try_get_matches_from([words, &[flag.as_str()]].concat());
            let is_refused = read.is_err_and(|error| error.kind() == clap::error::ErrorKind::ValueValidation);
            is_refused.then(|| [words, &[flag.as_str()]].concat().join(" "))
        };
        let here = command.get_arguments().filter_map(refuses);
        let below =
            command.get_subcommands().flat_map(|below| without_units(below, &[words, &[below.get_name()]].concat()));
        here.chain(below).collect()
    }

    #[test]
    fn every_quantity_takes_its_unit() {
        assert_eq!(without_units(&Cli::command(), &["rc"]), Vec::<String>::new());
    }

    #[test]
    fn a_page_of_help_fits_two_screens() {
        assert!(check_pages(&Cli::command(), &["rc"]) > 10, "not all pages were found");
    }

    /// The defaults in the pages are those of the embedded example.
    #[test]
    fn help_names_the_values_of_the_example() {
        let (example, page) = (crate::scene::keys::EXAMPLE, page(&["rc", "solve", "--help"]));
        let keys = example.lines().filter_map(|line| line.split('#').next().unwrap_or_default().split_once(" = "));
        let mut n_keys = 0;
        for (key, value) in keys.filter(|(key, _)| !["pressure", "grid"].contains(key)) {
            let flag = format!("--{} ", key.replace('_', "-"));
            let line = page.lines().find(|line| line.trim_start().starts_with(&flag)).expect("a line for each key");
            let default = line.split_once("[default").map(|(_, text)| text.trim_end_matches(']')).unwrap_or_default();
            let value = value.trim().trim_matches('"');
            let is_named = default.split([' ', ',', ':']).any(|word| {
                word == value || word.parse::<f64>().is_ok_and(|number| value.parse::<f64>() == Ok(number))
            });
            assert!(is_named, "{key} = {value}: {line}");
            n_keys += 1;
        }
        assert!(n_keys >= 11, "{n_keys}");
    }

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }
}
