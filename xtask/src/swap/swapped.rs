//! Put among the solver's own tests by `cargo xtask swap`: its kernel is that of the fork, and is one that it can rely on.

use rc_core::testing::{check_kernel, check_operator};
use rc_core::{Grid, Kernel as _};
use rc_kernel::Love;
use rc_solver::UniformOperator;

#[test]
fn the_solver_is_built_with_the_fork() {
    assert_eq!(Love.name(), "my-love");
    check_kernel(&Love);
    check_operator(&UniformOperator::new(Grid::new(12, 10).expect("a grid"), &Love));
}
