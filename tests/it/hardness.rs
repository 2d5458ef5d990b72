//! A sphere with a hardness.
//!
//! First yield is at Hertz's peak pressure. In the end the contact is plastic everywhere.

use std::f64::consts::PI;

use rc_core::{DVec2, Field, Grid, Silent};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams};
use rc_theory::hertz::PeriodicHertz;

fn sphere(n: usize) -> Field {
    let grid = Grid::square(n).expect("a grid");
    let centre = grid.centre(n / 2, n / 2);
    Field::from_fn(grid, |at| -(at - centre).length_squared() / 2.0)
}

fn solve(heights: &Field, load: f64, hardness: f64) -> Solution<'_> {
    let params = SolveParams::to_tolerance(1e-8).by(Method::Uniform);
    let problem = ContactProblem::new(heights, Control::MeanPressure(load)).with_hardness(hardness);
    problem.solve(&params, &Silent).expect("solvable")
}

#[test]
fn a_sphere_yields_at_the_peak_pressure_of_hertz_and_at_its_centre() {
    let heights = sphere(512);
    let elastic = PeriodicHertz { radius: 1.0 }.at_contact_radius(0.1).expect("a small contact");
    let below = solve(&heights, elastic.load, 1.002 * elastic.peak_pressure);
    assert!(below.observables().plastic.expect("hard").cells <= 0.0, "nothing yields below first yield");
    let above = solve(&heights, elastic.load, 0.99 * elastic.peak_pressure);
    let plastic = above.observables().plastic.expect("hard");
    assert!(plastic.cells > 0.0, "{plastic:?}");
    let centre = heights.grid().centre(256, 256);
    let farthest = above.pressure().values().iter().enumerate().filter(|(_, p)| **p >= above.hardness());
    let farthest = farthest.map(|(i, _)| (heights.grid().centre(i % 512, i / 512) - centre).length());
    // Without plasticity p = 0.99 p0 at r = a √(1 - 0.99²) = 0.14 a. The load that the plastic part does not bear makes
    // it about half as wide again.
    let farthest = farthest.fold(0.0, f64::max) / elastic.contact_radius;
    assert!((0.14..0.3).contains(&farthest), "plastic up to {farthest} a");
}

#[test]
fn a_sphere_far_beyond_first_yield_is_plastic_all_over() {
    let heights = sphere(256);
    let elastic = PeriodicHertz { radius: 1.0 }.at_contact_radius(0.1).expect("a small contact");
    let (mut last, hardness) = (f64::INFINITY, elastic.peak_pressure);
    for factor in [2.0, 8.0, 40.0] {
        // The load at first yield is proportional to the cube of the hardness.
        let hardness = hardness * f64::powf(factor, -1.0 / 3.0);
        let solution = solve(&heights, elastic.load, hardness);
        let (area, plastic) = (solution.area(), solution.observables().plastic.expect("hard"));
        let excess = area.fraction * hardness / elastic.load - 1.0;
        assert!(
            excess > -area.relative_error() && excess < last,
            "area {excess} more than load over hardness at {factor}"
        );
        assert!(plastic.fraction < area.fraction && plastic.fraction * hardness < elastic.load, "{plastic:?}");
        // This is the radius of a circle with the contact area.
        let radius = (area.fraction / PI).sqrt();
        let edge = DVec2::new(radius, 0.0).length();
        assert!((edge / (elastic.contact_radius * (1.0 + excess).sqrt())) > 0.5, "radius {radius}");
        last = excess;
    }
    assert!(last < 0.03, "the contact is plastic all over but for {last}");
}

/// Errors of the plastic area on coarse grids are about half of its error bars.
///
/// The reference is the area on a fine grid.
#[test]
fn bars_of_the_plastic_area_hold_their_errors() {
    let bumps = |shift: DVec2, n: usize| {
        let wave = |t: f64| (2.0 * PI * t).cos();
        Field::from_fn(Grid::square(n).expect("a grid"), |at| {
            let DVec2 { x, y } = at + shift / n as f64;
            1e-3 * (wave(x + 0.1)
                + 0.7 * wave(y - 2.0 * x)
                + 0.4 * wave(3.0 * x + 2.0 * y)
                + 0.3 * wave(4.0 * y - x + 0.3))
        })
    };
    let (load, hardness) = (2e-3, 7e-3);
    let plastic = |heights: &Field| solve(heights, load, hardness).observables().plastic.expect("hard");
    let exact = plastic(&bumps(DVec2::ZERO, 1024)).fraction;
    let mut squares = Vec::new();
    for i in 0..12 {
        let shift = DVec2::new(f64::from(i) * 0.618, f64::from(i) * 0.414);
        let found = plastic(&bumps(shift, 128));
        squares.push(((found.fraction - exact) / found.error).powi(2));
    }
    let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    assert!(rms < 0.8, "{rms}: {squares:?}");
}
