//! `cargo xtask swap`: a crate replaced whole by a fork, for real.
//!
//! A copy of the libraries gets one line of its root manifest changed, as the README tells forks to, and the solver's tests
//! run against the tiny fork of `rc-kernel` in `swap/my_rc_kernel.rs`.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use rc_figures::repository;
use toml::{Table, Value};

use crate::process::Step;

/// Builds the solver with a tiny fork of rc-kernel in place of the original, in a workspace in target/swap, and runs its tests
/// there.
#[derive(clap::Args)]
pub(crate) struct Args {}

const FORK: &str = include_str!("swap/my_rc_kernel.rs");
const SWAPPED: &str = include_str!("swap/swapped.rs");

/// What the solver needs of the workspace.
const CRATES: &[&str] = &["rc-core", "rc-fft", "rc-kernel", "rc-quadtree", "rc-solver"];

/// The fork has another name, and the crate that it forks as `upstream`.
const FORK_MANIFEST: &str = r#"
[package]
name = "my-rc-kernel"
version = "0.1.0"
edition = "2024"

[dependencies]
rc-core.workspace = true
upstream = { path = "../rc-kernel", package = "rc-kernel" }
"#;

const TEST: Step = Step { environment: &[], words: &["test", "-p", "rc-solver"] };

pub(crate) fn run(_args: &Args) -> Result<()> {
    let folder = repository::target().join("swap");
    let copy = folder.join("workspace");
    if copy.exists() {
        fs::remove_dir_all(&copy).with_context(|| format!("could not remove {}", copy.display()))?;
    }
    prepare(&repository::root(), &copy)?;
    // Crates of others are built once for all runs.
    TEST.run_in(&copy, &["--target-dir".to_owned(), folder.join("target").to_string_lossy().into_owned()])
}

/// Makes the workspace with the fork.
fn prepare(root: &Path, copy: &Path) -> Result<()> {
    for name in CRATES {
        copy_folder(&root.join("crates").join(name), &copy.join("crates").join(name))?;
    }
    let fork = copy.join("crates/my-rc-kernel");
    write(&fork.join("Cargo.toml"), FORK_MANIFEST)?;
    write(&fork.join("src/lib.rs"), FORK)?;
    write(&copy.join("crates/rc-solver/tests/swapped.rs"), SWAPPED)?;
    fs::copy(root.join("Cargo.lock"), copy.join("Cargo.lock")).context("could not copy Cargo.lock")?;
    for name in ["README.md", "clippy.toml"] {
        fs::copy(root.join(name), copy.join(name)).with_context(|| format!("could not copy {name}"))?;
    }
    let manifest = fs::read_to_string(root.join("Cargo.toml")).context("could not read Cargo.toml")?;
    write(&copy.join("Cargo.toml"), &swapped_manifest(&manifest)?)
}

/// The root manifest with `rc-kernel` replaced, and without the members that are not copied.
fn swapped_manifest(manifest: &str) -> Result<String> {
    let mut manifest: Table = manifest.parse().context("Cargo.toml is no TOML")?;
    let workspace = manifest.get_mut("workspace").and_then(Value::as_table_mut).context("no [workspace]")?;
    workspace.insert("members".into(), Value::Array(vec!["crates/*".into()]));
    workspace.remove("exclude");
    workspace.remove("default-members");
    let dependencies = workspace.get_mut("dependencies").and_then(Value::as_table_mut).context("no dependencies")?;
    let fork: Table = "path = 'crates/my-rc-kernel'\npackage = 'my-rc-kernel'\nversion = '0.1.0'".parse()?;
    dependencies.insert("rc-kernel".into(), Value::Table(fork));
    Ok(toml::to_string(&manifest)?)
}

fn write(path: &Path, text: &str) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .with_context(|| format!("could not write {}", path.display()))
}

fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("could not make {}", to.display()))?;
    for entry in fs::read_dir(from).with_context(|| format!("could not list {}", from.display()))? {
        let (path, name) = entry.map(|entry| (entry.path(), entry.file_name()))?;
        if path.is_dir() {
            copy_folder(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name)).with_context(|| format!("could not copy {}", path.display()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_with_the_fork_names_it_and_has_its_files() {
        let copy = tempfile::tempdir().expect("a temporary folder");
        prepare(&repository::root(), copy.path()).expect("a workspace");
        let read = |name: &str| fs::read_to_string(copy.path().join(name)).expect("a file");
        let manifest: Table = read("Cargo.toml").parse().expect("TOML");
        let kernel = &manifest["workspace"]["dependencies"]["rc-kernel"];
        assert_eq!(kernel["package"].as_str(), Some("my-rc-kernel"));
        assert_eq!(kernel["path"].as_str(), Some("crates/my-rc-kernel"));
        assert_eq!(read("crates/my-rc-kernel/src/lib.rs"), FORK);
        assert!(
            manifest["profile"]["dev"]["package"].get("rc-solver").is_some(),
            "profiles stay, so builds are shared"
        );
        for name in CRATES {
            assert!(copy.path().join("crates").join(name).join("src/lib.rs").is_file(), "{name}");
        }
    }
}
