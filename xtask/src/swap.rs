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
use toml::{Table, Value};

use crate::process::Step;

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
const CRATES: &[&str] = &["rc-comm", "rc-core", "rc-fft", "rc-solver"];

/// Source of the program that solves with the forks.
const SCENE: &str = include_str!("swap/scene.rs");
const MAIN: &str = r#"//! Prints the numbers of a contact.

mod scene;

fn main() {
    match scene::numbers() {
        Ok(numbers) => println!("{numbers}"),
        Err(error) => {
            eprintln!("{error}");
            std::process::exit(1);
        }
    }
}
"#;

const BUILD: Step = Step { environment: &[], words: &["build", "--release", "--package", "swapped"] };

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(_args: &Args) -> Result<()> {
    let copy = repository::target().join("swap");
    if copy.exists() {
        fs::remove_dir_all(&copy).with_context(|| format!("could not remove {}", copy.display()))?;
    }
    prepare(&repository::root(), &copy)?;
    // This is the folder of the repository's build, so that only the forks and the solver are built.
    BUILD.run_in(&copy, &["--target-dir".to_owned(), repository::target().to_string_lossy().into_owned()])?;
    let program = repository::target().join("release/swapped").with_extension(std::env::consts::EXE_EXTENSION);
    let originals = scene::numbers().map_err(|error| anyhow!("with the originals: {error}"))?;
    let forks = solved(&program, "")?;
    ensure!(forks == originals, "sound forks change the result: {forks} instead of {originals}");
    println!("sound forks: {forks}, as with the originals");
    for Fork { name, .. } in FORKS {
        let wrong = solved(&program, &fork_name(name)).with_context(|| format!("{name} wrong"))?;
        ensure!(wrong != originals, "the solver does not use {name}: a wrong fork of it changes nothing");
        println!("{name} wrong: {wrong}");
    }
    Ok(())
}

/// Output of the program when the fork called `wrong` is wrong.
fn solved(program: &Path, wrong: &str) -> Result<String> {
    let output = Command::new(program).env("RC_SWAP_WRONG", wrong).output();
    let output = output.with_context(|| format!("could not start {}", program.display()))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
    match output.status.code() {
        Some(0) => Ok(text(&output.stdout)),
        // An error of the solver is a result too. Any other exit code means that the program broke.
        Some(1) => Ok(format!("not solved: {}", text(&output.stderr))),
        _ => bail!("{} broke: {}", program.display(), text(&output.stderr)),
    }
}

fn fork_name(name: &str) -> String {
    format!("my-{name}")
}

/// Makes the workspace with the forks in `copy`.
fn prepare(root: &Path, copy: &Path) -> Result<()> {
    let folder = |name: &str| copy.join("crates").join(name);
    for name in CRATES {
        copy_folder(&root.join("crates").join(name), &folder(name))?;
    }
    for fork in FORKS {
        let folder = folder(&fork_name(fork.name));
        copy_folder(&root.join("crates").join(fork.name), &folder)?;
        change(
            &folder.join("Cargo.toml"),
            &format!("name = \"{}\"", fork.name),
            &format!("name = \"my-{}\"", fork.name),
        )?;
        change(&folder.join(fork.file), fork.original, fork.forked)?;
        let library = folder.join("src/lib.rs");
        write(&library, &(read(&library)? + IS_WRONG))?;
    }
    for name in ["Cargo.lock", "README.md", "clippy.toml"] {
        fs::copy(root.join(name), copy.join(name)).with_context(|| format!("could not copy {name}"))?;
    }
    let manifest: Table = read(&root.join("Cargo.toml"))?.parse().context("Cargo.toml is not TOML")?;
    write(&folder("swapped").join("Cargo.toml"), &program_manifest(root)?)?;
    write(&folder("swapped").join("src/main.rs"), MAIN)?;
    write(&folder("swapped").join("src/scene.rs"), SCENE)?;
    write(&copy.join("Cargo.toml"), &workspace_manifest(manifest)?)
}

/// The root manifest with the forks, and without the members that are not copied.
fn workspace_manifest(mut manifest: Table) -> Result<String> {
    let workspace = manifest.get_mut("workspace").and_then(Value::as_table_mut).context("no [workspace]")?;
    workspace.insert("members".into(), Value::Array(vec!["crates/*".into()]));
    workspace.remove("exclude");
    workspace.remove("default-members");
    let dependencies = workspace.get_mut("dependencies").and_then(Value::as_table_mut).context("no dependencies")?;
    for Fork { name, .. } in FORKS {
        let fork = format!("path = 'crates/my-{name}'\npackage = 'my-{name}'\nversion = '0.1.0'");
        dependencies.insert(name.into(), Value::Table(fork.parse()?));
    }
    // The program is compiled quickly, since it runs only briefly.
    let release = manifest.get_mut("profile").and_then(|profile| profile.get_mut("release")?.as_table_mut());
    let release = release.context("no [profile.release]")?;
    let packages = release.entry("package").or_insert_with(|| Value::Table(Table::new()));
    let packages = packages.as_table_mut().context("[profile.release.package] is not a table")?;
    for name in FORKS.map(|fork| fork_name(fork.name)).into_iter().chain(["rc-solver", "swapped"].map(str::to_owned)) {
        packages.insert(name, Value::Table("opt-level = 1".parse()?));
    }
    Ok(toml::to_string(&manifest)?)
}

/// The manifest of the program.
///
/// It names the external libraries of the repository's crates. Their features, and therefore their builds, are then
/// those of the repository.
fn program_manifest(root: &Path) -> Result<String> {
    let mut dependencies = Table::new();
    for name in ["rc-cli", "rc-heights", "rc-plot", "rc-solver", "rc-sweep"] {
        let manifest: Table = read(&root.join("crates").join(name).join("Cargo.toml"))?.parse()?;
        let used = manifest.get("dependencies").and_then(Value::as_table).cloned().unwrap_or_default();
        dependencies
            .extend(used.into_iter().filter(|(name, how)| !name.starts_with("rc-") && how.get("optional").is_none()));
    }
    for (name, features) in [("rc-core", "'serde'"), ("rc-fractal", ""), ("rc-solver", "'serde'")] {
        let how: Table = format!("workspace = true\nfeatures = [{features}]").parse()?;
        dependencies.insert(name.to_owned(), Value::Table(how));
    }
    let head = "[package]\nname = \"swapped\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n";
    let dependencies: Table = [("dependencies".to_owned(), Value::Table(dependencies))].into_iter().collect();
    Ok(head.to_owned() + &toml::to_string(&dependencies)?)
}

fn read(path: &Path) -> Result<String> {
    fs::read_to_string(path).with_context(|| format!("could not read {}", path.display()))
}

/// Replaces the only occurrence of `original` in a file.
fn change(path: &Path, original: &str, changed: &str) -> Result<()> {
    let text = read(path)?;
    let count = text.matches(original).count();
    ensure!(count == 1, "`{original}` occurs {count} times in {}, not once: mend FORKS", path.display());
    write(path, &text.replace(original, changed))
}

fn write(path: &Path, text: &str) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, text))
        .with_context(|| format!("could not write {}", path.display()))
}

/// Copies a folder with the times of its files. From these cargo knows that a crate is unchanged.
fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("could not make {}", to.display()))?;
    for entry in fs::read_dir(from).with_context(|| format!("could not list {}", from.display()))? {
        let (path, copy) = entry.map(|entry| (entry.path(), to.join(entry.file_name())))?;
        if path.is_dir() {
            copy_folder(&path, &copy)?;
        } else {
            let changed = fs::metadata(&path).and_then(|data| data.modified());
            let copied = fs::copy(&path, &copy)
                .and_then(|_| fs::File::options().write(true).open(&copy)?.set_modified(changed?));
            copied.with_context(|| format!("could not copy {}", path.display()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workspace_has_the_forks_in_place_of_the_originals() {
        let copy = tempfile::tempdir().expect("a temporary folder");
        prepare(&repository::root(), copy.path()).expect("a workspace");
        let manifest: Table = read(&copy.path().join("Cargo.toml")).and_then(|text| Ok(text.parse()?)).expect("TOML");
        for Fork { name, .. } in FORKS {
            let fork = &manifest["workspace"]["dependencies"][name];
            assert_eq!(fork["path"].as_str(), Some(format!("crates/my-{name}").as_str()));
            assert!(!copy.path().join("crates").join(name).exists(), "{name} itself is not there");
        }
    }
}
