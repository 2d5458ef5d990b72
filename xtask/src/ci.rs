//! `cargo xtask ci`: the steps of continuous integration, in their order.

use anyhow::Result;

use crate::process::Step;

/// Checks format, lints, documentation and tests as continuous integration does.
///
/// It also swaps crates for forks and tries the Python package. It stops at the first failure. The script `.ci/run` has
/// the same steps.
#[derive(clap::Args)]
pub(crate) struct Args {}

/// The steps, cheapest first. The script `.ci/run` must have the same lines, which `cargo xtask tidy` checks.
pub(crate) const STEPS: &[Step] = &[
    Step { environment: &[], words: &["fmt", "--all", "--check"] },
    Step {
        environment: &[],
        words: &["clippy", "--release", "--workspace", "--all-targets", "--all-features", "--", "-D", "warnings"],
    },
    Step {
        environment: &[("RUSTDOCFLAGS", "-D warnings")],
        words: &["doc", "--release", "--workspace", "--no-deps", "--all-features"],
    },
    Step { environment: &[], words: &["xtask", "test"] },
    Step { environment: &[], words: &["xtask", "swap"] },
    Step { environment: &[], words: &["xtask", "python"] },
    Step { environment: &[], words: &["xtask", "slurm"] },
    Step { environment: &[], words: &["xtask", "mpi"] },
];

pub(crate) fn run(_args: &Args) -> Result<()> {
    STEPS.iter().try_for_each(|step| step.run(&[]))
}
