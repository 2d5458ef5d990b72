//! `cargo xtask ci`: the steps of continuous integration, in their order.

use anyhow::Result;

use crate::process::{cargo, run as run_step};
use crate::{docs, mpi, swap, test};

/// Checks format, lints, documentation, dependencies and tests as continuous integration does.
///
/// It also swaps crates for forks, and runs on MPI where it is. It stops at the first failure.
#[derive(clap::Args)]
pub(crate) struct Args {}

const CLIPPY: [&str; 8] =
    ["clippy", "--release", "--workspace", "--all-targets", "--all-features", "--", "-D", "warnings"];

pub(crate) fn run(_args: &Args) -> Result<()> {
    run_step(&mut cargo(&["fmt", "--all", "--check"]))?;
    run_step(&mut cargo(&CLIPPY))?;
    docs::document_crates()?;
    check_dependencies()?;
    test::run(&test::Args::default())?;
    swap::run(&swap::Args {})?;
    mpi::run(&mpi::Args {})
}

/// Checks licences, sources and versions of dependencies by `deny.toml`.
#[expect(clippy::print_stderr, reason = "a task runner says what it runs")]
fn check_dependencies() -> Result<()> {
    // Cargo also looks in its own folder of programs, which need not be in the search path.
    if !cargo(&["deny", "--version"]).output().is_ok_and(|output| output.status.success()) {
        eprintln!("deny: skipped, there is no cargo-deny here (cargo install cargo-deny --locked)");
        return Ok(());
    }
    run_step(&mut cargo(&["deny", "--workspace", "--all-features", "check", "licenses", "sources", "bans"]))
}
