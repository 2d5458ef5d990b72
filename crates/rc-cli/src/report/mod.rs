//! `rc report`: a result or a sweep as one page, for a browser without a network.
//!
//! The page is a frame ([`document`]), a script, and data. [`contact`] makes the data of a solve, [`curves`] those of a
//! sweep. All texts are made here, and the script shows them as text. The script draws maps and charts from numbers.

pub(crate) mod args;

mod command;
mod contact;
mod curves;
mod document;
mod embedded;
mod flow_picture;
mod page;
mod percolation;
mod spot_sizes;

use std::path::Path;

use self::args::ReportArgs;
use crate::error::CliError;
use crate::terminal;
use rc_sweep::{TABLE_FILE, files};

/// Name of the page in a folder.
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
    let is_sweep = args.folder.join(TABLE_FILE).is_file();
    let page = if is_sweep {
        document::html(&curves::page(&args.folder)?)
    } else {
        document::html(&contact::page(&args.folder)?)
    };
    files::check_folder(target.parent().unwrap_or(Path::new("")))?;
    files::write_file(&target, |path| files::write_synced(path, page.as_bytes()))?;
    if args.quiet { Ok(()) } else { terminal::print(&format!("{}\n", target.display())) }
}
