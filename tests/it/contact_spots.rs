//! The areas of contact spots add up to the contact area, for all methods.

use rc_core::{Boundary, DVec2, Field, Grid, HeightField, HeightSource, Kernel, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::{FreeLove, Love, Spectral};
use rc_solver::{ContactProblem, ContactSpot, Control, Method, SolveParams};
use rc_theory::hertz::PeriodicHertz;

/// How a scene is solved.
#[derive(Clone, Copy)]
struct Way<'a> {
    kernel: &'a dyn Kernel,
    method: Method,
    border_level: usize,
    /// Hardness over the mean pressure.
    hardness: f64,
}

const ADAPTIVE: Way<'static> =
    Way { kernel: &Love, method: Method::Adaptive, border_level: 0, hardness: f64::INFINITY };
const UNIFORM: Way<'static> = Way { method: Method::Uniform, ..ADAPTIVE };
const WAYS: [Way<'static>; 7] = [
    ADAPTIVE,
    UNIFORM,
    Way { border_level: 2, ..ADAPTIVE },
    Way { kernel: &Spectral, ..UNIFORM },
    Way { kernel: &FreeLove, ..UNIFORM },
    Way { hardness: 20.0, ..ADAPTIVE },
    Way { hardness: 20.0, ..UNIFORM },
];

/// Solves a scene, and fails unless its spots have all of its contact. Returns its number of spots of one element.
fn assert_spots_are_the_contact<'a>(heights: impl Into<HeightSource<'a>>, mean_pressure: f64, way: Way<'a>) -> usize {
    let params = SolveParams { border_level: way.border_level, ..SolveParams::to_tolerance(1e-6).by(way.method) };
    let problem = ContactProblem::new(heights, Control::MeanPressure(mean_pressure)).with_kernel(way.kernel);
    let problem = problem.with_hardness(way.hardness * mean_pressure);
    let solution = problem.solve(&params, &Silent).expect("solvable");
    let boundary = if way.kernel.name() == FreeLove.name() { Boundary::Free } else { Boundary::Periodic };
    let overlap = solution.plastic_gap();
    let gap = solution.gap().values().iter().zip(overlap.values()).map(|(gap, overlap)| gap - overlap).collect();
    let gap = Field::new(solution.grid(), gap).expect("a field");
    let (bias, area) = (way.kernel.edge_bias(solution.grid()), solution.area().fraction);
    let spots = ContactSpot::with_area([solution.pressure(), &gap], solution.hardness(), bias, boundary, area);
    let sum = |of: fn(&ContactSpot) -> f64| spots.iter().map(of).sum::<f64>();
    assert!(spots.iter().all(|spot| spot.area_fraction > 0.0 && spot.mean_pressure > 0.0), "{spots:?}");
    assert!(spots.is_sorted_by(|a, b| a.area_fraction >= b.area_fraction));
    assert!((sum(|spot| spot.mean_pressure) / mean_pressure - 1.0).abs() < 1e-9);
    if area > 0.0 {
        let error = sum(|spot| spot.area_fraction) / area - 1.0;
        assert!(error.abs() < 1e-12, "{} by {}: {error:e}", way.kernel.name(), way.method.name());
    }
    spots.iter().filter(|spot| spot.elements == 1).count()
}

#[test]
fn spots_of_random_surfaces_add_up_to_the_contact() {
    let mut n_single = 0;
    for seed in 0..21 {
        let spectrum = SpectrumParams { hurst: 0.3, ..SpectrumParams::paper(40, 60 + seed as u64) };
        let surface = Surface::new(&spectrum).expect("a valid spectrum");
        let heights = surface.on(Grid::square([192, 256, 384][seed % 3]).expect("a grid"));
        let load = [1e-4, 1e-3, 1e-2][seed / 7];
        n_single += assert_spots_are_the_contact(heights, load, WAYS[seed % 7]);
    }
    assert!(n_single > 50, "{n_single}");
}

/// Balls with contact radii of 0.3 to 0.8 elements, at other places between elements each.
#[test]
fn spots_below_an_element_have_an_area() {
    const N: usize = 128;
    let mut n_single = 0;
    for (i, way) in WAYS.into_iter().enumerate().filter(|(_, way)| way.border_level == 0) {
        for radius in [0.3, 0.4, 0.5, 0.6, 0.7, 0.8] {
            let contact = PeriodicHertz { radius: 0.01 }.at_contact_radius(radius / N as f64).expect("a small contact");
            // Sixteen balls, each in a square of its own.
            let height = |at: DVec2| {
                let ball = (4.0 * at).floor();
                let place = (0.25 * ball + 0.125)
                    + DVec2::new(0.618, 0.414) * (ball.x + 4.0 * ball.y + i as f64) / N as f64 % (1.0 / N as f64);
                -50.0 * (at - place).length_squared()
            };
            let map = Field::from_fn(Grid::square(N).expect("a grid"), height);
            n_single += assert_spots_are_the_contact(&map, 16.0 * contact.load, way);
        }
    }
    assert!(n_single > 100, "{n_single}");
}
