//! `cargo xtask guide-figures`: the figures of the guide that the paper does not have.

use anyhow::Result;
use rc_figures::guide;

use crate::figures;

/// Draws the figures of the guide, also into docs/images/
///
/// They are the mesh of a solved contact, the kernel split, one V of levels, and the start of a level.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figures: figures::Args,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    guide::write_all(args.figures.preset(), &args.figures.out)
}
