//! `cargo xtask python`: the Python package, built, installed and tested.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use rc_figures::repository;

use crate::process::Program;

/// Builds, installs and tests the Python package in an environment in target/python.
///
/// It runs tests, type checks, examples and notebooks. It needs Python 3.11 or newer: `python3`, or the one in the
/// variable PYTHON. Without it the command says so and succeeds (Debian: python3-venv).
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Builds the documentation into target/python/site instead, with the notebooks and the guide
    #[arg(long)]
    docs: bool,
    /// Arguments of pytest, for instance part of a test's name after -k
    #[arg(last = true)]
    pytest: Vec<String>,
}

/// Packages with versions for tests, type checks, notebooks and documentation.
const REQUIREMENTS: &str = "python/requirements-test.txt";

#[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let python = chosen_python();
    if !is_usable(&python) {
        eprintln!(
            "python: skipped, {python} is no Python from 3.11 on with venv (Debian: apt-get install python3-venv; another \
             one is named in the variable PYTHON)"
        );
        return Ok(());
    }
    let environment = Environment::new()?;
    environment.install_package()?;
    if args.docs {
        return documentation(&environment);
    }
    environment.python(&["-m", "mypy", "--strict", "python/examples", "python/roughcontact"]).run()?;
    let words: Vec<&str> = ["-m", "pytest", "-q"].into_iter().chain(args.pytest.iter().map(String::as_str)).collect();
    environment.python(&words).run()
}

/// The Python that makes environments.
fn chosen_python() -> String {
    std::env::var("PYTHON").unwrap_or_else(|_| "python3".into())
}

/// Whether this program is a Python that can make the environment.
fn is_usable(python: &str) -> bool {
    let check = "import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))";
    let mut call = Command::new(python);
    call.args(["-c", check]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    call.status().is_ok_and(|status| status.success())
}

/// A virtual environment in the folder of build results.
struct Environment {
    folder: PathBuf,
}

impl Environment {
    /// The environment, which is made at the first use and when the requirements change.
    fn new() -> Result<Self> {
        let folder = folder().join("environment");
        let environment = Self { folder };
        let wanted = fs::read_to_string(repository::root().join(REQUIREMENTS)).context(REQUIREMENTS)?;
        let mark = environment.folder.join("requirements.txt");
        if fs::read_to_string(&mark).is_ok_and(|installed| installed == wanted) {
            return Ok(environment);
        }
        let python = chosen_python();
        let folder = path_text(&environment.folder)?;
        Program::new(python, &["-m", "venv", "--clear", folder]).run()?;
        environment.python(&["-m", "pip", "install", "--quiet", "--requirement", REQUIREMENTS]).run()?;
        fs::write(&mark, wanted)?;
        Ok(environment)
    }

    /// Builds the wheel in cargo's folder of build results, and installs it.
    fn install_package(&self) -> Result<()> {
        let wheels = folder().join("wheels");
        // Another wheel there could be mistaken for the new one.
        let _ = fs::remove_dir_all(&wheels);
        let out = path_text(&wheels)?;
        self.python(&["-m", "maturin", "build", "--release", "--locked", "--quiet", "--out", out]).run()?;
        let wheel = only_wheel(&wheels)?;
        let install = ["-m", "pip", "install", "--quiet", "--no-deps", "--force-reinstall", path_text(&wheel)?];
        self.python(&install).run()
    }

    /// A call of the environment's Python.
    fn python(&self, words: &[&str]) -> Program {
        Program::new(in_environment(&self.folder, "python"), words)
    }
}

/// Builds the documentation from docstrings, guide and notebooks with Sphinx.
fn documentation(environment: &Environment) -> Result<()> {
    let (source, site) = (folder().join("source"), folder().join("site"));
    for old in [&source, &site] {
        let _ = fs::remove_dir_all(old);
    }
    let root = repository::root();
    copy_files(&root.join("python/docs"), &source)?;
    copy_files(&root.join("docs"), &source.join("guide"))?;
    copy_files(&root.join("docs/images"), &source.join("guide/images"))?;
    let notebooks = source.join("extra/notebooks");
    copy_files(&root.join("python/notebooks"), &notebooks)?;
    let pattern = format!("{}/*.ipynb", path_text(&notebooks)?);
    environment.python(&["-m", "nbconvert", "--execute", "--to", "html", "--log-level", "WARN", &pattern]).run()?;
    let words = ["-m", "sphinx", "-q", "-W", "--keep-going", path_text(&source)?, path_text(&site)?];
    environment.python(&words).run()
}

/// Folder of all build results of Python.
pub(crate) fn folder() -> PathBuf {
    repository::target().join("python")
}

/// Path of a program in a virtual environment.
pub(crate) fn in_environment(environment: &Path, name: &str) -> PathBuf {
    let programs = if cfg!(windows) { "Scripts" } else { "bin" };
    environment.join(programs).join(name).with_extension(std::env::consts::EXE_EXTENSION)
}

/// Path of the only wheel in `folder`.
///
/// # Errors
/// When `folder` has no wheel, or more than one.
pub(crate) fn only_wheel(folder: &Path) -> Result<PathBuf> {
    let entries = fs::read_dir(folder).with_context(|| format!("no wheel in {}", folder.display()))?;
    let paths = entries.map(|entry| Ok(entry?.path())).collect::<Result<Vec<PathBuf>>>()?;
    let mut wheels = paths.into_iter().filter(|path| path.extension().is_some_and(|e| e == "whl"));
    match (wheels.next(), wheels.next()) {
        (Some(wheel), None) => Ok(wheel),
        _ => bail!("{} must hold exactly one wheel", folder.display()),
    }
}

/// A path as an argument of a command.
///
/// # Errors
/// When it is not UTF-8.
pub(crate) fn path_text(path: &Path) -> Result<&str> {
    path.to_str().with_context(|| format!("{} is not UTF-8", path.display()))
}

/// Copies the files of a folder, without its subfolders.
fn copy_files(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let entry = entry?;
        if entry.file_type()?.is_file() {
            fs::copy(entry.path(), to.join(entry.file_name()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_is_not_there_or_no_python_is_not_usable() {
        assert!(!is_usable("/nonexistent"));
        assert!(!is_usable("cargo"), "it knows no -c");
    }
}
