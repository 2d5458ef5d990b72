//! The slow reference: an independent elimination of the network.

use rc_core::testing::quasi_random;
use rc_core::{Field, Grid};
use rc_leakage::{LeakageParams, leakage};

/// Power of the network of `gap` under a unit fall across the cell, by elimination.
///
/// The fall is along x (`axis` 0) or y.
fn eliminated(gap: &Field, axis: usize) -> f64 {
    let grid = gap.grid();
    let (nx, ny, n) = (grid.nx(), grid.ny(), grid.len());
    let aspects = [grid.spacing().y / grid.spacing().x, grid.spacing().x / grid.spacing().y];
    let mut bonds = Vec::new();
    for iy in 0..ny {
        for ix in 0..nx {
            let next = [(ix + 1) % nx + iy * nx, ix + (iy + 1) % ny * nx];
            for (direction, next) in next.into_iter().enumerate() {
                let [a, b] = [ix + iy * nx, next].map(|i| gap.values()[i].powi(3));
                let fall = if direction == axis { 1.0 / [nx, ny][axis] as f64 } else { 0.0 };
                if a > 0.0 && b > 0.0 {
                    bonds.push((ix + iy * nx, next, aspects[direction] * 2.0 * a * b / (a + b), fall));
                }
            }
        }
    }
    let (mut matrix, mut right) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for &(a, b, conductance, fall) in &bonds {
        for (i, j, value) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            matrix[i][j] += value * conductance;
        }
        right[a] -= conductance * fall;
        right[b] += conductance * fall;
    }
    let pressure = solve(matrix, right);
    bonds.iter().map(|&(a, b, conductance, fall)| conductance * (pressure[a] - pressure[b] + fall).powi(2)).sum()
}

/// Elimination without pivoting. A pivot that is rounding belongs to a free pressure level.
fn solve(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    let diagonal: Vec<f64> = (0..n).map(|i| matrix[i][i]).collect();
    let is_free = |pivot: f64, i: usize| pivot <= 1e-12 * diagonal[i];
    for k in 0..n {
        if is_free(matrix[k][k], k) {
            continue;
        }
        let pivot_row = matrix[k].clone();
        for i in k + 1..n {
            let factor = matrix[i][k] / pivot_row[k];
            if factor != 0.0 {
                matrix[i].iter_mut().zip(&pivot_row).skip(k).for_each(|(entry, pivot)| *entry -= factor * pivot);
                right[i] -= factor * right[k];
            }
        }
    }
    let mut solution = vec![0.0; n];
    for i in (0..n).rev().filter(|&i| !is_free(matrix[i][i], i)) {
        let known: f64 = (i + 1..n).map(|j| matrix[i][j] * solution[j]).sum();
        solution[i] = (right[i] - known) / matrix[i][i];
    }
    solution
}

#[test]
fn permeances_are_those_of_elimination() {
    // Sides are odd, even, or large enough for several levels. Walls are from none to nearly all, and gaps extend over
    // three decades.
    for (nx, ny, ratio, walls) in
        [(24, 24, 1.0, 0.0), (24, 24, 1.0, 0.3), (25, 18, 0.6, 0.35), (31, 17, 4.0, 0.2), (24, 26, 1.0, 0.42)]
    {
        for seed in 0..4 {
            let gap = (0..nx * ny).map(|i| {
                let random = |salt: usize| quasi_random(7919 * (i + 1) + 104_729 * (4 * seed + salt));
                if random(1) < walls { 0.0 } else { 10.0_f64.powf(-3.0 * random(2)) }
            });
            let grid = Grid::in_cell(nx, ny, ratio).expect("a grid");
            let gap = Field::new(grid, gap.collect()).expect("a value for each element");
            let leakage = leakage(&gap, &LeakageParams::default()).expect("a flow");
            for (axis, flow) in leakage.flows.iter().enumerate() {
                let exact = eliminated(&gap, axis);
                let scale = if flow.percolates { exact } else { 1.0 };
                let what = format!("{nx} x {ny}, {walls} walls, seed {seed}, axis {axis}");
                assert!((flow.permeance - exact).abs() < 1e-9 * scale, "{what}: {} for {exact}", flow.permeance);
                assert!(
                    flow.percolates == (flow.permeance > 0.0) && flow.info.conservation <= 1e-10,
                    "{what}: {flow:?}"
                );
            }
        }
    }
}

/// The bounds are valid for any pressure, long before convergence.
#[test]
fn the_permeance_of_elimination_is_between_the_bounds() {
    let mut widest = 0.0_f64;
    for (seed, error) in [(0, 0.9), (1, 0.1), (2, 1e-2), (3, 1e-4), (4, 1e-6)] {
        let (nx, ny) = (26, 22);
        let gap = (0..nx * ny).map(|i| {
            let random = |salt: usize| quasi_random(7919 * (i + 1) + 104_729 * (4 * seed + salt));
            if random(1) < 0.3 { 0.0 } else { 10.0_f64.powf(-3.0 * random(2)) }
        });
        let gap = Field::new(Grid::in_cell(nx, ny, 0.8).expect("a grid"), gap.collect()).expect("a field");
        let leakage = leakage(&gap, &LeakageParams { error, ..LeakageParams::default() }).expect("a flow");
        for (axis, flow) in leakage.flows.iter().enumerate().filter(|(_, flow)| flow.percolates) {
            let exact = eliminated(&gap, axis);
            let lower = flow.permeance * (1.0 - flow.info.error);
            let is_between = lower <= exact * (1.0 + 1e-12) && exact <= flow.permeance * (1.0 + 1e-12);
            assert!(is_between, "seed {seed}, axis {axis}: {exact} is not from {lower} to {}", flow.permeance);
            widest = widest.max(flow.info.error);
        }
    }
    assert!(widest > 1e-4, "the bounds were never apart: {widest:e}");
}
