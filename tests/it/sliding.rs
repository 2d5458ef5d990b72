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

#[test]
fn scratch() {
    for (l, _) in [(0.001, 0), (0.01, 0), (0.03, 0), (0.1, 0), (0.3, 0), (1.0, 0)] {
        let (material, v) = one_mode(10.0, l);
        let heights = rough(256);
        let now = std::time::Instant::now();
        let solution = solved(&heights, &Viscoelastic::new(Spectral, &material, v), 6e-4, 1e-3);
        let info = solution.info();
        let f = friction(&solution);
        println!(
            "{l} area {:.5} counted {:.5} mu {:.6} {:.6} +- {:.1e} bound {:.1e} lateral {:.6} max {:.5} gmres {} storage {} levels {:?} {:.2?}",
            solution.area().fraction,
            solution.pressure().values().iter().filter(|p| **p > 0.0).count() as f64 / 65536.0,
            f.coefficient,
            f.of_displacement,
            f.error,
            f.bound,
            f.lateral,
            solution.pressure().max(),
            f.gmres_iterations,
            f.storage_rounds,
            info.levels
                .iter()
                .map(|l| (l.grid.nx(), l.operator_applications + l.preconditioner_applications))
                .collect::<Vec<_>>(),
            now.elapsed()
        );
    }
}
