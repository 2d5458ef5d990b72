//! One solve over several ranks: the digits are those of one rank.

use rc_comm::{Ranks, run_threads};
use rc_core::{Grid, HeightField, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{ContactElement, ContactProblem, Control, Method, Solution, SolveParams};

/// What a rank knows of a solution: its elements, and everything else as text with all digits.
fn told(solution: &Solution<'_>) -> (Vec<ContactElement>, String) {
    let elements = solution.elements().expect("a mesh").collect();
    let counts = [solution.n_elements(), solution.n_evaluated(), solution.n_proven()];
    let observables = (solution.observables(), solution.stiffness(), solution.status());
    (elements, format!("{:?} {counts:?} {observables:?}", solution.info()))
}

/// Fails unless the paper's surface with this many waves has the same solution, bit by bit, on 1, 2 and 4 ranks.
fn assert_same_digits(waves: usize, side: usize, control: Control, tolerance: f64) {
    let surface = Surface::new(&SpectrumParams::paper(waves, 1)).expect("a surface");
    let grid = Grid::square(side).expect("a grid");
    let solve = |ranks: Ranks| {
        let problem = ContactProblem::new(surface.on(grid), control).over(ranks);
        told(&problem.solve(&SolveParams::to_tolerance(tolerance).by(Method::Adaptive), &Silent).expect("a solution"))
    };
    let (elements, text) = solve(Ranks::alone());
    assert!(elements.len() > 1000, "{} elements", elements.len());
    for size in [2, 4] {
        let parts = run_threads(size, solve).expect("all ranks end");
        assert!(parts.iter().all(|(part, _)| part.len() < elements.len()), "a rank has a part");
        for (rank, (_, of_rank)) in parts.iter().enumerate() {
            assert_eq!(*of_rank, text, "rank {rank} of {size}, {control:?}");
        }
        let all: Vec<ContactElement> = parts.into_iter().flat_map(|(part, _)| part).collect();
        let bits = |element: &ContactElement| {
            let ContactElement { centre, side, pressure } = element;
            [centre.x, centre.y, *side, *pressure].map(f64::to_bits)
        };
        assert!(all.iter().map(bits).eq(elements.iter().map(bits)), "elements of {size} ranks, {control:?}");
    }
}

#[test]
fn digits_do_not_depend_on_the_number_of_ranks_at_64_waves() {
    assert_same_digits(64, 1024, Control::MeanPressure(8.9e-4), 1e-6);
    assert_same_digits(64, 1024, Control::Penetration(1.4e-3), 1e-6);
}

#[test]
fn digits_do_not_depend_on_the_number_of_ranks_at_128_waves() {
    assert_same_digits(128, 2048, Control::MeanPressure(8.9e-4), 1e-6);
    assert_same_digits(128, 2048, Control::Penetration(1.4e-3), 1e-6);
}
