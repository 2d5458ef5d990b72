//! The data of a page, in the form that its script reads.

use serde::Serialize;

/// A page with the data of its kind.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Page<B> {
    pub(super) title: String,
    pub(super) subtitle: String,
    /// Status in one word. `good` says whether it is the desired one.
    pub(super) status: String,
    pub(super) good: bool,
    /// Doubts about what the page shows.
    pub(super) warnings: Vec<String>,
    /// The most important numbers.
    pub(super) tiles: Vec<Tile>,
    /// Commands that repeat the result.
    pub(super) commands: Vec<Command>,
    /// Texts that a reader can unfold.
    pub(super) files: Vec<Text>,
    /// Program and version that made the page.
    pub(super) made: String,
    /// `result`, `surface`, `sweep`, `mean`, `study` or `shear`, which tells the script which parts to draw.
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
pub(super) const WITHOUT_FILES: &str = "Without any file, to the last digit:";

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

/// The line at the end of a page.
pub(super) fn made() -> String {
    format!("Made by rc report {}. This file loads nothing from anywhere.", env!("CARGO_PKG_VERSION"))
}
