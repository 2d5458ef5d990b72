//! The page as one HTML file: a frame with style, script and data.

use serde::Serialize;

use super::page::Page;

const FRAME: &str = include_str!("../../assets/report/page.html");
const STYLE: &str =
    concat!(include_str!("../../assets/report/page.css"), include_str!("../../assets/report/sweep.css"));

/// The script. Its parts are in the order in which they need each other.
const SCRIPT: &str = concat!(
    include_str!("../../assets/report/dom.js"),
    include_str!("../../assets/report/download.js"),
    include_str!("../../assets/report/chart.js"),
    include_str!("../../assets/report/maps.js"),
    include_str!("../../assets/report/bodies.js"),
    include_str!("../../assets/report/relief.js"),
    include_str!("../../assets/report/result.js"),
    include_str!("../../assets/report/sweep.js"),
    include_str!("../../assets/report/surface.js"),
    include_str!("../../assets/report/mean.js"),
    include_str!("../../assets/report/study.js"),
    include_str!("../../assets/report/shear.js"),
    include_str!("../../assets/report/page.js"),
);

/// The HTML of `page`.
pub(super) fn html<B: Serialize>(page: &Page<B>) -> String {
    let data = serde_json::to_string(page).expect("a record of numbers and text is valid JSON");
    // In JSON, `<` occurs only in text, where it may be escaped. So a text cannot close the element that contains it.
    let data = data.replace('<', "\\u003c");
    fill(FRAME, &[("title", &escaped(&page.title)), ("style", STYLE), ("data", &data), ("script", SCRIPT)])
}

/// `frame` with each `{{name}}` replaced by its text.
///
/// Inserted texts are not searched again.
fn fill(frame: &str, texts: &[(&str, &str)]) -> String {
    let mut parts = frame.split("{{");
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_once("}}").unwrap_or(("", part));
        let text = texts.iter().find(|(known, _)| *known == name).map_or("", |(_, text)| text);
        filled.push_str(text);
        filled.push_str(rest);
    }
    filled
}

/// `text` escaped for the inside of an element.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_is_filled_once() {
        let filled = fill("a {{x}} b {{y}} c", &[("x", "{{y}}"), ("y", "<1>")]);
        assert_eq!(filled, "a {{y}} b <1> c");
        assert_eq!(escaped("a<b>&"), "a&lt;b&gt;&amp;");
        for place in ["{{title}}", "{{style}}", "{{data}}", "{{script}}"] {
            assert_eq!(FRAME.matches(place).count(), 1, "{place}");
        }
        assert!(!SCRIPT.contains("</script") && !STYLE.contains("</style"), "an element would end early");
    }
}
