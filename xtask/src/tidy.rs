//! `cargo xtask tidy`: the rules of this repository that the compiler does not know.
//!
//! Each check is a pure function from file texts to complaints. A complaint says what is wrong, where, and what fixes
//! it.

mod arrows;
mod capabilities;
mod circles;
mod complaint;
mod culture;
mod dependencies;
mod emphasis;
mod guide;
mod named;
mod packages;
mod paper_map;
mod prose;
mod rooms;
mod rust;
mod snapshots;
mod tags;

use anyhow::{Result, bail};

use complaint::Complaint;
use rc_figures::repository::{self, Sources};

/// Checks the rules of this repository that the compiler does not know.
///
/// They are about dependency arrows, circles between modules, rooms of the solver, licences and versions of
/// dependencies, paper map, guide, snapshots and house rules. The numbers of docs/reproduction.md, docs/benchmarks.md
/// and README.md are checked too. It is also a test, so `cargo xtask test` runs it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Write the guide's table of what goes with what, from the solver's table
    #[arg(long)]
    write: bool,
}

/// A check, which is a pure function of the sources.
type Check = fn(&Sources) -> Vec<Complaint>;

/// The checks with their names.
const CHECKS: &[(&str, Check)] = &[
    ("arrows", arrows::check),
    ("circles", circles::check),
    ("rooms", rooms::check),
    ("paper map", paper_map::check),
    ("equations", tags::check),
    ("snapshots", snapshots::check),
    ("prose", prose::check),
    ("emphasis", emphasis::check),
    ("culture", culture::check),
    ("dependencies", dependencies::check),
    ("guide", guide::check),
    ("capabilities", capabilities::check),
    ("packages", packages::check),
    ("figures", rc_figures::blocks::check),
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

/// The texts to check: those of the repository, and the licences of its dependencies.
///
/// # Errors
/// When a file cannot be read, or cargo fails.
fn sources() -> Result<Sources> {
    let root = repository::root();
    let mut sources = repository::read_sources(&root)?;
    sources.insert(dependencies::LICENCES_FILE.to_owned(), dependencies::licences(&root)?);
    Ok(sources)
}

/// All complaints about the repository.
///
/// `xtask` is the command line of `cargo xtask`, whose commands texts may name.
///
/// # Errors
/// When a file cannot be read, or cargo fails.
pub(crate) fn complaints(xtask: &clap::Command) -> Result<Vec<Complaint>> {
    let sources = sources()?;
    let named = |name: &str, complaints: Vec<Complaint>| -> Vec<Complaint> {
        complaints.into_iter().map(|complaint| format!("{name}: {complaint}")).collect()
    };
    let mut all: Vec<Complaint> = CHECKS.iter().flat_map(|(name, check)| named(name, check(&sources))).collect();
    all.extend(named("names", named::check(&sources, xtask)));
    Ok(all)
}
