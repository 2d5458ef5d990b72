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
        solution.area().fraction,
        solution.area().error,
        solution.pressure().values().iter().filter(|p| **p > 0.0).count() as f64 / n,
        f.coefficient,
        f.of_displacement,
        f.error,
        f.bound,
        f.lateral,
        solution.pressure().max(),
        info.certificate.energy,
        f.gmres_iterations,
        f.storage_rounds,
        info.levels
            .iter()
            .map(|l| (l.grid.nx(), l.operator_applications + l.preconditioner_applications))
            .collect::<Vec<_>>(),
        now.elapsed()
    );
}

#[test]
fn scratch() {
    for kappa in [10.0, 30.0, 100.0, 1000.0] {
        let (mut worst, mut total, mut failed, mut n, mut max_gmres) = (0, 0, 0, 0, 0);
        for seed in 1..=30 {
            let params =
                SpectrumParams { normalisation: Normalisation::RmsHeight(1.3e-3), ..SpectrumParams::paper(16, seed) };
            let heights = rc_core::HeightField::sample(&Surface::new(&params).unwrap(), Grid::square(128).unwrap());
            for l in [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0] {
                for load in [1e-4, 1e-3, 6e-3] {
                    let (material, v) = one_mode(kappa, l);
                    let kernel = Viscoelastic::new(Spectral, &material, v);
                    let s = ContactProblem::new(&heights, Control::MeanPressure(load))
                        .with_kernel(&kernel)
                        .solve(&SolveParams::default(), &Silent);
                    n += 1;
                    match s {
                        Ok(s) => {
                            let ops = s
                                .info()
                                .levels
                                .last()
                                .map(|l| l.operator_applications + l.preconditioner_applications)
                                .unwrap();
                            total += ops;
                            worst = worst.max(ops);
                            max_gmres = max_gmres.max(s.info().friction.unwrap().storage_rounds);
                        }
                        Err(e) => {
                            failed += 1;
                            if failed < 5 {
                                println!("kappa {kappa} seed {seed} l {l} load {load}: {e}");
                            }
                        }
                    }
                }
            }
        }
        println!("kappa {kappa}: {n} solves, {failed} failed, worst {worst} mean {} storage {max_gmres}", total / n);
    }
}
