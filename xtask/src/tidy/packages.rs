//! Rules for published crates: manifests, and sources that build from a package.

use rc_figures::repository::{Sources, has_extension};
use toml::{Table, Value};

use super::complaint::Complaint;

/// Fields of `[package]` that each crate takes from the workspace. Its description is its own.
const FIELDS: &[&str] = &["version", "edition", "rust-version", "license", "readme", "keywords", "categories"];

/// Macros that read a file from the sources.
const INCLUDES: &[&str] = &[concat!("include_", "str!(\""), concat!("include_", "bytes!(\"")];

/// Checks the manifests in `crates/` and the files that sources include.
///
/// An included file outside its crate would be missing in the package. Crates with `publish = false` are left out.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let files = sources.iter().filter(|(path, _)| path.starts_with("crates/") && is_published(path, sources));
    files
        .flat_map(|(path, text)| match path.rsplit('/').next() {
            Some("Cargo.toml") => check_manifest(path, text),
            Some(name) if has_extension(name, "rs") && path.contains("/src/") => check_includes(path, text),
            _ => Vec::new(),
        })
        .collect()
}

/// Whether the crate of the file at `path` is published.
fn is_published(path: &str, sources: &Sources) -> bool {
    let name = path.split('/').nth(1).unwrap_or_default();
    let manifest = sources.get(&format!("crates/{name}/Cargo.toml")).map_or("", String::as_str);
    !manifest.lines().any(|line| line == "publish = false")
}

fn check_manifest(path: &str, text: &str) -> Vec<Complaint> {
    let manifest: Table = text.parse().unwrap_or_default();
    let package = manifest.get("package").and_then(Value::as_table).cloned().unwrap_or_default();
    let inherited =
        |field: &str| package.get(field).and_then(|value| value.get("workspace")) == Some(&Value::Boolean(true));
    let missing = FIELDS.iter().filter(|field| !inherited(field));
    let mut complaints: Vec<Complaint> = missing
        .map(|field| format!("{path}: no `{field}.workspace = true`, which a published crate needs; add it"))
        .collect();
    if package.get("description").and_then(Value::as_str).is_none_or(str::is_empty) {
        complaints.push(format!("{path}: no description; say in one sentence what the crate is"));
    }
    complaints
}

fn check_includes(path: &str, text: &str) -> Vec<Complaint> {
    // A path with more `..` than the depth of its file leads out of the crate.
    let depth = path.split('/').count() - 3;
    let included = INCLUDES.iter().flat_map(|name| text.split(name).skip(1));
    let outside = included.filter_map(|rest| rest.split('"').next()).filter(|file| file.matches("../").count() > depth);
    outside.map(|file| format!("{path}: includes {file} from outside of its crate; move it into the crate")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_without_a_field_is_found() {
        let fields = FIELDS.join(".workspace = true\n") + ".workspace = true\n";
        let manifest = format!("[package]\nname = \"a\"\ndescription = \"A crate.\"\n{fields}");
        assert_eq!(check_manifest("crates/a/Cargo.toml", &manifest), Vec::<String>::new());
        assert_eq!(check_manifest("crates/a/Cargo.toml", &manifest.replace("readme.workspace = true", "")).len(), 1);
        assert_eq!(check_manifest("crates/a/Cargo.toml", &manifest.replace("A crate.", "")).len(), 1);
    }

    #[test]
    fn a_crate_that_is_not_published_needs_no_fields() {
        let manifest = "[package]\nname = \"a\"\npublish = false\n";
        let of = |manifest: &str| check(&[("crates/a/Cargo.toml".to_owned(), manifest.to_owned())].into());
        assert_eq!(of(manifest), Vec::<String>::new());
        assert!(!of(&manifest.replace("publish = false\n", "")).is_empty());
    }

    #[test]
    fn an_included_file_of_another_folder_is_found() {
        let text = |file: &str| format!("const A: &str = {}{file}\");", INCLUDES[0]);
        for (path, file) in [("crates/a/src/lib.rs", "../b.txt"), ("crates/a/src/c/d.rs", "../../b.txt")] {
            assert_eq!(check_includes(path, &text(file)), Vec::<String>::new());
            assert_eq!(check_includes(path, &text(&format!("../{file}"))).len(), 1, "{path}");
        }
    }
}
