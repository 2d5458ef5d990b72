//! Operators of a kernel against each other.

use std::panic::{AssertUnwindSafe, catch_unwind};

use rc_core::testing::{ChangedOperator, check_operator, quasi_random};
use rc_core::{Grid, Kernel, Operator};
use rc_kernel::{Love, Spectral};

use rc_solver::{DirectSum, UniformOperator};

#[test]
fn operators_meet_the_contract() {
    for kernel in [&Love as &dyn Kernel, &Spectral] {
        for (nx, ny) in [(12, 10), (9, 15), (1, 8), (40, 33)] {
            let grid = Grid::new(nx, ny).expect("grid");
            check_operator(&UniformOperator::new(grid, kernel));
        }
        check_operator(&DirectSum::new(Grid::new(6, 5).expect("grid"), kernel));
    }
}

#[test]
fn fft_operator_matches_direct_sum_on_non_square_grids() {
    for kernel in [&Love as &dyn Kernel, &Spectral] {
        for (nx, ny) in [(12, 10), (7, 18), (20, 3)] {
            let grid = Grid::new(nx, ny).expect("grid");
            let pressure: Vec<f64> = (0..grid.len()).map(quasi_random).collect();
            let (mut fast, mut slow) = (vec![0.0; grid.len()], vec![0.0; grid.len()]);
            UniformOperator::new(grid, kernel).apply(&pressure, &mut fast, &mut []);
            DirectSum::new(grid, kernel).apply(&pressure, &mut slow, &mut []);
            let scale = slow.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            for (f, s) in fast.iter().zip(&slow) {
                assert!((f - s).abs() <= 1e-14 * scale.max(1e-2), "{nx} x {ny}: {f} against {s}");
            }
        }
    }
}

/// A change of displacements.
type Fault = fn(&mut [f64]);

/// The check that forks run on their operators finds faults.
#[test]
fn the_contract_finds_faults() {
    let faults: [(&str, Fault); 6] = [
        ("NaN", |v| v[17] = f64::NAN),
        ("wrong sign", |v| v.iter_mut().for_each(|v| *v = -*v)),
        ("shifted by an element", |v| v.rotate_right(1)),
        ("bias", |v| v.iter_mut().for_each(|v| *v += 1e-9)),
        ("not symmetric", |v| v[..128].iter_mut().for_each(|v| *v *= 1.0 + 1e-7)),
        ("not linear", |v| v.iter_mut().for_each(|v| *v += *v * v.abs())),
    ];
    for (name, fault) in faults {
        let operator = ChangedOperator(UniformOperator::new(Grid::square(16).expect("grid"), &Love), fault);
        assert!(catch_unwind(AssertUnwindSafe(|| check_operator(&operator))).is_err(), "{name} was not found");
    }
}
