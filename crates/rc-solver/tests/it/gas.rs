//! The conductance of a gas in the gap.

use rc_core::{Field, Silent};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams};

use crate::hardness::rough;

fn solve(heights: &Field, hardness: f64, method: Method) -> Solution<'_> {
    let problem = ContactProblem::new(heights, Control::MeanPressure(5e-4)).with_hardness(hardness);
    problem.solve(&SolveParams::default().by(method), &Silent).expect("solvable")
}

#[test]
fn the_inverse_gap_is_that_of_each_element_and_of_each_method() {
    let heights = rough(2, 256, 16);
    for hardness in [f64::INFINITY, 2e-2] {
        let by = [Method::Uniform, Method::Adaptive].map(|method| solve(&heights, hardness, method));
        // From far below the gaps to far above them.
        for jump_distance in [1e-7, 1e-4, 1.0] {
            let what = format!("hardness {hardness}, jump distance {jump_distance:e}");
            let found = by.each_ref().map(|solution| solution.mean_inverse_gap(jump_distance));
            for (solution, found) in by.iter().zip(found) {
                let fields = solution.gap().values().iter().zip(solution.pressure().values());
                let inverse =
                    fields.map(|(g, p)| if *p > 0.0 { 1.0 / jump_distance } else { 1.0 / (g + jump_distance) });
                let direct = inverse.sum::<f64>() / heights.grid().len() as f64;
                assert!((found / direct - 1.0).abs() < 1e-12, "{what}: {found} for {direct}");
            }
            // The energy error of 1 % leaves errors of its square; those of single elements at edges are divided by m.
            let expected = if jump_distance < 1e-6 { 5e-3 } else { 1e-4 };
            assert!((found[1] / found[0] - 1.0).abs() < expected, "{what}: {found:?}");
        }
        let contact = by[0].area().cells;
        let (far, near) = (by[0].mean_inverse_gap(1e3), by[0].mean_inverse_gap(1e-12));
        assert!((far * 1e3 - 1.0).abs() < 1e-4, "a wide gap conducts as its jumps do: {far}");
        assert!(
            (near * 1e-12 / contact - 1.0).abs() < 1e-2,
            "without jumps, contact shorts the gap: {near}, {contact}"
        );
    }
}
