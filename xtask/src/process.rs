//! Calls of cargo and other programs, announced before they run.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use rc_figures::repository;

/// A call of cargo in the root of the repository.
pub(crate) fn cargo(words: &[&str]) -> Command {
    // This is the cargo that started this process, so that a `+toolchain` is valid here too.
    program(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()), words)
}

/// A call of a program in the root of the repository.
pub(crate) fn program(name: impl AsRef<OsStr>, words: &[&str]) -> Command {
    let mut command = Command::new(name);
    command.args(words).current_dir(repository::root());
    command
}

/// Runs a command. Its output goes to the output of this process.
///
/// # Errors
/// When the command cannot be started, or fails.
#[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
pub(crate) fn run(command: &mut Command) -> Result<()> {
    let line = shell_line(command);
    eprintln!("$ {line}");
    let start = Instant::now();
    let status = command.status().with_context(|| format!("could not start `{line}`; is it installed?"))?;
    if !status.success() {
        bail!("`{line}` failed; repeat that line alone to see why");
    }
    eprintln!("  done in {:.0} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// The command as one types it in a shell.
fn shell_line(command: &Command) -> String {
    let name = Path::new(command.get_program());
    let name = if name.ends_with("cargo") { Path::new("cargo") } else { name };
    let environment =
        command.get_envs().filter_map(|(name, value)| Some(format!("{}=\"{}\"", name.display(), value?.display())));
    let words = command.get_args().map(|word| word.display().to_string());
    environment.chain([name.display().to_string()]).chain(words).collect::<Vec<_>>().join(" ")
}

/// Path of a program in the search path or in the system's folders.
pub(crate) fn path_of(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain(["/usr/sbin".into(), "/sbin".into()]);
    folders.map(|folder| folder.join(program)).find(|path| path.is_file())
}

/// Repeats a question until the answer is yes, for five minutes at most.
pub(crate) fn wait(what: &str, mut is_so: impl FnMut() -> Result<bool>) -> Result<()> {
    let started = Instant::now();
    while !is_so()? {
        ensure!(started.elapsed() < Duration::from_secs(300), "no {what} within five minutes");
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_written_as_typed() {
        let line = shell_line(cargo(&["doc", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings"));
        assert_eq!(line, "RUSTDOCFLAGS=\"-D warnings\" cargo doc --no-deps");
    }
}
