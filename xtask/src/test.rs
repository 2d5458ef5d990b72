//! `cargo xtask test`: every test of the workspace.

use anyhow::Result;

use crate::process::{cargo, run as run_step};
use crate::python;

/// Runs every test: unit, cross-crate, figure and documentation tests, and those of the Python package.
///
/// It uses the release profile, so that the crates of the binary `rc` are built once. It prints the lines that it runs.
#[derive(clap::Args, Default)]
pub(crate) struct Args {
    /// Makes another build, with overflow checks and debug assertions, and leaves out Python.
    #[arg(long)]
    checked: bool,
    /// Arguments of cargo, for instance part of a test's name to select tests. They leave out Python.
    #[arg(last = true)]
    cargo: Vec<String>,
}

/// Settings of the profile that `--checked` adds.
const CHECKED: [(&str, &str); 2] =
    [("CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS", "true"), ("CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS", "true")];

const STEPS: [&[&str]; 3] = [
    // Examples are modules of a test, so they are not built as binaries here.
    &["test", "--release", "--workspace", "--lib", "--bins", "--tests"],
    &["test", "--release", "--workspace", "--doc"],
    // This feature is not used by any program of the workspace.
    &["test", "--release", "--package", "rc-core", "--lib", "--features", "ndarray"],
];

pub(crate) fn run(args: &Args) -> Result<()> {
    for words in STEPS {
        let environment = CHECKED.into_iter().filter(|_| args.checked);
        run_step(cargo(words).args(&args.cargo).envs(environment))?;
    }
    if args.checked || !args.cargo.is_empty() { Ok(()) } else { python::run(&python::Args::default()) }
}
