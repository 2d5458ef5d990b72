//! `rc completions` and `rc man`: what shells and `man` know of the command line, from the same source as `--help`.

use std::path::Path;

use clap::CommandFactory as _;
use clap_complete::Shell;

use crate::args::Cli;
use crate::error::CliError;
use crate::output;
use rc_sweep::files::{self, Staged};

/// Prints completions.
///
/// # Errors
/// [`CliError::Write`].
pub(crate) fn completions(shell: Shell) -> Result<(), CliError> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "rc", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}

/// Writes a page for `rc` and one for each of its commands.
///
/// # Errors
/// [`CliError`] when the folder cannot be written to.
pub(crate) fn pages(folder: &Path) -> Result<(), CliError> {
    files::check_folder(folder)?;
    let mut rc = Cli::command();
    // Gives the commands below their full names.
    rc.build();
    let mut staged = Staged::new(folder)?;
    add_page(&mut staged, &rc)?;
    Ok(staged.commit()?)
}

/// The page of `command`, and those of the commands below it.
fn add_page(staged: &mut Staged, command: &clap::Command) -> Result<(), CliError> {
    let man = clap_mangen::Man::new(command.clone());
    let (name, mut page) = (man.get_filename(), Vec::new());
    man.render(&mut page).map_err(|cause| CliError::write(Path::new(&name), cause))?;
    staged.add_text(&name, &String::from_utf8_lossy(&page))?;
    command.get_subcommands().try_for_each(|below| add_page(staged, below))
}
