//! Rules for the tags `Eq. (n)` in code.
//!
//! Each equation of the paper has one tag, at the function that evaluates it and that the paper map names.

use rc_figures::repository::{Sources, has_extension};

use super::complaint::Complaint;

const MAP: &str = "docs/paper-map.md";
const LAST_EQUATION: usize = 14;

/// A tag and the function to which it belongs.
#[derive(Debug, PartialEq, Eq)]
struct Tag<'a> {
    equation: usize,
    path: &'a str,
    /// `None` if the tag is not in the documentation of a function.
    function: Option<&'a str>,
}

/// Checks that each equation has one tag, at the function that the map names.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let code = sources.iter().filter(|(path, _)| path.starts_with("crates/") && has_extension(path, "rs"));
    let tags: Vec<Tag<'_>> = code.flat_map(|(path, text)| tags(path, text)).collect();
    let map = sources.get(MAP).map_or("", String::as_str);
    (1..=LAST_EQUATION).flat_map(|equation| check_equation(equation, &tags, map)).collect()
}

fn check_equation(equation: usize, tags: &[Tag<'_>], map: &str) -> Vec<Complaint> {
    let found: Vec<&Tag<'_>> = tags.iter().filter(|tag| tag.equation == equation).collect();
    let [tag] = found[..] else {
        let places: Vec<&str> = found.iter().map(|tag| tag.path).collect();
        return vec![format!(
            "Eq. ({equation}) is a tag {} times ({}); the function that evaluates it has the only one, text elsewhere says Eq. {equation}",
            found.len(),
            places.join(", ")
        )];
    };
    let Some(function) = tag.function else {
        return vec![format!(
            "{}: Eq. ({equation}) is not in the documentation of a function; move the tag there, or write Eq. {equation}",
            tag.path
        )];
    };
    let row = map.lines().find(|line| line.starts_with(&format!("| Eq. ({equation}) |")));
    let named = format!("`{}`: `{function}`", tag.path);
    if row.is_some_and(|row| row.contains(&named)) {
        return Vec::new();
    }
    vec![format!("{MAP}: the row of Eq. ({equation}) does not name {named}, which has its tag; add it")]
}

/// All tags in a file.
fn tags<'a>(path: &'a str, text: &'a str) -> Vec<Tag<'a>> {
    let mut found = Vec::new();
    let mut after = text;
    while let Some((before, rest)) = after.split_once("Eq. (") {
        after = rest;
        let Some(equation) = rest.split_once(')').and_then(|(number, _)| number.parse().ok()) else { continue };
        let line = before.rsplit('\n').next().unwrap_or_default().trim_start();
        let function = line.starts_with("///").then(|| documented_function(rest)).flatten();
        found.push(Tag { equation, path, function });
    }
    found
}

/// Name of the function whose documentation continues with `text`.
fn documented_function(text: &str) -> Option<&str> {
    let apart = |line: &&str| line.starts_with("///") || line.starts_with("#[");
    let item = text.lines().skip(1).map(str::trim_start).find(|line| !apart(line))?;
    let (head, rest) = item.split_once("fn ")?;
    let qualifiers = ["pub", "pub(crate)", "pub(super)", "const", "async"];
    let is_function = head.split_whitespace().all(|word| qualifiers.contains(&word));
    is_function.then(|| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATH: &str = "crates/rc-kernel/src/love.rs";

    /// Complaints about equation 5 only.
    fn complaints(code: &str) -> Vec<Complaint> {
        let tags = tags(PATH, code);
        check_equation(5, &tags, &format!("| Eq. (5) | Love | `{PATH}`: `love` | test |\n"))
    }

    #[test]
    fn one_tag_at_the_function_of_the_map_passes() {
        assert_eq!(
            complaints("/// Eq. (5).\n/// More.\n#[must_use]\npub const fn love(x: f64) {}\n"),
            Vec::<String>::new()
        );
    }

    #[test]
    fn missing_repeated_misplaced_and_unnamed_tags_are_found() {
        for (code, what) in [
            ("/// Eq. 5.\nfn love() {}\n", "0 times"),
            ("/// Eq. (5).\nfn love() {}\n/// Eq. (5).\nfn again() {}\n", "2 times"),
            ("//! Eq. (5).\nfn love() {}\n", "not in the documentation of a function"),
            ("/// Eq. (5).\nstruct Love;\n", "not in the documentation of a function"),
            ("/// Eq. (5).\nfn hate() {}\n", "does not name"),
        ] {
            let complaints = complaints(code);
            assert!(complaints.len() == 1 && complaints[0].contains(what), "{code}: {complaints:?}");
        }
    }
}
