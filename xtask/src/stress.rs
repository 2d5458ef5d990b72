//! `cargo xtask stress`: hard scenes against the properties that every solution must have.

use anyhow::Result;
use rc_bench::stress;

use crate::figures;

/// Runs hard scenes by every method, one line for each property.
///
/// A line that fails is an error.
#[derive(clap::Args)]
// The group has a name of its own, since it flattens other arguments.
#[group(id = "stress")]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// Only groups whose name contains this: extremes, meshes or sliding.
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    stress::run(args.figure.preset(), args.only.as_deref(), &args.figure.out)
}
