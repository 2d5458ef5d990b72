//! Rules for external libraries: compatible licences, and one version of each.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};
use rc_figures::repository::Sources;
use serde::{Deserialize, Serialize};
use spdx::{Expression, LicenseReq};
use toml::{Table, Value};

use super::complaint::Complaint;

/// Licences of dependencies that are allowed, by their SPDX identifiers.
///
/// They demand no more than attribution.
const LICENCES: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Crates that may have several versions, each with the reason.
const SEVERAL_VERSIONS: &[(&str, &str)] = &[
    ("bitflags", "png 0.17, which plotters brings along, is from before its second version"),
    ("hashbrown", "the cache of hdf5-reader has the older one, toml the newer"),
    ("miniz_oxide", "png 0.17 has the older one, flate2 the newer"),
    ("quick-error", "proptest's rusty-fork has the older one, tiff the newer"),
    ("syn", "the macros of divan and zerocopy have the second version, those of serde and clap the third"),
];

/// Name among the sources of the licences from `cargo metadata`.
pub(super) const LICENCES_FILE: &str = "licences of dependencies";

/// The parts of the output of `cargo metadata` that are used.
#[derive(Serialize, Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Serialize, Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
}

/// Name, version and licence of every package of `Cargo.lock`, as JSON.
///
/// # Errors
/// When cargo cannot be started, or fails.
pub(super) fn licences(root: &Path) -> Result<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let words = ["metadata", "--format-version", "1", "--locked"];
    let output =
        Command::new(cargo).args(words).current_dir(root).output().context("could not start `cargo metadata`")?;
    if !output.status.success() {
        bail!("`cargo metadata --locked` failed: {}", String::from_utf8_lossy(&output.stderr).trim());
    }
    let metadata: Metadata = serde_json::from_slice(&output.stdout).context("cargo metadata is not JSON")?;
    Ok(serde_json::to_string(&metadata)?)
}

/// Checks the licences from `cargo metadata` and the versions in `Cargo.lock`.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let text = |name: &str| sources.get(name).map_or("", String::as_str);
    [check_licences(text(LICENCES_FILE)), check_versions(text("Cargo.lock"))].concat()
}

fn check_licences(metadata: &str) -> Vec<Complaint> {
    let Metadata { packages } = match serde_json::from_str(metadata) {
        Ok(metadata) => metadata,
        Err(error) => return vec![format!("cargo metadata cannot be read: {error}")],
    };
    packages.iter().filter_map(check_licence).collect()
}

fn check_licence(Package { name, version, license }: &Package) -> Option<Complaint> {
    let cure = "use another crate, or add the licence to LICENCES in xtask/src/tidy/dependencies.rs if it asks for no more than \
                these";
    let Some(license) = license else {
        return Some(format!("{name} {version} names no licence; {cure}"));
    };
    // Crates from before 2018 may write MIT/Apache-2.0.
    match Expression::parse_mode(license, spdx::ParseMode::LAX) {
        Ok(expression) if expression.evaluate(is_allowed) => None,
        Ok(_) => Some(format!("{name} {version} is under {license}; {cure}")),
        Err(error) => Some(format!("{name} {version}: {license} is not an SPDX expression ({}); {cure}", error.reason)),
    }
}

/// Whether a licence is on the list. An exception only adds permissions to a licence.
fn is_allowed(licence: &LicenseReq) -> bool {
    licence.license.id().is_some_and(|id| LICENCES.contains(&id.name))
}

fn check_versions(lock: &str) -> Vec<Complaint> {
    let lock: Table = match lock.parse() {
        Ok(lock) => lock,
        Err(error) => return vec![format!("Cargo.lock is not TOML: {error}; make it anew")],
    };
    let packages = lock.get("package").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let mut versions: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for package in packages {
        let field = |key: &str| package.get(key).and_then(Value::as_str).unwrap_or_default();
        versions.entry(field("name")).or_default().insert(field("version"));
    }
    versions.retain(|_, versions| versions.len() > 1);
    let allowed = |name: &str| SEVERAL_VERSIONS.iter().any(|(known, _)| *known == name);
    let too_many = versions.iter().filter(|(name, _)| !allowed(name)).map(|(name, versions)| {
        let versions = versions.iter().copied().collect::<Vec<_>>().join(" and ");
        format!(
            "{name} is there in the versions {versions}; `cargo tree -i {name}` says why: bring them together, or give the \
             reason in SEVERAL_VERSIONS in xtask/src/tidy/dependencies.rs"
        )
    });
    let gone = SEVERAL_VERSIONS.iter().filter(|(name, _)| !versions.contains_key(name)).map(|(name, _)| {
        format!("{name} is there in one version now; take it off SEVERAL_VERSIONS in xtask/src/tidy/dependencies.rs")
    });
    too_many.chain(gone).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn metadata(license: &str) -> String {
        format!("{{\"packages\": [{{\"name\": \"a\", \"version\": \"1.0.0\", \"license\": {license}}}]}}")
    }

    #[test]
    fn licences_on_the_list_pass_and_others_are_found() {
        for license in
            ["\"MIT OR Apache-2.0\"", "\"MIT/Apache-2.0\"", "\"GPL-3.0 OR MIT\"", "\"Apache-2.0 WITH LLVM-exception\""]
        {
            assert_eq!(check_licences(&metadata(license)), Vec::<String>::new(), "{license}");
        }
        for license in ["\"GPL-3.0\"", "\"MIT AND MPL-2.0\"", "null", "\"who knows\""] {
            assert_eq!(check_licences(&metadata(license)).len(), 1, "{license}");
        }
        assert_eq!(check_licences("").len(), 1, "no metadata is no licence");
    }

    #[test]
    fn a_crate_in_two_versions_is_found() {
        let package = |name: &str, version: &str| format!("[[package]]\nname = \"{name}\"\nversion = \"{version}\"\n");
        let of = |lock: &str| -> Vec<String> {
            check_versions(lock).into_iter().filter(|complaint| !complaint.contains("one version now")).collect()
        };
        assert_eq!(of(&(package("a", "1.0.0") + &package("b", "1.0.0"))), Vec::<String>::new());
        let complaints = of(&(package("a", "1.0.0") + &package("a", "2.0.0")));
        assert!(
            complaints.len() == 1 && complaints[0].contains("a is there in the versions 1.0.0 and 2.0.0"),
            "{complaints:?}"
        );
    }
}
