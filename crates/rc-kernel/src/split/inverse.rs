//! The inverse operator |q|/2 split by scale, with the accuracy of a preconditioner.

use std::f64::consts::PI;

use super::{Filter, Stencil};

/// Number of wavenumbers per axis at which the symbol is evaluated.
const SAMPLES: usize = 64;

/// The part of |q|/2 that a level adds to the next coarser level.
///
/// It is |q|/2 on the level minus |q|/2 on the coarser level between two filters, cut off at `radius`. The weight at
/// the centre is chosen so that a constant still gives zero.
pub(super) fn stencil(filter: &Filter, radius: usize) -> Stencil {
    let missing = Missing::new(filter, &|_| 1.0);
    let cut = Stencil::new(radius, |dx, dy| missing.weight(dx, dy));
    let excess = cut.sum();
    Stencil::new(radius, |dx, dy| {
        let value = cut.weight(dx as i32, dy as i32);
        if dx == 0 && dy == 0 { value - excess } else { value }
    })
}

/// The same of |q|/2 times a positive and even `factor` of the wavenumber along x, in radians per element.
pub(super) fn stencil_along_x(filter: &Filter, radius: usize, factor: &dyn Fn(f64) -> f64) -> Stencil {
    let missing = Missing::new(filter, factor);
    let cut = Stencil::of_rectangles(radius, |dx, dy| missing.weight(dx, dy));
    let excess = cut.sum();
    Stencil::of_rectangles(radius, |dx, dy| {
        let value = cut.weight(dx as i32, dy as i32);
        if dx == 0 && dy == 0 { value - excess } else { value }
    })
}

/// The symbol that a level adds, at equal steps of both wavenumbers.
struct Missing {
    wavenumbers: Vec<f64>,
    values: Vec<f64>,
}

impl Missing {
    fn new(filter: &Filter, factor: &dyn Fn(f64) -> f64) -> Self {
        let n = SAMPLES as i32;
        let wavenumbers: Vec<f64> = (0..n).map(|k| 2.0 * PI * f64::from(k - n / 2) / f64::from(n)).collect();
        let squares: Vec<f64> = wavenumbers.iter().map(|&q| filter.response(q).powi(2)).collect();
        // Waves that are too short for the coarse grid appear there as their longer aliases.
        let folded: Vec<f64> = wavenumbers.iter().map(|&q| q - PI * (q / PI).round()).collect();
        let factors: Vec<[f64; 2]> =
            wavenumbers.iter().zip(&folded).map(|(&q, &folded)| [factor(q), factor(folded)]).collect();
        let missing = |kx: usize, ky: usize| {
            let fine = factors[kx][0] * wavenumbers[kx].hypot(wavenumbers[ky]);
            let coarse = factors[kx][1] * folded[kx].hypot(folded[ky]);
            0.5 * (fine - squares[kx] * squares[ky] * coarse)
        };
        let values = (0..SAMPLES * SAMPLES).map(|i| missing(i % SAMPLES, i / SAMPLES)).collect();
        Self { wavenumbers, values }
    }

    fn weight(&self, dx: usize, dy: usize) -> f64 {
        let cosine = |k: usize, d: usize| (self.wavenumbers[k] * d as f64).cos();
        let row = |ky: usize| -> f64 { (0..SAMPLES).map(|kx| self.values[ky * SAMPLES + kx] * cosine(kx, dx)).sum() };
        (0..SAMPLES).map(|ky| row(ky) * cosine(ky, dy)).sum::<f64>() / (SAMPLES * SAMPLES) as f64
    }
}

#[cfg(test)]
mod tests {
    use crate::{ScaleSplit, SplitParams};

    /// The stencil restores |q|/2 well enough for a preconditioner.
    ///
    /// The coarser level has |q|/2 exactly here.
    #[test]
    fn one_level_restores_the_symbol() {
        let split = ScaleSplit::new(SplitParams::quick());
        let (filter, stencil) = (split.level_filter(), split.inverse_stencil(3));
        assert!(stencil.sum().abs() < 1e-12);
        for (qx, qy) in [(0.1, 0.0), (0.3, 0.2), (0.8, 0.1), (1.5, 1.0), (3.0, 0.5), (3.1, 3.1_f64)] {
            let fold = |q: f64| q - std::f64::consts::PI * (q / std::f64::consts::PI).round();
            let coarse = 0.5 * fold(qx).hypot(fold(qy)) * (filter.response(qx) * filter.response(qy)).powi(2);
            let mut fine = 0.0;
            for dx in -3..=3 {
                for dy in -3..=3 {
                    fine += stencil.weight(dx, dy) * (qx * f64::from(dx)).cos() * (qy * f64::from(dy)).cos();
                }
            }
            let ratio = (coarse + fine) / (0.5 * qx.hypot(qy));
            assert!((0.8..1.2).contains(&ratio), "({qx}, {qy}): {ratio}");
        }
    }
}
