//! `cargo xtask test`: every test of the workspace.

use anyhow::Result;

use crate::process::Step;

/// Runs every test: unit, cross-crate, figure and documentation tests.
///
/// The release profile, so that everything that the binary `rc` needs is built once. Prints the cargo lines it runs.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Another build, with overflow checks and debug assertions.
    #[arg(long)]
    checked: bool,
    /// Words for cargo, for instance part of a test's name, to run only tests that contain it.
    #[arg(last = true)]
    cargo: Vec<String>,
}

/// What `--checked` adds to the profile.
const CHECKED: &[(&str, &str)] =
    &[("CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS", "true"), ("CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS", "true")];

const STEPS: [&[&str]; 3] = [
    // Examples are modules of a test, so that they need no binaries here.
    &["test", "--release", "--workspace", "--lib", "--bins", "--tests"],
    &["test", "--release", "--workspace", "--doc"],
    // A feature that no program of the workspace turns on.
    &["test", "--release", "--package", "rc-core", "--lib", "--features", "ndarray"],
];

pub(crate) fn run(args: &Args) -> Result<()> {
    let environment = if args.checked { CHECKED } else { &[] };
    STEPS.into_iter().try_for_each(|words| Step { environment, words }.run(&args.cargo))
}
