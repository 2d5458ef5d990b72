//! The wavy surface of Westergaard, whose partial contact has an exact solution.

use std::f64::consts::TAU;

use rc_core::{DVec2, Field, Grid, Kernel};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactArea, Control, Solution};
use rc_theory::westergaard::Westergaard;

use crate::{assert_close, solved};

const AMPLITUDE: f64 = 1e-2;

/// The wave along x or along y on n × n elements.
fn wave(n: usize, along_x: bool) -> Field {
    let grid = Grid::square(n).expect("grid");
    Field::from_fn(grid, |DVec2 { x, y }| AMPLITUDE * (TAU * if along_x { x } else { y }).cos())
}

/// Relative L2 error of the pressure.
fn pressure_error(solution: &Solution<'_>, theory: Westergaard, mean_pressure: f64, along_x: bool) -> f64 {
    let exact = Field::from_fn(solution.pressure().grid(), |at| {
        theory.pressure(if along_x { at.x } else { at.y }, mean_pressure)
    });
    let difference: Vec<f64> = solution.pressure().values().iter().zip(exact.values()).map(|(p, e)| p - e).collect();
    Field::new(exact.grid(), difference).expect("same grid").rms() / exact.rms()
}

/// Contact width with the edges located between centres.
///
/// Counting elements would leave an uncertainty of one element. At an edge p = c √s inside and g = (4c/3) s^{3/2}
/// outside, with the distance s and the same c. The last pressure inside and the first gap outside are one element
/// apart, so they determine c and the edge.
fn contact_width(solution: &Solution<'_>, along_x: bool) -> f64 {
    let n = solution.pressure().grid().nx();
    let line =
        |field: &Field| -> Vec<f64> { (0..n).map(|i| if along_x { field.at(i, 0) } else { field.at(0, i) }).collect() };
    let (pressure, gap) = (line(solution.pressure()), line(solution.gap()));
    // The crest is at the ends of the cell, so contact is in [0, a) and (1 - a, 1).
    let edge = |at: &dyn Fn(usize) -> usize| {
        let first_out = (0..n).find(|&i| pressure[at(i)] <= 0.0).expect("partial contact");
        let (p, g, spacing) = (pressure[at(first_out - 1)], gap[at(first_out)].max(0.0), 1.0 / n as f64);
        let distances = |c: f64| ((p / c).powi(2), (0.75 * g / c).powf(2.0 / 3.0));
        let (mut low, mut high) = (p * spacing.sqrt(), 1e6 * p / spacing.sqrt());
        for _ in 0..200 {
            let middle = (low * high).sqrt();
            let (inside, outside) = distances(middle);
            if inside + outside > spacing { low = middle } else { high = middle }
        }
        (first_out as f64 - 0.5) * spacing + distances(low).0
    };
    edge(&|i| i) + edge(&|i| n - 1 - i)
}

#[test]
fn waves_along_x_and_along_y_match_westergaard() {
    let theory = Westergaard { amplitude: AMPLITUDE };
    for along_x in [true, false] {
        let heights = wave(512, along_x);
        for kernel in [&Love as &dyn Kernel, &Spectral] {
            for fraction in [0.0244717419, 0.0954915028, 0.3454915028, 0.6545084972, 0.9045084972] {
                let mean_pressure = fraction * theory.full_contact_pressure();
                let solution = solved(&heights, kernel, Control::MeanPressure(mean_pressure), 1e-8);
                let error = pressure_error(&solution, theory, mean_pressure, along_x);
                assert!(error <= 0.01, "{} at P = {fraction}: pressure off by {error:e}", kernel.name());
                let width = theory.area_fraction(mean_pressure);
                assert_close("contact width", contact_width(&solution, along_x), width, 5e-3);
                // The crest is between two centres, and Δ is counted from the crest.
                let penetration = solution.info().penetration + AMPLITUDE - heights.max();
                assert_close("penetration", penetration, theory.penetration(mean_pressure), 1e-4);
                assert_close("energy", solution.info().elastic_energy, theory.energy(mean_pressure), 5e-4);
            }
        }
    }
}

#[test]
fn penetration_control_finds_the_mean_pressure() {
    let theory = Westergaard { amplitude: AMPLITUDE };
    let heights = wave(256, true);
    for fraction in [0.05, 0.4, 0.95] {
        let mean_pressure = fraction * theory.full_contact_pressure();
        // The crest is between two centres, so h_max of the grid is slightly lower than the crest.
        let missing = AMPLITUDE - heights.max();
        let penetration = theory.penetration(mean_pressure) - missing;
        let solution = solved(&heights, &Spectral, Control::Penetration(penetration), 1e-9);
        assert_close("mean pressure", solution.info().mean_pressure, mean_pressure, 3e-4);
    }
}

#[test]
fn error_falls_with_the_grid() {
    let theory = Westergaard { amplitude: AMPLITUDE };
    let mean_pressure = 0.3 * theory.full_contact_pressure();
    for kernel in [&Love as &dyn Kernel, &Spectral] {
        let errors = [64, 128, 256, 512].map(|n| {
            let solution = solved(&wave(n, true), kernel, Control::MeanPressure(mean_pressure), 1e-9);
            pressure_error(&solution, theory, mean_pressure, true)
        });
        // The square root at the edge limits the L2 error to first order. Elements eight times smaller must reduce it
        // to a fourth or less.
        assert!(errors[3] < 0.25 * errors[0], "{}: {errors:?}", kernel.name());
        let solution = solved(&wave(512, true), kernel, Control::MeanPressure(mean_pressure), 1e-9);
        let area = ContactArea::of(solution.pressure(), solution.gap(), kernel.edge_bias(solution.grid()));
        assert!((area.cells - theory.area_fraction(mean_pressure)).abs() <= 2.0 / 512.0, "{area:?}");
    }
}
