//! A surface is the same for any grid, method and number of threads.

use rc_core::{DVec2, Field, Grid, HeightField, testing};
use rc_fractal::{Amplitudes, SampleError, SpectrumParams, Surface, Truncation, moments_of_grid, radial_spectrum};

use crate::surface;

#[test]
fn the_height_field_contract_holds() {
    for truncation in [Truncation::Disc, Truncation::Square] {
        testing::check_height_field(&surface(SpectrumParams { truncation, ..SpectrumParams::paper(17, 8) }));
    }
}

/// Compares synthesis with the direct sum.
///
/// Some grids resolve the surface. Others are so coarse that waves fold, down to one element.
#[test]
fn synthesis_equals_the_direct_sum_on_any_grid() {
    let surface = surface(SpectrumParams { truncation: Truncation::Square, ..SpectrumParams::paper(40, 2) });
    let scale = surface.moments().rms_height;
    let grids = [(96, 96), (250, 180), (81, 82), (80, 80), (64, 41), (40, 20), (9, 16), (2, 3), (1, 5), (1, 1)];
    for (nx, ny) in grids {
        let grid = Grid::new(nx, ny).expect("small");
        let heights = surface.sample(grid);
        for step in 0..37 {
            let index = step * (grid.len() - 1) / 36;
            let at = grid.centre(index % nx, index / nx);
            let (fast, direct) = (heights.values()[index], surface.height(at));
            let error = (fast - direct).abs() / scale;
            // Rounding of 6560 waves whose sizes have a sum of about 40 rms.
            assert!(error <= 1e-13, "{grid}, element {index}: {fast:e}, direct sum {direct:e}, error {error:.1e} rms");
        }
    }
}

#[test]
fn the_direct_sum_is_the_definition() {
    let surface = surface(SpectrumParams::paper(6, 11));
    for (x, y) in [(0.0, 0.0), (0.3, 0.71), (-1.2, 5.9)] {
        let mut expected = 0.0;
        for kx in -6_i64..=6 {
            for ky in -6_i64..=6 {
                let phase = 2.0 * std::f64::consts::PI * (kx as f64 * x + ky as f64 * y);
                let a = surface.amplitude(kx, ky);
                expected += a.re * phase.cos() - a.im * phase.sin();
            }
        }
        let height = surface.height(DVec2::new(x, y));
        let error = (height - expected).abs() / 1.3e-3;
        assert!(error <= 1e-13, "h({x}, {y}) = {height:e}, Eq. 10 gives {expected:e}, error {error:.1e} rms");
    }
}

#[test]
fn heights_far_from_the_cell_are_as_accurate_as_inside() {
    let surface = surface(SpectrumParams::paper(64, 1));
    let (near, far) =
        (surface.height(DVec2::new(0.375, 0.625)), surface.height(DVec2::new(1_048_576.375, -1_048_575.375)));
    assert!((near - far).abs() <= 1e-13 * 1.3e-3, "{near:e} in the cell, {far:e} a million cells away");
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let params = SpectrumParams { amplitudes: Amplitudes::Random, ..SpectrumParams::paper(50, 7) };
    let all = || {
        let surface = surface(params);
        let heights = surface.sample(Grid::new(300, 131).expect("small"));
        let statistics = (surface.moments(), moments_of_grid(&heights), radial_spectrum(&heights));
        (surface.amplitude(31, -8), heights, statistics)
    };
    let with_threads = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("a small pool").install(all);
    let one = with_threads(1);
    for n_threads in [2, 3] {
        assert!(with_threads(n_threads) == one, "{n_threads} threads give another result than one");
    }
}

#[test]
fn a_coarse_grid_is_refused_with_the_smallest_that_would_do() {
    let surface = surface(SpectrumParams::paper(20, 1));
    let grid = Grid::new(64, 40).expect("small");
    let error = surface.sample_on(grid).expect_err("40 elements are too few for 20 waves");
    assert_eq!(error, SampleError::TooCoarse { grid, waves: 20, smallest: 41 });
    assert_eq!(
        error.to_string(),
        "a grid of 64 x 40 is too coarse for 20 waves: it needs at least 41 elements per side"
    );
    assert!(surface.sample_on(Grid::square(41).expect("small")).is_ok());
}

/// A rectangular map has the same moments as the square of its copies. They also have the same power in all rings
/// together.
#[test]
fn a_rectangle_has_the_moments_of_its_copies_and_all_of_the_power() {
    let copies = 4;
    let wave = |x: f64, y: f64| {
        let wave = |a: f64, kx: f64, ky: f64| a * (std::f64::consts::TAU * (kx * x + ky * y) + kx).cos();
        wave(3e-3, 2.0, 1.0) + wave(1e-3, 5.0, -3.0) + wave(2e-3, 0.0, 2.0)
    };
    for (nx, ny, ratio) in [(48, 24, 0.25), (24, 48, 4.0)] {
        let part = Field::from_fn(Grid::in_cell(nx, ny, ratio).expect("a grid"), |DVec2 { x, y }| wave(x, y / ratio));
        let whole = if ratio < 1.0 {
            Field::from_fn(Grid::new(nx, copies * ny).expect("a grid"), |DVec2 { x, y }| wave(x, y / ratio))
        } else {
            // Lengths are in units of the longer side.
            Field::from_fn(Grid::new(copies * nx, ny).expect("a grid"), |DVec2 { x, y }| wave(ratio * x, y) / ratio)
        };
        let unit = ratio.max(1.0);
        let (a, b) = (moments_of_grid(&part), moments_of_grid(&whole));
        for (a, b) in [
            (a.rms_height, b.rms_height * unit),
            (a.rms_slope, b.rms_slope),
            (a.rms_curvature, b.rms_curvature / unit),
            (a.nayak, b.nayak),
        ] {
            assert!((a / b - 1.0).abs() < 1e-12, "{a} of the rectangle, {b} of its copies");
        }
        let rings = radial_spectrum(&part);
        let power: f64 = rings.iter().map(|ring| ring.psd * ring.n_modes as f64).sum();
        let power = std::f64::consts::TAU.powi(2) * power / ratio;
        assert!((power / a.rms_height.powi(2) - 1.0).abs() < 1e-12, "{power} in the rings");
    }
    let surface = Surface::new(&SpectrumParams::paper(4, 1)).expect("a surface");
    let rectangle = Grid::in_cell(32, 16, 0.5).expect("a grid");
    assert_eq!(surface.sample_on(rectangle), Err(SampleError::RectangularCell));
    let direct = surface.height(rectangle.centre(5, 7));
    assert!((surface.sample(rectangle).at(5, 7) - direct).abs() < 1e-15, "sampled as evaluated");
}
