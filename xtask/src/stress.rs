//! `cargo xtask stress`: hard scenes against the properties that every solution must have.

use anyhow::Result;
use clap::Parser as _;
use rc_bench::stress::{self, Params};

use crate::figures;

/// Runs hard scenes against solvers, kernels and operators, one line for each property.
///
/// It also draws a picture of all lines. A line that fails is an error.
#[derive(clap::Args)]
// The group has a name of its own, since it flattens other arguments.
#[group(id = "stress")]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// Only groups whose name contains this.
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Prints a number that depends on every bit of one solution, for comparison between processes.
    #[arg(long, value_name = "SCENE", hide = true)]
    fingerprint: Option<usize>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    if let Some(scene) = args.fingerprint {
        return stress::print_fingerprint(scene);
    }
    let params = Params { preset: args.figure.preset(), only: args.only.clone(), rc: Some(rc) };
    stress::run(&params, &args.figure.out)
}

/// Runs the command line in this process. An error has the exit code and the text.
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
