//! `cargo xtask docs`: the documentation of the crates, and the guide as a book.

use std::fs;

use anyhow::{Context, Result};
use rc_figures::repository;

use crate::process::{cargo, path_of, program, run as run_step};

/// Builds the documentation of all crates, and with mdbook the guide as a book in target/book.
#[derive(clap::Args)]
pub(crate) struct Args {}

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    document_crates()?;
    println!("{}", repository::target().join("doc/rc_core/index.html").display());
    if path_of("mdbook").is_none() {
        println!(
            "no book, there is no mdbook here (cargo install mdbook --locked); docs/introduction.md begins the guide"
        );
        return Ok(());
    }
    let book = repository::target().join("book");
    run_step(program("mdbook", &["build", "docs", "--dest-dir"]).arg(&book))?;
    println!("{}", book.join("index.html").display());
    Ok(())
}

/// Builds the documentation of all crates, with warnings denied.
pub(crate) fn document_crates() -> Result<()> {
    // Cargo documents crates in any order, and rustdoc writes links to another crate only if its folder exists.
    for entry in fs::read_dir(repository::root().join("crates"))? {
        let folder = repository::target().join("doc").join(entry?.file_name().to_string_lossy().replace('-', "_"));
        fs::create_dir_all(&folder).with_context(|| format!("could not make {}", folder.display()))?;
    }
    let words = ["doc", "--release", "--workspace", "--no-deps", "--all-features"];
    run_step(cargo(&words).env("RUSTDOCFLAGS", "-D warnings"))
}
