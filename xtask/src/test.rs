//! `cargo xtask test`: every test of the workspace.

use anyhow::Result;

use crate::process::Step;

/// Runs every test: unit, cross-crate, figure and documentation tests.
///
/// One build, cargo's `dev` profile, in which the numeric crates are optimised and overflow checks stay on. Prints the
/// cargo lines it runs.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Test the optimised build instead (no overflow checks; shares its libraries with the `rc` binary).
    #[arg(long)]
    release: bool,
    /// Words for cargo, for instance part of a test's name, to run only tests that contain it.
    #[arg(last = true)]
    cargo: Vec<String>,
}

/// `cargo test` runs unit, integration and documentation tests of all members.
const TEST: Step = Step { environment: &[], words: &["test", "--workspace"] };

pub(crate) fn run(args: &Args) -> Result<()> {
    let release = args.release.then(|| "--release".to_owned());
    TEST.run(&release.into_iter().chain(args.cargo.iter().cloned()).collect::<Vec<_>>())
}
