//! Arguments of `rc surface`.

use std::path::PathBuf;

use clap::Args;

use super::treatment::TreatmentKeys;
use crate::scene::keys::{RunKeys, SurfaceKeys};

/// Arguments of `rc surface`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SURFACE_HELP)]
// Only solves have a time limit.
#[command(mut_arg("time_limit", |limit| limit.hide(true)))]
#[command(mut_arg("out", |out| out.value_name("DIR|FILE").help("Folder, or FILE.npy, .csv, .gsf or .nc; without it nothing is written")))]
pub(crate) struct SurfaceArgs {
    /// Scene file; its keys of the contact are ignored
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene_file: Option<PathBuf>,
    /// What is given here overrides the scene file.
    #[command(flatten)]
    pub(crate) surface: SurfaceKeys,
    /// Treatment of a height map.
    #[command(flatten)]
    pub(crate) treatment: TreatmentKeys,
    /// Threads and output.
    #[command(flatten)]
    pub(crate) run: RunKeys,
}

const SURFACE_HELP: &str = "\
--out DIR receives heights.npy (m), scene.toml, surface.png and surface.json. --out FILE.npy, .csv, .gsf or .nc receives the \
heights alone (m); .gsf and .nc carry the size too.

Most measured maps need --crop measured --despike --level plane --fill laplace --periodic mirror, which rc prepare does. What each treatment changes is printed \
and goes into surface.json.";
