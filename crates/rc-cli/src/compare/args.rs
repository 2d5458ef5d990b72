//! Arguments of `rc compare`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `rc compare`.
#[derive(Args, Clone, Debug)]
#[command(after_help = COMPARE_HELP)]
pub(crate) struct CompareArgs {
    /// Folder of the first result (--out of rc solve, or rows/... of a sweep with --fields)
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,
    /// Folder of the second result
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,
    /// Folder for compare.json and difference.png
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print the comparison as JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing
    #[arg(long)]
    pub(crate) quiet: bool,
}

const COMPARE_HELP: &str = "\
Differences are those of B minus A. A difference in bars is divided by the root of the sum of the squares of both error bars: \
up to about 1, the mesh may explain it. The picture shows pressure and gap of B minus A, on the coarser of the two grids. It \
needs equal cells, and grids of which one is a multiple of the other.";
