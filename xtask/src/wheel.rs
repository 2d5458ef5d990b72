//! `cargo xtask wheel`: the wheel for distribution, tested without a compiler.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use rc_figures::repository;

use crate::process::Program;
use crate::python::{folder, in_environment, only_wheel, path_text};

/// Builds a manylinux wheel of the Python package into target/python/dist, and tests it.
///
/// The test is in a new virtual environment, in whose search path there is no compiler. maturin links with its own zig
/// against the C library of manylinux 2014. It needs a Python from 3.10 on, and rustup or a Rust for this target.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Platform tag of the wheel
    #[arg(long, default_value = "manylinux2014")]
    manylinux: String,
}

/// Tools that make the wheel, with versions.
const TOOLS: [&str; 2] = ["maturin[zig]==1.16.0", "pip"];

/// Packages that the tests of the wheel need.
const TEST_TOOLS: [&str; 4] = ["numpy", "pytest==9.2.0", "matplotlib", "tqdm"];

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let (tools, wheels) = (folder().join("wheel-tools"), folder().join("dist"));
    new_environment(&tools, &TOOLS)?;
    let _ = fs::remove_dir_all(&wheels);
    let build = ["-m", "maturin", "build", "--release", "--locked", "--zig", "--manylinux", &args.manylinux, "--out"];
    let words: Vec<&str> = build.into_iter().chain([path_text(&wheels)?]).collect();
    // Programs of the environment come first in the search path, since zig is one of them.
    Program::new(in_environment(&tools, "python"), &words).with_path(&programs_before(&tools)?).run()?;
    let wheel = only_wheel(&wheels)?;
    try_wheel(&wheel)?;
    let bytes = wheel.metadata()?.len();
    println!("{}: {:.1} MB", wheel.display(), bytes as f64 / 1e6);
    Ok(())
}

/// Installs the wheel in a new environment and runs tests and command there.
///
/// Only the programs of this environment are found.
fn try_wheel(wheel: &Path) -> Result<()> {
    let environment = folder().join("wheel-test");
    new_environment(&environment, &TEST_TOOLS)?;
    let programs = in_environment(&environment, "python").with_file_name("");
    let path = path_text(&programs)?.to_owned();
    let python = |words: &[&str]| Program::new(in_environment(&environment, "python"), words).with_path(&path);
    for compiler in ["cc", "gcc", "cargo", "rustc"] {
        if programs.join(compiler).exists() {
            bail!("{} is a compiler; the wheel is to be tried without one", programs.join(compiler).display());
        }
    }
    python(&["-m", "pip", "install", "--quiet", "--no-index", path_text(wheel)?]).run()?;
    Program::new(in_environment(&environment, "rc"), &["--version"]).with_path(&path).run()?;
    let tests = repository::root().join("python/tests");
    python(&["-m", "pytest", "-q", path_text(&tests)?, "-p", "no:cacheprovider", "-k", "not notebook"]).run()
}

/// A new virtual environment with these packages.
fn new_environment(environment: &Path, packages: &[&str]) -> Result<()> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    Program::new(python, &["-m", "venv", "--clear", path_text(environment)?]).run()?;
    let words: Vec<&str> = ["-m", "pip", "install", "--quiet"].into_iter().chain(packages.iter().copied()).collect();
    Program::new(in_environment(environment, "python"), &words).run()
}

/// Search path of this process, after the folder of an environment's programs.
fn programs_before(environment: &Path) -> Result<String> {
    let programs = in_environment(environment, "python").with_file_name("");
    let others = std::env::var_os("PATH").unwrap_or_default();
    let all = std::env::join_paths([programs].into_iter().chain(std::env::split_paths(&others)))?;
    all.into_string().ok().context("PATH is not UTF-8")
}
