//! `rc report`: a result or a sweep as one page that a browser opens without a network.
//!
//! The page is a frame ([`document`]), a script, and data: [`contact`] makes those of a solve, [`curves`] those of a sweep.
//! Everything that is text is made here, and shown by the script as text; maps and charts are drawn by the script from
//! numbers.

mod command;
mod contact;
mod curves;
mod document;
mod embedded;
mod spot_sizes;

use std::path::Path;

use serde::Serialize;

use crate::args::ReportArgs;
use crate::error::CliError;
use crate::output;
use rc_sweep::{TABLE_FILE, files};

/// The page's name in a folder.
const PAGE_FILE: &str = "report.html";

/// Runs `rc report`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &ReportArgs) -> Result<(), CliError> {
    let target = args.out.clone().unwrap_or_else(|| args.folder.join(PAGE_FILE));
    if target.is_dir() {
        return Err(CliError::in_file(&target, format_args!("is a folder; give --out FILE, as {PAGE_FILE}")));
    }
    let page =
        if args.folder.join(TABLE_FILE).is_file() { curves::page(&args.folder)? } else { contact::page(&args.folder)? };
    files::check_folder(target.parent().unwrap_or(Path::new("")))?;
    files::write_file(&target, |path| files::write_synced(path, document::html(&page).as_bytes()))?;
    if args.quiet { Ok(()) } else { output::print(&format!("{}\n", target.display())) }
}

/// The data of a page, as its script reads them.
#[derive(Clone, Debug, Serialize)]
struct Page {
    title: String,
    subtitle: String,
    /// In a word; `good` says whether it is the one that is hoped for.
    status: String,
    good: bool,
    /// The numbers that one looks for first.
    tiles: Vec<Tile>,
    /// What repeats the result.
    commands: Vec<Command>,
    /// Texts to unfold.
    files: Vec<Text>,
    /// What made the page.
    made: String,
    #[serde(flatten)]
    body: Body,
}

/// What kind of page it is.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Body {
    Result(Box<contact::Contact>),
    Sweep(curves::Curves),
}

/// A number with its name.
#[derive(Clone, Debug, Serialize)]
struct Tile {
    name: &'static str,
    value: String,
}

/// A command line and what it does.
#[derive(Clone, Debug, Serialize)]
struct Command {
    note: String,
    text: String,
}

/// A text with its title.
#[derive(Clone, Debug, Serialize)]
struct Text {
    title: &'static str,
    text: String,
}

/// Line at the end of a page.
fn made() -> String {
    format!("Made by rc report {}. This file loads nothing from anywhere.", env!("CARGO_PKG_VERSION"))
}
