//! Exact moments, and moments of grids.

use rc_core::{DVec2, Field, Grid, HeightField};
use rc_fractal::{
    Amplitudes, Moments, Normalisation, SpectrumParams, Truncation, height_and_slope_of_grid,
    height_and_slope_of_patch, moments_of_grid,
};

use crate::{assert_close, surface};

/// The paper's cell is 1 cm.
const CELL_UM: f64 = 1e4;
const CELL_M: f64 = 1e-2;

/// Independently computed values for the paper's two surfaces and both truncations.
///
/// The values are amplitudes at (1, 1) and (1, 0) (µm), rms slope, rms Laplacian (1/m) and Nayak's parameter. All
/// digits of the table must agree.
#[test]
fn moments_are_those_of_the_paper() {
    let table = [
        (Truncation::Disc, 64, ["2.68013023", "5.00129985", "0.0262327470", "469.394109", "117.944624"]),
        (Truncation::Disc, 128, ["2.67945718", "5.00004390", "0.0308104583", "1078.38210", "327.137758"]),
        (Truncation::Square, 64, ["2.67996742", "5.00099604", "0.0269903617", "549.527303", "144.251951"]),
        (Truncation::Square, 128, ["2.67940536", "4.99994720", "0.0316336913", "1256.35628", "399.580338"]),
    ];
    for (truncation, waves, expected) in table {
        let surface = surface(SpectrumParams { truncation, ..SpectrumParams::paper(waves, 1) });
        let moments = surface.moments();
        let actual = [
            surface.amplitude(1, 1).norm() * CELL_UM,
            surface.amplitude(1, 0).norm() * CELL_UM,
            moments.rms_slope,
            2.0 * moments.rms_curvature / CELL_M,
            moments.nayak,
        ];
        for (actual, expected) in actual.into_iter().zip(expected) {
            let decimals = expected.len() - expected.find('.').expect("a decimal point") - 1;
            assert_eq!(format!("{actual:.decimals$}"), expected, "{truncation:?}, N = {waves}: {actual}");
        }
        assert_close("rms height", moments.rms_height, 1.3e-3, 1e-14);
    }
}

/// Rounding errors of the transform reach the curvature through the largest q⁴. Hence the tolerance is 1e-10 and not
/// 1e-14.
#[test]
fn moments_of_a_resolved_grid_equal_the_exact_sums() {
    let surface = surface(SpectrumParams { amplitudes: Amplitudes::Random, ..SpectrumParams::paper(30, 3) });
    let exact = surface.moments();
    for (nx, ny) in [(61, 61), (64, 64), (96, 75), (81, 128)] {
        let sampled = moments_of_grid(&surface.sample_on(Grid::new(nx, ny).expect("small")).expect("resolved"));
        assert_same(&format!("{nx} x {ny}"), sampled, exact);
    }
}

#[test]
fn height_and_slope_need_one_axis_at_a_time() {
    let noise = |DVec2 { x, y }: DVec2| (1e3 * (13.0 * x + 57.0 * y)).sin() + 1e4;
    for (nx, ny) in [(64, 48), (35, 81), (128, 1), (2, 90)] {
        let heights = Field::from_fn(Grid::new(nx, ny).expect("small"), noise);
        let (moments, [height, slope]) = (moments_of_grid(&heights), height_and_slope_of_grid(&heights));
        assert_close("rms height", height, moments.rms_height, 1e-11);
        assert_close("rms slope", slope, moments.rms_slope, 1e-11);
    }
}

#[test]
fn the_mean_height_does_not_count() {
    let surface = surface(SpectrumParams::paper(10, 3));
    let grid = Grid::new(32, 27).expect("small");
    let shifted = Field::from_fn(grid, |at| surface.height(at) + 0.25);
    assert_same("shifted by 0.25", moments_of_grid(&shifted), surface.moments());
}

#[test]
fn one_wave_has_the_moments_of_a_cosine() {
    let q = 2.0 * std::f64::consts::PI * 5.0;
    let cosine =
        Field::from_fn(Grid::new(40, 17).expect("small"), |DVec2 { x, y }| 0.02 * (q * (0.6 * x + 0.8 * y)).cos());
    let rms = 0.02 / 2.0_f64.sqrt();
    let expected = Moments { rms_height: rms, rms_slope: q * rms, rms_curvature: q * q * rms / 2.0, nayak: 1.5 };
    assert_same("cosine of wave vector (3, 4)", moments_of_grid(&cosine), expected);
}

#[test]
fn the_requested_size_is_what_a_realisation_has() {
    for amplitudes in [Amplitudes::Fixed, Amplitudes::Random] {
        for seed in [0, 1, u64::MAX] {
            let base = SpectrumParams { amplitudes, ..SpectrumParams::paper(40, seed) };
            let of_slope = surface(SpectrumParams { normalisation: Normalisation::RmsSlope(0.07), ..base });
            assert_close("rms slope", of_slope.moments().rms_slope, 0.07, 1e-12);
            let of_height = surface(SpectrumParams { normalisation: Normalisation::RmsHeight(0.3), ..base });
            let heights = of_height.sample_on(Grid::new(100, 81).expect("small")).expect("resolved");
            assert_close("rms height on a grid", heights.rms(), 0.3, 1e-12);
            assert!(heights.mean().abs() < 1e-15, "mean height {:e}", heights.mean());
        }
    }
}

fn assert_same(what: &str, actual: Moments, expected: Moments) {
    let pairs = [
        ("rms height", actual.rms_height, expected.rms_height),
        ("rms slope", actual.rms_slope, expected.rms_slope),
        ("rms curvature", actual.rms_curvature, expected.rms_curvature),
        ("Nayak", actual.nayak, expected.nayak),
    ];
    for (name, actual, expected) in pairs {
        assert_close(&format!("{what}, {name}"), actual, expected, 1e-10);
    }
}

/// A tilted plane has its slope, without a cliff at the border.
#[test]
fn the_slope_of_a_patch_is_that_inside() {
    let grid = rc_core::Grid::in_cell(40, 30, 0.75).expect("a grid");
    let plane = rc_core::Field::from_fn(grid, |at| 0.3 * at.x - 0.4 * at.y);
    let [height, slope] = height_and_slope_of_patch(&plane);
    assert!((slope / 0.5 - 1.0).abs() < 1e-12, "slope {slope}");
    let uniform = |side: f64, n: f64| side * side / 12.0 * (1.0 - (n * n).recip());
    let expected = (0.09 * uniform(1.0, 40.0) + 0.16 * uniform(0.75, 30.0)).sqrt();
    assert!((height / expected - 1.0).abs() < 1e-12, "height {height} for {expected}");
}
