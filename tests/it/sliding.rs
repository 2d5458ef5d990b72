//! Steady sliding over viscoelastic solids.

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use rc_core::{DVec2, Field, Grid, Kernel, Silent};
use rc_fractal::{Normalisation, SpectrumParams, Surface};
use rc_kernel::{Love, Relaxation, Spectral, Viscoelastic};
use rc_solver::{ContactProblem, Control, Friction, Solution, SolveParams};
use rc_theory::hunter::Hunter;

use crate::assert_close;

fn solved(heights: &Field, kernel: &dyn Kernel, load: f64, tolerance: f64) -> Solution<'static> {
    let problem = ContactProblem::new(heights, Control::MeanPressure(load)).with_kernel(kernel);
    let solution = problem.solve(&SolveParams::to_tolerance(tolerance), &Silent);
    solution.unwrap_or_else(|error| panic!("{load}: {error}")).into_owned()
}

fn friction(solution: &Solution<'_>) -> Friction {
    solution.info().friction.expect("it slides")
}

/// A solid of the retardation length `length` for a surface that slides along +x.
fn one_mode(glassy_ratio: f64, length: f64) -> (Relaxation, DVec2) {
    (Relaxation::single(glassy_ratio, 1.0).expect("a material"), DVec2::X * length / glassy_ratio)
}

/// The surface of `rc surface --waves 16 --rms 1.3e-3 --seed 1` in a cell of side 1.
fn rough(side: usize) -> Field {
    let params = SpectrumParams { normalisation: Normalisation::RmsHeight(1.3e-3), ..SpectrumParams::paper(16, 1) };
    let surface = Surface::new(&params).expect("a spectrum");
    rc_core::HeightField::sample(&surface, Grid::square(side).expect("a grid"))
}

fn report(what: &str, solution: &Solution<'_>, now: std::time::Instant) {
    let info = solution.info();
    let f = friction(solution);
    let n = solution.pressure().values().len() as f64;
    println!(
        "{what}: area {:.5} ± {:.5} counted {:.5} mu {:.6} {:.6} +- {:.1e} bound {:.1e} lateral {:.6} max {:.5} cert {:.1e} gmres {} storage {} levels {:?} {:.2?}",
        solution.area().fraction, solution.area().error,
        solution.pressure().values().iter().filter(|p| **p > 0.0).count() as f64 / n,
        f.coefficient, f.of_displacement, f.error, f.bound, f.lateral, solution.pressure().max(), info.certificate.energy,
        f.gmres_iterations, f.storage_rounds,
        info.levels.iter().map(|l| (l.grid.nx(), l.operator_applications + l.preconditioner_applications)).collect::<Vec<_>>(), now.elapsed()
    );
}

#[test]
fn scratch() {
    let heights = rough(256);
    for l in [0.001, 0.01, 0.03, 0.1, 0.3, 1.0] {
        let (material, v) = one_mode(10.0, l);
        let now = std::time::Instant::now();
        let solution = solved(&heights, &Viscoelastic::new(Spectral, &material, v), 6e-4, 1e-10);
        report(&format!("{l}"), &solution, now);
        let solution = solved(&heights, &Viscoelastic::new(Love, &material, v), 6e-4, 1e-10);
        report(&format!("love {l}"), &solution, now);
    }
    for kappa in [100.0, 1000.0] {
        for l in [0.03, 0.1] {
            let (material, v) = one_mode(kappa, l);
            let now = std::time::Instant::now();
            let solution = solved(&heights, &Viscoelastic::new(Spectral, &material, v), 6e-4, 1e-3);
            report(&format!("kappa {kappa} {l}"), &solution, now);
        }
    }
    let params = SpectrumParams { normalisation: Normalisation::RmsHeight(1.3e-3), ..SpectrumParams::paper(64, 1) };
    let surface = Surface::new(&params).expect("a spectrum");
    let heights = rc_core::HeightField::sample(&surface, Grid::square(1024).expect("a grid"));
    for l in [0.0, 0.001, 0.01, 0.03, 0.1, 0.3] {
        let (material, v) = one_mode(10.0, l);
        let now = std::time::Instant::now();
        let problem = ContactProblem::new(&heights, Control::MeanPressure(6e-4));
        let params = SolveParams::default().by(rc_solver::Method::Uniform);
        if l == 0.0 {
            for _ in 0..2 {
            let now = std::time::Instant::now();
            let s = problem.clone().with_kernel(&Spectral).solve(&params, &Silent).unwrap();
            println!("elastic {:.2?} {:?} {:?}", now.elapsed(), s.area(), s.info().levels.iter().map(|l| (l.grid.nx(), l.operator_applications + l.preconditioner_applications)).collect::<Vec<_>>());
            }
        } else {
            let kernel = Viscoelastic::new(Spectral, &material, v);
            let s = problem.with_kernel(&kernel).solve(&params, &Silent).unwrap().into_owned();
            report(&format!("1024 {l}"), &s, now);
        }
    }
}

#[test]
fn scratch_hunter() {
    for kappa in [10.0, 100.0] {
        for l in [0.01, 0.1, 0.3, 1.0, 3.0, 10.0] {
            // a cell of 64 half widths, 128 elements for each
            let n = 64 * 200;
            let a = 1.0 / 64.0;
            let heights = Field::from_fn(Grid::new(n, 1).unwrap(), |at| -(at.x - 0.5).powi(2) / 2.0);
            let load = FRAC_PI_4 * a * a;
            let (material, v) = one_mode(kappa, l * a);
            let hunter = Hunter { radius: 1.0, glassy_ratio: kappa, length: l * a }.at_load(load).unwrap();
            for kernel in [&Viscoelastic::new(Spectral, &material, v) as &dyn Kernel, &Viscoelastic::new(Love, &material, v)] {
                let now = std::time::Instant::now();
                let s = solved(&heights, kernel, load, 1e-10);
                let f = friction(&s);
                report(&format!("hunter {kappa} {l}: mu {:.6} ratio {:.5} {:.5} area ratio {:.5}", hunter.friction, f.coefficient / hunter.friction, f.of_displacement / hunter.friction, s.area().fraction / 2.0 / hunter.half_width), &s, now);
            }
        }
    }
}
