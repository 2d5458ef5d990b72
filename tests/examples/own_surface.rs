//! A surface of one's own: Weierstrass's function, with ridges along both axes.
//!
//! Each octave has half the wavelength and 2^-H times the height. Run with
//! `cargo run -p rc-tests --example own_surface`. Units: cell side λ = 1, E* = 1.
#![expect(clippy::print_stdout, reason = "what an example is for")]

use std::error::Error;
use std::f64::consts::TAU;

use rc_core::{DVec2, Grid, HeightField};
use rc_solver::{Control, Solution, SolveParams};

/// Weierstrass's heights from a few octaves.
///
/// h(x, y) = a Σ_n 2^(-nH) [cos(2π 2^n x) + cos(2π 2^n y + n)], with n from 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Weierstrass {
    /// Amplitude a, in λ.
    pub(crate) amplitude: f64,
    /// Hurst exponent H, from 0 to 1.
    pub(crate) hurst: f64,
    /// Number of terms of the sum.
    pub(crate) octaves: u32,
}

impl Default for Weierstrass {
    fn default() -> Self {
        Self { amplitude: 1e-3, hurst: 0.8, octaves: 5 }
    }
}

impl HeightField for Weierstrass {
    fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
        let octave = |n: u32| {
            let waves = TAU * f64::from(1_u32 << n);
            2_f64.powf(-f64::from(n) * self.hurst) * ((waves * x).cos() + (waves * y + f64::from(n)).cos())
        };
        self.amplitude * (0..self.octaves).map(octave).sum::<f64>()
    }

    fn band_limit(&self) -> Option<usize> {
        Some(1 << self.octaves.saturating_sub(1))
    }
}

pub(crate) fn solve() -> Result<Solution<'static>, Box<dyn Error>> {
    let surface = Weierstrass::default();
    let heights = surface.on(Grid::square(512)?);
    Ok(rc_solver::solve(heights, Control::MeanPressure(1e-3), &SolveParams::default())?.into_owned())
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let solution = solve()?;
    let found = solution.observables();
    println!("A/A0 = {:.4} ± {:.4}", found.area.fraction, found.area.error);
    println!("stiffness {:.4} E*/λ, mean gap {:.4e} λ", solution.stiffness(), found.mean_gap);
    Ok(())
}
