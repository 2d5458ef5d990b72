//! The error bar of the contact area against its change when the grid moves.
//!
//! The grid moves by parts of an element.

use std::f64::consts::TAU;

use rc_core::testing::quasi_random;
use rc_core::{DVec2, Field, Grid, Silent};
use rc_kernel::FreeLove;
use rc_solver::{ContactProblem, Control, Method, SolveParams, solve};

/// Waves up to four per cell with the amplitudes of a self-affine surface, and moved.
///
/// `shift` is in λ.
fn rough(seed: usize, side: usize, shift: DVec2) -> Field {
    let waves: Vec<(f64, f64, f64, f64)> = (-4..=4_i32)
        .flat_map(|ky| (0..=4_i32).map(move |kx| (kx, ky)))
        .filter(|&(kx, ky)| (kx, ky) != (0, 0) && kx * kx + ky * ky <= 16)
        .enumerate()
        .map(|(i, (kx, ky))| {
            let k = f64::from(kx).hypot(f64::from(ky));
            (2e-3 * k.powf(-1.8), f64::from(kx), f64::from(ky), quasi_random(101 * seed + 37 * i * i))
        })
        .collect();
    let height =
        |at: DVec2| waves.iter().map(|(a, kx, ky, phase)| a * (TAU * (kx * at.x + ky * at.y + phase)).cos()).sum();
    Field::from_fn(Grid::square(side).expect("a grid"), |at| height(at + shift))
}

/// A bar that holds in 95 % of scenes is two standard deviations. The rms of the errors is half of it.
#[test]
fn bars_of_the_contact_area_hold_their_errors() {
    let params = SolveParams::default().by(Method::Uniform);
    let load = Control::MeanPressure(3e-3);
    let area = |heights: &Field| solve(heights, load, &params).expect("solvable").area();
    let (side, n_shifts) = (64, 4);
    let mut squares = Vec::new();
    for seed in 0..8 {
        let exact = area(&rough(seed, 8 * side, DVec2::ZERO)).fraction;
        for i in 0..n_shifts {
            let shift = DVec2::new(quasi_random(2 * i), quasi_random(2 * i + 1)) / side as f64;
            let area = area(&rough(seed, side, shift));
            squares.push(((area.fraction - exact) / area.error).powi(2));
        }
    }
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    assert!(rms < 0.75, "the rms error is {rms} of the bar");
}

/// Σ p² misses a part at the edges.
///
/// The corrected rms pressure is closer to that of small elements.
#[test]
fn the_corrected_rms_pressure_is_closer_to_that_of_a_fine_grid() {
    let params = SolveParams::default().by(Method::Uniform);
    let observables =
        |heights: &Field| *solve(heights, Control::MeanPressure(3e-3), &params).expect("solvable").observables();
    let (mut raw, mut corrected) = (0.0, 0.0);
    for seed in 0..6 {
        let exact = observables(&rough(seed, 512, DVec2::ZERO)).rms_pressure_corrected;
        let coarse = observables(&rough(seed, 64, DVec2::ZERO));
        raw += (coarse.rms_pressure / exact - 1.0) / 6.0;
        corrected += (coarse.rms_pressure_corrected / exact - 1.0) / 6.0;
    }
    assert!(corrected.abs() < 0.8 * raw.abs(), "off by {corrected:e} with the correction, {raw:e} without");
}

/// The stiffness of a square punch of side 1 is π times its capacitance, 0.366790 in units of its side. In full contact
/// no gap is beside it.
#[test]
fn the_bar_of_a_punch_holds_its_conductance() {
    let params = SolveParams::default().by(Method::Uniform);
    for n in [16, 64] {
        let flat = Field::zeros(Grid::square(n).expect("a grid"));
        let problem = ContactProblem::new(&flat, Control::MeanPressure(1e-3)).with_kernel(&FreeLove);
        let solution = problem.solve(&params, &Silent).expect("solvable");
        let (found, bar) = (solution.conductance(), solution.conductance_error());
        let off = (found - 0.366_790 * std::f64::consts::PI).abs();
        assert!(off < bar && bar < 2.0 * off, "{n}: {found} ± {bar}, off by {off}");
        assert!(solution.observables().mean_gap_error < 1e-12, "{:?}", solution.observables());
        assert!(solution.penetration_error() > 0.0);
    }
}
