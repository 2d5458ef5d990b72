//! A measured height map that is read, made periodic and solved.
//!
//! Run with `cargo run -p rc-tests --example height_map`, with your file for FILE. Files have metres, solvers have λ =
//! 1 and E* = 1.
#![expect(clippy::print_stdout, reason = "what an example is for")]

use std::error::Error;
use std::path::Path;

use rc_core::{Elasticity, PeriodicCell, Units};
use rc_heights::{Crop, Fill, Level, Periodic, Scales, Treatment, apply, read};
use rc_solver::{Control, Solution, SolveParams};

/// A file of any format of `rc_heights::Format`. The heights of this one are in units of its side.
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/reference/heights-256-n32-h0.8-s101.npy");

/// Side of a map whose file does not give it (m).
const SIDE: f64 = 1e-3;
const E_STAR: f64 = 1e9;

pub(crate) fn solve() -> Result<Solution<'static>, Box<dyn Error>> {
    let map = read(Path::new(FILE))?.in_metres(Scales { height_scale: Some(SIDE), ..Scales::default() })?;
    let treatments = [
        Treatment::Crop(Crop::Square),
        Treatment::Fill(Fill::Laplace),
        Treatment::Level(Level::Plane),
        Treatment::Periodic(Periodic::Mirror),
    ];
    let (map, effects) = apply(map, &treatments)?;
    for effect in &effects {
        println!("{:<18} {}, rms height {:.3e} m", effect.treatment, effect.grid, effect.rms_height);
    }
    // The mirrored map is twice as wide as the file's map.
    let side = map.sides.map_or(2.0 * SIDE, |[x, _]| x);
    let units = Units::new(PeriodicCell::new(side)?, Elasticity::from_e_star(E_STAR)?);
    let heights = units.heights(&map.heights)?;
    Ok(rc_solver::solve(&heights, Control::pascals(1e6, units), &SolveParams::default())?.into_owned())
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let solution = solve()?;
    let found = solution.observables();
    println!("contact area {:.2} ± {:.2} %", 100.0 * found.area.fraction, 100.0 * found.area.error);
    println!("maximum pressure {:.3e} Pa", found.max_pressure * E_STAR);
    Ok(())
}
