//! `cargo xtask docs`: the documentation of the crates, and the guide as a book.

mod links;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use rc_figures::repository;

use crate::process::Step;

/// Builds the documentation of all crates, and the guide as a book in target/book.
///
/// It uses the installed mdbook, or else installs one in target/tools.
#[derive(clap::Args)]
pub(crate) struct Args {}

const CRATES: Step = Step {
    environment: &[("RUSTDOCFLAGS", "-D warnings")],
    words: &["doc", "--release", "--workspace", "--no-deps", "--all-features"],
};

/// Installation of mdbook without the server of `mdbook serve`, but with the search.
const INSTALL: Step = Step {
    environment: &[],
    words: &[
        "install",
        "mdbook",
        "--locked",
        "--version",
        "0.5.4",
        "--no-default-features",
        "--features",
        "search",
        "--root",
    ],
};

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    let folder = repository::target();
    // The crates come first, since they do not need a network.
    make_folders_of_crates(&folder.join("doc")).context("could not make the folders of the documentation")?;
    CRATES.run(&[])?;
    println!("{}", folder.join("doc/rc_core/index.html").display());
    let book = folder.join("book");
    let chapters = folder.join("guide");
    write_chapters(&chapters)?;
    let mut build = Command::new(mdbook()?);
    build.arg("build").arg(&chapters).arg("--dest-dir").arg(&book);
    let status = build.status().context("could not start mdbook")?;
    if !status.success() {
        bail!("`mdbook build {}` failed", chapters.display());
    }
    println!("{}", book.join("index.html").display());
    Ok(())
}

/// Makes a folder in `documentation` for each crate.
///
/// Cargo documents crates in any order, and rustdoc writes links to another crate only if its folder exists.
fn make_folders_of_crates(documentation: &Path) -> std::io::Result<()> {
    for entry in fs::read_dir(repository::root().join("crates"))? {
        let name = entry?.file_name().to_string_lossy().replace('-', "_");
        fs::create_dir_all(documentation.join(name))?;
    }
    Ok(())
}

/// Copies the guide into `folder`, with links to lines of code in its paper map, and ARCHITECTURE.md beside it.
fn write_chapters(folder: &Path) -> Result<()> {
    let guide = repository::root().join("docs");
    copy_folder(&guide, folder)
        .with_context(|| format!("could not copy {} to {}", guide.display(), folder.display()))?;
    let sources = repository::read_sources(&repository::root())?;
    // A chapter includes it from the folder above.
    fs::copy(repository::root().join("ARCHITECTURE.md"), folder.with_file_name("ARCHITECTURE.md"))
        .context("could not copy ARCHITECTURE.md")?;
    let map = sources.get("docs/paper-map.md").context("docs/paper-map.md is missing; restore it from history")?;
    let path = folder.join("paper-map.md");
    fs::write(&path, links::to_lines(map, &sources)).with_context(|| format!("could not write {}", path.display()))
}

/// Copies a folder with all its contents, and replaces files that exist.
fn copy_folder(from: &Path, to: &Path) -> std::io::Result<()> {
    if to.exists() {
        fs::remove_dir_all(to)?;
    }
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let copy = to.join(path.file_name().unwrap_or_default());
        if path.is_dir() {
            copy_folder(&path, &copy)?;
        } else {
            fs::copy(&path, &copy)?;
        }
    }
    Ok(())
}

/// Path of this machine's mdbook, or of one in target/tools.
///
/// The latter is installed at the first use.
fn mdbook() -> Result<PathBuf> {
    let tools = repository::target().join("tools");
    let ours = tools.join("bin").join("mdbook").with_extension(std::env::consts::EXE_EXTENSION);
    let starts = |program: &PathBuf| {
        Command::new(program).arg("--version").stdout(Stdio::null()).status().is_ok_and(|status| status.success())
    };
    if let Some(found) = [PathBuf::from("mdbook"), ours.clone()].into_iter().find(starts) {
        return Ok(found);
    }
    INSTALL.run(&[tools.to_string_lossy().into_owned()]).context(
        "no book: there is no mdbook, and it could not be installed; the chapters are readable as they are, from docs/introduction.md",
    )?;
    Ok(ours)
}
