//! `cargo xtask test`: every test of the workspace.

use anyhow::Result;

use crate::process::Step;

/// Runs every test: unit, cross-crate, figure and documentation tests.
///
/// It uses the release profile, so that the crates of the binary `rc` are built once. It prints the cargo lines that it
/// runs.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Makes another build, with overflow checks and debug assertions.
    #[arg(long)]
    checked: bool,
    /// Arguments of cargo, for instance part of a test's name to select tests.
    #[arg(last = true)]
    cargo: Vec<String>,
}

/// Settings of the profile that `--checked` adds.
const CHECKED: &[(&str, &str)] =
    &[("CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS", "true"), ("CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS", "true")];

const STEPS: [&[&str]; 3] = [
    // Examples are modules of a test, so they are not built as binaries here.
    &["test", "--release", "--workspace", "--lib", "--bins", "--tests"],
    &["test", "--release", "--workspace", "--doc"],
    // This feature is not used by any program of the workspace.
    &["test", "--release", "--package", "rc-core", "--lib", "--features", "ndarray"],
];

pub(crate) fn run(args: &Args) -> Result<()> {
    let environment = if args.checked { CHECKED } else { &[] };
    STEPS.into_iter().try_for_each(|words| Step { environment, words }.run(&args.cargo))
}
