//! The task runner: `cargo xtask <command>`, one file per command.

mod accuracy;
mod bench;
mod challenge;
mod ci;
mod dist;
mod docs;
mod figures;
mod gfmd;
mod mpi;
mod process;
mod python;
mod stress;
mod swap;
mod test;
mod tidy;
mod wheel;

use clap::{CommandFactory as _, Parser, Subcommand};
use rc_figures::{Fig1, Fig2, Fig3, Fig4, Fig5, Fig6, Fig7, Fig8, Statements};

/// Tests, checks, figures and benchmarks of rc. Needs nothing but cargo.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", disable_help_subcommand = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Test(test::Args),
    Tidy(tidy::Args),
    Ci(ci::Args),
    /// Draws Fig. 1: a section of a solved contact with its mean planes and penetration
    Fig1(figures::Args),
    /// Draws Fig. 2: the self-balanced load on the cell and the displacement that it causes
    Fig2(figures::Args),
    /// Draws Fig. 3: elements of the three meshes against penetration and contact fraction
    Fig3(figures::Args),
    /// Draws Fig. 4: contact circle and pressure sections of a sphere against Hertz
    Fig4(figures::Args),
    /// Draws Fig. 5: contact area against mean pressure, with straight lines and Persson's curves
    Fig5(figures::Args),
    /// Draws Fig. 6: contact maps of the paper's surface with 64 and 128 waves
    Fig6(figures::Args),
    /// Draws Fig. 7: mean pressure against penetration, with exponential fits and Persson's decay length
    Fig7(figures::Args),
    /// Draws Fig. 8: the stress distribution, the fit of Eq. 7, and the approach to zero
    Fig8(figures::Args),
    /// Computes statements of the paper without a figure: energy and area, convergence, Gaussian heights
    Statements(figures::Args),
    /// Draws every figure of the paper, and compares with the archived run or replaces it
    Figures(figures::AllArgs),
    Reproduction(figures::ReproductionArgs),
    Gfmd(gfmd::Args),
    Challenge(challenge::Args),
    Accuracy(accuracy::Args),
    Bench(bench::Args),
    Mpi(mpi::Args),
    Stress(stress::Args),
    Swap(swap::Args),
    Dist(dist::Args),
    Python(python::Args),
    Wheel(wheel::Args),
    Docs(docs::Args),
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::Test(args) => test::run(&args),
        Command::Tidy(args) => tidy::run(&args, &Cli::command()),
        Command::Ci(args) => ci::run(&args),
        Command::Fig1(args) => figures::run::<Fig1>(&args),
        Command::Fig2(args) => figures::run::<Fig2>(&args),
        Command::Fig3(args) => figures::run::<Fig3>(&args),
        Command::Fig4(args) => figures::run::<Fig4>(&args),
        Command::Fig5(args) => figures::run::<Fig5>(&args),
        Command::Fig6(args) => figures::run::<Fig6>(&args),
        Command::Fig7(args) => figures::run::<Fig7>(&args),
        Command::Fig8(args) => figures::run::<Fig8>(&args),
        Command::Statements(args) => figures::run::<Statements>(&args),
        Command::Figures(args) => figures::run_all(&args),
        Command::Reproduction(args) => figures::run_reproduction(&args),
        Command::Gfmd(args) => gfmd::run(&args),
        Command::Challenge(args) => challenge::run(&args),
        Command::Accuracy(args) => accuracy::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Mpi(args) => mpi::run(&args),
        Command::Stress(args) => stress::run(&args),
        Command::Swap(args) => swap::run(&args),
        Command::Dist(args) => dist::run(&args),
        Command::Python(args) => python::run(&args),
        Command::Wheel(args) => wheel::run(&args),
        Command::Docs(args) => docs::run(&args),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_repository_is_tidy() {
        let complaints = tidy::complaints(&Cli::command()).expect("the sources can be read");
        assert!(complaints.is_empty(), "{} untidy:\n{}", complaints.len(), complaints.join("\n"));
    }

    #[test]
    fn the_command_line_is_well_formed() {
        Cli::command().debug_assert();
    }
}
