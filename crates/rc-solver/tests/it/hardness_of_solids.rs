//! A hardness on layers and on patches with free borders.
//!
//! It is compared with elimination, and where everything is plastic.

use rc_core::{Field, Grid, Kernel, Silent};
use rc_kernel::{FreeLove, Layer, LoveLayer, SpectralLayer};
use rc_solver::{
    ContactProblem, Control, Method, ProblemError, Solution, SolveError, SolveParams, solve_dense,
    solve_dense_with_hardness,
};

use crate::bumps;

const LAYER: Layer = Layer::on_rigid_base(0.2, 0.3);

fn solve<'a>(
    heights: &'a Field,
    kernel: &'a dyn Kernel,
    control: Control,
    hardness: f64,
) -> Result<Solution<'a>, SolveError> {
    let problem = ContactProblem::new(heights, control).with_hardness(hardness).with_kernel(kernel);
    problem.solve(&SolveParams::to_tolerance(1e-10), &Silent)
}

#[test]
fn pressures_are_those_of_elimination() {
    let kernels: [&dyn Kernel; 3] = [&FreeLove, &LoveLayer(LAYER), &SpectralLayer(LAYER)];
    for kernel in kernels {
        for (nx, ny) in [(16, 16), (12, 20)] {
            let heights = bumps(nx, ny);
            let range = heights.max() - heights.min();
            for depth in [0.2, 0.55, 1.5].map(|part| part * range) {
                let elastic = solve_dense(&heights, kernel, depth).expect("in range").expect("an active set");
                for part in [0.9, 0.3, 0.02] {
                    let hardness = part * elastic.max();
                    let what = format!("{}, {nx} x {ny}, depth {depth}, {part} of the peak", kernel.name());
                    let exact = match solve_dense_with_hardness(&heights, kernel, depth, hardness) {
                        Err(ProblemError::FullyPlastic { value, deepest }) => {
                            assert!(value >= deepest && deepest > range, "{what}: {deepest}");
                            continue;
                        }
                        exact => exact.expect(&what).expect(&what),
                    };
                    let is_unique = exact.values().iter().any(|p| *p > 0.0 && *p < hardness);
                    let mut controls = vec![Control::Penetration(depth)];
                    // If all pressures are the hardness, the load is not below it.
                    controls.extend((exact.min() < hardness).then(|| Control::MeanPressure(exact.mean())));
                    for control in controls {
                        let found = solve(&heights, kernel, control, hardness).expect(&what);
                        assert_eq!(found.method(), Method::Uniform, "{what}");
                        assert!(found.pressure().max() <= hardness, "{what}");
                        let differences = found.pressure().values().iter().zip(exact.values());
                        let error = differences.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / hardness;
                        assert!(error < 1e-6, "{what}, {control:?}: off by {error:e} of the hardness");
                        let penetration = found.info().penetration / depth;
                        assert!(!is_unique || (penetration - 1.0).abs() < 1e-7, "{what}, {control:?}: {penetration}");
                        // The mean of the open gap, minus the overlap that flow has removed, is the elastic mean gap.
                        let mean_gap = found.observables().mean_gap;
                        assert!((mean_gap - found.gap().mean()).abs() < 1e-7 * range, "{what}: {mean_gap}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_hardness_that_nothing_reaches_changes_no_bit() {
    let heights = bumps(64, 64);
    let kernels: [&dyn Kernel; 2] = [&FreeLove, &LoveLayer(LAYER)];
    for kernel in kernels {
        let [elastic, hard] = [f64::INFINITY, 1e3]
            .map(|hardness| solve(&heights, kernel, Control::MeanPressure(2e-3), hardness).expect("solvable"));
        assert_eq!(elastic.info(), hard.info(), "{}", kernel.name());
        assert!(elastic.pressure() == hard.pressure() && elastic.gap() == hard.gap(), "{}", kernel.name());
        assert_eq!(elastic.stiffness().to_bits(), hard.stiffness().to_bits(), "{}", kernel.name());
        assert_eq!(elastic.area(), hard.area(), "{}", kernel.name());
    }
}

/// A flat punch: pressures without bound at its border become a plastic rim.
///
/// Far below the surface all of it is plastic.
#[test]
fn the_border_of_a_flat_punch_is_plastic() {
    let heights = Field::zeros(Grid::square(64).expect("a grid"));
    let (load, hardness) = (1e-3, 1.5e-3);
    let by_load = solve(&heights, &FreeLove, Control::MeanPressure(load), hardness).expect("solvable");
    let depth = by_load.info().penetration;
    let by_depth = solve(&heights, &FreeLove, Control::Penetration(depth), hardness).expect("solvable");
    for found in [&by_load, &by_depth] {
        let pressure = found.pressure();
        assert!(pressure.at(0, 32) >= hardness && pressure.at(32, 32) < load, "{:e}", pressure.at(32, 32));
        assert!((pressure.mean() / load - 1.0).abs() < 1e-7, "{:e}", pressure.mean());
        let plastic = found.observables().plastic.expect("hard");
        assert!(plastic.cells > 0.05 && plastic.cells < 0.8 && plastic.mean_gap > 0.0, "{plastic:?}");
    }
    let elastic = solve(&heights, &FreeLove, Control::MeanPressure(load), f64::INFINITY).expect("solvable");
    assert!(elastic.info().penetration < depth, "a punch that yields sinks deeper");
    let deep = solve(&heights, &FreeLove, Control::Penetration(0.1), hardness).expect("solvable");
    assert!(deep.pressure().values().iter().all(|p| *p >= hardness), "all is plastic");
}

#[test]
fn a_layer_that_is_plastic_all_over_is_refused() {
    let heights = bumps(16, 16);
    let kernel = LoveLayer(LAYER);
    let (range, hardness) = (heights.max() - heights.min(), 1e-2);
    let deepest = range + hardness * kernel.uniform_displacement().expect("a layer is compressed");
    let below = solve(&heights, &kernel, Control::Penetration(0.999 * deepest), hardness).expect("solvable");
    assert!(below.observables().plastic.expect("hard").cells > 0.9, "nearly all is plastic");
    match solve(&heights, &kernel, Control::Penetration(1.001 * deepest), hardness) {
        Err(SolveError::Problem(ProblemError::FullyPlastic { deepest: found, .. })) => {
            assert!((found / deepest - 1.0).abs() < 1e-12, "{found}");
        }
        other => panic!("{other:?}"),
    }
}
