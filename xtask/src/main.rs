//! The task runner: `cargo xtask <command>`, one file per command.

mod accuracy;
mod bench;
mod blocks;
mod ci;
mod dist;
mod docs;
mod figures;
mod kernel_error;
mod numeric;
mod process;
mod repository;
mod reproduction;
#[cfg(test)]
mod snapshot;
mod stress;
mod swap;
mod test;
mod tidy;

use clap::{Parser, Subcommand};

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
    /// Draws Fig. 8: the stress distribution, the fit of Eq. (7), and the approach to zero
    Fig8(figures::Args),
    /// Draws every figure of the paper; compares with the archived run, or archives the run
    Figures(figures::all::Args),
    Reproduction(reproduction::Args),
    /// Tabulates and draws the truncation error of the image sums against shells and time, beside the exact coefficients
    KernelError(figures::Args),
    /// Measures the error of area, rms pressure and mean gap on usual meshes, and how often their error bars hold it
    Accuracy(figures::Args),
    Bench(bench::Args),
    Stress(stress::Args),
    Swap(swap::Args),
    Dist(dist::Args),
    Docs(docs::Args),
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::Test(args) => test::run(&args),
        Command::Tidy(args) => tidy::run(&args),
        Command::Ci(args) => ci::run(&args),
        Command::Fig1(args) => figures::run::<figures::fig1::Fig1>(&args),
        Command::Fig2(args) => figures::run::<figures::fig2::Fig2>(&args),
        Command::Fig3(args) => figures::run::<figures::fig3::Fig3>(&args),
        Command::Fig4(args) => figures::run::<figures::fig4::Fig4>(&args),
        Command::Fig5(args) => figures::run::<figures::fig5::Fig5>(&args),
        Command::Fig6(args) => figures::run::<figures::fig6::Fig6>(&args),
        Command::Fig7(args) => figures::run::<figures::fig7::Fig7>(&args),
        Command::Fig8(args) => figures::run::<figures::fig8::Fig8>(&args),
        Command::Figures(args) => figures::all::run(&args),
        Command::Reproduction(args) => reproduction::run(&args),
        Command::KernelError(args) => figures::run::<kernel_error::KernelErrors>(&args),
        Command::Accuracy(args) => figures::run::<accuracy::Accuracy>(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Stress(args) => stress::run(&args),
        Command::Swap(args) => swap::run(&args),
        Command::Dist(args) => dist::run(&args),
        Command::Docs(args) => docs::run(&args),
    }
}
