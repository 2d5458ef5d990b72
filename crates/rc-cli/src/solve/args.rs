//! Arguments of `rc solve`.

use std::path::PathBuf;

use clap::Args;

use crate::help;
use crate::scene::keys::Scene;

/// Arguments of `rc solve`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SOLVE_HELP, after_long_help = SOLVE_MANUAL)]
pub(crate) struct SolveArgs {
    /// Scene file: TOML with the flags below for keys, written with _ for -
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene_file: Option<PathBuf>,
    /// What is given here overrides the scene file.
    #[command(flatten)]
    pub(crate) scene: Scene,
    /// Print expected elements, memory and time; solve nothing
    #[arg(long, help_heading = help::MACHINE)]
    pub(crate) dry_run: bool,
    /// Keep a picture of the contact so far in DIR/watch.png (DIR: --out)
    ///
    /// It is drawn anew once a second at most.
    #[arg(long, help_heading = help::RESULTS)]
    pub(crate) watch: bool,
}

const SOLVE_HELP: &str = "\
Give --pressure, --penetration or --force, exactly one. Numbers may have units, such as 10kPa. Flags override the keys of the scene file.
A height map has no default material: give --e-star, or --young and --poisson. If its file has no size, give --cell too.

DIR receives summary.json, pressure.npy (Pa), gap.npy (m), contact.png and scene.toml.
Longer texts, and rare flags such as --poisson2, --radius, --viscosity, --pressure-drop: rc man --out man";

const SOLVE_MANUAL: &str = "\
Where neither scene file nor flags give a value, that of the paper's surface is taken: cell 0.01 m, E = 0.4 GPa, ν = 0.45, N = 64, H = 0.8, \
rms 13 µm, seed 1, kernel love, energy tolerance 0.01. A height map never takes the cell or the material of the paper's surface: with --heights, give \
--e-star, or --young and --poisson. If the file has no size, give --cell too. Only rc solve without arguments (or with --dry-run alone) has a \
load of its own. Otherwise give --pressure, --penetration or --force, exactly one. Numbers may have units, such as 10kPa, 25um, 200GPa or 10N. A flag also replaces its alternatives: --penetration replaces the pressure of the scene file, and \
--heights its random surface. Relative paths in a scene file start at its folder.

DIR (--out) receives summary.json, pressure.npy (Pa), gap.npy (m), contact.png and scene.toml, from which the result can be \
repeated. The methods adaptive and gauss-seidel have elements of their own: --elements writes them to elements.csv, with \
the columns x, y, size (m) and pressure (Pa). Heights from a file are written as heights.npy. In the summary, iterations and operator_applications are those of the finest level.

--leakage adds to the summary the flow of a thin film through the gap, Q = permeance ΔP/(12 viscosity), along x and along y. \
DIR receives leakage.png, flow_x.npy and flow_y.npy. The two arrays are the components of the flux (m²) of one flow, that along \
the axis flow_direction, for ΔP = 1 across the cell and 12 viscosity = 1.

--watch shows the contact as it emerges, from coarse grids to fine ones. Open DIR/watch.png in a viewer that reloads. The \
picture looks like contact.png and is replaced as a whole. It is removed when the result is there. The result does not depend \
on it.";
