//! `rc report`: one page of a result, a sweep or a mean, for a browser.
//!
//! The page needs no network. It is a frame ([`document`]), a script, and data. [`contact`] makes the data of a solve,
//! [`curves`] those of a sweep, and [`mean`] those of a mean over realisations. All texts are made here, and the script
//! shows them as text. The script draws maps and charts from numbers.

pub(crate) mod args;

mod certificate;
mod command;
mod contact;
mod curves;
mod document;
mod embedded;
mod flow_picture;
mod mean;
mod page;
mod percolation;
mod spot_sizes;

use std::path::Path;

use self::args::ReportArgs;
use crate::error::CliError;
use crate::terminal;
use rc_sweep::{TABLE_FILE, files, settings_in};

/// Name of the page in a folder.
const PAGE_FILE: &str = "report.html";

/// The page of what is in `folder`.
fn html(folder: &Path) -> Result<String, CliError> {
    if !folder.join(TABLE_FILE).is_file() {
        return Ok(document::html(&contact::page(folder)?));
    }
    let settings = settings_in(folder);
    match settings.as_ref() {
        Some(settings) if !settings["ensemble"].is_null() => Ok(document::html(&mean::page(folder, settings)?)),
        settings => Ok(document::html(&curves::page(folder, settings)?)),
    }
}

/// Runs `rc report`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &ReportArgs) -> Result<(), CliError> {
    let target = args.out.clone().unwrap_or_else(|| args.folder.join(PAGE_FILE));
    if target.is_dir() {
        return Err(CliError::in_file(&target, format_args!("is a folder; give --out FILE, as {PAGE_FILE}")));
    }
    if !args.folder.is_dir() {
        return Err(CliError::in_file(&args.folder, "no such folder; give the --out folder of a solve or a sweep"));
    }
    let page = html(&args.folder)?;
    files::check_folder(target.parent().unwrap_or(Path::new("")))?;
    files::write_file(&target, |path| files::write_synced(path, page.as_bytes()))?;
    if args.quiet { Ok(()) } else { terminal::print(&format!("{}\n", target.display())) }
}
