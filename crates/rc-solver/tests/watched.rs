//! What an observer sees of a running solve, by every method.

use std::sync::Mutex;

use rc_core::{DVec2, Event, Field, Grid, HeightSource, Observer, Silent, Snapshot};
use rc_kernel::{Love, PeriodicLove};
use rc_solver::{
    AdaptiveParams, Control, GaussSeidelParams, IterationParams, solve_adaptive, solve_gauss_seidel, solve_uniform,
};

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

fn bumps(n: usize) -> Field {
    Field::from_fn(Grid::square(n).expect("grid"), |DVec2 { x, y }| {
        let wave = |a: f64, kx: f64, ky: f64, phase: f64| a * (TAU * (kx * x + ky * y + phase)).cos();
        wave(5e-3, 1.0, 0.0, 0.1) + wave(4e-3, 1.0, 2.0, 0.37) + wave(2e-3, 3.0, -2.0, 0.8) + wave(1e-3, -2.0, 5.0, 0.5)
    })
}

/// Solves with this observer: the pressure on the grid of the heights.
type Method = fn(&Field, &dyn Observer) -> Field;

fn by_uniform(heights: &Field, observer: &dyn Observer) -> Field {
    let control = Control::MeanPressure(MEAN_PRESSURE);
    solve_uniform(heights, &Love, control, &IterationParams::certified(), observer).expect("solvable").pressure
}

fn by_adaptive(heights: &Field, observer: &dyn Observer) -> Field {
    let (source, control) = (HeightSource::Map(heights), Control::MeanPressure(MEAN_PRESSURE));
    let solution = solve_adaptive(source, control, &AdaptiveParams::certified(), observer).expect("solvable");
    let mut values = Vec::new();
    let Ok(()) = solution.pressure_rows(|_, rows| {
        values.extend_from_slice(rows);
        Ok::<_, std::convert::Infallible>(())
    });
    Field::new(solution.grid(), values).expect("all rows")
}

fn by_gauss_seidel(heights: &Field, observer: &dyn Observer) -> Field {
    let periodic = PeriodicLove::new();
    let params = GaussSeidelParams { uniform_elements: true, ..GaussSeidelParams::paper() };
    let control = Control::MeanPressure(MEAN_PRESSURE);
    let coefficient = |offset: DVec2, half_side: f64| periodic.coefficient(offset, half_side);
    solve_gauss_seidel(heights, &Love, &coefficient, control, &params, observer).expect("solvable").pressure
}

#[test]
fn a_watched_solve_finds_the_same_bits_and_shows_them_at_the_end() {
    for (name, method, side) in
        [("uniform", by_uniform as Method, 256), ("adaptive", by_adaptive, 512), ("gauss-seidel", by_gauss_seidel, 64)]
    {
        let (heights, watching) = (bumps(side), Watching::default());
        let pressure = method(&heights, &watching);
        assert!(pressure == method(&heights, &Silent), "{name}: watching changes the result");
        let seen = watching.seen.into_inner().expect("one thread");
        assert_eq!(seen.len(), watching.iterations.into_inner().expect("one thread"), "{name}: once an iteration");
        assert!(
            seen.iter().all(|field| field.values().iter().all(|p| p.is_finite())),
            "{name}: a pressure is not finite"
        );
        let sides: Vec<usize> = seen.iter().map(|field| field.grid().nx()).collect();
        assert!(sides.is_sorted() && sides.last() == Some(&side), "{name}: grids of {sides:?} elements per side");
        // Gauss-Seidel shows elements under tension before it takes them out.
        let tensile = name == "gauss-seidel";
        assert!(tensile || seen.iter().all(|field| field.min() >= 0.0), "{name}: a pressure is negative");
        let last = seen.last().expect("at least one");
        let pairs = last.values().iter().zip(pressure.values());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // What comes after the last look is a fresh gap and the last digits of the load.
        assert!(worst <= 1e-3 * pressure.max(), "{name}: off by {:e} of the peak", worst / pressure.max());
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
    let params = AdaptiveParams { border_level: 2, ..AdaptiveParams::certified() };
    let control = Control::MeanPressure(MEAN_PRESSURE);
    let solution = solve_adaptive(
        HeightSource::Surface { surface: &Wave, grid: Grid::square(128).expect("a grid") },
        control,
        &params,
        &watching,
    )
    .expect("solvable");
    let seen = watching.seen.into_inner().expect("one thread");
    let last = seen.last().expect("at least one");
    assert_eq!(last.grid(), solution.grid());
    // The mean over elements of different sizes is the load; its last digits are set after the last look.
    assert!((last.mean() / MEAN_PRESSURE - 1.0).abs() < 1e-6, "mean {:e}", last.mean());
}
