//! Full contact of a rough surface, whose exact pressure is p = σ0 + Σ (E*/2)|q| ĥ.

use std::f64::consts::TAU;

use rc_core::{DVec2, Grid};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Spectral;
use rc_solver::{Control, Status};
use rc_theory::full_contact;

use crate::{assert_close, solved};

#[test]
fn full_contact_pressure_is_half_q_times_the_spectrum() {
    let surface = Surface::new(&SpectrumParams::paper(8, 2)).expect("valid spectrum");
    let heights = surface.sample_on(Grid::new(36, 40).expect("grid")).expect("resolved");
    let solution = solved(&heights, &Spectral, Control::MeanPressure(0.1), 1e-6);
    assert_eq!(solution.status(), Status::FullContact);
    let grid = heights.grid();
    for (ix, iy) in [(0, 0), (7, 3), (18, 20), (35, 39), (11, 38)] {
        let DVec2 { x, y } = grid.centre(ix, iy);
        let mut exact = 0.1;
        for ky in -8_i64..=8 {
            for kx in -8_i64..=8 {
                let phase = TAU * (kx as f64 * x + ky as f64 * y);
                let wave = surface.amplitude(kx, ky) * rc_fractal::Complex64::from_polar(1.0, phase);
                exact += 0.5 * TAU * f64::hypot(kx as f64, ky as f64) * wave.re;
            }
        }
        assert_close(&format!("pressure at ({ix}, {iy})"), solution.pressure().at(ix, iy), exact, 1e-12);
    }
    let mean_square = solution.pressure().rms().powi(2) - 0.01;
    let slope = surface.moments().rms_slope;
    assert_close("rms of the fluctuation", mean_square.sqrt(), full_contact::rms_pressure(slope), 1e-12);
}
