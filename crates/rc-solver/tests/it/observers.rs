//! The pressures that an observer sees during a solve, by every method.

use std::sync::Mutex;

use rc_core::{DVec2, Event, Field, Grid, HeightField as _, Observer, Silent, Snapshot};
use rc_solver::{ContactProblem, Control, GaussSeidelParams, Method, SolveParams};

use crate::bumps;

const TAU: f64 = std::f64::consts::TAU;

const MEAN_PRESSURE: f64 = 2e-3;

/// Keeps every pressure that it is shown, and counts iterations.
#[derive(Default)]
struct Watching {
    seen: Mutex<Vec<Field>>,
    iterations: Mutex<usize>,
}

impl Observer for Watching {
    fn notify(&self, event: &Event) {
        if matches!(event, Event::Iteration { .. }) {
            *self.iterations.lock().expect("one thread") += 1;
        }
    }

    fn look(&self, pressure: &Snapshot<'_>) {
        let mut values = Vec::new();
        pressure.pressure_rows(|rows| {
            assert!(rows.len().is_multiple_of(pressure.grid().nx()), "{} values are no whole rows", rows.len());
            values.extend_from_slice(rows);
        });
        let field = Field::new(pressure.grid(), values).expect("all rows of the grid");
        self.seen.lock().expect("one thread").push(field);
    }
}

/// The pressure on the grid of the heights, by a method that an observer watches.
fn pressure(method: Method, heights: &Field, observer: &dyn Observer) -> Field {
    let gauss_seidel = GaussSeidelParams { uniform_elements: true, ..GaussSeidelParams::paper() };
    let params = SolveParams { gauss_seidel, ..SolveParams::default().by(method) };
    let problem = ContactProblem::new(heights, Control::MeanPressure(MEAN_PRESSURE));
    problem.solve(&params, observer).expect("solvable").pressure().clone()
}

#[test]
fn a_watched_solve_finds_the_same_bits_and_shows_them_at_the_end() {
    for (name, side) in [(Method::Uniform, 256), (Method::Adaptive, 512), (Method::GaussSeidel, 64)] {
        let (heights, watching) = (bumps(side, side), Watching::default());
        let found = pressure(name, &heights, &watching);
        assert!(found == pressure(name, &heights, &Silent), "{name}: watching changes the result");
        let seen = watching.seen.into_inner().expect("one thread");
        assert_eq!(seen.len(), watching.iterations.into_inner().expect("one thread"), "{name}: once an iteration");
        assert!(
            seen.iter().all(|field| field.values().iter().all(|p| p.is_finite())),
            "{name}: a pressure is not finite"
        );
        let sides: Vec<usize> = seen.iter().map(|field| field.grid().nx()).collect();
        assert!(sides.is_sorted() && sides.last() == Some(&side), "{name}: grids of {sides:?} elements per side");
        // Gauss-Seidel shows elements under tension before it takes them out.
        let tensile = name == Method::GaussSeidel;
        assert!(tensile || seen.iter().all(|field| field.min() >= 0.0), "{name}: a pressure is negative");
        let last = seen.last().expect("at least one");
        let pairs = last.values().iter().zip(found.values());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // After the last look there is only a fresh gap and the last digits of the load.
        assert!(worst <= 1e-3 * found.max(), "{name}: off by {:e} of the peak", worst / found.max());
    }
}

#[test]
fn elements_of_several_sizes_are_shown_on_the_grid() {
    struct Wave;
    impl rc_core::HeightField for Wave {
        fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
            5e-3 * (TAU * x).cos() + 4e-3 * (TAU * (x + 2.0 * y)).cos()
        }
        fn band_limit(&self) -> Option<usize> {
            Some(3)
        }
    }
    let watching = Watching::default();
    let params = SolveParams { border_level: 2, ..SolveParams::default().by(Method::Adaptive) };
    let heights = Wave.on(Grid::square(128).expect("a grid"));
    let problem = ContactProblem::new(heights, Control::MeanPressure(MEAN_PRESSURE));
    let solution = problem.solve(&params, &watching).expect("solvable");
    let seen = watching.seen.into_inner().expect("one thread");
    let last = seen.last().expect("at least one");
    assert_eq!(last.grid(), solution.grid());
    // The mean over elements of different sizes is the load. Its last digits are set after the last look.
    assert!((last.mean() / MEAN_PRESSURE - 1.0).abs() < 1e-6, "mean {:e}", last.mean());
}
