//! `cargo xtask tidy`: the rules of this repository that the compiler does not know.
//!
//! Each check is a pure function from file texts to complaints. A complaint says what is wrong, where, and what fixes
//! it.

mod capabilities;
mod crates;
mod guide;
mod modules;
mod named;
mod paper_map;
mod snapshots;

use anyhow::{Result, bail};

use rc_figures::repository::{self, Sources};

/// Checks the rules of this repository that the compiler does not know.
///
/// They are about dependency arrows, circles between modules, rooms of the solver, paper map, snapshots, links, and
/// names in texts. The numbers that programs write into documents are checked too. It is also a test, so `cargo xtask
/// test` runs it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Write the guide's table of what goes with what, from the solver's table
    #[arg(long)]
    write: bool,
}

/// A check, which is a pure function of the sources.
type Check = fn(&Sources) -> Vec<String>;

/// The checks with their names.
const CHECKS: &[(&str, Check)] = &[
    ("arrows", crates::check),
    ("circles", modules::check_circles),
    ("rooms", modules::check_rooms),
    ("paper map", paper_map::check),
    ("guide", guide::check),
    ("snapshots", snapshots::check),
    ("capabilities", capabilities::check),
    ("reproduction", rc_figures::reproduction::check),
    ("references", rc_figures::documents::check),
    ("benchmark", rc_bench::bench::check_documents),
];

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args, xtask: &clap::Command) -> Result<()> {
    if args.write {
        capabilities::write()?;
    }
    let complaints = complaints(xtask)?;
    if !complaints.is_empty() {
        bail!("{} untidy:\n{}", complaints.len(), complaints.join("\n"));
    }
    println!("tidy: {}, names", CHECKS.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", "));
    Ok(())
}

/// All complaints about the repository.
///
/// `xtask` is the command line of `cargo xtask`, whose commands texts may name.
///
/// # Errors
/// When a file cannot be read.
pub(crate) fn complaints(xtask: &clap::Command) -> Result<Vec<String>> {
    let sources = repository::read_sources(&repository::root())?;
    let mut found: Vec<(&str, Vec<String>)> = CHECKS.iter().map(|(name, check)| (*name, check(&sources))).collect();
    found.push(("names", named::check(&sources, xtask)));
    let of = |(name, complaints): (&str, Vec<String>)| -> Vec<String> {
        complaints.into_iter().map(|complaint| format!("{name}: {complaint}")).collect()
    };
    Ok(found.into_iter().flat_map(of).collect())
}
