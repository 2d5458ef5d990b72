//! Error bars where the error comes from the inside of contacts, or from a free border.

use rc_core::{DVec2, Field, Grid, HeightField as _, Silent};
use rc_fractal::{Complex64, Surface, Wave};
use rc_kernel::{FreeLove, Love};
use rc_solver::{ContactProblem, Control, Method, SolveParams};

use crate::solved;

/// Two long waves, and two short ones with 6.8 elements for a wave on 64².
fn waves() -> Surface {
    let waves = [(1, 0, 0.005), (0, 1, 0.005), (8, 5, 6.25e-4), (-5, 8, 6.25e-4)];
    let wave = |(kx, ky, amplitude): (i64, i64, f64)| Wave { kx, ky, amplitude: Complex64::new(amplitude, 0.0) };
    Surface::from_waves(waves.map(wave).to_vec()).expect("four waves")
}

/// Bars for a 95 % error may be slightly too small in a few scenes.
const BARS: f64 = 1.3;

/// Near full contact, short waves of the pressure inside contacts cause most of the error of ⟨p²⟩.
///
/// The true values are from an independent audit on finer grids.
#[test]
fn the_rms_pressure_is_within_its_bar_where_the_error_is_inside_contacts() {
    let (uniform, refined) = (SolveParams::default().by(Method::Uniform), SolveParams::default().by(Method::Adaptive));
    let refined = SolveParams { border_level: 2, ..refined };
    let surface = waves();
    for (load, exact) in [(0.0951, 0.106_654_06), (0.1087, 0.119_028_37), (0.1318, 0.140_465_91), (0.14, 0.148_187_22)]
    {
        for (side, params) in [64, 128].into_iter().flat_map(|side| [(side, &uniform), (side, &refined)]) {
            let heights = surface.on(Grid::square(side).expect("a grid"));
            let problem = ContactProblem::new(heights, Control::MeanPressure(load)).with_kernel(&Love);
            let found = *problem.solve(params, &Silent).expect("solvable").observables();
            let scene = format!("{load} on {side}², border level {}", params.border_level);
            let [error, raw] = [found.rms_pressure_corrected, found.rms_pressure].map(|rms| (rms - exact).abs());
            let bar = found.rms_pressure_error.expect("a bar");
            assert!(error <= BARS * bar, "{scene}: {error:e}, bar {bar:e}");
            assert!(5.0 * error <= raw, "{scene}: {error:e}, without the correction {raw:e}");
        }
    }
}

/// The singular pressure at a border presses the contact deeper on larger elements.
///
/// The true area is from an independent audit on finer grids.
#[test]
fn the_area_is_within_its_bar_where_contact_reaches_a_border() {
    let exact = 0.123_62;
    for side in [32, 64, 128, 256] {
        let place = DVec2::new(0.0, 0.51);
        let heights = Field::from_fn(Grid::square(side).expect("a grid"), |at| -0.5 * (at - place).length_squared());
        let area = solved(&heights, &FreeLove, Control::MeanPressure(0.02), 1e-8).area();
        let error = (area.fraction - exact).abs();
        assert!(error <= area.error, "{side}²: {} ± {} for {exact}", area.fraction, area.error);
    }
}
