//! A load curve: contact area and penetration over three decades of mean pressure.
//!
//! Run with `cargo run -p rc-tests --example load_curve`. Units: cell side λ = 1, E* = 1.
#![expect(clippy::print_stdout, reason = "what an example is for")]

use std::error::Error;

use rc_core::{Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{Control, SolveParams, solve};

/// Mean pressure, contact area A/A0 and penetration.
pub(crate) type Point = [f64; 3];

/// The curve, and the rms slope of its surface.
pub(crate) fn curve() -> Result<(Vec<Point>, f64), Box<dyn Error>> {
    let surface = Surface::new(&SpectrumParams::paper(16, 1))?;
    let mut points = Vec::new();
    for load in (0..7).map(|k| 1e-5 * 10_f64.powf(0.5 * f64::from(k))) {
        let heights = surface.on(Grid::square(512)?);
        let solution = solve(heights, Control::MeanPressure(load), &SolveParams::default())?;
        points.push([load, solution.area().fraction, solution.info().penetration]);
    }
    Ok((points, surface.moments().rms_slope))
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let (points, slope) = curve()?;
    println!("σ0/E*      A/A0      κ = (A/A0) g/(σ0/E*)   Δ/λ");
    for [load, area, penetration] in points {
        println!("{load:.2e}   {area:.5}   {:<20.3}   {penetration:.4e}", area * slope / load);
    }
    Ok(())
}
