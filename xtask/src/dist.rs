//! `cargo xtask dist`: the files of a release.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

use anyhow::{Context, Result, ensure};
use rc_figures::repository;

use crate::process::{cargo, program, run as run_step};
use crate::wheel;

/// Makes the files that a person uploads for a release, in target/dist.
///
/// They are the stripped binary `rc`, the wheel and the sources of the Python package, the release notes from
/// CHANGELOG.md, and the check sums of all. The binary is static if the musl target of this machine is installed.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Makes only the binary
    #[arg(long)]
    binary: bool,
    /// Another profile of cargo, for instance release, to try this command quickly
    #[arg(long, default_value = "packaged")]
    profile: String,
}

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let out = repository::target().join("dist");
    let _ = fs::remove_dir_all(&out);
    fs::create_dir_all(&out).with_context(|| format!("could not make {}", out.display()))?;
    let version = build_binary(&args.profile, &out.join("rc"))?;
    if !args.binary {
        let is_built = wheel::build(&out, &[wheel::WHEEL, wheel::SDIST])?;
        ensure!(is_built, "no wheel and no sdist without Python; `cargo xtask dist --binary` makes the binary alone");
        let changes = fs::read_to_string(repository::root().join("CHANGELOG.md")).context("CHANGELOG.md")?;
        let notes = section(&changes, &version).or_else(|| section(&changes, "Unreleased"));
        fs::write(out.join("NOTES.md"), notes.context("CHANGELOG.md has no section of this version")?)?;
    }
    let sums = "sha256sum * > SHA256SUMS && cat SHA256SUMS";
    run_step(program("sh", &["-c", sums]).current_dir(&out))?;
    println!("{}: version {version}", out.display());
    Ok(())
}

/// Builds the binary at `path`, and returns the version that it prints.
#[expect(clippy::print_stdout, reason = "the result of the command")]
fn build_binary(profile: &str, path: &Path) -> Result<String> {
    let target = musl_target()?;
    let mut build = cargo(&["build", "--package", "rc-cli", "--bin", "rc", "--profile", profile]);
    build.args(target.iter().flat_map(|target| ["--target", target]));
    run_step(&mut build)?;
    // The profile dev is the only one whose folder has another name.
    let folder = if profile == "dev" { "debug" } else { profile };
    let built = repository::target().join(target.as_deref().unwrap_or_default()).join(folder).join("rc");
    let bytes = fs::copy(&built, path).with_context(|| format!("no binary at {}", built.display()))?;
    let output = Command::new(path).arg("--version").output().context("the binary does not start")?;
    ensure!(output.status.success(), "{} --version failed", path.display());
    let kind = if target.is_some() { "static" } else { "needs the C library of this machine" };
    println!("{}: {:.1} MB, {kind}", path.display(), bytes as f64 / 1e6);
    if target.is_none() {
        println!("static after `rustup target add {}`", musl_name());
    }
    let text = String::from_utf8_lossy(&output.stdout);
    Ok(text.split_whitespace().last().unwrap_or_default().to_owned())
}

fn musl_name() -> String {
    format!("{}-unknown-linux-musl", env::consts::ARCH)
}

/// The musl target of this machine, if its standard library is installed.
fn musl_target() -> Result<Option<String>> {
    let rustc = program("rustc", &["--print", "target-libdir", "--target", &musl_name()]).output();
    let folder = String::from_utf8_lossy(&rustc.context("could not start rustc")?.stdout).trim().to_owned();
    Ok((!folder.is_empty() && Path::new(&folder).is_dir()).then(musl_name))
}

/// The section of a version in the change log, without its heading.
fn section<'a>(changes: &'a str, version: &str) -> Option<&'a str> {
    let (_, after) = changes.split_once(&format!("\n## [{version}]"))?;
    let text = after.split_once('\n')?.1;
    Some(text.split("\n## [").next().unwrap_or(text).trim())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_notes_are_the_section_of_the_version() {
        let changes = "# Changelog\n\n## [Unreleased]\n\n- New.\n\n## [0.1.0] - 2026-01-01\n\n- First.\n";
        assert_eq!(section(changes, "0.1.0"), Some("- First."));
        assert_eq!(section(changes, "Unreleased"), Some("- New."));
        assert_eq!(section(changes, "0.2.0"), None);
    }
}
