//! `cargo xtask accuracy`.

use anyhow::Result;
use rc_bench::accuracy::{Choice, run as measure};

use crate::figures;

/// Measures on random scenes how often the error bars hold
///
/// Fails if a bar holds too seldom or is too wide in a stratum of scenes. The full size takes about ten minutes.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// The seed of the scenes.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// Least number of scenes in a stratum, instead of 400.
    #[arg(long, value_name = "NUMBER")]
    scenes: Option<usize>,
    /// Only these families of scenes, separated by commas, such as "rough,free border".
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    families: Vec<String>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let preset = Choice::of(args.figure.preset());
    let (seed, families) = (args.seed, args.families.clone());
    let choice = Choice { seed, families, scenes: args.scenes.unwrap_or(preset.scenes) };
    measure(&choice, &args.figure.out)
}
