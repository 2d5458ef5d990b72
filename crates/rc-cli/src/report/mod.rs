//! `rc report`: one page of a result, a surface, a sweep or a mean, for a browser.
//!
//! The page needs no network. It is a frame ([`document`]), a script, and data. [`contact`] makes the data of a solve,
//! [`surface`] those of a surface (of a result: [`result_surface`]), [`curves`] those of a sweep, [`mean`] those of a mean over realisations, [`study`]
//! those of a study, and [`shear`] those of shear curves. All texts are made here, and the script shows them as text. The script draws maps and charts from numbers.

pub(crate) mod args;

mod certificate;
mod command;
mod contact;
mod curves;
mod document;
mod embedded;
mod flow_picture;
mod frames;
mod kappa;
mod mean;
mod page;
mod percolation;
mod result_surface;
mod shear;
mod spot_sizes;
mod study;
mod surface;
mod sweep_command;

use std::path::Path;

pub(crate) use self::command::{flags, quoted};

use self::args::ReportArgs;
use crate::curves::folder::no_table;
use crate::error::CliError;
use crate::files::names::{PAGE_FILE, SUMMARY_FILE};
use crate::files::result::no_folder;
use crate::inspect::{folder_of, is_scene};
use crate::shear::record::ShearRecord;
use crate::study::record::StudyRecord;
use crate::terminal;
use rc_sweep::{TABLE_FILE, files, settings_in};

/// The page of the study in `folder`.
pub(crate) fn of_study(folder: &Path, record: &StudyRecord) -> String {
    document::html(&study::page(folder, record))
}

/// The page of what is in `folder`.
fn html(folder: &Path, quiet: bool) -> Result<String, CliError> {
    if is_scene(folder) && !folder.join(TABLE_FILE).exists() {
        return Ok(document::html(&surface::page(folder, quiet)?));
    }
    if !folder.is_dir() {
        return Err(CliError::in_file(folder, no_folder(folder, "a solve or a sweep")));
    }
    if let Some(record) = StudyRecord::read(folder)? {
        return Ok(of_study(folder, &record));
    }
    if let Some(record) = ShearRecord::read(folder)? {
        return Ok(document::html(&shear::page(&record)));
    }
    let settings = settings_in(folder);
    if !folder.join(TABLE_FILE).is_file() {
        return match settings {
            Some(_) => Err(no_table(folder)),
            None if folder.join(SUMMARY_FILE).exists() => Ok(document::html(&contact::page(folder)?)),
            None => Err(CliError::in_file(
                folder,
                "not a result; give the --out folder of a solve, a sweep or a study, or of rc shear",
            )),
        };
    }
    match settings.as_ref() {
        Some(settings) if !settings["ensemble"].is_null() => Ok(document::html(&mean::page(folder, settings)?)),
        _ => Ok(document::html(&curves::page(folder)?)),
    }
}

/// Runs `rc report`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: &ReportArgs) -> Result<(), CliError> {
    let target = args.out.clone().unwrap_or_else(|| folder_of(&args.folder).join(PAGE_FILE));
    if target.is_dir() {
        return Err(CliError::in_file(&target, format_args!("is a folder; give --out FILE, for example {PAGE_FILE}")));
    }
    let page = html(&args.folder, args.quiet)?;
    files::check_folder(target.parent().unwrap_or(Path::new("")))?;
    files::write_file(&target, |path| files::write_synced(path, page.as_bytes()))?;
    if args.quiet { Ok(()) } else { terminal::print(&format!("{}\n", target.display())) }
}
