//! `cargo xtask stress`: hard scenes against the properties that every solution must have.

use anyhow::Result;
use clap::Parser as _;
use rc_bench::stress::{self, Params};

use crate::figures;

/// Stresses the solvers, kernels and operators on purpose: one line for each scene and property, a picture of all, and
/// an error when a line fails.
#[derive(clap::Args)]
// Its own name beside that of the arguments it flattens.
#[group(id = "stress")]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// Only groups whose name contains this.
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Puts faults into a copy of the sources, one at a time, and counts the rows of the reduced set that fail
    /// (with --only, the faults whose name contains it). Hours.
    #[arg(long)]
    mutate: bool,
    /// Prints a number that depends on every bit of one solution, for comparison between processes.
    #[arg(long, value_name = "SCENE", hide = true)]
    fingerprint: Option<usize>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    if let Some(scene) = args.fingerprint {
        return stress::print_fingerprint(scene);
    }
    if args.mutate {
        return stress::mutate(args.only.as_deref(), &args.figure.out);
    }
    let params = Params { preset: args.figure.preset(), only: args.only.clone(), rc: Some(rc) };
    stress::run(&params, &args.figure.out)
}

/// Runs the command line in this process; the exit code of a failure with its text.
fn rc(words: &[String]) -> Result<(), (u8, String)> {
    let words = [&["rc".to_owned()], words].concat();
    let cli = rc_cli::args::Cli::try_parse_from(words).map_err(|error| (2, error.to_string()))?;
    rc_cli::run(cli).map_err(|error| (error.exit_code(), error.to_string()))
}

#[cfg(test)]
mod tests {
    use rc_bench::stress::Stress;
    use rc_figures::{Figure as _, Preset};

    use super::*;

    #[test]
    fn the_command_line_passes_its_part_of_the_reduced_set() {
        let params = Params { preset: Preset::Quick, only: Some("rc solve".to_owned()), rc: Some(rc) };
        let stress = Stress::compute(&params).expect("scenes that can be made");
        stress.check().expect("every row passes");
        assert!(stress.n_rows() >= 40, "only {} rows", stress.n_rows());
    }
}
