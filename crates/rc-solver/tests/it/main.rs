//! The methods against slow references and against themselves, in one binary.

mod capabilities;
mod error_bars;
mod fluid;
mod gas;
mod gauss_seidel;
mod gradient;
mod handover;
mod hardness;
mod hardness_of_solids;
mod heavy_contact;
mod history;
mod observers;
mod operators;
mod over_ranks;
mod properties;
mod shear;
mod sliding;
mod split;
mod stops;
mod uniform;

use std::f64::consts::TAU;

use rc_core::{DVec2, Field, Grid};

/// A bumpy surface without symmetry, peak-to-valley of order 0.02.
fn bumps(nx: usize, ny: usize) -> Field {
    Field::from_fn(Grid::new(nx, ny).expect("grid"), |DVec2 { x, y }| {
        let wave = |a: f64, kx: f64, ky: f64, phase: f64| a * (TAU * (kx * x + ky * y + phase)).cos();
        wave(5e-3, 1.0, 0.0, 0.1) + wave(4e-3, 1.0, 2.0, 0.37) + wave(2e-3, 3.0, -2.0, 0.8) + wave(1e-3, -2.0, 5.0, 0.5)
    })
}
