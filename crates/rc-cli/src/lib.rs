//! The command line of rc: scenes, files in SI units, summaries and pictures.
//!
//! A solve has four steps. Arguments and a file give a [`scene`]. [`scene::resolve`] checks it and turns it into a
//! problem in units of λ and E*. `rc_solver` solves the problem. [`rc_sweep::Summary`] is the result in SI units, and
//! [`rc_sweep::files`] writes files completely or not at all.
//!
//! ```
//! use clap::Parser as _;
//! use rc_cli::{args::Cli, result::ResultFolder, run};
//!
//! // As `rc solve …` does it; the result is read back from its folder.
//! let folder = tempfile::tempdir()?;
//! let command = ["rc", "solve", "--waves", "8", "--grid", "64", "--pressure", "1e5", "--quiet", "--out"];
//! run(Cli::try_parse_from(command.map(Into::into).into_iter().chain([folder.path().as_os_str().to_owned()]))?)?;
//! let result = ResultFolder::read(folder.path())?;
//! assert_eq!(result.summary.status, "converged");
//! assert!((result.pressure.mean() / 1e5 - 1.0).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::ffi::OsString;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory as _, Parser as _};

pub mod args;
pub mod error;
pub mod scene;

mod compare;
mod curves;
mod export;
mod files;
mod help;
pub mod inspect;
mod manual;
mod plot;
mod prepare;
mod report;
pub mod run;
mod shear;
pub mod solve;
pub mod study;
pub mod surface;
pub mod sweep;
mod terminal;
mod text;
pub mod warnings;

pub use files::{checkpoint, kind, result};

use args::{Cli, Command};
use error::CliError;

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    main_with(std::env::args_os()).into()
}

/// Runs a command line and returns the exit code of the process.
///
/// The first argument is the name of the program.
#[must_use]
pub fn main_with(words: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => return refuse(&error),
    };
    match run(cli) {
        Ok(()) => 0,
        Err(error) => {
            terminal::tell(&format!("error: {error}"));
            error.exit_code()
        }
    }
}

/// Runs a command line as a program does.
///
/// The first argument is the name of the program.
///
/// # Errors
/// [`CliError`], which has the exit code.
pub fn run_words(words: impl IntoIterator<Item = OsString>) -> Result<(), CliError> {
    run(Cli::try_parse_from(words).map_err(|error| CliError::from(&error))?)
}

/// Runs one command.
///
/// # Errors
/// [`CliError`], which has the exit code.
pub fn run(cli: Cli) -> Result<(), CliError> {
    match cli.command {
        Command::Solve(args) => solve::run(*args),
        Command::Sweep(args) => sweep::run(*args),
        Command::Shear(args) => shear::command::run(&args),
        Command::Surface(args) => surface::run(*args),
        Command::Prepare(args) => prepare::command::run(*args),
        Command::Study(args) => study::command::run(*args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Plot(args) => plot::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Compare(args) => compare::command::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Completions(args) => manual::completions(&Cli::command(), args.shell),
        Command::Man(args) => manual::pages(Cli::command(), &args.out),
    }
}

/// Prints an error of clap and returns the exit code.
///
/// Help and version are printed as clap does. Anything else is one line with exit code 2.
fn refuse(error: &clap::Error) -> u8 {
    if matches!(
        error.kind(),
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    ) {
        // If the output is closed, there is no place to report it.
        let _ = error.print();
        return u8::try_from(error.exit_code()).unwrap_or(2);
    }
    let error = CliError::from(error);
    terminal::tell(&format!("error: {error}"));
    error.exit_code()
}
