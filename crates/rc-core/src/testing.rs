//! Conformance checks of the traits. Forks run them on their own types.
//!
//! Each function panics with a sentence that says what failed, so a test is one call.

use crate::{DVec2, Grid, HeightField, Kernel, Operator};

/// A reproducible quasi-random value in [0, 1) for index `i`.
///
/// The values form a Weyl sequence. The function has no state and needs no other crate.
#[must_use]
pub fn quasi_random(i: usize) -> f64 {
    (i as f64 * 0.754_877_666_246_692_8 + 0.5).fract()
}

/// Checks that a [`HeightField`] is finite and periodic, and that its samples equal its values.
///
/// The check uses a grid whose sides are odd and unequal, which exposes exchanged axes.
///
/// # Panics
/// When the contract is broken.
pub fn check_height_field(surface: &dyn HeightField) {
    let side = surface.band_limit().map_or(15, |limit| 2 * limit + 3);
    let grid = Grid::new(side, side + 2).expect("the band limit fits a grid");
    let sampled = surface.sample(grid);
    let scale = sampled.max().abs().max(sampled.min().abs()).max(f64::MIN_POSITIVE);
    for n in 0..97 {
        let i = n * (grid.len() - 1) / 96;
        let at = grid.centre(i % grid.nx(), i / grid.nx());
        let h = surface.height(at);
        assert!(h.is_finite(), "height at {at} is {h}");
        let differences = [
            ("sample", (sampled.values()[i] - h).abs()),
            ("period in x", (surface.height(at + DVec2::X) - h).abs()),
            ("period in y", (surface.height(at - DVec2::Y) - h).abs()),
        ];
        for (what, difference) in differences {
            assert!(
                difference <= 1e-9 * scale,
                "{what}: off by {difference:e} at {at}, heights are of order {scale:e}"
            );
        }
    }
}

/// Checks the symbol of a [`Kernel`].
///
/// The symbol must be zero at k = 0, and positive and finite elsewhere. It must be symmetric under x ↔ y on a square
/// grid. Three copies of a rectangular cell make a square cell. The check requires that both cells have the same symbol
/// for the same waves.
///
/// # Panics
/// When the contract is broken.
pub fn check_kernel(kernel: &dyn Kernel) {
    for (nx, ny) in [(16, 16), (15, 9), (8, 20)] {
        let symbol = kernel.symbol(Grid::new(nx, ny).expect("small grid"));
        assert!(symbol(0, 0) == 0.0, "the symbol at k = 0 is {}, not 0", symbol(0, 0));
        for ky in 0..=ny / 2 {
            for kx in 0..=nx / 2 {
                let value = symbol(kx, ky);
                let allowed = if kx + ky == 0 { value == 0.0 } else { value > 0.0 && value.is_finite() };
                assert!(allowed, "the symbol at ({kx}, {ky}) on {nx} x {ny} is {value}");
                if nx == ny {
                    let mirrored = symbol(ky, kx);
                    assert!(
                        (value - mirrored).abs() <= 1e-13 * value,
                        "symbol ({kx}, {ky}) = {value}, mirrored {mirrored}"
                    );
                }
            }
        }
    }
    // Three copies make a square, with square and with rectangular elements.
    for (nx, ny) in [(24, 8), (12, 10)] {
        let part = kernel.symbol(Grid::in_cell(nx, ny, 1.0 / 3.0).expect("small grid"));
        let whole = kernel.symbol(Grid::new(nx, 3 * ny).expect("small grid"));
        for ky in 0..=ny / 2 {
            for kx in 0..=nx / 2 {
                let (value, copies) = (part(kx, ky), whole(kx, 3 * ky));
                assert!(
                    (value - copies).abs() <= 1e-13 * value,
                    "the symbol at ({kx}, {ky}) of a third of a cell is {value}, of its three copies {copies}"
                );
            }
        }
    }
}

/// Checks a symmetric [`Operator`].
///
/// The operator must be linear, symmetric, positive on random loads, and zero for a uniform load. The result must not
/// depend on the previous contents of output or scratch.
///
/// # Panics
/// When the contract is broken.
pub fn check_operator(operator: &dyn Operator) {
    let n = operator.n_elements();
    let apply = |p: &[f64], dirt: f64| {
        let (mut v, mut scratch) = (vec![dirt; n], vec![dirt; operator.scratch_len()]);
        operator.apply(p, &mut v, &mut scratch);
        v
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let a: Vec<f64> = (0..n).map(|i| quasi_random(i) - 0.5).collect();
    let b: Vec<f64> = (0..n).map(|i| quasi_random(3 * i + 1) - 0.5).collect();
    let (la, lb) = (apply(&a, 0.0), apply(&b, 0.0));
    let scale = la.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(scale > 0.0 && scale.is_finite(), "the displacement of a random load is {scale}");

    assert!(apply(&a, f64::NAN) == la, "the result depends on what scratch and output held before");
    let combined: Vec<f64> = a.iter().zip(&b).map(|(a, b)| 2.0 * a - b).collect();
    for ((c, la), lb) in apply(&combined, 0.0).iter().zip(&la).zip(&lb) {
        assert!((c - (2.0 * la - lb)).abs() <= 1e-12 * scale, "not linear: {c} against {}", 2.0 * la - lb);
    }
    let (ab, ba) = (dot(&a, &lb), dot(&b, &la));
    assert!((ab - ba).abs() <= 1e-12 * scale * n as f64, "not symmetric: <a, Lb> = {ab}, <b, La> = {ba}");
    assert!(dot(&a, &la) > 0.0, "not positive: <a, La> = {}", dot(&a, &la));
    let worst = apply(&vec![1.0; n], 0.0).iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    assert!(worst <= 1e-12, "a uniform pressure moves the surface by {worst}");
}

/// An operator whose displacements a function changes, for tests of what must notice it.
#[derive(Debug)]
pub struct ChangedOperator<O, F>(pub O, pub F);

impl<O: Operator, F: Fn(&mut [f64]) + Sync> Operator for ChangedOperator<O, F> {
    fn n_elements(&self) -> usize {
        self.0.n_elements()
    }

    fn scratch_len(&self) -> usize {
        self.0.scratch_len()
    }

    fn apply(&self, pressure: &[f64], displacement: &mut [f64], scratch: &mut [f64]) {
        self.0.apply(pressure, displacement, scratch);
        (self.1)(displacement);
    }
}
