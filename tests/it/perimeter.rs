//! The length of the edges of contacts, for straight edges in many directions and for circles.

use std::f64::consts::TAU;

use rc_core::{DVec2, Field, Grid, HeightField, Kernel, Silent};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactProblem, Control, Method, SolveParams};
use rc_theory::hertz::PeriodicHertz;

use crate::{assert_close, solved};

/// Numbers of waves along both axes, in directions from 0 to 90 degrees.
const WAVES: [[u8; 2]; 12] =
    [[1, 0], [11, 1], [6, 1], [3, 1], [2, 1], [3, 2], [6, 5], [1, 1], [5, 6], [1, 2], [1, 6], [0, 1]];

/// A wave of the cell.
#[derive(Clone, Copy, Debug)]
struct Wave([u8; 2]);

impl Wave {
    fn frequency(self) -> f64 {
        let [kx, ky] = self.0.map(f64::from);
        kx.hypot(ky)
    }

    /// A load at which each crest touches, with an edge on both sides.
    fn load(self) -> Control {
        Control::MeanPressure(0.005 * self.frequency())
    }

    /// The length of the edges of all crests.
    fn edges(self) -> f64 {
        2.0 * self.frequency()
    }
}

impl HeightField for Wave {
    fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
        let [kx, ky] = self.0.map(f64::from);
        0.01 * (TAU * (kx * x + ky * y) + 0.3).cos()
    }

    fn band_limit(&self) -> Option<usize> {
        self.0.into_iter().max().map(usize::from)
    }
}

#[test]
fn straight_edges_have_their_length_in_every_direction() {
    for waves in WAVES {
        let wave = Wave(waves);
        let heights = Field::from_fn(Grid::square(256).expect("a grid"), |at| wave.height(at));
        for kernel in [&Love as &dyn Kernel, &Spectral] {
            let area = solved(&heights, kernel, wave.load(), 1e-8).area();
            assert_close(&format!("{}, {waves:?}", kernel.name()), area.perimeter, wave.edges(), 3.5e-3);
        }
    }
}

/// The elements at the edges are half as large as the others.
#[test]
fn straight_edges_have_their_length_on_elements_of_two_sizes() {
    for waves in WAVES {
        let wave = Wave(waves);
        let params = SolveParams { border_level: 1, ..SolveParams::to_tolerance(1e-8).by(Method::Adaptive) };
        let problem = ContactProblem::new(wave.on(Grid::square(128).expect("a grid")), wave.load());
        let solution = problem.solve(&params, &Silent).unwrap_or_else(|error| panic!("{waves:?}: {error}"));
        assert_close(&format!("{waves:?}"), solution.area().perimeter, wave.edges(), 3.5e-3);
    }
}

#[test]
fn circles_have_their_length() {
    let n = 256;
    let grid = Grid::square(n).expect("a grid");
    // The errors allowed are those of each circle, and of the mean over their places between elements.
    for (elements, each, mean) in [(3.0, 4e-2, 1e-2), (5.0, 1e-2, 5e-3), (10.0, 5e-3, 3e-3), (25.0, 3e-3, 2e-3)] {
        let radius = elements / n as f64;
        let load = PeriodicHertz { radius: 1.0 }.at_contact_radius(radius).expect("a small contact").load;
        for kernel in [&Love as &dyn Kernel, &Spectral] {
            let circles = (0..8).map(|place| {
                let at = DVec2::new(0.618, 0.414) * f64::from(place);
                let middle = DVec2::splat(0.5) + at.fract() / n as f64;
                let heights = Field::from_fn(grid, |at| -0.5 * (at - middle).length_squared());
                let length = solved(&heights, kernel, Control::MeanPressure(load), 1e-8).area().perimeter;
                assert_close(&format!("{} of {elements}", kernel.name()), length, TAU * radius, each);
                length / 8.0
            });
            assert_close(&format!("{} of {elements}", kernel.name()), circles.sum(), TAU * radius, mean);
        }
    }
}

/// The shortest wave has 8 to 64 elements. The reference has 128.
#[test]
fn edges_of_a_rough_surface_converge() {
    let surface = rc_fractal::Surface::new(&rc_fractal::SpectrumParams::paper(8, 1)).expect("a surface");
    let length = |n: usize| {
        let heights = surface.on(Grid::square(n).expect("a grid"));
        let problem = ContactProblem::new(heights, Control::MeanPressure(8e-4));
        problem.solve(&SolveParams::to_tolerance(1e-8), &Silent).expect("solvable").area().perimeter
    };
    let finest = length(1024);
    for (n, allowed) in [(64, 1.2e-2), (128, 3e-3), (256, 1e-3), (512, 5e-4)] {
        assert_close(&format!("{n}"), length(n), finest, allowed);
    }
}

/// On oblong elements the positions of edges have larger errors.
#[test]
fn straight_edges_have_about_their_length_on_oblong_elements() {
    for sides in [[256, 128], [128, 256]] {
        for waves in [[1, 0], [3, 1], [2, 1], [1, 1], [1, 3], [0, 1]] {
            let wave = Wave(waves);
            let heights = Field::from_fn(Grid::new(sides[0], sides[1]).expect("a grid"), |at| wave.height(at));
            let area = solved(&heights, &Love, wave.load(), 1e-8).area();
            assert_close(&format!("{sides:?}, {waves:?}"), area.perimeter, wave.edges(), 7e-3);
        }
    }
}

/// Plastic contacts, whose edges are located where the overlap ends.
#[test]
fn sharp_edges_have_their_length() {
    for waves in WAVES {
        let wave = Wave(waves);
        let heights = Field::from_fn(Grid::square(256).expect("a grid"), |at| wave.height(at));
        let hardness = 5e-3;
        let problem = ContactProblem::new(&heights, Control::MeanPressure(0.2 * hardness)).with_hardness(hardness);
        let solution = problem.solve(&SolveParams::to_tolerance(1e-8), &Silent).expect("solvable");
        assert_close(&format!("{waves:?}"), solution.area().perimeter, wave.edges(), 2e-3);
    }
}
