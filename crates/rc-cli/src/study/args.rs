//! Arguments of `rc study`.

use std::path::PathBuf;

use clap::{Arg, Args};
use rc_sweep::Loads;

use crate::help::without_shear;
use crate::prepare::args::{Steps, without_generated};
use crate::scene::keys::Scene;
use crate::scene::quantity::pressures;

/// Arguments of `rc study`.
#[derive(Args, Clone, Debug)]
#[command(after_help = STUDY_HELP)]
#[command(mut_args(without_generated))]
#[command(mut_args(without_loads))]
#[command(mut_args(without_shear))]
#[command(mut_arg("out", |out| out.required(true).help("Folder for the rows, the tables and the page")))]
#[command(mut_arg("time_limit", |limit| limit.hide(false)))]
pub(crate) struct StudyArgs {
    /// Height map: a file of an instrument or a program, or a folder of rc surface
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,
    /// Mean pressures (Pa): 1e4,1e5,1e6, or 1e4:1e6:3 (geometric)
    #[arg(long, value_name = "LIST", required_unless_present = "force", value_parser = pressures, allow_hyphen_values = true)]
    pub(crate) pressures: Option<Loads>,
    /// Continue the study in --out, or start it
    #[arg(long)]
    pub(crate) resume: bool,
    /// The treatments of which one at a time is changed.
    #[command(flatten)]
    pub(crate) steps: Steps,
    /// How the file is read, the contact, and the output.
    #[command(flatten)]
    pub(crate) scene: Scene,
}

/// Hides the keys that a study has other flags for, and those of surfaces that are no map.
fn without_loads(arg: Arg) -> Arg {
    const HIDDEN: [&str; 15] = [
        "pressure",
        "penetration",
        "force",
        "history",
        "history_steps",
        "fluid_pressure",
        "area_error",
        "output_grid",
        "border_level",
        "shape",
        "radius",
        "angle",
        "wavelength",
        "wave_amplitude",
        "add",
    ];
    let is_hidden = HIDDEN.contains(&arg.get_id().as_str());
    if is_hidden { arg.hide(true) } else { arg }
}

const STUDY_HELP: &str = "\
The map is prepared as rc prepare does it, and solved at each pressure. Then one step at a time is changed: fill, level, crop, \
border, low-pass, despike, a patch with free borders, and every second point. treatment_low and treatment_high are the least and \
the greatest result of all these rows; of a patch, penetration, stiffness and conductance do not count. Treatments that give the \
same map are solved once.

  rc study scan.x3p --pressures 1MPa,3MPa,10MPa --e-star 1e9 --out study

DIR receives study.csv (a line for each treatment and pressure), study.json (the ranges too), the page report.html, which \
rc report DIR draws again, contact/ (pictures of the contact at the largest pressure), and sweep/, the rows for --resume.";
