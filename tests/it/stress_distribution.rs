//! The stress distribution of solved contacts against exact distributions.

use std::f64::consts::{PI, TAU};

use rc_core::{DVec2, Field, Grid, HeightField, Kernel, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams, StressDistribution};
use rc_theory::hertz::{PeriodicContact, PeriodicHertz};
use rc_theory::westergaard::Westergaard;

use crate::solved;

/// The distribution of the pressure alone, and that with the solution's contact area.
fn both(solution: &Solution<'_>, edges: &[f64]) -> [StressDistribution; 2] {
    let (pressure, area) = (solution.pressure(), solution.area().fraction);
    [StressDistribution::of(pressure, edges), StressDistribution::with_area(pressure, edges, area)]
}

fn solve(heights: &Field, mean_pressure: f64) -> Solution<'static> {
    solved(heights, &Love, Control::MeanPressure(mean_pressure), 1e-9)
}

/// The contact of a sphere with 51 elements per contact radius.
///
/// The apex is `offset` elements from a corner of elements.
fn sphere(offset: f64) -> (Solution<'static>, PeriodicContact) {
    let exact = PeriodicHertz { radius: 1.0 }.at_contact_radius(0.1).expect("a small contact");
    let n = 512;
    let apex = 0.5 + offset / n as f64;
    let nearest = |x: f64| (x - apex + 0.5).rem_euclid(1.0) - 0.5;
    let heights =
        Field::from_fn(Grid::square(n).expect("a grid"), |DVec2 { x, y }| -0.5 * nearest(x).hypot(nearest(y)).powi(2));
    (solve(&heights, exact.load), exact)
}

/// Hertz's distribution is P(σ) = 2πa²σ/p0² up to p0.
#[test]
fn the_stress_of_a_sphere_starts_linearly() {
    for offset in [0.0, 0.3, 0.5] {
        let (solution, exact) = sphere(offset);
        let edges: Vec<f64> = (0..10).map(|k| 0.1 * f64::from(k) * exact.peak_pressure).collect();
        let area = PI * exact.contact_radius.powi(2);
        let [_, found] = both(&solution, &edges);
        for (bin, density) in found.density.iter().enumerate() {
            let expected = area * (edges[bin] + edges[bin + 1]) / exact.peak_pressure.powi(2);
            let error = (density / expected - 1.0).abs();
            let allowed = if bin < 3 { 0.05 } else { 0.005 };
            assert!(error < allowed, "offset {offset}, bin {bin}: {density} against {expected}, off by {error:.1e}");
        }
        let error = (found.area_fraction / area - 1.0).abs();
        assert!(error < 2e-3, "offset {offset}: area {} against {area}", found.area_fraction);
    }
}

/// In a histogram of elements, the smallest pressures are missing or accumulate in single bins.
#[test]
fn a_histogram_of_elements_does_not() {
    let (solution, exact) = sphere(0.3);
    let width = 0.02 * exact.peak_pressure;
    let area = PI * exact.contact_radius.powi(2);
    let expected = area * 0.02 * 0.02;
    let n = solution.pressure().values().iter().filter(|&&p| p > 0.0 && p < width).count();
    let counted = n as f64 / solution.pressure().grid().len() as f64;
    let found = StressDistribution::of(solution.pressure(), &[0.0, width]).density[0] * width;
    assert!((found / expected - 1.0).abs() < 0.06, "{found:e} against {expected:e}");
    assert!(!(0.5..2.0).contains(&(counted / expected)), "counting gives {counted:e}, {expected:e} is right");
}

/// Westergaard's p² depends only on sin², so the area below a stress is known.
#[test]
fn the_stress_of_a_wave_is_exact_in_every_bin() {
    let wave = Westergaard { amplitude: 1e-3 };
    let mean_pressure = 0.3 * wave.full_contact_pressure();
    let heights = Field::from_fn(Grid::square(512).expect("a grid"), |at| wave.amplitude * (TAU * at.x).cos());
    let solution = solve(&heights, mean_pressure);
    let peak = wave.peak_pressure(mean_pressure);
    let edges: Vec<f64> = (0..10).map(|k| 0.1 * f64::from(k) * peak).collect();
    let found = StressDistribution::of(solution.pressure(), &edges);
    // The pressure falls from the middle of the contact to its edge, so bisection finds the place of a stress.
    let place = |stress: f64| {
        let (mut inside, mut outside) = (0.0, 0.5);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            let is_inside = wave.pressure(middle, mean_pressure) > stress;
            (inside, outside) = if is_inside { (middle, outside) } else { (inside, middle) };
        }
        2.0 * inside
    };
    for (bin, density) in found.density.iter().enumerate() {
        let expected = (place(edges[bin]) - place(edges[bin + 1])) / (edges[bin + 1] - edges[bin]);
        let error = (density / expected - 1.0).abs();
        assert!(error < 0.05, "bin {bin}: {density} against {expected}, off by {error:.1e}");
    }
}

/// On rough surfaces, by both methods and kernels: light and heavy contacts of 5 to 16 elements for the shortest wave.
#[test]
fn the_area_of_the_stress_is_the_contact_area() {
    for seed in 0..24 {
        let spectrum = SpectrumParams { hurst: [0.3, 0.8][seed % 2], ..SpectrumParams::paper(12, 40 + seed as u64) };
        let surface = Surface::new(&spectrum).expect("a valid spectrum");
        let heights = surface.on(Grid::square([64, 96, 192][seed % 3]).expect("a grid"));
        let load = Control::MeanPressure([1e-4, 1e-3, 5e-3, 2e-2][seed / 3 % 4]);
        let (kernel, method): (&dyn Kernel, _) =
            [(&Love as &dyn Kernel, Method::Adaptive), (&Spectral, Method::Uniform), (&Love, Method::Uniform)]
                [seed / 2 % 3];
        let problem = ContactProblem::new(heights, load).with_kernel(kernel);
        let solution = problem.solve(&SolveParams::to_tolerance(1e-6).by(method), &Silent).expect("solvable");
        let max = 1.2 * solution.pressure().max();
        let edges: Vec<f64> = (0..=200).map(|k| 5e-3 * f64::from(k) * max).collect();
        let [bare, found] = both(&solution, &edges);
        let sum = |of: &StressDistribution, power: i32| {
            let bins = of.density.iter().zip(edges.windows(2));
            bins.map(|(p, edge)| p * (edge[1] - edge[0]) * (0.5 * (edge[0] + edge[1])).powi(power)).sum::<f64>()
        };
        assert!((found.area_fraction - solution.area().fraction).abs() < 1e-15);
        assert!((sum(&found, 0) / found.area_fraction - 1.0).abs() < 1e-12, "{seed}: area {}", sum(&found, 0));
        assert!(found.density.iter().all(|&density| density >= 0.0), "{seed}: {found:?}");
        // The mean stress is not less accurate than that of the pressure alone. Bins add the error of their middles.
        let [before, after] = [&bare, &found].map(|of| (sum(of, 1) / solution.info().mean_pressure - 1.0).abs());
        assert!(after < before + 1e-3, "{seed}: the mean stress is off by {after:e}, and by {before:e} before");
    }
}
