//! Steps that run cargo or another program, announced before they run.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result, bail};

use rc_figures::repository;

/// One call of cargo, as plain data.
///
/// So steps can be listed, compared and printed.
pub(crate) struct Step {
    /// Environment variables of this call.
    pub(crate) environment: &'static [(&'static str, &'static str)],
    /// Arguments of `cargo`.
    pub(crate) words: &'static [&'static str],
}

impl Step {
    /// The step as one types it in a shell.
    pub(crate) fn shell_line(&self) -> String {
        let environment = self.environment.iter().map(|(name, value)| format!("{name}=\"{value}\""));
        let words = self.words.iter().map(ToString::to_string);
        environment.chain(["cargo".to_owned()]).chain(words).collect::<Vec<_>>().join(" ")
    }

    /// Runs the step in the root of the repository.
    ///
    /// `extra` arguments follow the step's own. The output goes to the output of this process.
    ///
    /// # Errors
    /// When cargo cannot be started, or fails.
    pub(crate) fn run(&self, extra: &[String]) -> Result<()> {
        self.run_in(&repository::root(), extra)
    }

    /// Runs the step as [`Step::run`] does, in another folder.
    ///
    /// # Errors
    /// When cargo cannot be started, or fails.
    #[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
    pub(crate) fn run_in(&self, folder: &Path, extra: &[String]) -> Result<()> {
        let line = [self.shell_line()].into_iter().chain(extra.iter().cloned()).collect::<Vec<_>>().join(" ");
        eprintln!("$ {line}");
        let start = Instant::now();
        // This is the cargo that started this process, so that a `+toolchain` is valid for the steps too.
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let status = Command::new(cargo)
            .args(self.words)
            .args(extra)
            .envs(self.environment.iter().copied())
            .current_dir(folder)
            .status()
            .with_context(|| format!("could not start `{line}`; is cargo installed?"))?;
        if !status.success() {
            bail!("`{line}` failed; repeat that line alone to see why");
        }
        eprintln!("  done in {:.0} s", start.elapsed().as_secs_f64());
        Ok(())
    }
}

/// A call of a program that is not cargo, in the root of the repository.
pub(crate) struct Program {
    name: OsString,
    words: Vec<String>,
    path: Option<String>,
}

impl Program {
    /// The program with these arguments.
    pub(crate) fn new(name: impl Into<OsString>, words: &[&str]) -> Self {
        Self { name: name.into(), words: words.iter().map(ToString::to_string).collect(), path: None }
    }

    /// The program with another search path for programs.
    pub(crate) fn with_path(self, path: &str) -> Self {
        Self { path: Some(path.to_owned()), ..self }
    }

    /// Runs the program. Its output goes to the output of this process.
    ///
    /// # Errors
    /// When the program cannot be started, or fails.
    #[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
    pub(crate) fn run(&self) -> Result<()> {
        let line = format!("{} {}", self.name.display(), self.words.join(" "));
        eprintln!("$ {line}");
        let start = Instant::now();
        let mut command = Command::new(&self.name);
        command.args(&self.words).current_dir(repository::root());
        if let Some(path) = &self.path {
            command.env("PATH", path);
        }
        let status = command.status().with_context(|| format!("could not start `{line}`; is it installed?"))?;
        if !status.success() {
            bail!("`{line}` failed; repeat that line alone to see why");
        }
        eprintln!("  done in {:.0} s", start.elapsed().as_secs_f64());
        Ok(())
    }
}

/// Path of a program in the search path or in the system's folders.
pub(crate) fn path_of(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain(["/usr/sbin".into(), "/sbin".into()]);
    folders.map(|folder| folder.join(program)).find(|path| path.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_written_as_typed() {
        let step = Step { environment: &[("RUSTDOCFLAGS", "-D warnings")], words: &["doc", "--no-deps"] };
        assert_eq!(step.shell_line(), "RUSTDOCFLAGS=\"-D warnings\" cargo doc --no-deps");
    }
}
