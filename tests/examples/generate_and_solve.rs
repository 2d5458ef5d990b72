//! A random surface pressed against a half-space.
//!
//! Prints the contact area with its error bar, pressures and the certificate. Run with
//! `cargo run -p rc-tests --example generate_and_solve`. Units: cell side λ = 1, E* = 1.
#![expect(clippy::print_stdout, reason = "what an example is for")]

use std::error::Error;

use rc_core::{Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{Control, Solution, SolveParams};

/// The contact of the paper's surface with 32 waves at the paper's load.
///
/// The seed is 1, and the grid has 1024 x 1024 elements.
pub(crate) fn solve() -> Result<Solution<'static>, Box<dyn Error>> {
    let surface = Surface::new(&SpectrumParams::paper(32, 1))?;
    println!("rms height {:.4e} λ, rms slope {:.4}", surface.moments().rms_height, surface.moments().rms_slope);

    let heights = surface.on(Grid::square(1024)?);
    Ok(rc_solver::solve(heights, Control::MeanPressure(8.9e-4), &SolveParams::default())?.into_owned())
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let solution = solve()?;
    let found = solution.observables();
    println!("A/A0 = {:.4} ± {:.4}", found.area.fraction, found.area.error);
    println!("maximum pressure {:.4} E*, mean gap {:.4e} λ", found.max_pressure, found.mean_gap);
    println!("{} elements of {} in contact", solution.n_elements(), solution.grid());
    println!("{:?}", solution.info().certificate);
    Ok(())
}
