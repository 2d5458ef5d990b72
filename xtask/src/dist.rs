//! `cargo xtask dist`: the binary for distribution.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use rc_figures::repository;

use crate::process::Step;

/// Builds the stripped binary `rc` and prints its place and size.
///
/// The binary is static if the musl target of this machine is installed.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Another profile of cargo, for instance dev, to try this command quickly
    #[arg(long, default_value = "dist")]
    profile: String,
}

const BUILD: Step = Step { environment: &[], words: &["build", "-p", "rc-cli", "--bin", "rc"] };

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let target = musl_target()?;
    let mut words = vec!["--profile".to_owned(), args.profile.clone()];
    if let Some(target) = &target {
        words.extend(["--target".to_owned(), target.clone()]);
    }
    BUILD.run(&words)?;
    let binary = binary(&repository::target(), target.as_deref(), &args.profile);
    let bytes = binary.metadata().with_context(|| format!("no binary at {}", binary.display()))?.len();
    let version = Command::new(&binary).arg("--version").output().context("the binary does not start")?;
    if !version.status.success() {
        bail!("{} --version failed", binary.display());
    }
    let kind = if target.is_some() { "static" } else { "needs the C library of this machine" };
    println!("{}: {:.1} MB, {kind}", binary.display(), bytes as f64 / 1e6);
    println!("{}", String::from_utf8_lossy(&version.stdout).trim());
    if let (None, Some(name)) = (&target, musl_name()) {
        println!("static after `rustup target add {name}`");
    }
    Ok(())
}

/// Name of this machine's musl target; `None` if the system is not Linux.
fn musl_name() -> Option<String> {
    (std::env::consts::OS == "linux").then(|| format!("{}-unknown-linux-musl", std::env::consts::ARCH))
}

/// The musl target of this machine, if its standard library is installed.
fn musl_target() -> Result<Option<String>> {
    let Some(name) = musl_name() else { return Ok(None) };
    let rustc = Command::new("rustc").args(["--print", "target-libdir", "--target", &name]).output();
    let folder = rustc.context("could not start rustc")?;
    let folder = String::from_utf8_lossy(&folder.stdout).trim().to_owned();
    Ok((!folder.is_empty() && Path::new(&folder).is_dir()).then_some(name))
}

/// Path of the binary that cargo builds.
fn binary(folder: &Path, target: Option<&str>, profile: &str) -> PathBuf {
    let folder = target.map_or_else(|| folder.to_path_buf(), |target| folder.join(target));
    // Cargo's folder of the profile `dev` has another name, for historical reasons.
    let profile = if profile == "dev" { "debug" } else { profile };
    folder.join(profile).join("rc").with_extension(std::env::consts::EXE_EXTENSION)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_binary_is_where_cargo_puts_it() {
        let name = format!("rc{}", std::env::consts::EXE_SUFFIX);
        let path = |target, profile| binary(Path::new("target"), target, profile);
        assert_eq!(path(None, "dev"), Path::new("target/debug").join(&name));
        assert_eq!(path(Some("a-b-c"), "dist"), Path::new("target/a-b-c/dist").join(&name));
    }
}
