//! Arguments of `rc shear`.

use std::path::PathBuf;

use clap::Args;

/// Arguments of `rc shear`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SHEAR_HELP)]
pub(crate) struct ShearArgs {
    /// Load curve: folder of rc sweep, or its sweep.csv
    #[arg(value_name = "CURVE")]
    pub(crate) curve: PathBuf,
    /// Coulomb's coefficient of friction
    #[arg(long, value_name = "MU", allow_hyphen_values = true)]
    pub(crate) friction: f64,
    /// Poisson's ratio [default: that of the sweep, or 0]
    #[arg(long, value_name = "NU", allow_hyphen_values = true)]
    pub(crate) poisson: Option<f64>,
    /// A shear curve for each load with three smaller ones, not only for the largest
    #[arg(long)]
    pub(crate) every_load: bool,
    /// Folder for shear.csv and shear.json
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Print only errors, and what --json asks for
    #[arg(long)]
    pub(crate) quiet: bool,
    /// Print the results as JSON, also with --quiet
    #[arg(long)]
    pub(crate) json: bool,
}

const SHEAR_HELP: &str = "\
The bodies are pressed together by the largest load of each surface, and then sheared. A shear curve is a difference of the load \
curve, for any surface (Ciavarella, Jäger): exact for a Poisson's ratio of 0. Otherwise displacements are multiplied by Mindlin's ratio of \
compliances. It needs at least four loads; the curve ends where the load curve does.

  rc sweep --waves 8 --grid 128 --pressures 1e4:1e6:12 --out curve
  rc shear curve --friction 0.4 --out shear
  rc report shear

shear.csv has, for each shear, displacement, slip and stick area, stiffness, and loss of a cycle between plus and minus the shear.";
