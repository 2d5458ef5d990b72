//! Arguments of `rc solve`.

use std::path::PathBuf;

use clap::Args;

use crate::scene::keys::Scene;

/// Arguments of `rc solve`.
#[derive(Args, Clone, Debug)]
#[command(after_help = SOLVE_HELP)]
pub(crate) struct SolveArgs {
    /// Scene file: TOML with the flags below for keys, written with _ for -
    #[arg(value_name = "SCENE.toml")]
    pub(crate) scene_file: Option<PathBuf>,
    /// What is given here overrides the scene file.
    #[command(flatten)]
    pub(crate) scene: Scene,
    /// Print the elements, memory and time to be expected, and solve nothing
    #[arg(long, help_heading = "Run")]
    pub(crate) dry_run: bool,
    /// While solving, keep a picture of the contact so far in DIR/watch.png (DIR: --out), drawn anew once a second at
    /// most
    #[arg(long, help_heading = "Run")]
    pub(crate) watch: bool,
}

const SOLVE_HELP: &str = "\
What neither scene file nor flags give has the value of the embedded example: cell 0.01 m, E = 0.4 GPa, ν = 0.45, N = 64, \
H = 0.8, rms 13 µm, seed 1, kernel love, energy tolerance 0.01. A height map never gets its cell or material: with --heights, give --cell, \
unless the file has a size, and --e-star, or --young and --poisson. The control is never assumed: give --pressure or \
--penetration, exactly one. A flag replaces its alternatives in the scene file: --penetration its pressure, --heights its random surface. \
Relative paths in a scene file start at its folder.

Without --method, the solver is adaptive where the estimated contact area makes that cheaper than the uniform grid, and where \
it can be: kernel love, and square elements. --method adaptive, uniform or gauss-seidel is used as given.

DIR receives summary.json, pressure.npy (Pa), gap.npy (m), contact.png and scene.toml, from which the result can be repeated; \
elements.csv (m, m, m, Pa) from the methods with elements of their own, adaptive and gauss-seidel; and heights.npy, if the \
heights came from a file. In the summary, iterations and operator_applications are those of the finest level.

--leakage adds to the summary the flow of a thin film through the gap, Q = permeance ΔP/(12 viscosity), along x and along y, and to DIR \
leakage.png, and flow_x.npy and flow_y.npy (flux in m² for ΔP = 1 across the cell and 12 viscosity = 1) of the axis flow_direction.

rc solve --waves 256 --pressure 446395 --out result --watch shows the contact as it emerges, from coarse grids to fine ones: open \
result/watch.png in a viewer that reloads. The picture looks as contact.png does, is replaced as a whole, and is removed when the \
result is there, which does not depend on it.";
