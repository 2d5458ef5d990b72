//! A contact whose numbers depend on all crates that `cargo xtask swap` replaces.
//!
//! This file is compiled into xtask, with the originals, and into the program with the forks.

use std::error::Error;

use rc_core::{Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{Control, Method, SolveParams, solve};

/// Area, rms pressure and penetration of a rough contact, as text.
///
/// # Errors
/// Those of the libraries.
pub(crate) fn numbers() -> Result<String, Box<dyn Error>> {
    let surface = Surface::new(&SpectrumParams::paper(8, 1))?;
    let params = SolveParams::default().by(Method::Adaptive);
    let solution = solve(surface.on(Grid::square(128)?), Control::MeanPressure(8.9e-4), &params)?;
    let (area, rms_pressure) = (solution.area().fraction, solution.observables().rms_pressure);
    Ok(format!("area {area:.9} rms pressure {rms_pressure:.9e} penetration {:.9e}", solution.info().penetration))
}
