//! Words of Rust sources, without a parser.
//!
//! They are enough to see modules, imports and the lengths of functions.

/// A word, a sign or `::`, with its line (from 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    pub(super) line: usize,
}

/// The words and signs of `text`.
///
/// Comments and lifetimes are left out, and literals of text become `""`.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let (mut at, mut line) = (0, 1);
    while at < text.len() {
        let (length, token) = next(&text[at..]);
        tokens.extend(token.map(|text| Token { text, line }));
        line += text[at..at + length].matches('\n').count();
        at += length;
    }
    tokens
}

/// Length of the first piece of `rest`, and its token if the piece is one.
fn next(rest: &str) -> (usize, Option<&str>) {
    let first = rest.chars().next().unwrap_or(' ');
    let word = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
    if rest.starts_with("//") {
        (rest.find('\n').unwrap_or(rest.len()), None)
    } else if rest.starts_with("/*") {
        (rest.find("*/").map_or(rest.len(), |end| end + 2), None)
    } else if let Some(length) = literal(rest, word) {
        (length, Some("\"\""))
    } else if word > 0 {
        (word, Some(&rest[..word]))
    } else if first == '\'' {
        (quoted(rest), None)
    } else {
        let length = if rest.starts_with("::") { 2 } else { first.len_utf8() };
        (length, (!first.is_whitespace()).then_some(&rest[..length]))
    }
}

/// Length of a literal of text that begins after a prefix of `word` bytes.
///
/// `None` if `rest` does not begin with such a literal.
fn literal(rest: &str, word: usize) -> Option<usize> {
    let (prefix, after) = rest.split_at(word);
    let raw = prefix.ends_with('r');
    let n_hashes = after.len() - after.trim_start_matches('#').len();
    if !["", "b", "c", "r", "br", "cr"].contains(&prefix) || !after[n_hashes..].starts_with('"') || n_hashes > 0 && !raw
    {
        return None;
    }
    let start = word + n_hashes + 1;
    if raw {
        let end = format!("\"{}", "#".repeat(n_hashes));
        return Some(rest[start..].find(&end).map_or(rest.len(), |at| start + at + end.len()));
    }
    let mut escaped = false;
    let end = rest[start..].find(|c| {
        let is_end = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        is_end
    });
    Some(end.map_or(rest.len(), |at| start + at + 1))
}

/// Length of a character literal or of a lifetime.
fn quoted(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    let is_escape = chars.next().is_some_and(|(_, c)| c == '\\');
    let second = chars.next();
    if is_escape {
        // The escaped character may be a quote itself.
        return chars.find(|(_, c)| *c == '\'').map_or(rest.len(), |(at, _)| at + 1);
    }
    match second {
        Some((at, '\'')) => at + 1,
        _ => 1 + rest[1..].find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len() - 1),
    }
}

/// `tokens` without the items that are compiled for tests only.
pub(super) fn without_tests<'a>(tokens: &[Token<'a>]) -> Vec<Token<'a>> {
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let attribute = attribute_end(tokens, at);
        let is_test = attribute.is_some_and(|end| {
            let words: Vec<&str> = tokens[at..end].iter().map(|token| token.text).collect();
            words[2] == "cfg" && words.contains(&"test") && !words.contains(&"not")
        });
        if is_test {
            at = item_end(tokens, at);
        } else {
            kept.push(tokens[at]);
            at += 1;
        }
    }
    kept
}

/// End of the attribute `#[…]` that begins at `at`.
fn attribute_end(tokens: &[Token<'_>], at: usize) -> Option<usize> {
    let starts = tokens[at].text == "#" && tokens.get(at + 1).is_some_and(|token| token.text == "[");
    starts.then(|| closing(tokens, at + 1) + 1).filter(|end| *end > at + 3)
}

/// End of the item that begins at `at`, after its `;` or its braces.
pub(super) fn item_end(tokens: &[Token<'_>], at: usize) -> usize {
    let mut at = at;
    while at < tokens.len() {
        match tokens[at].text {
            ";" => return at + 1,
            "{" => return closing(tokens, at) + 1,
            "(" | "[" => at = closing(tokens, at) + 1,
            _ => at += 1,
        }
    }
    at
}

/// Index of the bracket that closes the one at `open`.
pub(super) fn closing(tokens: &[Token<'_>], open: usize) -> usize {
    let mut depth = 0;
    let found = tokens[open..].iter().position(|token| {
        match token.text {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => depth -= 1,
            _ => {}
        }
        depth == 0
    });
    found.map_or(tokens.len() - 1, |length| open + length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<&str> {
        tokens(text).iter().map(|token| token.text).collect()
    }

    #[test]
    fn comments_texts_characters_and_lifetimes_are_no_words() {
        let text = "a::b /* c */ 'd' '\\'' '\\u{e}' \"f \\\" g\" r#\"h \" i\"# // j\n&'k l<'m> b\"n\" '\"' o";
        assert_eq!(words(text), ["a", "::", "b", "\"\"", "\"\"", "&", "l", "<", ">", "\"\"", "o"]);
        assert_eq!(tokens("a\n\"b\n\"\nc").last(), Some(&Token { text: "c", line: 4 }));
    }

    #[test]
    fn items_for_tests_are_left_out() {
        let text = "a; #[cfg(test)] mod b { fn c() {} } #[cfg(all(test, unix))] #[d] use e; #[cfg(not(test))] f;";
        let kept: String = without_tests(&tokens(text)).iter().map(|token| token.text).collect();
        assert_eq!(kept, "a;#[cfg(not(test))]f;");
    }
}
