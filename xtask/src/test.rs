//! `cargo xtask test`: every test of the workspace.

use anyhow::Result;

use crate::process::Step;

/// Runs every test: unit, cross-crate, figure and documentation tests.
///
/// The release profile, so that everything that the binary `rc` needs is built once. Prints the cargo lines it runs.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Another build, with overflow checks and debug assertions: cargo's `dev` profile
    #[arg(long)]
    dev: bool,
    /// Words for cargo, for instance part of a test's name, to run only tests that contain it.
    #[arg(last = true)]
    cargo: Vec<String>,
}

/// Unit and integration tests of all members. Examples are modules of a test, so that they need no binaries here.
const TESTS: Step = Step { environment: &[], words: &["test", "--workspace", "--lib", "--bins", "--tests"] };

const DOCUMENTATION: Step = Step { environment: &[], words: &["test", "--workspace", "--doc"] };

/// Features that no program of the workspace turns on.
const FEATURES: Step =
    Step { environment: &[], words: &["test", "--package", "rc-core", "--lib", "--features", "ndarray"] };

pub(crate) fn run(args: &Args) -> Result<()> {
    let release = (!args.dev).then(|| "--release".to_owned());
    let words: Vec<String> = release.into_iter().chain(args.cargo.iter().cloned()).collect();
    [TESTS, DOCUMENTATION, FEATURES].iter().try_for_each(|step| step.run(&words))
}
