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

/// The command as one types it in a shell in the root of the repository.
fn shell_line(command: &Command) -> String {
    let name = Path::new(command.get_program());
    let name = if name.ends_with("cargo") { Path::new("cargo") } else { name };
    let folder = command.get_current_dir().filter(|folder| *folder != repository::root());
    let folder = folder.map(|folder| format!("cd {} &&", quoted(folder.as_ref())));
    let environment =
        command.get_envs().filter_map(|(name, value)| Some(format!("{}={}", name.display(), quoted(value?))));
    let words = std::iter::once(name.as_os_str()).chain(command.get_args()).map(quoted);
    folder.into_iter().chain(environment).chain(words).collect::<Vec<_>>().join(" ")
}

/// A word for a shell, in quotes if it has spaces or what the shell would read as more than text.
fn quoted(word: &OsStr) -> String {
    let word = word.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:,=+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) { word } else { format!("'{}'", word.replace('\'', r"'\''")) }
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
        assert_eq!(line, "RUSTDOCFLAGS='-D warnings' cargo doc --no-deps");
        let line = shell_line(program("sh", &["-c", "echo '*'"]).current_dir("/tmp"));
        assert_eq!(line, r"cd /tmp && sh -c 'echo '\''*'\'''");
    }
}
