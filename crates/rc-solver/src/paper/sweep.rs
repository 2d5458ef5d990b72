//! Gauss-Seidel on a given set of elements: step (iv) of the paper's procedure.

use rayon::prelude::*;

use crate::paper::coefficients::{Coefficients, Site};

/// Number of elements that are relaxed before the others get their changes.
///
/// It does not change the order of relaxation, which is that of the elements. It only groups the work.
const BLOCK: usize = 64;

/// The end of a relaxation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Relaxed {
    pub(super) sweeps: usize,
    /// Maximum |v_i - prescribed v_i| over the elements.
    pub(super) residual: f64,
}

/// Limits of a relaxation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Maximum |v_i - prescribed v_i| that may remain.
    pub(super) residual: f64,
    pub(super) max_sweeps: usize,
    /// Over-relaxation factor.
    pub(super) relaxation: f64,
}

/// Relaxes `pressure` until L p equals `prescribed` on the elements.
///
/// Elements are relaxed in their order. Each sees all changes before it, as Gauss-Seidel demands. A block is relaxed in
/// sequence. Then the displacement of all other elements by its changes is added, in parallel over those elements. The
/// sums do not depend on the number of threads.
pub(super) fn relax(
    coefficients: &Coefficients<'_>,
    sites: &[Site],
    prescribed: &[f64],
    pressure: &mut [f64],
    limits: &Limits,
) -> Relaxed {
    let mut sweeps = 0;
    loop {
        // Fresh sums at the start of some sweeps prevent rounding from building up, at the price of one more product.
        let mut v = displacement(coefficients, sites, pressure);
        for _ in 0..SWEEPS_PER_REFRESH {
            let residual = greatest_difference(&v, prescribed);
            if residual <= limits.residual || sweeps >= limits.max_sweeps {
                return Relaxed { sweeps, residual };
            }
            sweep(coefficients, sites, prescribed, pressure, &mut v, limits.relaxation);
            sweeps += 1;
        }
    }
}

/// Sweeps between two fresh products.
const SWEEPS_PER_REFRESH: usize = 16;

fn greatest_difference(v: &[f64], prescribed: &[f64]) -> f64 {
    v.iter().zip(prescribed).map(|(v, wanted)| (v - wanted).abs()).fold(0.0, f64::max)
}

/// `v = L p` on the elements: step (v) for elements in contact.
pub(super) fn displacement(coefficients: &Coefficients<'_>, sites: &[Site], pressure: &[f64]) -> Vec<f64> {
    let at = |&target: &Site| {
        sites.iter().zip(pressure).map(|(&source, p)| coefficients.get(target, source) * p).sum::<f64>()
    };
    sites.par_iter().map(at).collect()
}

fn sweep(
    coefficients: &Coefficients<'_>,
    sites: &[Site],
    prescribed: &[f64],
    pressure: &mut [f64],
    v: &mut [f64],
    relaxation: f64,
) {
    let mut changes = [0.0; BLOCK];
    for first in (0..sites.len()).step_by(BLOCK) {
        let block = first..(first + BLOCK).min(sites.len());
        for i in block.clone() {
            let own = coefficients.get(sites[i], sites[i]);
            let change = relaxation * (prescribed[i] - v[i]) / own;
            pressure[i] += change;
            changes[i - first] = change;
            for j in block.clone() {
                v[j] += coefficients.get(sites[j], sites[i]) * change;
            }
        }
        let sources = &sites[block.clone()];
        v.par_iter_mut().zip(sites).enumerate().with_min_len(256).for_each(|(j, (v, &target))| {
            if !block.contains(&j) {
                let terms =
                    sources.iter().zip(&changes).map(|(&source, change)| coefficients.get(target, source) * change);
                *v += terms.sum::<f64>();
            }
        });
    }
}
