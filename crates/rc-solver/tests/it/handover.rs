//! The uniform method after the adaptive one.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_core::{Field, Grid};
use rc_solver::{Control, Method, MethodReason, SolveError, SolveParams, Tolerance, solve};

/// The error of the operator on noise is 2e-4 of the pressure. The uniform operator has none.
#[test]
fn what_the_adaptive_method_cannot_certify_is_solved_by_the_uniform_one() {
    let grid = Grid::square(384).expect("a grid");
    let mut values = ChaCha8Rng::seed_from_u64(2);
    let heights = Field::from_fn(grid, |_| 0.01 * (values.random::<f64>() - 0.5));
    let load = Control::MeanPressure(2e-4);
    let params = SolveParams { tolerance: Tolerance::Energy(1e-4), ..SolveParams::default() };
    let taken = solve(&heights, load, &params).expect("certified");
    let MethodReason::NotCertified { error, .. } = taken.reason() else { panic!("{}", taken.reason()) };
    assert!(*error > 1e-4 && taken.certificate().energy <= 1e-4, "{error:e}, {}", taken.certificate());
    let uniform = solve(&heights, load, &params.by(Method::Uniform)).expect("certified");
    assert_eq!((taken.method(), taken.pressure()), (Method::Uniform, uniform.pressure()));
    let asked = solve(&heights, load, &params.by(Method::Adaptive)).expect_err("the method is used as given");
    let SolveError::NotConverged { solution, .. } = asked else { panic!("{asked}") };
    assert_eq!(solution.method(), Method::Adaptive);
    // If the uniform grid does not fit into memory, the best solution is that of the adaptive method.
    for method_follows_memory in [true, false] {
        let little = SolveParams { memory_limit: Some(1_300_000), method_follows_memory, ..params };
        let error = solve(&heights, load, &little).expect_err("not certified");
        let SolveError::NotConverged { solution, .. } = error else { panic!("{error}") };
        assert_eq!(solution.method(), Method::Adaptive);
    }
}
