//! `cargo xtask python`: the Python package, built, installed and tested.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use anyhow::{Context, Result, bail};
use rc_figures::repository;

use crate::process::{program, run as run_step};

/// Builds, installs and tests the Python package in an environment in target/python.
///
/// It runs tests, type checks, examples and notebooks. It needs Python 3.11 or newer: `python3`, or the one in the
/// variable PYTHON. Without it the command says so and succeeds (Debian: python3-venv).
#[derive(clap::Args, Default)]
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

pub(crate) fn run(args: &Args) -> Result<()> {
    let Some(python) = usable_python() else { return Ok(()) };
    let python = environment(&python)?;
    install_package(&python)?;
    if args.docs {
        return documentation(&python);
    }
    run_step(&mut program(&python, &["-m", "mypy", "--strict", "python/examples", "python/roughcontact"]))?;
    run_step(program(&python, &["-m", "pytest", "-q"]).args(&args.pytest))
}

/// The Python that makes environments. Without one that can, a line says so.
#[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
pub(crate) fn usable_python() -> Option<String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let mut call = program(&python, &["-c", "import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))"]);
    call.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let is_usable = call.status().is_ok_and(|status| status.success());
    if !is_usable {
        eprintln!(
            "python: skipped, {python} is no Python from 3.11 on with venv (Debian: apt-get install python3-venv; another \
             one is named in the variable PYTHON)"
        );
    }
    is_usable.then_some(python)
}

/// The Python of the environment for tests, which is made at the first use and when the requirements change.
fn environment(python: &str) -> Result<PathBuf> {
    let wanted = fs::read_to_string(repository::root().join(REQUIREMENTS)).context(REQUIREMENTS)?;
    let mark = folder().join("environment/requirements.txt");
    if fs::read_to_string(&mark).is_ok_and(|installed| installed == wanted) {
        return Ok(folder().join("environment/bin/python"));
    }
    let python = new_environment(python, "environment", &["--requirement", REQUIREMENTS])
        .context("packages for Python could not be installed; with PYTHON=none the tests of Python are left out")?;
    fs::write(mark, wanted)?;
    Ok(python)
}

/// The Python of a new virtual environment in target/python, with packages from PyPI.
pub(crate) fn new_environment(python: &str, name: &str, packages: &[&str]) -> Result<PathBuf> {
    let environment = folder().join(name);
    run_step(program(python, &["-m", "venv", "--clear"]).arg(&environment))?;
    let python = environment.join("bin/python");
    run_step(program(&python, &["-m", "pip", "install", "--quiet"]).args(packages))?;
    Ok(python)
}

/// Builds the wheel in cargo's folder of build results, and installs it.
fn install_package(python: &Path) -> Result<()> {
    let wheels = folder().join("wheels");
    // Another wheel there could be mistaken for the new one.
    let _ = fs::remove_dir_all(&wheels);
    let build = ["-m", "maturin", "build", "--release", "--locked", "--quiet", "--out"];
    run_step(program(python, &build).arg(&wheels))?;
    let install = ["-m", "pip", "install", "--quiet", "--no-deps", "--force-reinstall"];
    run_step(program(python, &install).arg(only_wheel(&wheels)?))
}

/// Builds the documentation from docstrings, guide and notebooks with Sphinx.
fn documentation(python: &Path) -> Result<()> {
    let (source, site) = (folder().join("source"), folder().join("site"));
    for old in [&source, &site] {
        let _ = fs::remove_dir_all(old);
    }
    let notebooks = source.join("extra/notebooks");
    for (from, to) in [
        ("python/docs", source.clone()),
        ("docs", source.join("guide")),
        ("docs/images", source.join("guide/images")),
        ("python/notebooks", notebooks.clone()),
    ] {
        copy_files(&repository::root().join(from), &to)?;
    }
    let convert = ["-m", "nbconvert", "--execute", "--to", "html", "--log-level", "WARN"];
    run_step(program(python, &convert).arg(notebooks.join("*.ipynb")))?;
    run_step(program(python, &["-m", "sphinx", "-q", "-W", "--keep-going"]).args([source, site]))
}

/// Folder of all build results of Python.
pub(crate) fn folder() -> PathBuf {
    repository::target().join("python")
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

/// Copies the files of a folder, without its subfolders.
fn copy_files(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let path = entry?.path();
        if path.is_file() {
            fs::copy(&path, to.join(path.file_name().unwrap_or_default()))?;
        }
    }
    Ok(())
}
