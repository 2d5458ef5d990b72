//! `cargo xtask docs`: the documentation of the crates, the guide as a book, and the paper as PDF.

use std::fs;

use anyhow::{Context, Result};
use rc_figures::repository;

use crate::process::{cargo, path_of, program, run as run_step};

/// Builds the documentation of all crates, the guide as a book in target/book, and the paper as target/paper.pdf.
///
/// The book needs mdbook. The paper needs pandoc and a program that writes PDF.
#[derive(clap::Args)]
pub(crate) struct Args {}

/// What pandoc can write PDF with, best first.
const PDF_WRITERS: [&str; 5] = ["xelatex", "lualatex", "pdflatex", "typst", "weasyprint"];

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    document_crates()?;
    println!("{}", repository::target().join("doc/rc_core/index.html").display());
    if path_of("mdbook").is_some() {
        let book = repository::target().join("book");
        run_step(program("mdbook", &["build", "docs", "--dest-dir"]).arg(&book))?;
        println!("{}", book.join("index.html").display());
    } else {
        println!(
            "no book, there is no mdbook here (cargo install mdbook --locked); docs/getting-started.md begins the guide"
        );
    }
    let writer = PDF_WRITERS.into_iter().find(|writer| path_of(writer).is_some());
    if let (Some(_), Some(writer)) = (path_of("pandoc"), writer) {
        let paper = repository::target().join("paper.pdf");
        let mut pandoc = program("pandoc", &["paper.md", "--citeproc", "--pdf-engine", writer, "--output"]);
        run_step(pandoc.arg(&paper).current_dir(repository::root().join("docs/paper")))?;
        println!("{}", paper.display());
    } else {
        println!("no PDF of the paper, there is no pandoc here or none of {}", PDF_WRITERS.join(", "));
    }
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
