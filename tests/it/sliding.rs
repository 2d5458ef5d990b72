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
fn scratch_campaign() {
    for kappa in [10.0, 30.0, 100.0] {
        let (mut worst, mut total, mut failed, mut n, mut max_storage) = (0, 0, 0, 0, 0);
        for seed in 31..=60 {
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
                            max_storage = max_storage.max(s.info().friction.unwrap().storage_rounds);
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
        println!("kappa {kappa}: {n} solves, {failed} failed, worst {worst} mean {} storage {max_storage}", total / n);
    }
}

/// Located areas and friction on coarse grids against a fine one.
#[test]
fn scratch_bars() {
    for name in ["spectral", "love"] {
        for side in [64, 128, 256] {
            let mut lines = Vec::new();
            let (mut area_hold, mut mu_hold, mut n) = (0, 0, 0);
            let mut signed = Vec::new();
            for seed in 101..=108 {
                let params = SpectrumParams {
                    normalisation: Normalisation::RmsHeight(1.3e-3),
                    ..SpectrumParams::paper(16, seed)
                };
                let surface = Surface::new(&params).unwrap();
                for l in [0.001, 0.004, 0.016, 0.06, 0.25, 1.0] {
                    for load in [2e-4, 2e-3] {
                        let (material, v) = one_mode(10.0, l);
                        let s = |side: usize, spectral: bool| {
                            let heights = rc_core::HeightField::sample(&surface, Grid::square(side).unwrap());
                            let kernels: [Box<dyn Kernel>; 2] = [
                                Box::new(Viscoelastic::new(Spectral, &material, v)),
                                Box::new(Viscoelastic::new(Love, &material, v)),
                            ];
                            let s = ContactProblem::new(&heights, Control::MeanPressure(load))
                                .with_kernel(&*kernels[usize::from(!spectral)])
                                .solve(&SolveParams::default(), &Silent)
                                .unwrap();
                            (s.area(), s.info().friction.unwrap())
                        };
                        let (fine, fine_mu) = s(1024, true);
                        let (coarse, mu) = s(side, name == "spectral");
                        let (ra, rm) = (
                            (coarse.fraction - fine.fraction) / coarse.error,
                            (mu.coefficient - fine_mu.coefficient) / mu.error,
                        );
                        n += 1;
                        area_hold += usize::from(ra.abs() <= 1.0);
                        mu_hold += usize::from(rm.abs() <= 1.0);
                        signed.push((
                            l,
                            (coarse.fraction / fine.fraction - 1.0),
                            coarse.error / fine.fraction,
                            mu.coefficient / fine_mu.coefficient - 1.0,
                            mu.error / fine_mu.coefficient,
                        ));
                        lines.push((ra, rm));
                    }
                }
            }
            println!("{name} {side}: {n} scenes, area holds {area_hold}, friction holds {mu_hold}");
            for l in [0.001, 0.004, 0.016, 0.06, 0.25, 1.0] {
                let of: Vec<_> = signed.iter().filter(|s| s.0 == l).collect();
                let mean = |f: &dyn Fn(&(f64, f64, f64, f64, f64)) -> f64| {
                    of.iter().map(|s| f(s)).sum::<f64>() / of.len() as f64
                };
                let rms = |f: &dyn Fn(&(f64, f64, f64, f64, f64)) -> f64| {
                    (of.iter().map(|s| f(s).powi(2)).sum::<f64>() / of.len() as f64).sqrt()
                };
                println!(
                    "   l {l}: area mean {:+.4} rms {:.4} bar {:.4}; mu mean {:+.4} rms {:.4} bar {:.4}",
                    mean(&|s| s.1),
                    rms(&|s| s.1),
                    mean(&|s| s.2),
                    mean(&|s| s.3),
                    rms(&|s| s.3),
                    mean(&|s| s.4)
                );
            }
        }
    }
}
