//! Heavy contact, whose finest grids are solved for their gap.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_core::{DVec2, Field, Grid, Operator as _, Silent};
use rc_kernel::Spectral;
use rc_solver::{
    ContactProblem, Control, Method, MethodReason, Solution, SolveParams, Status, Tolerance, UniformOperator,
};

/// The part of a bar that the gap may be off from rounds to a tight tolerance.
const OF_BAR: f64 = 0.5;

#[test]
fn random_surfaces_agree_with_rounds() {
    for (side, seed, waves, hurst, load) in [
        (512, 1, 16, 0.8, 1.0),
        (512, 4, 16, 0.8, 0.8),
        (512, 2, 32, 0.3, 1.0),
        (1024, 3, 16, 0.8, 1.1),
        (512, 11, 64, 0.5, 0.85),
        (512, 12, 32, 0.8, 0.75),
        (1024, 21, 16, 0.8, 0.6),
        (512, 22, 8, 0.5, 0.65),
    ] {
        let heights = random(Grid::square(side).expect("a grid"), seed, waves, hurst);
        let pressure = load * 1.3 * slope(&heights);
        let scene = format!("{side}, seed {seed}, {waves} waves");
        let gap = solved(&heights, pressure, SolveParams::default());
        let params = SolveParams { tolerance: Tolerance::Energy(1e-4), ..by_rounds() };
        let rounds = solved(&heights, pressure, params);
        assert_eq!(gap.reason(), &MethodReason::HeavyContact, "{scene}");
        assert!(rounds.info().fine_iterations() > 0, "{scene}");
        let (a, b) = (gap.observables(), rounds.observables());
        let check = |what: &str, off: f64, bar: f64| {
            assert!(off.abs() <= OF_BAR * bar, "{scene}: the {what} is off by {off:e}, the bar is {bar:e}");
        };
        check("area", a.area.fraction - b.area.fraction, a.area.error);
        check("mean gap", a.mean_gap - b.mean_gap, a.mean_gap_error);
        let off = a.rms_pressure_corrected - b.rms_pressure_corrected;
        check("rms pressure", off, a.rms_pressure_error.expect("a bar"));
        check("stiffness", gap.stiffness() / rounds.stiffness() - 1.0, 2e-3);
        assert!((gap.pressure().mean() / pressure - 1.0).abs() < 1e-12, "{scene}: the load");
        // Contacts are the same up to the energy error, which bounds that of the pressure. U is ½ ⟨p v⟩.
        let (bound, error) = (gap.certificate().energy, energy_error(&gap, &rounds));
        assert!(error <= bound + 1e-4 && bound < 1e-3, "{scene}: {error:e}, {bound:e}");
    }
}

/// The error of a pressure in the energy norm, in units of √U, from an exact solution.
fn energy_error(solution: &Solution<'_>, exact: &Solution<'_>) -> f64 {
    let grid = solution.pressure().grid();
    let off = solution.pressure().values().iter().zip(exact.pressure().values()).map(|(a, b)| a - b);
    let off = Field::new(grid, off.collect()).expect("a value for each element");
    let operator = UniformOperator::new(grid, &Spectral);
    let (mut displacement, mut scratch) = (Field::zeros(grid), vec![0.0; operator.scratch_len()]);
    operator.apply(off.values(), displacement.values_mut(), &mut scratch);
    let work: f64 = off.values().iter().zip(displacement.values()).map(|(p, v)| p * v).sum();
    (work / grid.len() as f64 / exact.observables().elastic_energy).sqrt()
}

/// Westergaard's wave: σ0 = p* sin²(π f/2) at the contact fraction f.
#[test]
fn waves_have_their_exact_area() {
    let heights = wave(Grid::square(512).expect("a grid"), 3.0, 1.0);
    for (fraction, is_gap) in [(0.75, false), (0.92, true), (0.97, true), (0.99, true)] {
        let pressure = PI * 1e-3 * (FRAC_PI_2 * fraction).sin().powi(2);
        let solution = solved(&heights, pressure, SolveParams::default());
        assert_eq!(solution.reason() == &MethodReason::HeavyContact, is_gap, "{fraction}");
        let area = solution.area();
        assert!((area.fraction - fraction).abs() <= 2.0 * area.error, "{fraction}: {} ± {}", area.fraction, area.error);
    }
}

#[test]
fn full_contact_stays_exact() {
    let heights = wave(Grid::square(512).expect("a grid"), 3.0, 1.0);
    let solution = solved(&heights, 1.01e-3 * PI, SolveParams::default());
    assert_eq!(solution.status(), Status::FullContact);
    assert_eq!(solution.pressure(), solved(&heights, 1.01e-3 * PI, by_rounds()).pressure());
}

/// Half contact is not tried. A narrow pit, which the coarser grids do not see, is tried in vain.
#[test]
fn rejected_scenes_have_the_digits_of_rounds() {
    let grid = Grid::square(512).expect("a grid");
    let pit = Field::from_fn(grid, |DVec2 { x, y }| {
        let far = ((x - 0.5).powi(2) + (y - 0.5).powi(2)) / 0.0025;
        -1e-3 * (-far).exp() + 1e-5 * (20.0 * TAU * x).cos() * (20.0 * TAU * y).cos()
    });
    for (heights, pressure) in [(wave(grid, 3.0, 1.0), 0.5e-3 * PI), (pit, 6e-3)] {
        let found = solved(&heights, pressure, SolveParams::default());
        let rounds = solved(&heights, pressure, by_rounds());
        assert!(rounds.status() == Status::Converged && rounds.area().fraction < 1.0);
        assert_ne!(found.reason(), &MethodReason::HeavyContact);
        assert_eq!(found.pressure(), rounds.pressure());
        assert_eq!(found.gap(), rounds.gap());
        assert_eq!(found.info(), rounds.info());
    }
}

#[test]
fn the_gap_is_bitwise_equal_for_any_number_of_threads() {
    let heights = random(Grid::square(512).expect("a grid"), 1, 16, 0.8);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let solution = solved(&heights, 1.3 * slope(&heights), SolveParams::default());
            assert_eq!(solution.reason(), &MethodReason::HeavyContact);
            (solution.pressure().clone(), solution.gap().clone(), solution.info().clone())
        })
    };
    assert_eq!(run(1), run(2));
}

/// A wave with the pressure π/1000 of full contact.
fn wave(grid: Grid, kx: f64, ky: f64) -> Field {
    let k = kx.hypot(ky);
    Field::from_fn(grid, |DVec2 { x, y }| 1e-3 / k * (TAU * (kx * x + ky * y) + 0.3).cos())
}

fn by_rounds() -> SolveParams {
    SolveParams { method: Some(Method::Uniform), ..SolveParams::default() }
}

fn solved(heights: &Field, pressure: f64, params: SolveParams) -> Solution<'_> {
    let problem = ContactProblem::new(heights, Control::MeanPressure(pressure)).with_kernel(&Spectral);
    problem.solve(&params, &Silent).expect("a solution")
}

/// Rms slope of a periodic map, from differences of neighbours.
fn slope(heights: &Field) -> f64 {
    let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
    let h = heights.values();
    let square = |x: usize, y: usize| {
        let here = h[y * nx + x];
        (h[y * nx + (x + 1) % nx] - here).powi(2) + (h[(y + 1) % ny * nx + x] - here).powi(2)
    };
    let sum: f64 = (0..ny).flat_map(|y| (0..nx).map(move |x| (x, y))).map(|(x, y)| square(x, y)).sum();
    (sum / (nx * ny) as f64).sqrt() * nx as f64
}

/// A random self-affine surface of waves up to `waves` per cell, with an rms slope of 0.01.
fn random(grid: Grid, seed: u64, waves: i32, hurst: f64) -> Field {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut parts = Vec::new();
    while parts.len() < 200 {
        let [kx, ky] = [rng.random_range(0..=waves), rng.random_range(-waves..=waves)].map(f64::from);
        let k = kx.hypot(ky);
        if k >= 1.0 && k <= f64::from(waves) {
            parts.push((kx, ky, k.powf(-1.0 - hurst), rng.random::<f64>()));
        }
    }
    let raw = Field::from_fn(grid, |DVec2 { x, y }| {
        parts.iter().map(|(kx, ky, a, phase)| a * (TAU * (kx * x + ky * y + phase)).cos()).sum()
    });
    let scale = 0.01 / slope(&raw);
    Field::from_fn(grid, |DVec2 { x, y }| {
        let at = |v: f64, n: usize| ((v * n as f64 - 0.5).round() as usize).min(n - 1);
        scale * raw.values()[at(y, grid.ny()) * grid.nx() + at(x, grid.nx())]
    })
}
