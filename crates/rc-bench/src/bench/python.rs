//! The Python environment of the peers.
//!
//! It is made once, from pinned versions, in a folder under `target/`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use rc_figures::repository;

/// Packages that have wheels, or that build without options.
const REQUIREMENTS: &str = include_str!("../../peers/requirements.txt");

/// The package that is built from source, against the packages above.
const ASPHER: &str = "aspher==0.1.3.post1";

/// Build options that make ASPHER fastest. Without the FFTW library it is built with its own transform.
const FASTEST: &str = "-DASPHER_NATIVE=ON -DASPHER_USE_FFTW=ON";

/// The interpreter of an environment that has all peers, which is made now unless it exists.
///
/// # Errors
/// When a step fails. The text says which, and what to do about it.
pub(super) fn interpreter() -> Result<PathBuf> {
    environment(&repository::root().join("target/bench-peers"))
}

fn environment(folder: &Path) -> Result<PathBuf> {
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    // This file is written last, so that an environment is made again when its making was interrupted.
    let (ready, contents) = (folder.join("ready.txt"), format!("{REQUIREMENTS}{ASPHER}\n"));
    if fs::read_to_string(&ready).is_ok_and(|text| text == contents) {
        return Ok(python);
    }
    announce(folder);
    run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(folder), &[])?;
    fs::write(folder.join("requirements.txt"), REQUIREMENTS)?;
    let pip = |words: &[&str], environment: &[(&str, &str)]| {
        run(
            Command::new(&python).args(["-m", "pip", "install", "--quiet"]).args(words).current_dir(folder),
            environment,
        )
    };
    pip(&["-r", "requirements.txt"], &[])?;
    let build = ["--no-build-isolation", ASPHER];
    pip(&build, &[("CMAKE_ARGS", FASTEST)]).or_else(|_| pip(&build, &[]))?;
    fs::write(&ready, contents).with_context(|| format!("could not write {}", ready.display()))?;
    Ok(python)
}

#[expect(clippy::print_stderr, reason = "it takes minutes")]
fn announce(folder: &Path) {
    eprintln!("peers: making {} from PyPI, once", folder.display());
}

fn run(command: &mut Command, environment: &[(&str, &str)]) -> Result<()> {
    let line = format!("{command:?}");
    let output = command.envs(environment.iter().copied()).output().with_context(|| {
        format!("could not start {line}; peers need python3 with venv, a C++ compiler, Eigen and FFTW")
    })?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let last = text.trim().lines().last().unwrap_or("nothing was said").to_owned();
        bail!("{line} failed: {last}; peers need python3 with venv, a C++ compiler, Eigen and FFTW");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_made_environment_is_used_again_and_every_package_is_pinned() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("ready.txt"), format!("{REQUIREMENTS}{ASPHER}\n")).expect("a written file");
        let python = environment(folder.path()).expect("nothing has to be made");
        assert!(python.starts_with(folder.path()), "{}", python.display());
        let mut lines = REQUIREMENTS.lines().filter(|line| !line.starts_with('#')).chain([ASPHER]);
        assert!(lines.all(|line| line.contains("==")), "{REQUIREMENTS}");
    }

    #[test]
    fn a_failed_step_says_why() {
        let error = run(&mut Command::new("no-such-program-anywhere"), &[]).err();
        assert!(error.is_some_and(|error| error.to_string().contains("peers need python3")));
    }
}
