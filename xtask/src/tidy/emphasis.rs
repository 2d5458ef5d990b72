//! Stars of E* that Markdown takes for emphasis.

use pulldown_cmark::{Event, Options, Parser, Tag};
use rc_figures::repository::{Sources, has_extension};

use super::complaint::Complaint;
use super::prose;

/// Checks documents and the documentation in Rust.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let of = |(path, text): (&String, &String)| -> Vec<Complaint> {
        if has_extension(path, "md") {
            return check_text(path, 1, text);
        }
        if !has_extension(path, "rs") {
            return Vec::new();
        }
        prose::docs(text).iter().flat_map(|doc| check_text(path, doc.line, &doc.lines.join("\n"))).collect()
    };
    sources.iter().flat_map(of).collect()
}

/// Complaints about `text`, whose first line is line `first` of the file.
fn check_text(path: &str, first: usize, text: &str) -> Vec<Complaint> {
    let emphasis =
        Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter().filter_map(|(event, range)| match event {
            Event::Start(Tag::Emphasis) => Some(range),
            _ => None,
        });
    let stars =
        emphasis.filter_map(|range| [range.start, range.end - 1].into_iter().find(|&star| is_modulus(&text[..star])));
    let complaint = |star: usize| {
        let line = first + text[..star].matches('\n').count();
        format!("{path}:{line}: Markdown takes the star of E* for emphasis; write E\\*, or a space after E*")
    };
    stars.map(complaint).collect()
}

/// Whether the text before a star ends with the letter of the modulus.
fn is_modulus(before: &str) -> bool {
    before.strip_suffix('E').is_some_and(|rest| !rest.ends_with(char::is_alphanumeric))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complaints(path: &str, text: &str) -> Vec<Complaint> {
        check(&Sources::from([(path.to_owned(), text.to_owned())]))
    }

    #[test]
    fn stars_that_begin_or_end_emphasis_are_found_at_their_lines() {
        for (path, text, line) in [
            ("docs/a.md", "# A\n\n*Stress at σ0/E* = 1e-3.* Then more.\n", 3),
            ("docs/a.md", "Text\nin E*λ² and\nin E*λ³.\n", 2),
            ("crates/rc-core/src/grid.rs", "/// Load.\n///\n/// In E*λ². The pressure is in E*.\npub fn f() {}\n", 3),
        ] {
            let complaints = complaints(path, text);
            assert!(complaints.len() == 1 && complaints[0].contains(&format!("{path}:{line}:")), "{complaints:?}");
        }
    }

    #[test]
    fn other_stars_pass() {
        for text in [
            "*Stress at σ0/E\\* = 1e-3.*",
            "In E* λ² and in E* λ³, `E*λ` and `E*λ`.",
            "The *field* at 2 E* is 3 E*. In E*λ only.",
            "*LINE* of a NAME.",
            "| E*² | E*² |\n|---|---|\n| 1 | 2 |\n",
        ] {
            assert_eq!(complaints("docs/a.md", text), Vec::<String>::new(), "{text}");
        }
    }
}
