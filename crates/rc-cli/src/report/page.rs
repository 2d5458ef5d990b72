//! The data of a page, as its script reads them.

use serde::Serialize;

/// A page with the data of its kind.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Page<B> {
    pub(super) title: String,
    pub(super) subtitle: String,
    /// In a word; `good` says whether it is the one that is hoped for.
    pub(super) status: String,
    pub(super) good: bool,
    /// The numbers that one looks for first.
    pub(super) tiles: Vec<Tile>,
    /// What repeats the result.
    pub(super) commands: Vec<Command>,
    /// Texts to unfold.
    pub(super) files: Vec<Text>,
    /// What made the page.
    pub(super) made: String,
    /// `result`, `sweep` or `mean`: which of its parts the script draws.
    pub(super) kind: &'static str,
    #[serde(flatten)]
    pub(super) body: B,
}

/// A number with its name.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Tile {
    pub(super) name: &'static str,
    pub(super) value: String,
}

/// What a command line does that has all parameters in it.
pub(super) const WITHOUT_FILES: &str = "Without any file, digit by digit:";

/// A command line and what it does.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Command {
    pub(super) note: String,
    pub(super) text: String,
}

/// A text with its title.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Text {
    pub(super) title: &'static str,
    pub(super) text: String,
}

/// Line at the end of a page.
pub(super) fn made() -> String {
    format!("Made by rc report {}. This file loads nothing from anywhere.", env!("CARGO_PKG_VERSION"))
}
