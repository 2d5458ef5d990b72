//! The error bar of the penetration. It contains the summit between samples.

use std::ops::Range;

use rc_comm::run_threads;
use rc_core::{Grid, HeightField, HeightSource, Kernel, Silent};
use rc_fractal::{Amplitudes, Normalisation, SpectrumParams, Surface};
use rc_kernel::{FreeLove, Love, Spectral};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams};

fn surface(hurst: f64, amplitudes: Amplitudes, seed: usize) -> Surface {
    let spectrum = SpectrumParams { hurst, amplitudes, ..SpectrumParams::paper(8, seed as u64) };
    Surface::new(&spectrum).expect("a valid spectrum")
}

fn square(n: usize) -> Grid {
    Grid::square(n).expect("a grid")
}

fn solve<'a>(heights: impl Into<HeightSource<'a>>, kernel: &'a dyn Kernel, control: Control) -> Solution<'a> {
    let params = SolveParams::to_tolerance(1e-7).by(Method::Uniform);
    ContactProblem::new(heights, control).with_kernel(kernel).solve(&params, &Silent).expect("solvable")
}

/// Penetration from the true summit.
fn from_summit(solution: &Solution<'_>) -> f64 {
    solution.info().penetration + solution.summit_excess()
}

/// How many of three bars hold, and how many would without the summit.
///
/// The grids have 4, 8 and 16 elements for the shortest wave, and the reference has 32.
fn held(surface: &Surface, kernel: &dyn Kernel, load: Control, as_map: bool) -> [usize; 2] {
    let reference = solve(surface.on(square(256)), kernel, load);
    let bars = [32, 64, 128].map(|n| {
        let map = as_map.then(|| surface.sample(square(n)));
        let source = map.as_ref().map_or(surface.on(square(n)), HeightSource::from);
        let found = solve(source, kernel, load);
        let error = (found.info().penetration - from_summit(&reference)).abs();
        let of_gap = found.observables().mean_gap_error;
        assert!(found.penetration_error() >= of_gap && found.mean_pressure_error().is_none());
        [found.penetration_error(), of_gap].map(|bar| usize::from(error <= bar))
    });
    bars.into_iter().fold([0; 2], |sum, held| [sum[0] + held[0], sum[1] + held[1]])
}

/// Bars hold in at least 93 of 100 scenes. Returns the part that would hold without the summit.
fn assert_bars_hold(seeds: Range<usize>, kernels: [&dyn Kernel; 2], as_map: bool) -> f64 {
    let n_scenes = 3 * seeds.len();
    let of_scene = |seed: usize| {
        let amplitudes = if seed.is_multiple_of(2) { Amplitudes::Random } else { Amplitudes::Fixed };
        let surface = surface([0.3, 0.5, 0.8, 1.0][seed / 2 % 4], amplitudes, seed);
        held(&surface, kernels[seed / 4 % 2], Control::MeanPressure([1e-4, 1e-3, 1e-2][seed % 3]), as_map)
    };
    let [with, without] = seeds.map(of_scene).fold([0; 2], |sum, held| [sum[0] + held[0], sum[1] + held[1]]);
    assert!(100 * with >= 93 * n_scenes, "{with} of {n_scenes} bars hold");
    without as f64 / n_scenes as f64
}

#[test]
fn bars_hold_on_random_surfaces() {
    let without_summit = assert_bars_hold(700..748, [&Love, &Spectral], false);
    assert!(without_summit < 0.3, "few summits are between samples: {without_summit}");
}

#[test]
fn bars_hold_on_maps() {
    assert_bars_hold(800..824, [&Love, &Spectral], true);
}

#[test]
fn bars_hold_on_patches() {
    assert_bars_hold(900..924, [&FreeLove; 2], false);
    assert_bars_hold(924..948, [&FreeLove; 2], true);
}

fn audited() -> Surface {
    let spectrum = SpectrumParams {
        hurst: 0.5,
        amplitudes: Amplitudes::Random,
        normalisation: Normalisation::RmsHeight(0.01),
        ..SpectrumParams::paper(8, 3)
    };
    Surface::new(&spectrum).expect("a valid spectrum")
}

/// Its highest sample is far below the summit. The limit is from 2048² elements.
#[test]
fn bars_hold_where_the_summit_is_far_from_samples() {
    let (surface, load) = (audited(), Control::MeanPressure(0.01));
    for n in [128, 256] {
        let map = surface.sample(square(n));
        for source in [surface.on(square(n)), HeightSource::from(&map)] {
            let found = solve(source, &Love, load);
            let (error, bar) = ((found.info().penetration - 0.019_797_7).abs(), found.penetration_error());
            assert!(error <= bar && bar < 3.0 * error, "{n}²: {error:e} ± {bar:e}");
        }
    }
}

/// All methods and numbers of ranks know the same summit. Smaller elements at edges are nearer to it.
#[test]
fn all_methods_have_the_same_summit() {
    let (surface, load) = (audited(), Control::MeanPressure(1e-3));
    let uniform = solve(surface.on(square(256)), &Love, load);
    let adaptive = |level: usize, ranks| {
        let params = SolveParams { border_level: level, ..SolveParams::to_tolerance(1e-6).by(Method::Adaptive) };
        let problem = ContactProblem::new(surface.on(square(256)), load).over(ranks);
        let solution = problem.solve(&params, &Silent).expect("solvable");
        [solution.h_max(), solution.summit_excess(), solution.penetration_error()]
    };
    let [h_max, excess, error] = adaptive(0, rc_comm::Ranks::alone());
    assert!((h_max - uniform.h_max()).abs() < 1e-9 && (excess / uniform.summit_excess() - 1.0).abs() < 1e-3);
    assert!((error / uniform.penetration_error() - 1.0).abs() < 1e-2, "{error:e}");
    for of_rank in run_threads(2, |ranks| adaptive(0, ranks)).expect("threads") {
        assert_eq!(of_rank.map(f64::to_bits), [h_max, excess, error].map(f64::to_bits));
    }
    let [finer_max, finer_excess, _] = adaptive(2, rc_comm::Ranks::alone());
    assert!((finer_max + finer_excess - h_max - excess).abs() < 1e-3 * excess && finer_excess < 0.5 * excess);
    let params = SolveParams::to_tolerance(1e-4).by(Method::GaussSeidel);
    let paper = ContactProblem::new(surface.on(square(256)), load).solve(&params, &Silent).expect("solvable");
    assert!((paper.summit_excess() / excess - 1.0).abs() < 1e-3);
}

/// With the given penetration of coarse elements, the load is that of a smaller penetration from the summit.
#[test]
fn under_a_given_penetration_the_load_has_the_error() {
    let surface = audited();
    let reference = solve(surface.on(square(512)), &Love, Control::MeanPressure(0.01));
    let given = Control::Penetration(from_summit(&reference));
    for n in [64, 128, 256] {
        let found = solve(surface.on(square(n)), &Love, given);
        let error = (found.info().mean_pressure - 0.01).abs();
        let bar = found.mean_pressure_error().expect("a bar");
        assert!(error <= bar && bar < 3.0 * error, "{n}²: {error:e} ± {bar:e}");
    }
}
