//! Warnings on the terminal, and as errors with `--strict`.

use rc_sweep::Warning;

use crate::error::CliError;
use crate::scene::keys::RunKeys;
use crate::terminal;

/// Prints warnings, one line each, unless `run` is quiet.
pub(crate) fn tell(warnings: &[Warning], run: &RunKeys) {
    if !run.quiet {
        for warning in warnings {
            terminal::tell(&format!("warning: {}", warning.text));
        }
    }
}

/// Refuses warnings if `is_strict`. `after` says what has happened to the results.
///
/// # Errors
/// [`CliError::Input`] with the first warning and the codes of the others.
pub fn refuse(warnings: &[Warning], is_strict: bool, after: &str) -> Result<(), CliError> {
    let [first, others @ ..] = warnings else { return Ok(()) };
    if !is_strict {
        return Ok(());
    }
    let codes: Vec<&str> = others.iter().map(|warning| warning.code.name()).collect();
    let more = if codes.is_empty() { String::new() } else { format!("; also: {}", codes.join(", ")) };
    Err(CliError::input(format_args!("strict: {} ({}){more}{after}", first.text, first.code)))
}
