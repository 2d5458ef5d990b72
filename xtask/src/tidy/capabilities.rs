//! The guide's table of what goes with what, which the solver's table writes.

use anyhow::Result;
use rc_figures::blocks;
use rc_figures::repository::Sources;
use rc_solver::capabilities_as_markdown;

const DOCUMENT: &str = "docs/mesh-and-tolerance.md";

const CURE: &str = "the table in rc-solver/src/problem/capabilities.rs; run `cargo xtask tidy --write`";

/// Checks that the guide has the table of the solver.
pub(super) fn check(sources: &Sources) -> Vec<String> {
    blocks::complaint(DOCUMENT, sources, render(sources), CURE).into_iter().collect()
}

/// Writes the table into the guide.
pub(super) fn write() -> Result<()> {
    blocks::rewrite([DOCUMENT], |_, sources| render(sources))
}

fn render(sources: &Sources) -> Result<String, String> {
    blocks::fill(DOCUMENT, sources, |name| match name {
        "capabilities" => Ok(capabilities_as_markdown()),
        _ => Err(format!("{DOCUMENT}: no numbers are called `{name}`")),
    })
}
