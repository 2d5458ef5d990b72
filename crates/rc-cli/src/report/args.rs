//! Arguments of `rc report`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `rc report`.
#[derive(Args, Clone, Debug)]
#[command(after_help = REPORT_HELP)]
pub(crate) struct ReportArgs {
    /// Folder of a result, a surface, a sweep, a study or shear curves (--out of their commands)
    #[arg(value_name = "DIR")]
    pub(crate) folder: PathBuf,
    /// The page [default: report.html in DIR]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Do not print the name of the page
    #[arg(long)]
    pub(crate) quiet: bool,
}

const REPORT_HELP: &str = "\
The page is one file, usually below 3 MB, which loads nothing: it can be sent by mail and opened anywhere.

For a result it has maps of contact, pressure and gap, sections through both bodies, a view that turns, the surface with its \
spectrum and areal parameters, the stress distribution with a fit of Eq. 7, contact spots, certificate, parameters, and the command that repeats it. For a sweep it has area-load and load-penetration curves \
and the rows. For a mean (rc sweep --error-of-mean) it has the means with error bars, and variance and cost of each level. \
For a study it has the range of each result, and the contacts with the least and the greatest area. For shear curves it has \
shear, loop, slip area and losses. \
Fields of more than 512 x 512 elements are averaged to at most 512 x 512 pixels.";
