//! Solves that an observer stops at any moment.

use std::sync::atomic::{AtomicUsize, Ordering};

use rc_core::{Event, Field, Observer};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveError, SolveParams, Status};

use crate::bumps;

/// Wants to stop from the n-th question on, and counts questions and iterations.
struct StopAt {
    n: usize,
    questions: AtomicUsize,
    iterations_after: AtomicUsize,
}

impl StopAt {
    fn new(n: usize) -> Self {
        Self { n, questions: AtomicUsize::new(0), iterations_after: AtomicUsize::new(0) }
    }

    fn is_over(&self) -> bool {
        self.questions.load(Ordering::Relaxed) > self.n
    }
}

impl Observer for StopAt {
    fn notify(&self, event: &Event) {
        if self.is_over() && matches!(event, Event::Iteration { iteration, .. } if *iteration > 0) {
            self.iterations_after.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn should_stop(&self) -> bool {
        self.questions.fetch_add(1, Ordering::Relaxed);
        self.is_over()
    }
}

fn solve(heights: &Field, control: Control, hardness: f64, method: Method, stop: &StopAt) -> Solution<'static> {
    let params = SolveParams::default().by(method);
    let result = ContactProblem::new(heights, control).with_hardness(hardness).solve(&params, stop);
    match result {
        Ok(solution) => solution.into_owned(),
        Err(SolveError::NotConverged { solution, .. }) => *solution,
        Err(error) => panic!("{error}"),
    }
}

/// A stop at any question leaves an admissible pressure with its certificate, and takes no further step.
#[test]
fn a_solve_stopped_at_any_moment_returns_an_admissible_pressure() {
    let heights = bumps(256, 256);
    let (load, depth) = (Control::MeanPressure(2e-3), Control::Penetration(2e-3));
    for (method, control, hardness) in [
        (Method::Uniform, load, f64::INFINITY),
        (Method::Uniform, depth, f64::INFINITY),
        (Method::Uniform, load, 0.02),
        (Method::Adaptive, load, f64::INFINITY),
        (Method::Adaptive, depth, f64::INFINITY),
    ] {
        let whole = StopAt::new(usize::MAX);
        let solved = solve(&heights, control, hardness, method, &whole);
        assert_eq!(solved.status(), Status::Converged, "{method}, {control:?}");
        let questions = whole.questions.into_inner();
        assert!(questions > 20, "{method}: asked {questions} times");
        for n in (0..questions).step_by(1 + questions / 23) {
            let stop = StopAt::new(n);
            let found = solve(&heights, control, hardness, method, &stop);
            let what = format!("{method}, {control:?}, hardness {hardness}, question {n} of {questions}");
            assert_eq!(found.grid(), solved.grid(), "{what}");
            assert_eq!(stop.iterations_after.into_inner(), 0, "{what}: a step after the stop");
            let pressure = found.pressure();
            assert!(pressure.min() >= 0.0 && pressure.max() <= hardness, "{what}: {}", pressure.max());
            let (info, certificate) = (found.info(), found.certificate());
            if let Control::MeanPressure(mean) = control {
                let off = (pressure.mean() / mean - 1.0).abs();
                assert!(off < 1e-6, "{what}: the load is off by {off:e}");
            }
            // The bound holds: energies of both differ by at most the certified error.
            assert!(certificate.energy.is_finite() && info.elastic_energy > 0.0, "{what}: {certificate:?}");
            let area = found.area().fraction / solved.area().fraction;
            assert!((0.3..3.0).contains(&area), "{what}: {area} times the area");
        }
    }
}
