//! `rc completions` and `rc man`: shell completions and manual pages.
//!
//! Their source is that of `--help`.

use std::path::{Path, PathBuf};

use clap::Args;
use clap_complete::Shell;

use crate::error::CliError;
use crate::terminal;
use rc_sweep::files::{self, Staged};

/// Arguments of `rc completions`.
#[derive(Args, Clone, Debug)]
#[command(after_help = COMPLETIONS_HELP)]
pub(crate) struct CompletionsArgs {
    /// The shell
    pub(crate) shell: Shell,
}

const COMPLETIONS_HELP: &str = "\
For the current user, in a new shell:
  bash  rc completions bash > ~/.local/share/bash-completion/completions/rc
  zsh   rc completions zsh > ~/.zfunc/_rc    (or another folder of $fpath)
  fish  rc completions fish > ~/.config/fish/completions/rc.fish";

/// Arguments of `rc man`.
#[derive(Args, Clone, Debug)]
pub(crate) struct ManArgs {
    /// Folder that receives rc.1, rc-solve.1 and so on
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
}

/// Prints completions of `rc`.
///
/// # Errors
/// [`CliError::Write`].
pub(crate) fn completions(rc: &clap::Command, shell: Shell) -> Result<(), CliError> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut without_hidden(rc), "rc", &mut script);
    terminal::print(&String::from_utf8_lossy(&script))
}

/// The command without hidden arguments, which shells would offer.
fn without_hidden(command: &clap::Command) -> clap::Command {
    let shown = command.get_arguments().filter(|argument| !argument.is_hide_set()).cloned();
    let mut copy = clap::Command::new(command.get_name().to_owned())
        .about(command.get_about().cloned().unwrap_or_default())
        .disable_help_flag(true)
        .disable_help_subcommand(true)
        .args(shown)
        .subcommands(command.get_subcommands().map(without_hidden));
    if let Some(version) = command.get_version() {
        copy = copy.version(version.to_owned());
    }
    copy
}

/// Writes a page for `rc` and one for each of its commands.
///
/// # Errors
/// [`CliError`] when the folder cannot be written to.
pub(crate) fn pages(mut rc: clap::Command, folder: &Path) -> Result<(), CliError> {
    files::check_folder(folder)?;
    // This gives subcommands their full names.
    rc.build();
    let mut staged = Staged::new(folder)?;
    add_page(&mut staged, &rc)?;
    Ok(staged.commit()?)
}

/// Adds the page of `command`, and those of its subcommands.
fn add_page(staged: &mut Staged, command: &clap::Command) -> Result<(), CliError> {
    let man = clap_mangen::Man::new(command.clone());
    let (name, mut page) = (man.get_filename(), Vec::new());
    man.render(&mut page).map_err(|cause| CliError::write(Path::new(&name), cause))?;
    staged.add_text(&name, &with_usage(&String::from_utf8_lossy(&page), command))?;
    command.get_subcommands().try_for_each(|below| add_page(staged, below))
}

/// The page with the usage of `--help` as its synopsis.
///
/// The generated synopsis lacks the values of required options, and does not say which arguments may be repeated.
fn with_usage(page: &str, command: &clap::Command) -> String {
    const HEADING: &str = ".SH SYNOPSIS\n";
    let usage = command.clone().render_usage().to_string();
    let lines: Vec<&str> = usage.trim_start_matches("Usage: ").lines().map(str::trim).collect();
    let lines = lines.join("\n.br\n").replace('-', "\\-");
    match page.split_once(HEADING).and_then(|(before, after)| Some((before, after.split_once('\n')?.1))) {
        Some((before, after)) => format!("{before}{HEADING}{lines}\n{after}"),
        None => page.to_owned(),
    }
}
