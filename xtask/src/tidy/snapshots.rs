//! Rules for snapshots: reviewed by a person, small enough for that, and each with its test.

use rc_figures::repository::{Sources, has_extension};

/// The largest snapshot that a person still reviews, in bytes.
const LARGEST: usize = 20 * 1024;

/// Checks that no snapshot waits for review or is too large for it, and that a test names each.
pub(super) fn check(sources: &Sources) -> Vec<String> {
    let code: Vec<&String> =
        sources.iter().filter(|(path, _)| has_extension(path, "rs")).map(|(_, text)| text).collect();
    let complaint = |(path, text): (&String, &String)| {
        let name = path.rsplit('/').next().unwrap_or(path).strip_suffix(".snap");
        let is_named = |name: &str| code.iter().any(|text| text.contains(&format!("\"{name}\"")));
        match name {
            None => path
                .ends_with(".snap.new")
                .then(|| format!("{path}: waits for review; accept it with `cargo insta review`, or delete it")),
            Some(_) if text.len() > LARGEST => Some(format!("{path}: has more than 20 KiB; make it shorter")),
            Some(name) => {
                (!is_named(name)).then(|| format!("{path}: no test names it; delete it, or restore its test"))
            }
        }
    };
    sources.iter().filter_map(complaint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snapshots_that_wait_are_large_or_have_no_test_are_found() {
        let complaints = |(snapshot, n_lines): (&str, usize)| {
            let files = [("a/src/fig4.rs", "snap(\"fig4-summary\", table)"), (snapshot, &*"a,b\n".repeat(n_lines))];
            check(&files.map(|(path, text)| (path.to_owned(), text.to_owned())).into()).len()
        };
        let (named, other, new) = ("a/fig4-summary.snap", "a/fig4-other.snap", "a/fig4-summary.snap.new");
        assert_eq!([(named, 5120), (named, 5121), (other, 1), (new, 1)].map(complaints), [0, 1, 1, 1]);
    }
}
