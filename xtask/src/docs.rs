//! `cargo xtask docs`: the guide as a book, and the documentation of the crates.

use std::io::ErrorKind;
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::process::Step;
use crate::repository;

/// Builds the guide into target/book, where mdbook is installed, and the documentation of all crates.
#[derive(clap::Args)]
pub(crate) struct Args {}

const CRATES: Step =
    Step { environment: &[("RUSTDOCFLAGS", "-D warnings")], words: &["doc", "--workspace", "--no-deps"] };

#[expect(clippy::print_stderr, reason = "a task runner says what it does not do")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    let book = Command::new("mdbook").args(["build", "docs"]).current_dir(repository::root()).status();
    match book {
        Ok(status) if status.success() => {}
        Ok(_) => bail!("`mdbook build docs` failed"),
        Err(error) if error.kind() == ErrorKind::NotFound => eprintln!(
            "no mdbook here, so no book: `cargo install mdbook --locked`; the chapters are readable as they are, from docs/introduction.md"
        ),
        Err(error) => return Err(error).context("could not start mdbook"),
    }
    CRATES.run(&[])
}
