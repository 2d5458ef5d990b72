//! `cargo xtask swap`: builds with whole crates replaced by forks.
//!
//! A copy of the libraries has forks of three crates in place of the originals, as the guide describes. Each fork is
//! its original with one place that can be made wrong on demand. With sound forks a contact must have the numbers of
//! the originals. With each wrong fork it must have other numbers. This shows that the solver really uses each fork.

mod scene;

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, anyhow, bail, ensure};
use rc_figures::repository;

use crate::process::{cargo, run as run_step};

/// Replaces rc-fractal, rc-kernel and rc-quadtree by forks, in a workspace in target/swap.
///
/// It shows for each that the solver uses the fork: wrong forks change the result, sound ones do not.
#[derive(clap::Args)]
pub(crate) struct Args {}

/// A crate with a place that can be made wrong.
struct Fork {
    name: &'static str,
    file: &'static str,
    original: &'static str,
    forked: &'static str,
}

const FORKS: [Fork; 3] = [
    Fork {
        name: "rc-fractal",
        file: "src/surface.rs",
        original: "*amplitude *= factor)",
        forked: "*amplitude *= if crate::is_wrong() { 1.01 } else { 1.0 } * factor)",
    },
    Fork {
        name: "rc-kernel",
        file: "src/split/stencil.rs",
        original: "love_displacement(offset, 0.5) -",
        forked: "(if crate::is_wrong() { 1.01 } else { 1.0 }) * love_displacement(offset, 0.5) -",
    },
    Fork {
        name: "rc-quadtree",
        file: "src/patch.rs",
        original: "tiles.find(column + block_column as i64, row +",
        forked: "tiles.find(column + block_column as i64, row + i64::from(crate::is_wrong()) +",
    },
];

/// Text at the end of each fork's `lib.rs`.
const IS_WRONG: &str = r#"
/// Whether this fork is to be wrong.
pub(crate) fn is_wrong() -> bool {
    static WRONG: std::sync::LazyLock<bool> =
        std::sync::LazyLock::new(|| std::env::var("RC_SWAP_WRONG").is_ok_and(|name| name == env!("CARGO_PKG_NAME")));
    *WRONG
}
"#;

/// Names of the other libraries that the solver needs.
const CRATES: [&str; 4] = ["rc-comm", "rc-core", "rc-fft", "rc-solver"];

/// The program that solves with the forks: its manifest, and its source beside `scene.rs`.
const MANIFEST: &str = r#"[package]
name = "swapped"
edition = "2024"

[dependencies]
rc-core.workspace = true
rc-fractal.workspace = true
rc-solver.workspace = true
"#;
const MAIN: &str = r#"mod scene;

fn main() {
    match scene::numbers() {
        Ok(numbers) => println!("{numbers}"),
        Err(error) => println!("not solved: {error}"),
    }
}
"#;

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    let copy = repository::target().join("swap");
    let _ = fs::remove_dir_all(&copy);
    prepare(&copy)?;
    // This is the folder of the repository's build, so that only the forks and the solver are built.
    let mut build = cargo(&["build", "--release", "--package", "swapped", "--target-dir"]);
    run_step(build.arg(repository::target()).current_dir(&copy))?;
    let originals = scene::numbers().map_err(|error| anyhow!("with the originals: {error}"))?;
    let forks = solved("none")?;
    ensure!(forks == originals, "sound forks change the result: {forks} instead of {originals}");
    println!("sound forks: {forks}, as with the originals");
    for Fork { name, .. } in FORKS {
        let wrong = solved(&format!("my-{name}"))?;
        ensure!(wrong != originals, "the solver does not use {name}: a wrong fork of it changes nothing");
        println!("{name} wrong: {wrong}");
    }
    Ok(())
}

/// Output of the program when the fork called `wrong` is wrong. An error of the solver is a result too.
fn solved(wrong: &str) -> Result<String> {
    let output = Command::new(repository::target().join("release/swapped")).env("RC_SWAP_WRONG", wrong).output()?;
    if !output.status.success() {
        bail!("the program with {wrong} wrong broke: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Makes the workspace with the forks in `copy`.
fn prepare(copy: &Path) -> Result<()> {
    let root = repository::root();
    for name in CRATES {
        copy_folder(&root.join("crates").join(name), &copy.join("crates").join(name))?;
    }
    for name in ["Cargo.lock", "Cargo.toml", "README.md", "clippy.toml"] {
        fs::copy(root.join(name), copy.join(name)).with_context(|| format!("could not copy {name}"))?;
    }
    let manifest = copy.join("Cargo.toml");
    change(&manifest, r#"["crates/*", "xtask", "tests"]"#, r#"["crates/*"]"#)?;
    change(&manifest, r#"default-members = ["crates/rc-cli"]"#, "")?;
    // The crates are compiled quickly, since they run only briefly.
    change(&manifest, "[profile.release.package]", "[profile.release.package]\nrc-solver.opt-level = 1")?;
    for fork in FORKS {
        let name = fork.name;
        let folder = copy.join(format!("crates/my-{name}"));
        copy_folder(&root.join("crates").join(name), &folder)?;
        change(&folder.join("Cargo.toml"), &format!("name = \"{name}\""), &format!("name = \"my-{name}\""))?;
        change(&folder.join(fork.file), fork.original, fork.forked)?;
        let library = folder.join("src/lib.rs");
        fs::write(&library, fs::read_to_string(&library)? + IS_WRONG)?;
        let line = format!("{name} = {{ path = \"crates/{name}\",");
        change(&manifest, &line, &format!("{name} = {{ path = \"crates/my-{name}\", package = \"my-{name}\","))?;
        let profile = format!("[profile.release.package]\nmy-{name}.opt-level = 1");
        change(&manifest, "[profile.release.package]", &profile)?;
    }
    let program = copy.join("crates/swapped");
    fs::create_dir_all(program.join("src"))?;
    fs::write(program.join("Cargo.toml"), MANIFEST)?;
    fs::write(program.join("src/main.rs"), MAIN)?;
    fs::write(program.join("src/scene.rs"), include_str!("swap/scene.rs")).context("could not write the program")
}

/// Replaces the only occurrence of `original` in a file.
fn change(path: &Path, original: &str, changed: &str) -> Result<()> {
    let text = fs::read_to_string(path).with_context(|| format!("could not read {}", path.display()))?;
    let count = text.matches(original).count();
    ensure!(count == 1, "`{original}` occurs {count} times in {}, not once: mend the swap", path.display());
    fs::write(path, text.replace(original, changed)).with_context(|| format!("could not write {}", path.display()))
}

fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("could not make {}", to.display()))?;
    for entry in fs::read_dir(from).with_context(|| format!("could not list {}", from.display()))? {
        let (path, copy) = entry.map(|entry| (entry.path(), to.join(entry.file_name())))?;
        if path.is_dir() {
            copy_folder(&path, &copy)?;
        } else {
            fs::copy(&path, &copy).with_context(|| format!("could not copy {}", path.display()))?;
        }
    }
    Ok(())
}
