//! `cargo xtask wheel`: the wheel for distribution, tested without a compiler.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use rc_figures::repository;

use crate::process::{program, run as run_step};
use crate::python::{new_environment, only_wheel, usable_python};

/// Builds a manylinux wheel of the Python package into target/dist, and tests it.
///
/// The test is in a new virtual environment, in whose search path there is no compiler. maturin links with its own zig
/// against the C library of manylinux 2014. It needs Python 3.11 or newer, and rustup or a Rust for this target.
#[derive(clap::Args)]
pub(crate) struct Args {}

/// Tools that make the wheel, with versions.
const TOOLS: [&str; 1] = ["maturin[zig]==1.16.0"];

/// Packages that the tests of the wheel need.
const TEST_TOOLS: [&str; 4] = ["numpy", "pytest==9.2.0", "matplotlib", "tqdm"];

pub(crate) fn run(_args: &Args) -> Result<()> {
    build(&repository::target().join("dist"), &[WHEEL]).map(drop)
}

/// What maturin makes for PyPI: the wheel, and the sources.
pub(crate) const WHEEL: &[&str] = &["build", "--release", "--locked", "--zig", "--compatibility", "manylinux2014"];
pub(crate) const SDIST: &[&str] = &["sdist"];

/// Makes some of [`WHEEL`] and [`SDIST`] in `out`, and tests the wheel.
///
/// Without Python, a line says so, and the result is `false`.
pub(crate) fn build(out: &Path, kinds: &[&[&str]]) -> Result<bool> {
    let Some(python) = usable_python() else { return Ok(false) };
    let tools = new_environment(&python, "wheel-tools", &TOOLS)?;
    if let Ok(old) = only_wheel(out) {
        fs::remove_file(old)?;
    }
    // Programs of the environment come first in the search path, since zig is one of them.
    let others = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths([programs(&tools)].into_iter().chain(std::env::split_paths(&others)))?;
    for words in kinds {
        run_step(program(&tools, &["-m", "maturin"]).args(*words).arg("--out").arg(out).env("PATH", &path))?;
    }
    try_wheel(&python, &only_wheel(out)?)?;
    Ok(true)
}

/// Installs the wheel in a new environment and runs tests and command there.
///
/// Only the programs of this environment are found.
fn try_wheel(python: &str, wheel: &Path) -> Result<()> {
    let python = new_environment(python, "wheel-test", &TEST_TOOLS)?;
    let path = programs(&python);
    run_step(program(&python, &["-m", "pip", "install", "--quiet", "--no-index"]).arg(wheel).env("PATH", &path))?;
    run_step(program(path.join("rc"), &["--version"]).env("PATH", &path))?;
    let tests = ["-m", "pytest", "-q", "python/tests", "-p", "no:cacheprovider", "-k", "not notebook"];
    run_step(program(&python, &tests).env("PATH", &path)).context("the wheel does not work")
}

/// Folder of the programs of an environment.
fn programs(python: &Path) -> PathBuf {
    python.with_file_name("")
}
